"""
How do I compare two designs?
=============================

The same arm with a longer forearm, as Denavit–Hartenberg tables: volumes with intervals, and indices, side by side.
"""

import wsrender as ws


def arm(forearm_m: float) -> ws.DHTable:
    """Three joints: a shoulder of two axes and an elbow."""
    limits = {"limits_deg": [-150, 150]}
    rows = [{"d": 0.3, "alpha_deg": 90, **limits}, {"a": 0.4, **limits}, {"a": forearm_m, **limits}]
    return ws.DHTable(convention="standard", rows=rows)


designs = {"forearm_0.3": arm(0.3), "forearm_0.4": arm(0.4)}
result = ws.robot_comparison(
    list(designs.values()), ws.Grid(60), indices=["manipulability"], names=list(designs), device="cpu"
)
print(result.summary())

# Picture: Planes through both workspaces, one arm a row; the longer forearm reaches farther.
result.plot.comparison()
