"""Lattice, distribution map and volume data."""
