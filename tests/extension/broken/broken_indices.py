"""Entries that are no indices, and some whose names are taken."""

import wsrender as ws


def _largest(sigma, m, n):
    return sigma[0]


NUMBER = 3
TAKEN = ws.Index("manipulability", "μ", _largest, "lab")
TWICE = [ws.Index("largest", "σ", _largest, "lab")] * 2
NEEDY = ws.Index("heavy", "h", _largest, "lab", needs=("gravity",))
