"""
What is the exact boundary of a planar arm?
===========================================

Lines and arcs, each with the joints at their limits that draw it. DXF and SVG are written, too.
"""

import wsrender as ws

boundary = ws.exact_boundary("scara", locked={"joint4": 0.0})
kinds = [segment.kind for loop in boundary.segments for segment in loop]
print(f"area {boundary.area:.6f} m², {kinds.count('arc')} arcs and {kinds.count('line')} lines")

# %%
# Beside it what a Monte Carlo sample finds:

samples = ws.BoundaryBiased(100_000, locked={"joint4": 0.0})
result = ws.planar_boundary("scara", samples)

# Picture: The boundary as lines and arcs around the sampled points, in the plane.
result.plot.boundary()
