"""
How do I describe an arm by Denavit–Hartenberg parameters?
==========================================================

A table, standard or modified; of a planar arm the headline is an area.
"""

import wsrender as ws

rows = [{"a": 0.4, "limits_deg": [-150, 150]}, {"a": 0.3, "limits_deg": [-160, 160]}]
planar = ws.load_robot(ws.DHTable(convention="standard", rows=rows))
common = {"indices": ["manipulability"], "voxel_size_m": 0.01, "device": "cpu"}
result = ws.analyze(planar, ws.Grid(400), task=["x", "y"], **common)
print(result.summary())

# Picture: The area of the planar arm: a ring with a notch, coloured by manipulability.
result.plot.slice(z=0.0)
