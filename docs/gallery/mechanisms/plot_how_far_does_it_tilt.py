"""
How far does a Stewart platform tilt?
=====================================

At one position, over all tilts and turns: the orientation workspace.
"""

import wsrender as ws

hexapod = {"library": "stewart_gough", "length_m": [0.5, 0.8]}
result = ws.parallel_workspace(
    hexapod, kind="orientation", position_m=[0, 0, 0.55], orientations={"tilt_deg": 60}, device="cpu"
)
print(result.summary())

# Picture: Discs of tilt by direction, one for each turn about the axis: reached tilts are filled.
result.plot.orientations()
