"""Homogeneous transforms where positions and quaternions are asked for."""

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from wsrender.errors import InputError

RIGID = 1e-3  # of entries of R Rᵀ − 1: rotation matrices of three digits


def position_and_quaternion(position: Any, quat_wxyz: Any, fields: tuple[str, str]) -> tuple[Any, Any]:
    """Positions (N, 3) [m] and quaternions (N, 4) of transforms (4, 4) or (N, 4, 4); all else stays as it is.

    ``fields`` are the names of the two. Raises InputError where orientations stand beside transforms, or what has their
    shape is none.
    """
    if not _has_their_shape(position):
        return position, quat_wxyz
    if quat_wxyz is not None:
        raise InputError(fields[1], f"must not be given beside transforms as {fields[0]}, which say their own")
    T = np.asarray(position, np.float64).reshape(-1, 4, 4)
    R = T[:, :3, :3]
    with np.errstate(invalid="ignore", over="ignore"):
        off = np.abs(R @ R.swapaxes(1, 2) - np.eye(3)).max(axis=(1, 2))
        good = (off < RIGID) & (np.linalg.det(R) > 0) & (T[:, 3] == [0, 0, 0, 1]).all(axis=1)
    if not good.all():
        message = f"transform {int(np.argmin(good))} is not rigid: rotation matrix, position, last row 0 0 0 1"
        raise InputError(fields[0], message)
    return T[:, :3, 3], Rotation.from_matrix(R).as_quat(scalar_first=True)


def _has_their_shape(values: Any) -> bool:
    if isinstance(values, np.ndarray):
        return values.ndim in (2, 3) and values.shape[-2:] == (4, 4)
    if not isinstance(values, list | tuple) or not values or not isinstance(values[0], list | tuple | np.ndarray):
        return False
    first = values[0]
    rows = values if len(first) == 4 and not hasattr(first[0], "__len__") else first
    return len(rows) == 4 and all(hasattr(row, "__len__") and len(row) == 4 for row in rows)
