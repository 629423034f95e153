"""The largest ball and the largest cube in the occupied voxels of a volume, and in a ball region.

At a point, each surface of the region allows a ball or a cube of some size about it, in closed form; the least of these
sizes is what fits. On the wrong side of a surface the size counts as negative, by the distance (for cubes: over √3).
From there to a point a distance d away no size grows by more than d (for cubes: d along an axis), so that the size at
the middle of a cell bounds all sizes in it: cells are divided until none can hold more than what sequential quadratic
programming (SLSQP, Kraft 1988) has found, but for a stated gap.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import optimize
from scipy.ndimage import distance_transform_edt

from wsrender.mechanisms.ball_region import BallRegion
from wsrender.volume.lattice import round_to_digits
from wsrender.volume.volume_data import VolumeData

# How far both may be off, in voxels, where the set has no details smaller than a voxel: the nearest voxel's centre lies
# within half a diagonal, and so does the nearest centre outside beyond the boundary; a cube may lose a voxel's width.
SPHERE_ERROR, CUBE_ERROR = (3**0.5 + 1) / 2, 1.0
FIRST_CELLS = 12  # along the longest side of the box
GAP = 2e-3  # of the largest size, to which it is proved; where many points are as good, MOST_CELLS ends the proof
MOST_CELLS = 60_000
SEARCHED_LEVELS = 3  # of cells
STARTS = 6  # of the search, from the best cells that are apart
STEP = 1e-6  # of the box, for central differences
DIGITS = 10  # of a size: the last ones of SLSQP depend on how many threads the linear algebra has
LAST_CHANGE = 1e-13  # of the size in units of the box, at which SLSQP ends

Sizes = Callable[[np.ndarray], np.ndarray]
"""What each surface allows at points (N, 3), (N, K) [m]; below 0: nothing."""


def inscribed_sphere_radius(volume: VolumeData | None) -> float:
    """Radius [m] of the largest ball about a voxel's centre that meets no voxel outside; 0 of an empty volume.

    Distance transform to the centres of voxels outside, less half a voxel; right to SPHERE_ERROR.
    """
    if volume is None or not volume.n_occupied:
        return 0.0
    distance = np.asarray(distance_transform_edt(np.pad(volume.occupied, 1)))
    return float((distance.max() - 0.5) * volume.voxel_size_m)


def inscribed_cube_edge(volume: VolumeData | None) -> float:
    """Edge [m] of the largest cube of occupied voxels, faces along the axes; 0 of an empty volume. CUBE_ERROR."""
    if volume is None or not volume.n_occupied:
        return 0.0
    sums = np.pad(volume.occupied.astype(np.int64), ((1, 0),) * 3).cumsum(0).cumsum(1).cumsum(2)
    fits, fails = 1, min(volume.occupied.shape) + 1
    while fails - fits > 1:
        middle = (fits + fails) // 2
        fits, fails = (middle, fails) if _has_cube(sums, middle) else (fits, middle)
    return fits * volume.voxel_size_m


def _has_cube(sums: np.ndarray, edge: int) -> bool:
    """Whether some edge³ block is full; ``sums`` are the sums of all voxels below each corner."""
    for axis in range(3):
        high, low = [slice(None)] * 3, [slice(None)] * 3
        high[axis], low[axis] = slice(edge, None), slice(None, -edge)
        sums = sums[tuple(high)] - sums[tuple(low)]
    return bool((sums == edge**3).any())


@dataclass(frozen=True, eq=False)
class Inscribed:
    """Radius of a ball, or half the edge of a cube, about ``center`` (3,) [m]; none is larger than ``at_most`` [m].

    ``size`` is rounded to ten digits.
    """

    size: float
    center: np.ndarray
    at_most: float


@dataclass(frozen=True, eq=False)
class _Surfaces:
    """Balls and planes of a region: ``side`` is 1 where it is inside the ball, −1 outside; x · normal ≤ offset."""

    centres: np.ndarray
    radii: np.ndarray
    side: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray
    lower: np.ndarray
    upper: np.ndarray

    @classmethod
    def of(cls, region: BallRegion, T_world_base: np.ndarray) -> "_Surfaces":
        R, shift = T_world_base[:3, :3], T_world_base[:3, 3]
        normals, offsets = region.sides_of_box()
        inside = region.inside_centres @ R.T + shift
        if len(inside):
            lower = (inside - region.inside_radii[:, None]).max(axis=0)
            upper = (inside + region.inside_radii[:, None]).min(axis=0)
        else:
            ends = np.meshgrid(*zip(region.lower, region.upper, strict=True))
            corners = np.array(ends).reshape(3, -1).T @ R.T + shift
            lower, upper = corners.min(axis=0), corners.max(axis=0)
        return cls(
            np.concatenate([inside, region.outside_centres @ R.T + shift]),
            np.concatenate([region.inside_radii, region.outside_radii]),
            np.concatenate([np.ones(len(inside)), -np.ones(len(region.outside_radii))]),
            normals @ R.T,
            offsets + normals @ R.T @ shift,
            lower,
            upper,
        )

    def balls(self, points: np.ndarray) -> np.ndarray:
        """Radius of the largest ball about each point that each surface allows, (N, K)."""
        away = np.linalg.norm(points[:, None] - self.centres, axis=2)
        return np.concatenate([self.side * (self.radii - away), self.offsets - points @ self.normals.T], axis=1)

    def cubes(self, points: np.ndarray) -> np.ndarray:
        """Half the edge of the largest cube, its faces along the axes, about each point that each surface allows."""
        away = np.sort(np.abs(points[:, None] - self.centres), axis=2)
        clear = self.side * (self.radii - np.linalg.norm(away, axis=2))
        sizes = np.where(self.side > 0, _within(away, self.radii), _beside(away, self.radii))
        allowed = np.where(clear > 0, sizes, clear / np.sqrt(3.0))
        planes = (self.offsets - points @ self.normals.T) / np.abs(self.normals).sum(axis=1)
        return np.concatenate([allowed, planes], axis=1)


def _within(away: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """The farthest corner of the cube lies on the sphere: Σ (|d| + a)² = R²."""
    total, square = away.sum(axis=2), (away**2).sum(axis=2)
    return (_root(total**2 - 3 * (square - radius**2)) - total) / 3


def _beside(away: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """The nearest point of the cube lies on the sphere: Σ max(|d| − a, 0)² = ρ²; a corner, an edge or a face.

    ``away`` (N, B, 3) ascending.
    """
    low, middle, high = np.moveaxis(away, 2, 0)
    total, square = away.sum(axis=2), (away**2).sum(axis=2)
    corner = (total - _root(total**2 - 3 * (square - radius**2))) / 3
    edge = (middle + high - _root(2 * radius**2 - (high - middle) ** 2)) / 2
    at_corner = (middle - low) ** 2 + (high - low) ** 2 <= radius**2
    return np.where(at_corner, corner, np.where(high - middle <= radius, edge, high - radius))


def _root(values: np.ndarray) -> np.ndarray:
    """Square roots; 0 of negative values, which stand for cases that do not apply."""
    return np.sqrt(np.maximum(values, 0.0))


def largest_ball(region: BallRegion, T_world_base: np.ndarray) -> Inscribed | None:
    """The largest ball in a region, placed in the world; None of an empty region."""
    surfaces = _Surfaces.of(region, T_world_base)
    return _largest(surfaces.balls, surfaces, np.sqrt(3.0))


def largest_cube(region: BallRegion, T_world_base: np.ndarray) -> Inscribed | None:
    """The largest cube with its faces along the world's axes in a region; None of an empty region."""
    surfaces = _Surfaces.of(region, T_world_base)
    return _largest(surfaces.cubes, surfaces, 1.0)


def _largest(sizes: Sizes, surfaces: _Surfaces, slope: float) -> Inscribed | None:
    """``slope``: how much sizes may grow from a cell's middle to its corner, in half edges of the cell."""
    lower, upper = surfaces.lower, surfaces.upper
    extent = float((upper - lower).max())
    if not (upper > lower).all():
        return None
    half = extent / FIRST_CELLS / 2
    counts = np.ceil((upper - lower) / (2 * half)).astype(int)
    cells = lower + half * (2 * np.argwhere(np.ones(counts, bool)) + 1)
    best, center = 0.0, np.zeros(3)
    level = 0
    while True:
        values = sizes(cells).min(axis=1)
        # Later a search starts only from what the earlier ones have missed.
        for start in _apart(cells, values, 2 * half) if level < SEARCHED_LEVELS or values.max() > best else ():
            found = _refined(sizes, start, extent)
            if (size := float(sizes(found[None]).min())) > best:
                best, center = size, found
        bounds = values + slope * half
        open_cells = cells[bounds > best * (1 + GAP)]
        if not len(open_cells) or 8 * len(open_cells) > MOST_CELLS or half < STEP * extent:
            at_most = max(best * (1 + GAP), float(bounds.max())) if len(open_cells) else best * (1 + GAP)
            return Inscribed(round_to_digits(best, DIGITS), center, at_most) if best > 0 else None
        half /= 2
        corners = np.array(np.meshgrid(*[[-half, half]] * 3)).reshape(3, -1).T
        cells = (open_cells[:, None] + corners).reshape(-1, 3)
        level += 1


def _apart(cells: np.ndarray, values: np.ndarray, distance: float) -> list[np.ndarray]:
    """The best cells with room in them, at least so far from each other."""
    kept: list[np.ndarray] = []
    for k in np.argsort(-values, kind="stable"):
        if values[k] <= 0 or len(kept) == STARTS:
            break
        if all(np.abs(cells[k] - other).max() > 2 * distance for other in kept):
            kept.append(cells[k])
    return kept


def _refined(sizes: Sizes, start: np.ndarray, extent: float) -> np.ndarray:
    """The point with the largest size near a start, both (3,): x of the largest s that all surfaces allow at x."""
    step = STEP * extent
    shifts = step * np.concatenate([np.eye(3), -np.eye(3)])

    def room(x: np.ndarray) -> np.ndarray:
        return sizes(extent * x[None, :3])[0] / extent - x[3]

    def slopes(x: np.ndarray) -> np.ndarray:
        around = sizes(extent * x[:3] + shifts)
        gradient = (around[:3] - around[3:]).T / (2 * step)
        return np.column_stack([gradient, -np.ones(len(gradient))])

    found = optimize.minimize(
        lambda x: -x[3],
        np.append(start / extent, float(sizes(start[None]).min()) / extent),
        jac=lambda _: np.array([0.0, 0.0, 0.0, -1.0]),
        constraints=[{"type": "ineq", "fun": room, "jac": slopes}],
        method="SLSQP",
        options={"ftol": LAST_CHANGE, "maxiter": 60},
    )
    return extent * found.x[:3]
