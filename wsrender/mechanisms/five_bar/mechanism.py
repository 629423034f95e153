"""A planar five-bar with two actuated base joints: geometry, forward and inverse kinematics ([CB])."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.documents.mechanism import LEAST_RANGE, WORKING_MODES
from wsrender.documents.quantities import argument, positive
from wsrender.errors import InputError
from wsrender.keywords import keywords
from wsrender.tolerances import CLOSURE

ASSEMBLY_MODES = ("+", "-")
"""Sign of sin(θ4 − θ3): the side of the line from C to D on which P lies."""

Pair = tuple[float, float]
Interval = tuple[float, float]


@keywords
@dataclass(frozen=True)
class FiveBar:
    """Base points A = (0, 0) and B = (base_m, 0), elbows C and D, end point P; lengths of left and right leg [m].

    C = A + L1 u(θ1), D = B + L1' u(θ2), P = C + L2 u(θ3) = D + L2' u(θ4) with u(θ) = (cos θ, sin θ); all angles are
    absolute [rad]. ``limits_rad`` bound θ1 and θ2, each [low, high] of at most a turn, or None: it turns freely.
    Raises InputError, naming the field, for lengths that are not positive and limits out of order.

    >>> mechanism = ws.FiveBar(base_m=0.2, proximal_m=(0.2, 0.2), distal_m=(0.3, 0.3))
    >>> mechanism.forward_kinematics([np.pi / 2, np.pi / 2], "+").round(4).tolist()  # y: 0.2 + (0.3² − 0.1²)^½
    [[0.1, 0.4828]]
    """

    base_m: float
    proximal_m: Pair
    distal_m: Pair
    limits_rad: tuple[Interval | None, Interval | None] = (None, None)

    def __post_init__(self):
        lengths = {"base_m": (self.base_m,), "proximal_m": self.proximal_m, "distal_m": self.distal_m}
        for name, values in lengths.items():
            if name != "base_m" and len(values) != 2:
                raise InputError(name, f"has {len(values)} values; one for each leg is needed")
            for value in values:
                argument(name, positive, value)
        if len(self.limits_rad) != 2:
            raise InputError("limits_rad", f"has {len(self.limits_rad)} entries; one for each leg, or null, is needed")
        for limits in self.limits_rad:
            if limits is not None and not LEAST_RANGE - CLOSURE <= limits[1] - limits[0] <= 2 * np.pi + CLOSURE:
                raise InputError(
                    "limits_rad", f"{list(limits)} is not allowed; low + {LEAST_RANGE:g} ≤ high ≤ low + 2π is"
                )

    @classmethod
    def symmetric(cls, base_m: float, proximal_m: float, distal_m: float) -> "FiveBar":
        """(L0, L1, L2) of [CB]: both legs alike, joints that turn freely."""
        return cls(base_m, (proximal_m, proximal_m), (distal_m, distal_m))

    @property
    def bases(self) -> np.ndarray:
        """A and B [m], (2, 2)."""
        return np.array([[0.0, 0.0], [self.base_m, 0.0]])

    @property
    def size_m(self) -> float:
        """Sum of all lengths [m]: the scale of tolerances."""
        return self.base_m + sum(self.proximal_m) + sum(self.distal_m)

    def reach_m(self, leg: int) -> Interval:
        """Least and largest distance of P from the base point of a leg (0 left, 1 right) [m]."""
        first, second = self.proximal_m[leg], self.distal_m[leg]
        return abs(first - second), first + second

    def forward_kinematics(self, theta: Any, assembly_mode: str) -> np.ndarray:
        """P [m] of actuated angles (N, 2) or (2,) [rad] in an assembly mode, (N, 2).

        NaN where the distal links do not meet, or where C = D with equal links, which leaves P free on a circle.
        Limits are not regarded. Raises InputError for another assembly mode.
        """
        elbows = self.elbows(rows_of(theta, 2, "theta"))
        C, D = elbows[:, 0], elbows[:, 1]
        return triangle_apex(C, D, *self.distal_m, sign_of(assembly_mode, ASSEMBLY_MODES, "assembly_mode")[0])

    def inverse_kinematics(self, position: Any, working_mode: str) -> np.ndarray:
        """Angles θ1 … θ4 [rad] that put P at positions (N, 2) or (2,) [m] in a working mode, (N, 4).

        Rows are NaN where P is out of reach or θ1 or θ2 would leave its limits; limited angles lie within them, free
        ones in [−π, π]. Raises InputError for another working mode.
        """
        position = rows_of(position, 2, "position")
        signs = sign_of(working_mode, WORKING_MODES, "working_mode")
        first, third = self.leg_angles(position, 0, signs[0])
        second, fourth = self.leg_angles(position, 1, signs[1])
        angles = np.stack([first, second, third, fourth], axis=1)
        angles[np.isnan(angles).any(axis=1)] = np.nan
        return angles

    def leg_angles(self, position: np.ndarray, leg: int, sign: int) -> tuple[np.ndarray, np.ndarray]:
        """Absolute angles of the proximal and distal link of one leg at positions (N, 2), NaN out of reach."""
        first, second = self.proximal_m[leg], self.distal_m[leg]
        v = position - self.bases[leg]
        squared = (v**2).sum(axis=1)
        cosine = (squared - first**2 - second**2) / (2 * first * second)
        # Rounding of the cosine at the ends of the reach, in terms of the squared distance.
        slack = CLOSURE * self.size_m**2 / (first * second)
        cosine = np.where(np.abs(cosine) <= 1 + slack, np.clip(cosine, -1.0, 1.0), np.nan)
        elbow = sign * np.arccos(cosine)
        proximal = np.arctan2(v[:, 1], v[:, 0]) - np.arctan2(second * np.sin(elbow), first + second * np.cos(elbow))
        proximal = self.within_limits(proximal, leg)
        return proximal, proximal + elbow

    def within_limits(self, angle: np.ndarray, leg: int) -> np.ndarray:
        """Angles turned by whole turns into the limits of a base joint, NaN where none does."""
        limits = self.limits_rad[leg]
        if limits is None:
            return wrapped(angle)
        middle, half = (limits[0] + limits[1]) / 2, (limits[1] - limits[0]) / 2
        away = wrapped(angle - middle)
        return np.where(np.abs(away) <= half + CLOSURE, middle + np.clip(away, -half, half), np.nan)

    def elbows(self, theta: np.ndarray) -> np.ndarray:
        """C and D [m] of actuated angles (N, 2), (N, 2, 2): row, leg, coordinate."""
        directions = np.stack([np.cos(theta[:, :2]), np.sin(theta[:, :2])], axis=2)
        return self.bases + np.array(self.proximal_m)[:, None] * directions


def triangle_apex(C: np.ndarray, D: np.ndarray, from_c: float, from_d: float, sign: int) -> np.ndarray:
    """Points (N, 2) at distances ``from_c`` of C and ``from_d`` of D, left (sign 1) or right (−1) of the line C → D.

    NaN where there is none, or where C = D.
    """
    along = D - C
    distance = np.linalg.norm(along, axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        along = along / distance[:, None]
        foot = (distance**2 + from_c**2 - from_d**2) / (2 * distance)
        squared = from_c**2 - foot**2
        slack = CLOSURE * (from_c + from_d + distance) ** 2
        height = np.sqrt(np.where(squared >= -slack, np.maximum(squared, 0.0), np.nan))
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    return C + foot[:, None] * along + sign * height[:, None] * across


def wrapped(angle: np.ndarray) -> np.ndarray:
    """Angles less whole turns, in [−π, π]."""
    return np.remainder(angle + np.pi, 2 * np.pi) - np.pi


def sign_of(mode: str, allowed: Sequence[str], field: str) -> tuple[int, ...]:
    """The signs that a mode is written with; InputError for another one."""
    if mode not in allowed:
        raise InputError(field, f"{mode!r} is not a mode; allowed: {', '.join(allowed)}")
    return tuple(1 if sign == "+" else -1 for sign in mode)


def rows_of(values: Any, width: int, field: str) -> np.ndarray:
    """Rows of numbers (N, width) float64 of one row or many; InputError for another shape."""
    rows = np.asarray(values, np.float64)
    if rows.ndim not in (1, 2) or rows.shape[-1] != width:
        raise InputError(field, f"has shape {rows.shape}; ({width},) or (N, {width}) is needed")
    return rows.reshape(-1, width)
