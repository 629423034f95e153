"""
Which surfaces bound a spatial arm's workspace?
===============================================

Patches of planes, spheres, cylinders, cones and tori where three joints move the end point: each with the limits that
generate it.
"""

import wsrender as ws

surface = ws.boundary_patches("cylindrical")
print(surface.document["volume_m3"])

# Picture: The boundary from two sides, a colour for each patch: cylinders and planes.
surface.plot.patches()

# %%

surface.to_pandas("patches")[["kind", "generated_by", "method", "radius_m"]]
