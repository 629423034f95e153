"""Entries that are no pictures, one whose name wsrender has, and one that needs what there is not."""

import wsrender as ws

TEXT = "robot"
TAKEN = ws.Picture("aspects", print)
UPPER = ws.Picture("Upper", print)
NEEDY = ws.Picture("needy", print, needs=("curve.scan",))
