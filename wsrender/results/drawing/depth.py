"""A depth buffer: what is nearest to the eye at each pixel. Matplotlib has none, it paints one thing after another."""

from dataclasses import dataclass

import numpy as np

from wsrender.results.drawing.camera import Camera

OVERSAMPLING = 2  # pixels looked at per pixel of the picture, each way: edges without steps
_AT_ONCE = 500_000  # pixels × triangles
_ON_SIDE = 1e-9  # of a triangle's area: a pixel on a common side belongs to both
_LIFTED = 4  # pixels by which what lies on a surface may be behind it


@dataclass(frozen=True, eq=False)
class DepthBuffer:
    """What of some triangles is seen at each pixel.

    ``nearest`` (height, width) is the number of the triangle, -1 where there is none; ``nearness`` (height, width) how
    much nearer to the eye than the camera's centre it is there [m]; ``shares`` (height, width, 2) how much of its
    second and third corner the place is.
    """

    camera: Camera
    nearest: np.ndarray
    nearness: np.ndarray
    shares: np.ndarray

    @classmethod
    def of(cls, camera: Camera, size: tuple[int, int], corners: np.ndarray) -> "DepthBuffer":
        """Of triangles with corners (T, 3, 3) [m] in a picture of ``size`` (width, height) pixels."""
        width, height = (OVERSAMPLING * pixels for pixels in size)
        shape = height, width
        buffer = cls(camera, np.full(shape, -1), np.full(shape, -np.inf), np.zeros((*shape, 2), np.float32))
        flat = corners.reshape(-1, 3)
        pixels = buffer._pixels(flat).reshape(-1, 3, 2)
        near = camera.nearness(flat).reshape(-1, 3)
        low = np.clip(np.floor(pixels.min(axis=1)), 0, [width, height]).astype(np.int64)
        high = np.clip(np.ceil(pixels.max(axis=1)), 0, [width, height]).astype(np.int64)
        edge = np.maximum((high - low).max(axis=1, initial=1), 1)
        exponent = np.ceil(np.log2(edge)).astype(np.int64)
        for each in np.unique(exponent).tolist():  # triangles of like size together
            chosen, side = np.flatnonzero(exponent == each), 1 << each
            step = max(_AT_ONCE // side**2, 1)
            for first in range(0, len(chosen), step):
                rows = chosen[first : first + step]
                buffer._fill(rows, low[rows], side, pixels[rows], near[rows])
        return buffer

    def hides(self, points: np.ndarray) -> np.ndarray:
        """Which points (N, 3) [m] a triangle hides from the eye, (N,) bool."""
        height, width = self.nearest.shape
        column, row = np.floor(self._pixels(points)).astype(np.int64).T
        seen = (column >= 0) & (column < width) & (row >= 0) & (row < height)
        before = self.nearness[row.clip(0, height - 1), column.clip(0, width - 1)]
        lifted = _LIFTED * 2 * self.camera.half_height / height
        return seen & (before > self.camera.nearness(points) + lifted)

    def image(self, colors: np.ndarray, alpha: float = 1.0) -> np.ndarray:
        """RGBA 0 … 1 (height, width, 4) of the picture's pixels; ``colors`` (T, 3, 3) are those of corners."""
        height, width = self.nearest.shape
        seen = np.flatnonzero(self.nearest.ravel() >= 0)
        a, b, c = colors[self.nearest.ravel()[seen]].astype(np.float32).transpose(1, 0, 2)
        u, v = self.shares.reshape(-1, 2)[seen].T[..., None]
        flat = np.zeros((height * width, 4), np.float32)
        flat[seen, :3], flat[seen, 3] = a + u * (b - a) + v * (c - a), 1
        n = OVERSAMPLING
        rows = flat.reshape(height, width, 4)
        image = np.mean([rows[i::n, j::n] for i in range(n) for j in range(n)], axis=0)
        image[..., :3] /= np.maximum(image[..., 3:], 1e-12)
        image[..., 3] *= alpha
        return image.clip(0, 1)

    def _pixels(self, points: np.ndarray) -> np.ndarray:
        """Columns and rows (N, 2) from the upper left of points (N, 3) [m]."""
        height, width = self.nearest.shape
        return self.camera.to_picture(points) * [height / 2, -height / 2] + [width / 2, height / 2]

    def _fill(self, rows: np.ndarray, low: np.ndarray, side: int, corners: np.ndarray, near: np.ndarray) -> None:
        """Write triangles ``rows`` whose pixels lie in squares of ``side`` from ``low`` (R, 2) on.

        ``corners`` (R, 3, 2) are their pixels, ``near`` (R, 3) how near to the eye these are [m].
        """
        height, width = self.nearest.shape
        (column, row), start = (low[:, k, None] + np.arange(side) for k in (0, 1)), corners[:, 0, :, None]
        x, y = column + 0.5 - start[:, 0], row + 0.5 - start[:, 1]
        (abx, aby), (acx, acy) = ((corners[:, k] - corners[:, 0]).T[..., None] for k in (1, 2))
        with np.errstate(divide="ignore", invalid="ignore"):
            area = abx * acy - aby * acx
            # Places grow evenly along rows and columns.
            u = (x * (acy / area))[:, None] - (y * (acx / area))[:, :, None]
            v = (y * (abx / area))[:, :, None] - (x * (aby / area))[:, None]
            inside = (u >= -_ON_SIDE) & (v >= -_ON_SIDE) & (u + v <= 1 + _ON_SIDE)
        inside &= (column < width)[:, None] & (row < height)[:, :, None]
        triangle, down, along = np.nonzero(inside)
        u, v = u[inside], v[inside]
        a, b, c = near[triangle].T
        depth, cell = a + u * (b - a) + v * (c - a), row[triangle, down] * width + column[triangle, along]
        front = np.flatnonzero(depth > self.nearness.ravel()[cell])
        front = front[np.argsort(depth[front], kind="stable")]  # of one pixel's the nearest is written last
        self.nearness.ravel()[cell[front]] = depth[front]
        self.nearest.ravel()[cell[front]] = rows[triangle[front]]
        self.shares.reshape(-1, 2)[cell[front]] = np.stack([u[front], v[front]], axis=1)
