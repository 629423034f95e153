"""
What are all postures of a pose?
================================

A UR5e has up to eight. Each within the limits and to 1e-9 m and rad; what stands around says which are free.
"""

import wsrender as ws

floor = ws.Environment([ws.HalfSpace(name="floor")])
result = ws.all_postures(
    "ur5e", [[0.4, 0.2, 0.3]], quat_wxyz=[[0, 1, 0, 0]], environment=floor, indices=["manipulability"], device="cpu"
)
print(result.summary())

# Picture: The arm in all eight postures that put the tool at the same pose; the legend names the four that hit the
# floor.
result.plot.postures()

# %%

found = ws.postures(ws.load_robot("ur5e"), [0.4, 0.2, 0.3], [0, 1, 0, 0], environment=floor, device="cpu")
for q, reason in zip(found.configurations, found.reasons, strict=True):
    print(q.round(3), reason or "free")
