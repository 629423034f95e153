"""A constraint of another package, in one file: the tool's axis points downwards."""

import wsrender as ws


def margin(q, position, axes, cosine=0.5):
    return -axes[2][2] - cosine


TOOL_DOWN = ws.ExpressionConstraint("tool_down", margin)
