"""Mapping of a slave robot's workspace into that of its master ([WSR] III.D)."""
