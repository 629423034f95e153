"""
How do I add a constraint of my own?
====================================

A function of the configuration that is admitted where it is not negative: here the elbow must stay above the base.
"""

import wsrender as ws

ws.register_constraint("elbow_high", lambda q, position, axes, frames: frames[2].position[2] - 0.2)
result = ws.analyze(
    "ur5e",
    ws.Sobol(1 << 18),
    ["manipulability"],
    constraints={"elbow_high": True},
    refined_volume=None,
    voxel_size_m=0.06,
    device="cpu",
)
print(result.document["samples"])

# %%
# The share of samples in each voxel that are admitted:

# Picture: Planes of the share of admitted samples: 1 above the base, 0 below, with a mixed belt between.
result.plot.share(at=(0, 0, 0.3))
