"""
How do I keep the arm from colliding with itself and a table?
=============================================================

What stands around is an ``Environment``; ``self_collision`` keeps the arm off itself. Labels of collisions are
MuJoCo's.
"""

import wsrender as ws

cell = ws.Environment(
    [
        ws.HalfSpace(name="floor", point_m=(0, 0, -0.5)),
        ws.Box(name="table", size_m=(0.6, 1.2, 0.04), position_m=(0.6, 0, -0.05)),
    ]
)
kept = {"self_collision": True, "environment": {"margin_m": 0.005}}
result = ws.analyze(
    "ur5e",
    ws.Sobol(1 << 18),
    ["manipulability"],
    environment=cell,
    constraints=kept,
    voxel_size_m=0.05,
    refined_volume=0.03,
    device="cpu",
)
print(result.summary())

# %%
# *Free* is what some admitted posture reaches, *blocked* where postures were found and all were rejected, *undecided*
# what neither could be shown of.

for name in ("free", "blocked", "undecided"):
    found = result.document["volume_m3"][name]
    print(f"{name:10s}{found['value']:.2f} m³, 95 %: {found['ci95'][0]:.2f} … {found['ci95'][1]:.2f}")

# Picture: Planes of free voxels in grey and blocked ones in orange; the blocked ones are the table and all below
# the floor.
result.plot.admission(at=(0.4, 0, 0.2))

# %%

# Picture: Interactive view of the free workspace with arm, table and floor.
result
