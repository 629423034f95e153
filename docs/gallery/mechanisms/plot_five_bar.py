"""
Where is a five-bar singular, and which parts connect?
======================================================

A planar five-bar is known exactly: singular loci, conditioning in every working mode, and aspects, the parts between
which it cannot move without a singularity.
"""

import wsrender as ws

result = ws.five_bar(ws.FiveBar.symmetric(6, 8, 5), points_m=[[5, 7]])
print(result.summary())

# Picture: Map over the plane of the conditioning of A, with the singular curves, in each working mode.
result.plot.conditioning("a")

# %%

# Picture: The aspects of each working mode, in the plane and in the space of the joints.
result.plot.aspects()
