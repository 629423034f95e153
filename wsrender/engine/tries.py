"""Tries of inverse kinematics: what is asked of them, and where they ended."""

from dataclasses import dataclass, fields

import numpy as np

from wsrender.robots.kinematics import Kinematics


@dataclass(frozen=True)
class Accuracy:
    """What counts as reached: distance [m] and angle [rad]; ``length`` [m] makes angles comparable to distances.

    ``flatness``: the slope at which a try counts as at rest, relative to the solver's FLAT.
    """

    position_m: float
    angle_rad: float
    length: float
    flatness: float = 1.0

    @property
    def rotation_2(self) -> float:
        """Square of the largest difference of the axes that counts as reached: 8 sin²(angle / 2)."""
        return 8 * np.sin(min(self.angle_rad, np.pi) / 2) ** 2


@dataclass(frozen=True, eq=False)
class Tries:
    """Where tries ended: configurations (N, n) [rad or m], distances (N,) [m] and angles (N,) [rad] to the target.

    ``reached``: within the accuracy; ``stationary``: at a nearest point within the limits that is not the target;
    neither: the steps did not suffice.
    """

    q: np.ndarray
    distance: np.ndarray
    angle: np.ndarray
    reached: np.ndarray
    stationary: np.ndarray

    def taken(self, at: np.ndarray) -> "Tries":
        """Those ``at`` places (M,)."""
        return Tries(**{each.name: getattr(self, each.name)[at] for each in fields(self)})

    def replaced(self, at: np.ndarray, others: "Tries") -> "Tries":
        """These, but for those ``at`` places (M,)."""
        columns = {each.name: getattr(self, each.name).copy() for each in fields(self)}
        for name, column in columns.items():
            column[at] = getattr(others, name)
        return Tries(**columns)


def angle_of(rotation_2: np.ndarray) -> np.ndarray:
    """Angles (N,) [rad] between frames whose axes' squared differences add up to 8 sin²(angle / 2)."""
    return 2 * np.arcsin(np.minimum(np.sqrt(rotation_2 / 8), 1.0))


def step_bounds(
    chain: Kinematics, accuracy: Accuracy, without_limits: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Lower and upper limits (n,), infinite where a coordinate has none, and its scale in a step."""
    endless = chain.periodic | (chain.revolute & without_limits)
    lower = np.where(endless, -np.inf, chain.lower_limits)
    upper = np.where(endless, np.inf, chain.upper_limits)
    return lower, upper, np.where(chain.revolute, 1.0, accuracy.length)
