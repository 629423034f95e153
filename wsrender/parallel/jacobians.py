"""The two Jacobians of a mechanism, A ẋ = B q̇ (Gosselin & Angeles 1990), and what follows from them.

Each link has a fixed length, or one that is actuated: with the unit vector n along it and r = R p, the derivative of
|e - elbow|² gives, in screw coordinates, n·v + (r × n)·ω = b q̇ with b = 1 (UPS), n·a (PUS), n·(a × crank) (RUS,
delta). ẋ: velocity of the platform's origin and angular velocity, base axes; of a delta the velocity alone.
Merlet, *Parallel Robots*, 2006, chapter 5.
"""

from dataclasses import dataclass

import numpy as np

from wsrender.errors import InputError
from wsrender.parallel.inverse_kinematics import LegSolutions
from wsrender.parallel.mechanism import Mechanism


@dataclass(frozen=True, eq=False)
class Jacobians:
    """``A`` (N, L, m), rows by leg, columns linear [1] then angular [m]; ``B`` (N, L), the diagonal [1, or m/rad]."""

    A: np.ndarray
    B: np.ndarray


def jacobians(mechanism: Mechanism, legs: LegSolutions, poses: np.ndarray) -> Jacobians:
    """Of solved poses (N, 4, 4) of `inverse_kinematics`; NaN where a leg has no solution."""
    link = legs.joints - legs.elbows
    length = np.linalg.norm(link, axis=2, keepdims=True)
    n = np.divide(link, length, out=np.full_like(link, np.nan), where=length > 0)
    lever = legs.joints - poses[:, None, :3, 3]
    A = n if mechanism.translational else np.concatenate([n, np.cross(lever, n)], axis=2)
    kinds = np.array(mechanism.kinds)
    crank = np.cross(mechanism.axis, legs.elbows - mechanism.base)
    drive = np.where((kinds == "PUS")[:, None], np.broadcast_to(mechanism.axis, n.shape), crank)
    B = np.where(kinds == "UPS", 1.0, (n * drive).sum(axis=2))
    return Jacobians(A, np.where(np.isnan(legs.values), np.nan, B))


def check_square(mechanism: Mechanism) -> None:
    """Raise InputError where the actuated legs are not as many as the platform's degrees of freedom."""
    legs, freedom = len(mechanism.kinds), mechanism.degrees_of_freedom
    if legs != freedom:
        raise InputError("mechanism.legs", f"must be {freedom} for Jacobians and indices, not {legs}")


def platform_jacobian(J: Jacobians) -> np.ndarray:
    """ẋ = A⁻¹ B q̇ (N, m, L); infinite where A is singular (type 2: the platform moves while the legs are locked)."""
    m = J.A.shape[2]
    determinant = np.linalg.det(J.A)
    regular = np.isfinite(determinant) & (np.abs(determinant) > 0)
    safe = np.where(regular[:, None, None], J.A, np.eye(m))
    found = np.linalg.inv(safe) * J.B[:, None, :]
    return np.where(regular[:, None, None], found, np.inf)
