"""The sampling pipeline as plain data: source, kinematics, constraints, values, and what is kept."""
