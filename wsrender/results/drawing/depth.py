"""A depth buffer: what is nearest to the eye at each pixel. Matplotlib has none, it paints one thing after another."""

from dataclasses import dataclass

import numpy as np

from wsrender.results.drawing.camera import Camera

OVERSAMPLING = 2  # pixels looked at per pixel of the picture, each way: edges without steps
_AT_ONCE = 200_000  # pixels of the rectangles around triangles
_ON_SIDE = 1e-9  # of a triangle's area: a pixel on a common side belongs to both
_LIFTED = 4  # pixels by which what lies on a surface may be behind it


@dataclass(frozen=True, eq=False)
class DepthBuffer:
    """What of some triangles is seen at each pixel.

    ``nearest`` (height, width) is the number of the triangle, -1 where there is none; ``nearness`` (height, width) how
    much nearer to the eye than the camera's centre it is there [m]. ``start`` (T, 2) is the pixel, column and row, of
    a first corner, ``growth`` (2, T, 2) what the shares of the second and the third grow by along columns and rows.
    """

    camera: Camera
    nearest: np.ndarray
    nearness: np.ndarray
    start: np.ndarray
    growth: np.ndarray

    @classmethod
    def of(cls, camera: Camera, size: tuple[int, int], corners: np.ndarray) -> "DepthBuffer":
        """Of triangles with corners (T, 3, 3) [m] in a picture of ``size`` (width, height) pixels."""
        width, height = (OVERSAMPLING * pixels for pixels in size)
        pixels = _pixels(camera, (height, width), corners.reshape(-1, 3)).reshape(-1, 3, 2)
        ab, ac = pixels[:, 1] - pixels[:, 0], pixels[:, 2] - pixels[:, 0]
        area = ab[:, :1] * ac[:, 1:] - ab[:, 1:] * ac[:, :1]
        growth = np.stack([ac[:, ::-1], -ab[:, ::-1]]) * [1, -1] / np.where(area == 0, np.inf, area)
        nothing = np.full((height, width), -1, np.int32), np.full((height, width), -np.inf, np.float32)
        buffer = cls(camera, *nothing, pixels[:, 0], growth)
        low = np.clip(np.floor(pixels.min(axis=1)), 0, [width, height]).astype(np.int64)
        high = np.clip(np.ceil(pixels.max(axis=1)), 0, [width, height]).astype(np.int64)
        size_of = (high - low).prod(axis=1)
        chosen = np.flatnonzero((area[:, 0] != 0) & (size_of > 0))
        cuts = np.flatnonzero(np.diff(np.cumsum(size_of[chosen]) // _AT_ONCE)) + 1
        near = camera.nearness(corners.reshape(-1, 3)).reshape(-1, 3)
        for rows in np.split(chosen, cuts):
            buffer._fill(rows, low[rows, 1], high[rows, 1], near[rows])
        return buffer

    def hides(self, points: np.ndarray) -> np.ndarray:
        """Which points (N, 3) [m] a triangle hides from the eye, (N,) bool."""
        height, width = self.nearest.shape
        column, row = np.floor(_pixels(self.camera, (height, width), points)).astype(np.int64).T
        seen = (column >= 0) & (column < width) & (row >= 0) & (row < height)
        before = self.nearness[row.clip(0, height - 1), column.clip(0, width - 1)]
        lifted = _LIFTED * 2 * self.camera.half_height / height
        return seen & (before > self.camera.nearness(points) + lifted)

    def image(self, colors: np.ndarray, alpha: float = 1.0) -> np.ndarray:
        """RGBA 0 … 1 (height, width, 4) of the picture's pixels; ``colors`` (T, 3, 3) are those of corners."""
        a, b, c = colors.transpose(1, 0, 2)
        steps = [u[:, None] * (b - a) + v[:, None] * (c - a) for u, v in self.growth.transpose(2, 0, 1)]
        planes = np.stack([a, *steps]).astype(np.float32)
        n = OVERSAMPLING
        height, width = (edge // n for edge in self.nearest.shape)
        parts = self.nearest.reshape(height, n, width, n).transpose(1, 3, 0, 2).reshape(n * n, -1)
        covered = np.flatnonzero((parts >= 0).any(axis=0))
        parts, down, across = parts[:, covered], *np.divmod(covered, width)
        # Colours grow evenly: where a pixel has one triangle, their mean is that in the middle.
        whole = (parts == parts[0]).all(axis=0)
        looked = [(np.where(whole, -1, part), k // n + 0.5, k % n + 0.5, 1) for k, part in enumerate(parts)]
        flat = np.zeros((len(covered), 4), np.float32)
        for part, below, beside, times in (*looked, (np.where(whole, parts[0], -1), n / 2, n / 2, n * n)):
            seen = np.flatnonzero(part >= 0)
            triangle = part[seen]
            start = self.start[triangle]
            place = np.stack([n * across[seen] + beside - start[:, 0], n * down[seen] + below - start[:, 1]])
            x, y = place.astype(np.float32)[..., None]
            first, right, under = (plane[triangle] for plane in planes)
            flat[seen, :3] += times * (first + x * right + y * under)
            flat[seen, 3] += times
        flat[:, :3] /= flat[:, 3:]
        flat[:, 3] *= alpha / n**2
        image = np.zeros((height * width, 4), np.float32)
        image[covered] = flat.clip(0, 1)
        return image.reshape(height, width, 4)

    def _fill(self, rows: np.ndarray, low: np.ndarray, high: np.ndarray, near: np.ndarray) -> None:
        """Write triangles ``rows`` that are seen from row ``low`` (R,) of the picture to before ``high``.

        ``near`` (R, 3) is how near to the eye their corners are [m].
        """
        width = self.nearest.shape[1]
        of, down = _counted(high - low)
        y = down + low[of] + 0.5 - self.start[rows, 1][of]
        (ux, uy), (vx, vy) = (each[rows].T for each in self.growth)
        # Shares are at least 0: each is a bound of the columns.
        across, along = np.stack([ux, vx, -ux - vx]), np.stack([uy, vy, -uy - vy])
        with np.errstate(divide="ignore", invalid="ignore"):
            bound = (-_ON_SIDE - np.array([[0], [0], [1]]) - along[:, of] * y) / (across + 0.0)[:, of]
        first = np.fmax.reduce(np.where(across[:, of] >= 0, bound, -np.inf))
        last = np.fmin.reduce(np.where(across[:, of] < 0, bound, np.inf))
        start = self.start[rows, 0][of] - 0.5
        left, right = (np.clip(np.ceil(start + each), 0, width) for each in (first, last))
        line, step = _counted(np.maximum(right - left, 0).astype(np.int64))
        a, b, c = near.T
        grows = ux * (b - a) + vx * (c - a)
        begins = a[of] + y * (uy * (b - a) + vy * (c - a))[of] + (left - start) * grows[of]
        depth = (begins[line] + step * grows[of][line]).astype(np.float32)
        cell = ((low[of] + down) * width + left.astype(np.int64))[line] + step
        np.maximum.at(self.nearness.ravel(), cell, depth)
        front = depth == self.nearness.ravel()[cell]
        self.nearest.ravel()[cell[front]] = rows[of[line[front]]]


def _pixels(camera: Camera, shape: tuple[int, int], points: np.ndarray) -> np.ndarray:
    """Columns and rows (N, 2) from the upper left of points (N, 3) [m]."""
    height, width = shape
    return camera.to_picture(points) * [height / 2, -height / 2] + [width / 2, height / 2]


def _counted(numbers: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of ``numbers`` (R,) of things each: whose each thing is, and the how manieth of it from 0."""
    whose = np.repeat(np.arange(len(numbers)), numbers)
    return whose, np.arange(len(whose)) - (np.cumsum(numbers) - numbers)[whose]
