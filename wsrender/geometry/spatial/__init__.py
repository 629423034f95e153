"""Boundaries of the positions that spatial arms reach, in patches: what generates each, and what surface it is."""
