"""Entries that are no constraints, and one whose name wsrender has."""

import numpy as np

import wsrender as ws


def FUNCTION(q, position, axes):  # noqa: N802
    return q[0]


TAKEN = ws.ExpressionConstraint("region", FUNCTION)
UNTRACEABLE = ws.ExpressionConstraint("wavy", lambda q, position, axes: np.sin(q[0]))
