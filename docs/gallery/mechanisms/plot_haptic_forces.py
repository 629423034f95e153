"""
Which forces keep a hand within a haptic device's limits?
=========================================================

Joint limits and bad conditioning as forces [N] that a person feels, at one configuration and over the workspace.
"""

import wsrender as ws

field = ws.force_field("phantom_omni")
print(field.force([0.8, 0.9, -0.8, 0, 1.5, 0]), "N near the first joint's limit")

result = ws.kinetostatic_field("phantom_omni", ws.Sobol(50_000), device="cpu")
print(result.summary())

# Picture: Stream lines of the force in three planes, pointing from the borders inwards.
result.plot.vectors()
