"""
How far does a Stewart platform tilt?
=====================================

At one position, over all directions of tilt up to 60°: the orientation workspace.
"""

import wsrender as ws

hexapod = {"library": "stewart_gough", "length_m": [0.5, 0.8]}
result = ws.parallel_workspace(
    hexapod, kind="orientation", position_m=[0, 0, 0.55], orientations={"tilt_deg": 60}, device="cpu"
)
print(result.summary())

# Picture: A disc of directions of tilt, 60° at its rim: filled to about 35° in all directions.
result.plot.orientations()
