"""The box of a picture in space: where its camera stands, its panes, numbers and names of axes."""

from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.ticker import MaxNLocator

from wsrender.results.drawing.camera import Camera
from wsrender.results.drawing.style import DPI, quantity

AZIMUTH_DEG, ELEVATION_DEG = -58.0, 24.0  # of the eye
THINNEST = 0.3  # least extent of the box along an axis, relative to the largest: planar sets stay legible
NUMBER_SIZE, NAME_SIZE = 8.0, 9.0  # of letters [pt]
_LETTER = (0.64 / 72, 1.05 / 72)  # width and height of a letter of 1 pt [in]
_GAP = (0.07, 0.06)  # from the box to its numbers, from these to the name [in]
_FURTHER, _MOST_STEPS = 0.05, 40  # step by which a name gives way to something else [in], and how often it does
_CORNER = 0.08  # least distance between the numbers of two axes [in]
_APART = (0.09, 0.03)  # least distances between two numbers [in]
_MARGIN = (0.58, 0.43)  # free border left and right, above and below the box [in]
_MOST_MARGIN = 0.2  # of the picture's half width and height, where it is small
_SHRINKINGS = 8  # tries to give the numbers room, by a tenth each
_STEPS = [1, 2, 2.5, 5, 10]


@dataclass(frozen=True)
class PlacedText:
    """A text at a place of the picture, with half its width and height, all in half heights of the picture."""

    text: str
    x: float
    y: float
    half: tuple[float, float]
    upright: bool = False  # to be read from the right

    def overlaps(self, other: "PlacedText", gap: float = 0.0) -> bool:
        """Whether the texts would be written over each other, or nearer to each other than ``gap``."""
        apart = abs(self.x - other.x), abs(self.y - other.y)
        return all(apart[k] < self.half[k] + other.half[k] + gap for k in (0, 1))


@dataclass(frozen=True, eq=False)
class SeenBox:
    """A box lower … upper (3,) [m] seen by a camera; ``inch`` is one of the printed picture, in half heights of it.

    Other quantities than lengths are drawn multiplied by ``stretch`` (3,), with ``names`` of their own.
    """

    lower: np.ndarray
    upper: np.ndarray
    camera: Camera
    inch: float
    stretch: np.ndarray = field(default_factory=lambda: np.ones(3))
    names: tuple[str, ...] = tuple(quantity(name, "m") for name in "xyz")

    @property
    def near(self) -> np.ndarray:
        """Whether the upper side of the box along x, y, z faces the eye, (3,) bool."""
        return self.camera.forward < 0

    def ticks(self, axis: int) -> np.ndarray:
        """Round coordinates along an axis, inside the box, as many as have room for their numbers [m]."""
        low, high = self.lower[axis] / self.stretch[axis], self.upper[axis] / self.stretch[axis]
        values = np.empty(0)
        for most in (6, 5, 4, 3, 2):
            values = MaxNLocator(most, steps=_STEPS).tick_values(low, high)
            values = values[(values >= low - 1e-9 * (high - low)) & (values <= high + 1e-9 * (high - low))]
            if len(values) < 3 or self._have_room(axis, values):
                break
        return values

    def labels(self) -> list[PlacedText]:
        """The numbers of the three axes and their names, none over another; a number without room is left out."""
        found: list[PlacedText] = []
        rows = [self._numbers(axis) for axis in range(3)]
        for row in rows:
            others = list(found)
            for number in row:
                near = any(number.overlaps(other, _CORNER * self.inch) for other in others)
                if not near and not any(number.overlaps(other) for other in found):
                    found.append(number)
        for axis, row in enumerate(rows):
            found.append(self._name(axis, row, found))
        return found

    def _have_room(self, axis: int, values: np.ndarray) -> bool:
        numbers = self._numbers(axis, values)
        apart = [part * self.inch for part in _APART]
        return all(
            abs(b.x - a.x) > a.half[0] + b.half[0] + apart[0] or abs(b.y - a.y) > a.half[1] + b.half[1] + apart[1]
            for a, b in pairwise(numbers)
        )

    def _numbers(self, axis: int, values: np.ndarray | None = None) -> list[PlacedText]:
        """The coordinates of an axis beside its edge, outside the box."""
        values = self.ticks(axis) if values is None else values
        start, end = self.edge(axis)
        places = np.repeat(start[None], len(values), axis=0)
        places[:, axis] = values * self.stretch[axis]
        away = _outward(*self.camera.to_picture(np.stack([start, end])))
        digits = _digits(values)
        labels = []
        for (x, y), value in zip(self.camera.to_picture(places), values, strict=True):
            text = f"{value + 0.0:.{digits}f}".replace("-", "−")  # + 0.0: no −0
            half = self._half(text, NUMBER_SIZE)
            off = _GAP[0] * self.inch + np.abs(away) @ half
            labels.append(PlacedText(text, float(x + off * away[0]), float(y + off * away[1]), half))
        return labels

    def _name(self, axis: int, numbers: list[PlacedText], taken: list[PlacedText]) -> PlacedText:
        """The name of an axis beyond its numbers, further out where something else stands."""
        start, end = self.edge(axis)
        away = _outward(*self.camera.to_picture(np.stack([start, end])))
        x, y = self.camera.to_picture((start + end)[None] / 2)[0]
        half = self._half(text := self.names[axis], NAME_SIZE)
        half = (half[1], half[0]) if axis == 2 else half
        widest = max((float(2 * np.abs(away) @ number.half) for number in numbers), default=0.0)
        off = sum(_GAP) * self.inch + widest + float(np.abs(away) @ half)
        steps = (off + _FURTHER * self.inch * step for step in range(_MOST_STEPS))
        places = [PlacedText(text, float(x + at * away[0]), float(y + at * away[1]), half, axis == 2) for at in steps]
        return next((label for label in places if not any(label.overlaps(other) for other in taken)), places[-1])

    def _half(self, text: str, size: float) -> tuple[float, float]:
        """Half width and height of a text of letters of ``size`` [pt]."""
        return len(text) * _LETTER[0] * size * self.inch / 2, _LETTER[1] * size * self.inch / 2

    def side(self, axis: int, near: bool) -> float:
        """Coordinate of the box's side towards the eye, or away from it [m]."""
        return float((self.upper if self.near[axis] == near else self.lower)[axis])

    def edge(self, axis: int) -> tuple[np.ndarray, np.ndarray]:
        """Ends (3,), (3,) of the edge along which an axis has its numbers [m].

        x and y: the lower edges towards the eye; z: the upright edge farthest left.
        """
        start = np.array([self.side(0, True), self.side(1, True), self.side(2, False)])
        if axis == 2:
            upright = [(self.side(0, True), self.side(1, False)), (self.side(0, False), self.side(1, True))]
            seen = self.camera.to_picture(np.array([[x, y, 0.0] for x, y in upright]))
            start[:2] = upright[int(np.argmin(seen[:, 0]))]
        end = start.copy()
        start[axis], end[axis] = self.lower[axis], self.upper[axis]
        return start, end

    def panes(self) -> tuple[np.ndarray, np.ndarray]:
        """Lines (N, 2, 3) [m] of the three far sides: the grid of the round coordinates, and the outlines."""
        grid, frame = [], []
        for normal in range(3):
            at = self.side(normal, False)
            across = [axis for axis in range(3) if axis != normal]
            for along, other in (across, across[::-1]):
                for value in self.ticks(along) * self.stretch[along]:
                    grid.append(self._line(normal, at, along, value, other))
                for value in (self.lower[along], self.upper[along]):
                    frame.append(self._line(normal, at, along, value, other))
        return np.array(grid).reshape(-1, 2, 3), np.array(frame)

    def _line(self, normal: int, at: float, along: int, value: float, other: int) -> np.ndarray:
        ends = np.empty((2, 3))
        ends[:, normal], ends[:, along] = at, value
        ends[:, other] = self.lower[other], self.upper[other]
        return ends


def box(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corners (3,), (3,) of a box around points (N, 3), not thinner than 0.3 of its longest edge [m]."""
    if len(points) == 0:
        return np.full(3, -0.5), np.full(3, 0.5)
    lower, upper = points.min(axis=0).astype(float), points.max(axis=0).astype(float)
    longest = (upper - lower).max()
    span = np.maximum(upper - lower, THINNEST * longest) if longest > 0 else np.full(3, 0.1)
    middle = (lower + upper) / 2
    return middle - 0.52 * span, middle + 0.52 * span


def space_around(
    points: np.ndarray, size: tuple[int, int], azimuth_deg: float, elevation_deg: float, **axes_of: Any
) -> SeenBox:
    """The box of points (N, 3) [m] in a picture of ``size`` pixels, seen from a direction [deg].

    The picture holds its numbers and names too. ``axes_of``: ``stretch`` and ``names`` of a `Space`.
    """
    lower, upper = box(points)
    middle = (lower + upper) / 2
    forward = -towards_eye(azimuth_deg, elevation_deg)
    azimuth = np.deg2rad(azimuth_deg)
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    up = np.cross(right, forward)
    corners = np.stack(np.meshgrid(*zip(lower, upper, strict=True)), axis=-1).reshape(-1, 3)
    seen = (corners - middle) @ np.stack([right, up], axis=1)
    half = np.ptp(seen, axis=0) / 2
    wide, inch = size[0] / size[1], 2 * DPI / size[1]
    margin = min(_MARGIN[0] * inch, _MOST_MARGIN * wide), min(_MARGIN[1] * inch, _MOST_MARGIN)
    half_height = max(half[0] / (wide - margin[0]), half[1] / (1 - margin[1]))
    space = SeenBox(lower, upper, Camera(middle, forward, up, float(half_height)), inch, **axes_of)
    for _ in range(_SHRINKINGS):
        ends = np.array([np.abs([label.x, label.y]) + label.half for label in space.labels()])
        if (ends <= [wide, 1.0]).all():
            break
        smaller = replace(space.camera, half_height=1.1 * space.camera.half_height)
        space = replace(space, camera=smaller)
    return space


def towards_eye(azimuth_deg: float, elevation_deg: float) -> np.ndarray:
    """Unit vector towards the eye, (3,)."""
    azimuth, elevation = np.deg2rad([azimuth_deg, elevation_deg])
    return np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])


def _outward(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Unit vector across an edge of the picture, away from the middle of the picture; downwards where it is a point."""
    along = end - start
    length = float(np.linalg.norm(along))
    if length < 1e-9:
        return np.array([0.0, -1.0])
    across = np.array([-along[1], along[0]]) / length
    return across if across @ (start + end) > 0 else -across


def _digits(ticks: np.ndarray) -> int:
    """Decimals that tell the ticks apart."""
    step = float(np.diff(ticks).min()) if len(ticks) > 1 else 1.0
    return next((digits for digits in range(10) if abs(step - round(step, digits)) < 1e-6 * step), 10)
