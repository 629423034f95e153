"""What stands around a robot: floor, tables, boxes."""

from dataclasses import dataclass

import numpy as np

from wsrender.errors import InputError
from wsrender.results.render.scene import Color, DrawnSurface

# Faces of a box whose corners are numbered by the bits x y z, outward.
_FACES = [
    [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
    [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
]  # fmt: skip
TABLE_TOP = 0.04  # thickness of a table's top and legs [m]


@dataclass(frozen=True)
class Box:
    """A box with edges along the world's axes: ``center_m`` and ``size_m``, each (x, y, z) [m]."""

    center_m: tuple[float, float, float]
    size_m: tuple[float, float, float]

    def __post_init__(self):
        _check("box.center_m", self.center_m, 3)
        _check("box.size_m", self.size_m, 3, positive=True)


@dataclass(frozen=True)
class Table:
    """A table on four legs: ``center_m`` (x, y, z) is the middle of its top, ``size_m`` (x, y) of the top [m].

    It stands on ``floor_m``, the height of the floor [m].
    """

    center_m: tuple[float, float, float]
    size_m: tuple[float, float]
    floor_m: float = 0.0

    def __post_init__(self):
        _check("table.center_m", self.center_m, 3)
        _check("table.size_m", self.size_m, 2, positive=True)
        if not self.center_m[2] - TABLE_TOP > self.floor_m:
            raise InputError(
                "table.center_m",
                f"its top, z = {self.center_m[2]:g} m, must be more than its thickness, {TABLE_TOP:g} m, above the "
                f"floor, z = {self.floor_m:g} m",
            )


@dataclass(frozen=True)
class Floor:
    """A floor at a height [m], as large as the picture."""

    height_m: float = 0.0

    def __post_init__(self):
        _check("floor.height_m", (self.height_m,), 1)


Item = Box | Table | Floor
COLORS: dict[type, Color] = {Box: (0.72, 0.62, 0.5), Table: (0.62, 0.66, 0.7), Floor: (0.86, 0.86, 0.84)}
LABELS: dict[type, str] = {Box: "box", Table: "table", Floor: "floor"}


def corners(item: Item) -> np.ndarray:
    """Points (N, 3) [m] that a picture of the item must hold; none for a floor but its height decides."""
    if isinstance(item, Floor):
        return np.empty((0, 3))
    return np.concatenate([_ends(center, size) for center, size in _boxes(item)])


def surfaces(item: Item, lower: np.ndarray, upper: np.ndarray) -> list[DrawnSurface]:
    """The item in a picture of the box lower … upper [m]; a floor covers it."""
    if isinstance(item, Floor):
        middle, size = (lower + upper) / 2, upper - lower
        thickness = 0.004 * size.max()
        boxes = [(np.array([*middle[:2], item.height_m - thickness / 2]), np.array([*size[:2], thickness]))]
    else:
        boxes = _boxes(item)
    return [_box(center, size, COLORS[type(item)]) for center, size in boxes]


def _boxes(item: Box | Table) -> list[tuple[np.ndarray, np.ndarray]]:
    """(centre, size) of the boxes that make an item [m]."""
    center, size = np.array(item.center_m, float), np.array(item.size_m, float)
    if isinstance(item, Box):
        return [(center, size)]
    t = TABLE_TOP
    height = center[2] - t - item.floor_m
    boxes = [(center - [0, 0, t / 2], np.array([*size, t]))]
    for sign in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
        foot = center[:2] + np.array(sign) * (size - t) / 2
        boxes.append((np.array([*foot, item.floor_m + height / 2]), np.array([t, t, height])))
    return boxes


def _ends(center: np.ndarray, size: np.ndarray) -> np.ndarray:
    return np.stack([center - size / 2, center + size / 2])


def _box(center: np.ndarray, size: np.ndarray, color: Color) -> DrawnSurface:
    bits = np.array([[k >> 2 & 1, k >> 1 & 1, k & 1] for k in range(8)])
    return DrawnSurface(center + (bits - 0.5) * size, np.array(_FACES), color)


def _check(field: str, values: tuple[float, ...], count: int, positive: bool = False) -> None:
    numbers = np.asarray(values, float)
    if numbers.shape != (count,) or not np.isfinite(numbers).all() or (positive and not (numbers > 0).all()):
        kind = "positive numbers" if positive else "numbers"
        raise InputError(field, f"must be {count} finite {kind} in metres, not {values}")
