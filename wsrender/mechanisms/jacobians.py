"""The two Jacobians of a mechanism, A ẋ = B q̇ (Gosselin & Angeles 1990), and what follows from them.

Each link has a fixed length, or one that is actuated: with the unit vector n along it and r = R p, the derivative of
|e - elbow|² gives, in screw coordinates, n·v + (r × n)·ω = b q̇ with b = 1 (UPS), n·a (PUS), n·(a × crank) (RUS,
delta). ẋ: velocity of the platform's origin and angular velocity, base axes; of a delta the velocity alone.
Merlet, *Parallel Robots*, 2006, chapter 5.

A leg solved numerically moves its tip by S ẋ = J_a q̇_a + J_p q̇_p, with S the velocity of its place at the platform.
Rows N of the left null space of J_p leave its passive joints out: N S ẋ = N J_a q̇_a.
"""

from dataclasses import dataclass

import numpy as np

from wsrender.errors import InputError
from wsrender.mechanisms.inverse_kinematics import LegSolutions
from wsrender.mechanisms.mechanism import Mechanism
from wsrender.mechanisms.serial_leg import NumericLeg


@dataclass(frozen=True, eq=False)
class Jacobians:
    """``A`` (N, R, m), columns linear [1] then angular [m], and ``B`` (N, R, n) [1, or m/rad] of n actuated joints.

    A row for each leg in closed form, where B is diagonal, then the rows of the others.
    """

    A: np.ndarray
    B: np.ndarray


def jacobians(mechanism: Mechanism, legs: LegSolutions, poses: np.ndarray, length_m: float = 1.0) -> Jacobians:
    """Of solved poses (N, 4, 4) of `inverse_kinematics`; NaN where a leg in closed form has no solution.

    ``length_m`` makes angular constraints of a leg that holds the pose comparable to linear ones.
    """
    link = legs.joints - legs.elbows
    length = np.linalg.norm(link, axis=2, keepdims=True)
    n = np.divide(link, length, out=np.full_like(link, np.nan), where=length > 0)
    lever = legs.joints - poses[:, None, :3, 3]
    A = n if mechanism.translational else np.concatenate([n, np.cross(lever, n)], axis=2)
    kinds = np.array(mechanism.kinds)
    crank = np.cross(mechanism.axis, legs.elbows - mechanism.base)
    drive = np.where((kinds == "PUS")[:, None], np.broadcast_to(mechanism.axis, n.shape), crank)
    diagonal = np.where(kinds == "UPS", 1.0, (n * drive).sum(axis=2))
    diagonal = np.where(np.isnan(legs.values), np.nan, diagonal)
    blocks = [(A, diagonal[..., None] * np.eye(len(kinds)))]
    blocks += [_of_numeric(leg, poses, length_m) for leg in mechanism.numeric]
    return Jacobians(np.concatenate([rows for rows, _ in blocks], axis=1), _block_diagonal([B for _, B in blocks]))


def _of_numeric(leg: NumericLeg, poses: np.ndarray, length_m: float) -> tuple[np.ndarray, np.ndarray]:
    """Rows of A (N, r, 6) and block of B (N, r, a) of a leg at poses that it reaches."""
    J = leg.jacobian(leg.solve(poses).q)
    lever = leg.targets(poses)[:, :3, 3] - poses[:, :3, 3]
    S = np.broadcast_to(np.eye(6), (len(poses), 6, 6)).copy()
    S[:, :3, 3:] = np.swapaxes(np.cross(np.eye(3), lever[:, None]), 1, 2)  # ω × r, column by column
    scale = np.where(np.arange(6) < 3, 1.0, length_m)[: leg.constraints, None]
    S, J = scale * S[:, : leg.constraints], scale * J[:, : leg.constraints]
    left = np.linalg.svd(J[:, :, ~leg.actuated])[0] if not leg.actuated.all() else np.eye(leg.constraints)[None]
    N = np.swapaxes(left, 1, 2)[:, leg.constraints - leg.rows :]
    return N @ S, N @ J[:, :, leg.actuated]


def _block_diagonal(blocks: list[np.ndarray]) -> np.ndarray:
    """Matrices (N, r, c) along the diagonal."""
    rows, columns = (sum(block.shape[axis] for block in blocks) for axis in (1, 2))
    found = np.zeros((len(blocks[0]), rows, columns))
    row = column = 0
    for block in blocks:
        _, r, c = block.shape
        found[:, row : row + r, column : column + c] = block
        row, column = row + r, column + c
    return found


def check_square(mechanism: Mechanism) -> None:
    """Raise InputError where the legs do not hold the platform exactly as often as it has degrees of freedom."""
    freedom, total = mechanism.degrees_of_freedom, len(mechanism.kinds)
    for leg in mechanism.numeric:
        field, passive = f"mechanism.legs.{leg.number}.actuated", int((~leg.actuated).sum())
        if not leg.actuated.any():
            raise InputError(field, "must name the actuated joints for Jacobians and indices")
        if leg.rows < 1:
            message = f"must leave fewer passive joints: {passive} take all {leg.constraints} constraints away"
            raise InputError(field, message)
        total += leg.rows
    if mechanism.numeric and total != freedom:
        raise InputError(
            "mechanism.legs",
            f"must hold the platform by {freedom} constraints for Jacobians and indices, not {total}: one for each leg "
            "in closed form, 3 or 6 less the passive joints for each of the others",
        )
    if total != freedom:
        raise InputError("mechanism.legs", f"must be {freedom} for Jacobians and indices, not {total}")


def platform_jacobian(J: Jacobians) -> np.ndarray:
    """ẋ = A⁻¹ B q̇ (N, m, n); infinite where A is singular (type 2: the platform moves while the legs are locked)."""
    m = J.A.shape[2]
    determinant = np.linalg.det(J.A)
    regular = np.isfinite(determinant) & (np.abs(determinant) > 0)
    safe = np.where(regular[:, None, None], J.A, np.eye(m))
    found = np.linalg.inv(safe) @ J.B
    return np.where(regular[:, None, None], found, np.inf)
