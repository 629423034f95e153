"""Frames in a job document: a position and an orientation, in metres and degrees."""

import math
from collections.abc import Iterator
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, Field

from wsrender.documents.document import Document
from wsrender.documents.quantities import numbers_of, quoted, real

LARGEST = 1e6  # m or rad: beyond any robot, far from overflow


def number_list(*counts: int) -> BeforeValidator:
    """A validator of lists of finite numbers, of any of the given lengths."""
    allowed = " or ".join(str(count) for count in counts)

    def validate(value: Any) -> tuple[float, ...]:
        numbers = numbers_of(value)
        if len(numbers) not in counts:
            raise ValueError(f"must be a list of {allowed} finite numbers")
        return numbers

    return BeforeValidator(validate)


Vector = Annotated[tuple[float, float, float], number_list(3)]
Quaternion = Annotated[tuple[float, float, float, float], number_list(4)]
LengthUnit = Annotated[float, Field(ge=1e-9, le=LARGEST), BeforeValidator(real)]


class Transform(Document):
    """A position and at most one of three ways to say an orientation (none: no rotation)."""

    position_m: Vector = (0.0, 0.0, 0.0)
    """Origin of the transformed frame [m]."""
    quat_wxyz: Quaternion | None = None
    """Quaternion, scalar first; any length but zero, it is normalised."""
    rpy_deg: Vector | None = None
    """Roll, pitch, yaw about fixed x, y, z as in URDF: R = Rz(yaw) Ry(pitch) Rx(roll) [°]."""
    euler_xyz_deg: Vector | None = None
    """Angles about the moving x, y, z: R = Rx Ry Rz [°]."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        names = ("quat_wxyz", "rpy_deg", "euler_xyz_deg")
        given = [name for name in names if getattr(self, name) is not None]
        if len(given) > 1:
            yield given[1], f"must not be given together with {quoted(given[:1])}: one orientation is enough"
        if self.quat_wxyz is not None and not 1e-6 < math.hypot(*self.quat_wxyz) < 1e6:
            yield "quat_wxyz", f"must not have length {math.hypot(*self.quat_wxyz):g}: it says no rotation"

    def matrix(self) -> np.ndarray:
        """The homogeneous transform, shape (4, 4) float64: parent ← frame, translation in metres."""
        T = np.eye(4)
        T[:3, 3] = self.position_m
        if self.quat_wxyz is not None:
            T[:3, :3] = _rotation_of_quaternion(np.array(self.quat_wxyz))
        elif self.rpy_deg is not None:
            x, y, z = (_turn(axis, angle) for axis, angle in enumerate(self.rpy_deg))
            T[:3, :3] = z @ y @ x
        elif self.euler_xyz_deg is not None:
            x, y, z = (_turn(axis, angle) for axis, angle in enumerate(self.euler_xyz_deg))
            T[:3, :3] = x @ y @ z
        return T


def _turn(axis: int, angle_deg: float) -> np.ndarray:
    """Rotation about x, y or z (axis 0, 1, 2); quarter turns are exact. Shape (3, 3)."""
    angle = math.radians(math.remainder(angle_deg, 360.0))
    c, s = (value if abs(value) > 1e-15 else 0.0 for value in (math.cos(angle), math.sin(angle)))
    j, k = (axis + 1) % 3, (axis + 2) % 3
    R = np.eye(3)
    R[j, j], R[j, k], R[k, j], R[k, k] = c, -s, s, c
    return R


def _rotation_of_quaternion(quat_wxyz: np.ndarray) -> np.ndarray:
    """Rotation matrix of a quaternion of any length (Shuster 1993, eq. 117), shape (3, 3)."""
    w, x, y, z = quat_wxyz / np.linalg.norm(quat_wxyz)
    return np.array(
        [
            [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ]
    )
