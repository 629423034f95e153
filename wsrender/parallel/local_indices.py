"""Local indices of a mechanism at poses, from its Jacobian ẋ = A⁻¹ B q̇."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from wsrender.indices.catalogue import find
from wsrender.parallel.inverse_kinematics import inverse_kinematics
from wsrender.parallel.jacobians import Jacobians, check_square, jacobians, platform_jacobian
from wsrender.parallel.mechanism import Mechanism

OF_MECHANISMS = (
    "inverse_condition_number_A",
    "inverse_condition_number_B",
    "inverse_condition_number_J",
    "determinant_A",
    "determinant_B",
)
BATCH = 100_000  # poses


def pose_indices(
    mechanism: Mechanism,
    poses: np.ndarray,
    names: Sequence[str],
    rows: Sequence[int],
    characteristic_length_m: float = 1.0,
) -> dict[str, np.ndarray]:
    """Indices (N,) by name at reached poses (N, 4, 4), base frame, for task rows 0…5 (x y z rx ry rz).

    After the six: 1/κ of A, of B and of J = A⁻¹ B (all rows, whatever the task), and the determinants of A and B. Where
    A is singular to rounding (type 2) the legs do not hold the platform, and the six and 1/κ(J) are 0. Raises
    InputError for a mechanism with more or fewer legs than degrees of freedom.
    """
    check_square(mechanism)
    batches = [poses[first : first + BATCH] for first in range(0, len(poses), BATCH)]
    parts = [_batch(mechanism, batch, names, rows, characteristic_length_m) for batch in batches]
    all_names = (*names, *OF_MECHANISMS)
    return {name: np.concatenate([np.zeros(0), *(part[name] for part in parts)]) for name in all_names}


def _batch(mechanism: Mechanism, poses: np.ndarray, names, rows, length_m: float) -> dict[str, np.ndarray]:
    J = jacobians(mechanism, inverse_kinematics(mechanism, poses), poses)
    A = J.A / np.where(np.arange(J.A.shape[2]) < 3, 1.0, length_m)  # per metre: angular columns by the length
    sigma_A = np.linalg.svd(A, compute_uv=False)
    size = np.abs(J.B)
    regular = sigma_A[:, -1] > len(mechanism.kinds) * np.finfo(float).eps * sigma_A[:, 0]
    sigma = _singular_values(J, regular, rows, length_m)
    m, n = len(rows), J.B.shape[-1]
    columns: list[Any] = list(sigma.T)
    values = {name: np.asarray(find(name).function(columns, m, n)) for name in names}
    sigma_J = _singular_values(J, regular, range(J.A.shape[2]), length_m)
    return values | {
        "inverse_condition_number_A": np.where(regular, sigma_A[:, -1] / sigma_A[:, 0], 0.0),
        "inverse_condition_number_B": _ratio(size.min(axis=1), size.max(axis=1)),
        "inverse_condition_number_J": _ratio(sigma_J[:, -1], sigma_J[:, 0]),
        "determinant_A": np.where(regular, np.linalg.det(A), 0.0),
        "determinant_B": J.B.prod(axis=1),
    }


def _singular_values(J: Jacobians, regular: np.ndarray, rows: Sequence[int], length_m: float) -> np.ndarray:
    """Of those rows of A⁻¹ B, largest first, (N, len(rows)); 0 where A is singular, and where only rounding is left."""
    rows = list(rows)
    mixed = min(rows) < 3 <= max(rows)
    scale = np.where(np.array(rows) < 3, 1.0 / length_m if mixed else 1.0, 1.0)
    task = platform_jacobian(J)[:, rows] * scale[:, None]
    m, n = task.shape[1:]
    sigma = np.linalg.svd(np.where(regular[:, None, None], task, 0.0), compute_uv=False)
    if m > n:
        sigma = np.concatenate([sigma, np.zeros((len(sigma), m - n))], axis=1)
    return np.where(sigma > max(m, n) * np.finfo(float).eps * sigma[:, :1], sigma, 0.0)


def _ratio(smallest: np.ndarray, largest: np.ndarray) -> np.ndarray:
    return np.divide(smallest, largest, out=np.zeros_like(smallest), where=largest > 0)
