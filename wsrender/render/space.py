"""The box of a picture: where its camera stands, its panes and the places of its numbers."""

from dataclasses import dataclass

import numpy as np
from matplotlib.ticker import MaxNLocator

from wsrender.render.scene import Camera, Lines

AZIMUTH_DEG, ELEVATION_DEG = -58.0, 24.0  # of the eye, as in the pictures by matplotlib
_THINNEST = 0.3  # least extent of the box along an axis, relative to the largest: planar sets stay legible
_CORNER = 0.06  # part of an axis without numbers at its near end
_MARGIN = (0.23, 0.17)  # free border left and right, above and below the box, in half heights of the picture


@dataclass(frozen=True, eq=False)
class Space:
    """A box lower … upper (3,) [m] seen by a camera."""

    lower: np.ndarray
    upper: np.ndarray
    camera: Camera

    @property
    def near(self) -> np.ndarray:
        """Whether the upper side of the box along x, y, z faces the eye, (3,) bool."""
        return self.camera.forward < 0

    def ticks(self, axis: int) -> np.ndarray:
        """Round coordinates along an axis, inside the box [m]."""
        longest = (self.upper - self.lower).max()
        wide = self.upper[axis] - self.lower[axis] > 0.6 * longest
        values = MaxNLocator(6 if wide else 3, steps=[1, 2, 2.5, 5, 10]).tick_values(self.lower[axis], self.upper[axis])
        inside = (values >= self.lower[axis] - 1e-9 * longest) & (values <= self.upper[axis] + 1e-9 * longest)
        return values[inside]

    def labelled_ticks(self, axis: int) -> np.ndarray:
        """The round coordinates but those at the corner where two axes would write over each other [m]."""
        ticks = self.ticks(axis)
        if axis == 2:
            return ticks
        corner, length = self.side(axis, True), self.upper[axis] - self.lower[axis]
        return ticks[np.abs(ticks - corner) > _CORNER * length]

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

    def panes(self) -> list[Lines]:
        """The three far sides: their outlines and the grid of the round coordinates."""
        grid, frame = [], []
        for normal in range(3):
            at = self.side(normal, False)
            across = [axis for axis in range(3) if axis != normal]
            for along, other in (across, across[::-1]):
                for value in self.ticks(along):
                    grid.append(self._line(normal, at, along, value, other))
                for value in (self.lower[along], self.upper[along]):
                    frame.append(self._line(normal, at, along, value, other))
        return [Lines(np.array(grid), (0.87, 0.87, 0.87), 1.0), Lines(np.array(frame), (0.6, 0.6, 0.6), 1.2)]

    def _line(self, normal: int, at: float, along: int, value: float, other: int) -> np.ndarray:
        ends = np.empty((2, 3))
        ends[:, normal], ends[:, along] = at, value
        ends[:, other] = self.lower[other], self.upper[other]
        return ends


def space_around(points: np.ndarray, size: tuple[int, int], azimuth_deg: float, elevation_deg: float) -> Space:
    """The box of points (N, 3) [m] in a picture of ``size`` pixels, seen from a direction [deg].

    The box is not thinner than 0.3 of its longest edge.
    """
    lower, upper = points.min(axis=0).astype(float), points.max(axis=0).astype(float)
    longest = (upper - lower).max()
    span = np.maximum(upper - lower, _THINNEST * longest) if longest > 0 else np.full(3, 0.1)
    middle = (lower + upper) / 2
    lower, upper = middle - 0.52 * span, middle + 0.52 * span
    azimuth, elevation = np.deg2rad([azimuth_deg, elevation_deg])
    forward = -np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    up = np.cross(right, forward)
    corners = np.stack(np.meshgrid(*zip(lower, upper, strict=True)), axis=-1).reshape(-1, 3)
    seen = (corners - middle) @ np.stack([right, up], axis=1)
    half = np.ptp(seen, axis=0) / 2
    width, height = size
    half_height = max(half[0] / (width / height - _MARGIN[0]), half[1] / (1 - _MARGIN[1]))
    return Space(lower, upper, Camera(middle, forward, up, float(half_height)))
