"""Where a base may stand in a job document: ranges and steps of its coordinates, and how it is mounted."""

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator

from wsrender.documents.document import Document
from wsrender.documents.quantities import PositiveNumber, numbers_of, quoted, real
from wsrender.documents.transform import LARGEST, number_list

COORDINATES = ("x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg")
ANGLES = COORDINATES[3:]
IN_DEGREES = np.array([1.0] * 3 + [np.pi / 180] * 3)  # of coordinates, in m and rad
NEARLY = 1e-9  # of a step, or m: rounding of ranges
TURN = 360.0
_MOUNTED = {"floor": (0.0, 0.0, 0.0), "wall": (0.0, 90.0, 0.0), "ceiling": (180.0, 0.0, 0.0)}  # roll, pitch, yaw [°]


def _coordinate(value: Any) -> float | tuple[float, ...]:
    if not hasattr(value, "__len__") or isinstance(value, str | Mapping):
        number = real(value)
        if abs(number) > LARGEST:
            raise ValueError(f"must lie within ±{LARGEST:g}")
        return number
    numbers = numbers_of(value)
    if len(numbers) != 3 or max(map(abs, numbers)) > LARGEST:
        raise ValueError(f"must be a number, or [lower, upper, step], within ±{LARGEST:g}")
    lower, upper, step = numbers
    if not (lower < upper and step > 0):
        raise ValueError("must be [lower, upper, step], lower below upper and step above 0")
    if upper - lower < step * (1 - NEARLY):
        raise ValueError(f"must have a step of at most its range, {upper - lower:g}, not {step:g}")
    return lower, upper, step


def _angle(value: Any) -> float | tuple[float, ...]:
    found = _coordinate(value)
    if isinstance(found, tuple) and found[1] - found[0] > TURN * (1 + NEARLY):
        raise ValueError(f"must hold at most one turn, not {found[1] - found[0]:g}°")
    return found


Coordinate = Annotated[float | tuple[float, float, float], BeforeValidator(_coordinate)]
AngleCoordinate = Annotated[float | tuple[float, float, float], BeforeValidator(_angle)]


class PlacementSpace(Document):
    """Where a base may stand: each coordinate is a number, or a range [lower, upper, step].

    A length's range is divided into cells, as many as fit, whose centres lower + (i + 1/2) step are tried; angles are
    lower, lower + step, … up to upper, and of a whole turn none is tried twice.
    """

    x_m: Coordinate = 0.0
    """x of the base in the world [m]."""
    y_m: Coordinate = 0.0
    """y of the base in the world [m]."""
    z_m: Coordinate = 0.0
    """z of the base in the world [m]."""
    roll_deg: AngleCoordinate = 0.0
    """Turn of the base about x, the first: R = Rz(yaw) Ry(pitch) Rx(roll) [°]."""
    pitch_deg: AngleCoordinate = 0.0
    """Turn of the base about y, the second [°]."""
    yaw_deg: AngleCoordinate = 0.0
    """Turn of the base about the world's z, the last [°]."""

    @property
    def ranges(self) -> dict[str, tuple[float, float, float]]:
        """[lower, upper, step] of the coordinates that have several values."""
        found = {name: getattr(self, name) for name in COORDINATES}
        return {name: value for name, value in found.items() if isinstance(value, tuple)}

    @property
    def shape(self) -> tuple[int, ...]:
        """How many values each coordinate has, (6,)."""
        return tuple(self._size(name) for name in COORDINATES)

    @property
    def count(self) -> int:
        """How many placements there are."""
        return math.prod(self.shape)

    def values(self, name: str) -> np.ndarray:
        """Values that are tried of a coordinate (k,) [m or °]."""
        value, number = getattr(self, name), np.arange(self._size(name))
        if not isinstance(value, tuple):
            return np.array([value])
        lower, _, step = value
        return lower + (number + (0.0 if name in ANGLES else 0.5)) * step

    def _size(self, name: str) -> int:
        value = getattr(self, name)
        if not isinstance(value, tuple):
            return 1
        lower, upper, step = value
        steps = math.floor((upper - lower) / step + NEARLY)
        if name not in ANGLES:
            return steps
        return steps + (lower + steps * step < lower + TURN - NEARLY * step)

    def coordinates(self, numbers: np.ndarray) -> np.ndarray:
        """Coordinates (N, 6) [m and °] of placements by number (N,): yaw changes first, x last."""
        at, found = np.unravel_index(numbers, self.shape), np.empty((len(numbers), len(COORDINATES)))
        for column, (name, k) in enumerate(zip(COORDINATES, at, strict=True)):
            values = self.values(name)
            found[:, column] = values[k] if len(values) > 1 else values[0]
        return found

    def column(self, name: str) -> np.ndarray:
        """A coordinate of all placements, (count,) [m or °], in their order."""
        values = self.values(name).reshape([-1 if each == name else 1 for each in COORDINATES])
        return np.broadcast_to(values, self.shape).ravel()

    @property
    def limits(self) -> tuple[np.ndarray, np.ndarray]:
        """Ends of all coordinates, (6,) each [m and °]; those without a range are held."""
        ends = [(value[0], value[1]) if isinstance(value, tuple) else (value, value) for value in
                (getattr(self, name) for name in COORDINATES)]  # fmt: skip
        return np.array(ends).T[0], np.array(ends).T[1]


Mounting = Literal["floor", "wall", "ceiling"]


class TableEdge(Document):
    """The edge of a table: the base stands upright on its rectangle, and is clamped no farther from its edge.

    The table's top is at the z of what is placed.
    """

    kind: Literal["table_edge"]
    """The edge of a table."""
    center_m: Annotated[tuple[float, float], number_list(2)] = (0.0, 0.0)
    """x and y of the middle of the table in the world [m]."""
    size_m: Annotated[tuple[PositiveNumber, PositiveNumber], number_list(2)]
    """Lengths of the table along its x and y [m]."""
    yaw_deg: Annotated[float, BeforeValidator(real)] = 0.0
    """Turn of the table about the world's z [°]."""
    clamp_m: PositiveNumber
    """Largest distance of the origin of the frame that is placed from the nearest edge [m]."""

    @property
    def corners(self) -> np.ndarray:
        """The table's corners (4, 2) in the world, around it [m]."""
        return self.center_m + np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)]) * self.size_m @ self._axes / 2

    @property
    def _axes(self) -> np.ndarray:
        """The table's x and y in the world, (2, 2)."""
        return placed(np.array([[0.0] * 5 + [self.yaw_deg]]))[0, :2, :2].T

    def holds(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Whether a base may stand at x and y [m], bool of their shape."""
        own = np.stack([x - self.center_m[0], y - self.center_m[1]], axis=-1) @ self._axes.T
        inwards = (np.array(self.size_m) / 2 - np.abs(own)).min(axis=-1)
        return (inwards >= -NEARLY) & (inwards <= self.clamp_m + NEARLY)


def _mounting(value: Any) -> Any:
    if isinstance(value, TableEdge) or (isinstance(value, str) and value in _MOUNTED):
        return value
    if isinstance(value, Mapping):
        return TableEdge.model_validate(value)
    raise ValueError(f"must be one of {quoted(_MOUNTED)}, or a table's edge as an object")


AnyMounting = Annotated[Mounting | TableEdge, BeforeValidator(_mounting)]


def mounted(mounting: Mounting | TableEdge) -> np.ndarray:
    """How a base stands in the frame that is placed, (4, 4): its z is the frame's z, x, or -z."""
    turn = _MOUNTED["floor" if isinstance(mounting, TableEdge) else mounting]
    return placed(np.array([[0.0, 0.0, 0.0, *turn]]))[0]


def placed(coordinates: np.ndarray) -> np.ndarray:
    """Frames (N, 4, 4) in the world of coordinates (N, 6) [m and °], as `PlacementSpace` has them."""
    T = np.zeros((len(coordinates), 4, 4))
    T[:, 3, 3] = 1.0
    T[:, :3, 3] = coordinates[:, :3]
    angles = np.radians(np.remainder(coordinates[:, 3:] + 180.0, TURN) - 180.0)
    (cx, cy, cz), (sx, sy, sz) = (_tidy(turn(angles).T) for turn in (np.cos, np.sin))
    T[:, 0, 0], T[:, 0, 1], T[:, 0, 2] = cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx
    T[:, 1, 0], T[:, 1, 1], T[:, 1, 2] = sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx
    T[:, 2, 0], T[:, 2, 1], T[:, 2, 2] = -sy, cy * sx, cy * cx
    return T


def _tidy(values: np.ndarray) -> np.ndarray:
    """Quarter turns are exact."""
    return np.where(np.abs(values) > 1e-15, values, 0.0)
