"""The two Jacobians of a mechanism, A ẋ = B q̇ (Gosselin & Angeles 1990), and what follows from them.

Each link has a fixed length, or one that is actuated: with the unit vector n along it and r = R p, the derivative of
|e - elbow|² gives, in screw coordinates, n·v + (r × n)·ω = b q̇ with b = 1 (UPS), n·a (PUS), n·(a × crank) (RUS,
delta). ẋ: velocity of the platform's origin and angular velocity, base axes; of a delta the velocity alone.
Merlet, *Parallel Robots*, 2006, chapter 5.

A leg solved numerically moves its tip by S ẋ = J_a q̇_a + J_p q̇_p, with S the velocity of its place at the platform.
Rows N of the left null space of J_p leave its passive joints out: N S ẋ = N J_a q̇_a.

Local indices are those of ẋ = A⁻¹ B q̇. Singularities of type 1, det B = 0: a leg is stretched or folded and its
actuator has no effect. Type 2, det A = 0: the platform moves while the legs are locked.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.errors import InputError
from wsrender.indices.index_catalogue import find
from wsrender.mechanisms.inverse_kinematics import LegSolutions, inverse_kinematics
from wsrender.mechanisms.keeping_apart import stand
from wsrender.mechanisms.mechanism import Mechanism
from wsrender.mechanisms.serial_leg import NumericLeg
from wsrender.volume.volume_data import VolumeData

CONDITION_NUMBERS = ("inverse_condition_number_A", "inverse_condition_number_B", "inverse_condition_number_J")
DETERMINANTS = ("determinant_A", "determinant_B")
Composition = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Jacobian of a hybrid (N, 6, k), from that of the parallel part (N, m, n) and the poses (N, 4, 4), both base frame."""
BATCH = 100_000  # poses
SINGULARITY_TYPES = {1: "determinant_B", 2: "determinant_A"}


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
    if mechanism.numeric:
        rows = zip(mechanism.numeric, stand(mechanism, poses).q, strict=True)
        blocks += [_of_numeric(leg, q, poses, length_m) for leg, q in rows]
    return Jacobians(np.concatenate([rows for rows, _ in blocks], axis=1), _block_diagonal([B for _, B in blocks]))


def _of_numeric(leg: NumericLeg, q: np.ndarray, poses: np.ndarray, length_m: float) -> tuple[np.ndarray, np.ndarray]:
    """Rows of A (N, r, 6) and block of B (N, r, a) of a leg at configurations (N, n) that reach the poses."""
    J = leg.jacobian(q)
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


def pose_indices(
    mechanism: Mechanism,
    poses: np.ndarray,
    names: Sequence[str],
    rows: Sequence[int],
    characteristic_length_m: float = 1.0,
    composition: Composition | None = None,
    options: Mapping[str, Mapping[str, Any]] | None = None,
) -> dict[str, np.ndarray]:
    """Indices (N,) by name at reached poses (N, 4, 4), base frame, for task rows 0…5 (x y z rx ry rz).

    After the six: 1/κ of A, of B and of J = A⁻¹ B (all rows, whatever the task), and the determinants of A and B. Where
    A is singular to rounding (type 2) the legs do not hold the platform, and the six and 1/κ(J) are 0. Raises
    InputError for a mechanism whose legs do not hold the platform as often as it has degrees of freedom.

    ``options``: of indices that have any, by index and option; defaults where none are given. ``composition`` gives J
    of a hybrid. There are no determinants of hybrids and of mechanisms with legs that are
    solved numerically: a place belongs to several postures, each with a sign of its own.
    """
    check_square(mechanism)
    functions = {name: find(name).function_for("standard", (options or {}).get(name)) for name in names}
    batches = [poses[first : first + BATCH] for first in range(0, len(poses), BATCH)]
    parts = [_batch(mechanism, batch, functions, rows, characteristic_length_m, composition) for batch in batches]
    all_names = (*names, *CONDITION_NUMBERS)
    if composition is None and not mechanism.numeric:
        all_names = (*all_names, *DETERMINANTS)
    return {name: np.concatenate([np.zeros(0), *(part[name] for part in parts)]) for name in all_names}


def _batch(
    mechanism: Mechanism, poses: np.ndarray, functions, rows, length_m: float, composition: Composition | None
) -> dict[str, np.ndarray]:
    J = jacobians(mechanism, inverse_kinematics(mechanism, poses), poses, length_m)
    A = J.A / np.where(np.arange(J.A.shape[2]) < 3, 1.0, length_m)  # per metre: angular columns by the length
    sigma_A = np.linalg.svd(A, compute_uv=False)
    regular = sigma_A[:, -1] > A.shape[1] * np.finfo(float).eps * sigma_A[:, 0]
    whole = np.where(regular[:, None, None], platform_jacobian(J), 0.0)
    if composition is not None:
        whole = np.where(regular[:, None, None], composition(whole, poses), 0.0)
    sigma = _singular_values(whole, rows, length_m)
    columns: list[Any] = list(sigma.T)
    m, n = len(rows), whole.shape[2]
    values = {name: _values(function(columns, m, n), len(poses)) for name, function in functions.items()}
    sigma_J = _singular_values(whole, range(mechanism.degrees_of_freedom), length_m)
    values |= {
        "inverse_condition_number_A": np.where(regular, sigma_A[:, -1] / sigma_A[:, 0], 0.0),
        "inverse_condition_number_B": _ratio(np.linalg.svd(J.B, compute_uv=False)),
        "inverse_condition_number_J": _ratio(sigma_J),
    }
    if mechanism.numeric:
        return values
    diagonal = np.diagonal(J.B, axis1=1, axis2=2)
    return values | {"determinant_A": np.where(regular, np.linalg.det(A), 0.0), "determinant_B": diagonal.prod(axis=1)}


def _values(found: Any, poses: int) -> np.ndarray:
    """Values (N,) of an index, which may be one for all poses."""
    return np.array(np.broadcast_to(found, poses))


def _singular_values(J: np.ndarray, rows: Sequence[int], length_m: float) -> np.ndarray:
    """Of rows of Jacobians (N, m, n), largest first, (N, len(rows)); 0 where only rounding is left."""
    rows = list(rows)
    mixed = min(rows) < 3 <= max(rows)
    scale = np.where(np.array(rows) < 3, 1.0 / length_m if mixed else 1.0, 1.0)
    task = J[:, rows] * scale[:, None]
    m, n = task.shape[1:]
    sigma = np.linalg.svd(task, compute_uv=False)
    if m > n:
        sigma = np.concatenate([sigma, np.zeros((len(sigma), m - n))], axis=1)
    return np.where(sigma > max(m, n) * np.finfo(float).eps * sigma[:, :1], sigma, 0.0)


def _ratio(sigma: np.ndarray) -> np.ndarray:
    """1/κ (N,) of singular values (N, k), largest first; 0 of a matrix of zeros."""
    return np.divide(sigma[:, -1], sigma[:, 0], out=np.zeros(len(sigma)), where=sigma[:, 0] > 0)


def sign_changes(volume: VolumeData) -> dict[int, np.ndarray]:
    """By type, points (N, 3) [m] where the determinant is 0, linear between the centres of voxels that share a face.

    The volume holds the determinants as statistic "center". A determinant that is 0 at a centre counts there.
    """
    first = np.array(volume.first_voxel)
    return {
        kind: zeros(volume.statistics["center"][name], first, volume.voxel_size_m)
        for kind, name in SINGULARITY_TYPES.items()
    }


def zeros(values: np.ndarray, first: np.ndarray, edge: float) -> np.ndarray:
    """Points (N, 3) [m] where values (nx, ny, nz) at centres of voxels, the ``first`` one (3,), pass through 0.

    NaN: no value there.
    """
    found = [np.argwhere(values == 0.0).astype(np.float64)]
    for axis in range(3):
        count = values.shape[axis]
        here, there = values.take(range(count - 1), axis), values.take(range(1, count), axis)
        cells = np.argwhere(here * there < 0)
        at = tuple(cells.T)
        points = cells.astype(np.float64)
        points[:, axis] += here[at] / (here[at] - there[at])
        found.append(points)
    return (np.concatenate(found) + first + 0.5) * edge
