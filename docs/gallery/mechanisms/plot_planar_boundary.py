"""
What is the exact boundary of a planar arm?
===========================================

Lines and arcs, each with the joints at their limits that draw it. DXF and SVG are written, too.
"""

import wsrender as ws

boundary = ws.exact_boundary("scara", locked={"joint4": 0.0})
print(f"area {boundary.area:.6f} m², {len(boundary.segments)} segments")

# %%
# Beside it what a Monte Carlo sample finds:

samples = ws.BoundaryBiased(100_000, locked={"joint4": 0.0})
result = ws.planar_boundary("scara", samples)

# Picture: The boundary as lines and arcs around the sampled points, in the plane.
result.plot.boundary()
