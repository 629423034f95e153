"""Constraints on configurations: one module each; those of other packages join by `register_constraint`."""
