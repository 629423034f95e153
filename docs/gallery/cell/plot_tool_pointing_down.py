"""
Where can the tool point straight down?
=======================================

For pick and place only postures count whose tool points downwards: an ``orientation`` of the tip, within a cone.
"""

import wsrender as ws

down = {"axis": [0, 0, 1], "toward": [0, 0, -1], "within_deg": 10}
result = ws.analyze(
    "ur5e",
    ws.Sobol(1 << 18),
    ["manipulability"],
    constraints={"orientation": down},
    refined_volume=0.03,
    voxel_size_m=0.08,
    voxel_labels=True,
    device="cpu",
)
print(result.summary())

# %%
# With ``voxel_labels`` it decides each voxel, too.
#
# Few random postures point downwards; the headline does not suffer from it, since inverse kinematics looks for them.

samples, labels = result.document["samples"], result.document["voxel_labels"]
print(f"{samples['admitted']:,} of {samples['drawn']:,} samples point downwards")
print(", ".join(f"{name} {number:,}" for name, number in labels["labels"].items()))

# Picture: Planes of voxels by whether their centres are reached so: all but a rim and the surroundings of the axis.
result.plot.labels(at=(0, 0, 0.2))
