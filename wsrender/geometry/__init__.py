"""Boundaries of workspaces."""
