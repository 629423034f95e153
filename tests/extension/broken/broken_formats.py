"""Rows that are none, and one that wsrender has."""

import wsrender as ws

TAKEN = ws.Format("vti", "volume", "application/vnd.vtk.vti", print)
TEXT = "vti"
