"""
Which of my targets does the arm reach, and why not the others?
===============================================================

Targets may be a list, a CSV or Parquet table, or measured points. "Unreachable" is a proof for arms whose inverse
kinematics has a closed form, as the UR5e's.
"""

import numpy as np

import wsrender as ws

x, y = np.meshgrid(np.linspace(0.2, 1.1, 7), np.linspace(-0.6, 0.6, 7))
points = np.stack([x.ravel(), y.ravel(), np.full(x.size, 0.1)], axis=1)
down = np.tile([0.0, 1.0, 0.0, 0.0], (len(points), 1))
asked = [{"least_share": 0.8, "joint_margin_deg": 5}]
result = ws.reachability("ur5e", points, down, criteria=asked, device="cpu")
print(result.summary())
print(result.document["verdict"])

# Picture: The targets in space with the arm: 33 near ones are reached, 16 far ones are crossed out.
result.plot.targets()

# %%
# The table behind it, one row per target:

result.to_pandas("targets")[["position_0", "position_1", "position_2", "label", "reason"]].head(8)
