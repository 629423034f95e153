"""Parallel mechanisms: legs between base and platform, their inverse kinematics, Jacobians and workspaces."""
