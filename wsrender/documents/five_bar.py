"""What job documents say of a planar five-bar."""

WORKING_MODES = ("++", "+-", "-+", "--")
"""Signs of sin(θ3 − θ1) and sin(θ4 − θ2): the sides to which the left and the right elbow bend."""
LEAST_RANGE = 1e-3  # [rad] of a base joint: with less the workspace is a line
