"""Local indices of a mechanism at poses, from its Jacobian ẋ = A⁻¹ B q̇."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from wsrender.indices.index_catalogue import find
from wsrender.mechanisms.inverse_kinematics import inverse_kinematics
from wsrender.mechanisms.jacobians import check_square, jacobians, platform_jacobian
from wsrender.mechanisms.mechanism import Mechanism

CONDITION_NUMBERS = ("inverse_condition_number_A", "inverse_condition_number_B", "inverse_condition_number_J")
DETERMINANTS = ("determinant_A", "determinant_B")
Composition = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Jacobian of a hybrid (N, 6, k), from that of the parallel part (N, m, n) and the poses (N, 4, 4), both base frame."""
BATCH = 100_000  # poses


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
    return values | {
        "determinant_A": np.where(regular, np.linalg.det(A), 0.0),
        "determinant_B": diagonal.prod(axis=1),
    }


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
