"""Several robots in one space."""
