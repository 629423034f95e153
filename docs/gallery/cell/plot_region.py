"""
How much of a given box does the arm reach?
===========================================

A ``region`` bounds the tip: what lies outside is not counted. The headline is what is reached within it.
"""

import wsrender as ws

box = {"lower_m": [0.2, -0.4, 0.0], "upper_m": [1.0, 0.4, 0.6]}
result = ws.analyze(
    "ur5e",
    ws.Sobol(1 << 18),
    ["manipulability"],
    constraints={"region": {"box": box}},
    refined_volume=0.01,
    device="cpu",
)
headline, whole = result.document["headline"], 0.8 * 0.8 * 0.6
print(f"{headline['value']:.4f} m³ of {whole:.4f} m³: {headline['value'] / whole:.1%}")

# Picture: Three planes through the part of the box that the arm reaches; its far corners are missing.
result.plot.slices()
