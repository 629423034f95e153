"""Tolerances of comparisons with references, each named once with its reason."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Tolerances:
    """Largest accepted errors in one precision.

    ``kinematics``: positions and linear Jacobian rows [m] per metre of reach (at least 1 m); orientations and
    angular rows as they are. ``inertia``: entries of M relative to max|M|. ``index``: an index relative to its
    maximum, a root removed first. ``elementary``: relative error of an elementary function, and absolute error of sin
    and cos. ``singular_value``: singular values relative to the largest.
    """

    kinematics: float
    inertia: float
    index: float
    elementary: float
    singular_value: float

    def position(self, reach: float) -> float:
        """Largest error of a position or linear Jacobian entry for a chain of this reach [m]."""
        return self.kinematics * max(reach, 1.0)


TOLERANCES = {
    # Ten joints' rotations and translations of about unit length each add a few half-ulps: about 16 ulps in all.
    # M adds products of three such numbers for every body; J M^-1 multiplies its error by the ratio of the links'
    # inertias, up to 1e5 in the library (1e-10 would do in float64, but the reference's own error is of that order).
    "float64": Tolerances(kinematics=1e-12, inertia=1e-10, index=1e-9, elementary=8 * 2.0**-52, singular_value=1e-13),
    "float32": Tolerances(kinematics=2e-6, inertia=1e-5, index=1e-4, elementary=8 * 2.0**-23, singular_value=5e-6),
}

# A p-value below this fails a test of a distribution: with fixed seeds it either always or never does.
SMALLEST_P_VALUE = 1e-3


def epsilon(precision: str) -> float:
    """Spacing of floating-point numbers at 1 in a precision."""
    return float(np.finfo(precision).eps)


# How far rounding may push a posture at the end of a link's reach or of a joint's limit beyond it: the law of cosines
# adds and subtracts a few squares, each with an error of half an ulp (relative to the squared size; angles [rad]).
CLOSURE = 64 * 2.0**-52

# Thickness of a set of positions that counts as none, relative to its size: model files that mean a right angle say
# 1.5708.
FLAT = 1e-5
