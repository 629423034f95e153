"""
What is the workspace of a Stewart platform?
============================================

Six legs of 0.5 to 0.8 m: where can the platform go without turning? The exact boundary is made of parts of spheres, one
for each limit of a leg.
"""

import wsrender as ws

hexapod = {"library": "stewart_gough", "length_m": [0.5, 0.8]}
exact = ws.parallel_workspace(hexapod, method="exact")
print(exact.summary())

# Picture: The boundary surface from two sides, each face in the colour of the leg that is at a limit there.
exact.plot.surface()

# %%
# With indices, on a lattice:

result = ws.parallel_workspace(hexapod, indices=["inverse_condition_number"], voxel_size_m=0.03, device="cpu")

# Picture: Three planes through the workspace, coloured by the inverse condition number.
result.plot.slices()

# %%

# Picture: Interactive view of the platform with its six legs in its workspace.
result
