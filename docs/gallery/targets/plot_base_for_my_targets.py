"""
Where do I put the base so that all my targets are reached?
===========================================================

Ten holes of a plate, to be met from above, and a post in the way: from each cell of a grid of placements, how many are
served?
"""

import wsrender as ws

holes = [(0.5 + 0.06 * row, y, 0.12) for row in range(5) for y in (-0.03, 0.03)]
around = ws.Environment([ws.Cylinder(name="post", radius_m=0.04, length_m=1.0, position_m=(0.35, 0.25, 0.5))])
over = {"x_m": [-0.5, 1.2, 0.1], "y_m": [-0.6, 0.6, 0.1], "yaw_deg": [0, 360, 90]}
result = ws.base_placement("ur5e", holes, [(0, 1, 0, 0)] * 10, over=over, environment=around, device="cpu")
print(result.summary())

# Picture: Map over x and y of how many of the ten holes are served: all, but near the plate, at the post and far off.
result.plot.placements()

# %%

# Picture: Interactive view of the arm at the best placement, with the holes and the post.
result
