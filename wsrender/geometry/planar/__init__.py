"""Workspace boundaries of arms that move in a plane: exact, as lines and arcs, and estimated from samples."""
