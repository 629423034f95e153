"""
Can the arm carry 3 kg everywhere?
==================================

``payload_capacity`` is the mass [kg] that the motors hold at rest, by the model's torque limits and link masses. Its
*least* value per voxel answers for every posture that was drawn, its greatest for the best one.
"""

import numpy as np

import wsrender as ws

options = {"payload_capacity": {"com_m": [0, 0, 0.05], "limit_kg": 20}}
result = ws.analyze(
    "ur5e",
    ws.Sobol(1 << 18),
    ["payload_capacity"],
    index_options=options,
    gravity_m_s2=(0, 0, -9.81),
    voxel_statistics=["minimum", "maximum"],
    voxel_size_m=0.05,
    refined_volume=None,
    device="cpu",
)
volume = result.to_xarray()
print(f"at least {float(volume.minimum_payload_capacity.min()):.1f} kg")

# %%
# In which share of the voxels is a mass held in every posture drawn, and in which in at least one? 3 kg everywhere, at
# rest; more not.

least, most = volume["minimum_payload_capacity"], volume["maximum_payload_capacity"]
occupied = np.isfinite(least)
for kg in (3, 6, 10, 14, 18):
    every, one = (float((held >= kg).sum() / occupied.sum()) for held in (least, most))
    print(f"{kg:2d} kg: in every posture in {every:4.0%} of the voxels, in at least one in {one:4.0%}")

# %%
# The picture of the worst case: far out the arm holds less than near its base.

# Picture: Slice at y = 0 of the least payload in kilograms, about 9 where the arm is stretched out, 20 above and
# below the base.
result.plot.slice(y=0.0, index="payload_capacity", statistic="minimum")
