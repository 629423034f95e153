"""Indices of another package, in one file."""

import wsrender as ws


def anisotropy(sigma, m, n):
    return 1.0 - ws.math.divide(sigma[-1], sigma[0])


def weighted(sigma, m, n, *, weight):
    return sigma[0] + weight * sigma[-1]


WEIGHT = ws.Option("weight", default=0.5, range=(0.0, 4.0), description="share of the smallest value")
BOTH = [
    ws.Index("anisotropy", "1 - 1/κ", anisotropy, "lab", range=(0.0, 1.0), unit="1", bound=1.0),
    ws.Index("weighted", "σ_w", weighted, "lab", unit=lambda A: A.value, options=(WEIGHT,)),
]
