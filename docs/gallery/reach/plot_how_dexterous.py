"""
How dexterous is an arm? From how many directions does it get there?
====================================================================

A point may be reached from one side only. ``ws.capability`` asks inverse kinematics, voxel by voxel, for each of many
approach directions; the *dexterous* workspace is where all of them are reached.
"""

import wsrender as ws

result = ws.capability("ur5e", voxel_size_m=0.2, directions=20, device="cpu")
print(result.summary())

# %%
# Around the middle of the workspace the arm comes from everywhere; near its border only outwards, and near the
# base's axis from few sides.

# Picture: Three planes through the workspace: the share of directions is 1 around the base, and lower at the border
# and along the base axis.
result.plot.slices()

# %%
# Finer voxels and more directions are a matter of time: eight times the voxels for half their size.

# Picture: Interactive view of the voxels, coloured by the share of approach directions that are reached.
result
