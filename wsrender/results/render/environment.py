"""What stands around a robot in a picture: shapes of the world, and short names of floor, table and box."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from wsrender.documents import environment as world
from wsrender.errors import InputError
from wsrender.results.render.scene import Color, DrawnSurface
from wsrender.robot.surroundings import shapes_around
from wsrender.world.surfaces import ClosedSurface
from wsrender.world.triangles import plate, triangles

TABLE_TOP = 0.04  # thickness of a table's top and legs [m]


@dataclass(frozen=True)
class RenderedBox:
    """A box with edges along the world's axes: ``center_m`` and ``size_m``, each (x, y, z) [m]."""

    center_m: tuple[float, float, float]
    size_m: tuple[float, float, float]
    kind: ClassVar[str] = "box"

    def __post_init__(self):
        _check("box.center_m", self.center_m, 3)
        _check("box.size_m", self.size_m, 3, positive=True)

    def shapes(self) -> list[world.Box]:
        """The box in the world."""
        return [world.Box(position_m=self.center_m, size_m=self.size_m)]


@dataclass(frozen=True)
class RenderedTable:
    """A table on four legs: ``center_m`` (x, y, z) is the middle of its top, ``size_m`` (x, y) of the top [m].

    It stands on ``floor_m``, the height of the floor [m].
    """

    center_m: tuple[float, float, float]
    size_m: tuple[float, float]
    floor_m: float = 0.0
    kind: ClassVar[str] = "table"

    def __post_init__(self):
        _check("table.center_m", self.center_m, 3)
        _check("table.size_m", self.size_m, 2, positive=True)
        if not self.center_m[2] - TABLE_TOP > self.floor_m:
            raise InputError(
                "table.center_m",
                f"its top, z = {self.center_m[2]:g} m, must be more than its thickness, {TABLE_TOP:g} m, above the "
                f"floor, z = {self.floor_m:g} m",
            )

    def shapes(self) -> list[world.Box]:
        """Its top and four legs in the world."""
        center, size, t = np.array(self.center_m, float), np.array(self.size_m, float), TABLE_TOP
        height = center[2] - t - self.floor_m
        boxes = [world.Box(position_m=(*center[:2], center[2] - t / 2), size_m=(*size, t))]
        for sign in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
            foot = center[:2] + np.array(sign) * (size - t) / 2
            boxes.append(world.Box(position_m=(*foot, self.floor_m + height / 2), size_m=(t, t, height)))
        return boxes


@dataclass(frozen=True)
class Floor:
    """A floor at a height [m], as large as the picture."""

    height_m: float = 0.0
    kind: ClassVar[str] = "floor"

    def __post_init__(self):
        _check("floor.height_m", (self.height_m,), 1)

    def shapes(self) -> list[world.HalfSpace]:
        """The half-space below it."""
        return [world.HalfSpace(point_m=(0.0, 0.0, self.height_m))]


@dataclass(frozen=True)
class RenderedItem:
    """A robot, a scene, a mesh or a height field: its shapes, read once, and what a legend calls it."""

    kind: str
    stands: tuple[world.Shape | ClosedSurface, ...]

    def shapes(self) -> tuple[world.Shape | ClosedSurface, ...]:
        """Its shapes in the world."""
        return self.stands


Item = RenderedBox | RenderedTable | Floor | RenderedItem | world.Shape
_WOOD: Color = (0.72, 0.62, 0.5)
COLORS: dict[type, Color] = {
    RenderedTable: (0.62, 0.66, 0.7),
    Floor: (0.86, 0.86, 0.84),
    world.HalfSpace: (0.86, 0.86, 0.84),
}


def color(item: Item) -> Color:
    """Colour of an item in pictures."""
    return COLORS.get(type(item), _WOOD)


def label(item: Item) -> str:
    """What a legend calls an item: its kind."""
    named = isinstance(item, RenderedBox | RenderedTable | Floor | RenderedItem)
    return item.kind if named else item.shape.replace("_", " ")


def items_of(environment: "Iterable[Item] | world.Environment") -> list[Item]:
    """The items of an environment. Raises InputError for what is none, or has no shapes."""
    items: list[Any] = list(environment.items if isinstance(environment, world.Environment) else environment)
    for k, item in enumerate(items):
        if isinstance(item, world.OtherRobot | world.Scene | world.Mesh | world.HeightField):
            try:
                items[k] = RenderedItem(
                    item.shape.replace("_", " "), tuple(each.shape for each in shapes_around([item]))
                )
            except InputError as error:
                raise error.at(error.field.replace("items.0", f"environment.{k}", 1)) from None
            continue
        if not isinstance(item, (RenderedBox, RenderedTable, Floor, *world.SHAPES.values())):
            allowed = "a wsrender Environment's shape, or a wsrender.results.render Floor, Table or Box"
            raise InputError(f"environment.{k}", f"must be {allowed}, not {item!r}")
    return items


def planes(items: Iterable[Item]) -> list[world.HalfSpace]:
    """The half-spaces of items: no picture holds them whole."""
    return [shape for item in items for shape in _shapes(item) if isinstance(shape, world.HalfSpace)]


def corners(item: Item) -> np.ndarray:
    """Points (N, 3) [m] that a picture of the item must hold; none for a half-space but where it is decides."""
    solids = [shape for shape in _shapes(item) if not isinstance(shape, world.HalfSpace)]
    return np.concatenate([np.empty((0, 3)), *(triangles(shape)[0] for shape in solids)])


def surfaces(item: Item, lower: np.ndarray, upper: np.ndarray) -> list[DrawnSurface]:
    """The item in a picture of the box lower … upper [m]; a half-space covers it."""
    flat = world.HalfSpace
    meshes = [plate(each, lower, upper) if isinstance(each, flat) else triangles(each) for each in _shapes(item)]
    return [DrawnSurface(*mesh, color(item)) for mesh in meshes]


def _shapes(item: Item) -> "Sequence[world.Shape | ClosedSurface]":
    return item.shapes() if isinstance(item, RenderedBox | RenderedTable | Floor | RenderedItem) else [item]


def _check(field: str, values: tuple[float, ...], count: int, positive: bool = False) -> None:
    numbers = np.asarray(values, float)
    if numbers.shape != (count,) or not np.isfinite(numbers).all() or (positive and not (numbers > 0).all()):
        kind = "positive numbers" if positive else "numbers"
        raise InputError(field, f"must be {count} finite {kind} in metres, not {values}")
