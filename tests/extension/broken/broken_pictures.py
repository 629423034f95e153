"""Entries that are no pictures, one whose name wsrender has, and some that need what there is not."""

import wsrender as ws

TEXT = "robot"
TAKEN = ws.Picture("aspects", print)
UPPER = ws.Picture("Upper", print)
NEEDY = ws.Picture("needy", print, needs=("curve.scan",))
PART = ws.Picture("part", print, uses=("meshes.best|samples.x",))
