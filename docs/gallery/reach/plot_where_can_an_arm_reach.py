"""
Where can a UR5e reach?
=======================

The reachable volume, with its uncertainty, and a map of how well the arm moves there.
"""

import wsrender as ws

result = ws.analyze("ur5e", ws.Sobol(1 << 18), ["manipulability"], device="cpu")
print(result.summary())

# %%
# The number to quote is the *headline*: whether points are reached is decided by inverse kinematics, not by counting
# voxels, and the interval says how far off it may be.

headline = result.document["headline"]
print(f"{headline['value']:.3f} m³, 95 % interval {headline['ci95'][0]:.3f} … {headline['ci95'][1]:.3f}")

# %%
# A slice through the base's axis: the colour is the largest manipulability that was found in each voxel. Near the axis
# the arm hardly moves sideways: dark.

# Picture: Slice at y = 0 through the UR5e's workspace, a disc of 0.95 m radius, bright on both sides of the axis,
# dark along it.
result.plot.slice(y=0.0, index="manipulability")

# %%
# The same in three dimensions: turn it, cut it, hide voxels below a threshold.

# Picture: Interactive view of the UR5e in the voxels of its workspace, coloured by manipulability.
result
