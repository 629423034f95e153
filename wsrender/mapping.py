"""Mapping of a slave robot's workspace into that of its master: slave' = S R slave + offset ([WSR] III.D).

The largest one that stays inside is searched for.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from scipy.ndimage import distance_transform_edt, map_coordinates
from scipy.optimize import differential_evolution

from wsrender.errors import ResourceError
from wsrender.geometry.alpha_shape import AlphaShape
from wsrender.volume.lattice import LatticeBlock, block_around, check_voxels

MOST_VOXELS = 2**30  # one byte each
BISECTIONS = 30
TOUCH = 1e-7  # of a length; points nearer to a boundary lie on either side by rounding
SEARCH_POINTS = 600  # of the slave, in the search over several numbers; the result is checked on all
GROWTH, SMALLEST_STEP = 3e-4, 2e-4  # of the scales that makes a move of the offset worth it; steps over the extent
WAYS = np.array([way for way in np.ndindex(3, 3, 3) if way != (1, 1, 1)]) - 1.0  # of a move: along edges and diagonals
FIELD_CELLS = 48  # along the mean edge of the field of distances
SERVED, OUT_OF_REACH = 0, -1  # what a labelled set says of a target; from 1: the constraint that blocks it
INWARD, OUTWARD, LAST_STEPS = 0.5, 1.2, 71  # factors on the search's result among which the exact test looks


class MeasuredSet(Protocol):
    """A workspace that knows its volume and what lies in it: an alpha shape or a voxel set."""

    @property
    def volume_m3(self) -> float:
        """Volume."""
        ...

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Whether each point (N, 3) [m] lies in it, (N,) bool."""
        ...


@dataclass(frozen=True, eq=False)
class LinearMapping:
    """Scales along the master's axes (3,), rotation (3, 3), offset (3,) [m]."""

    scale: np.ndarray
    rotation: np.ndarray
    offset: np.ndarray

    def apply(self, points: np.ndarray) -> np.ndarray:
        """Points (N, 3) of the slave in the master's space [m]."""
        return (points @ self.rotation.T) * self.scale + self.offset

    @property
    def volume_factor(self) -> float:
        """Volume of what is mapped, relative to what it was."""
        return float(np.abs(np.prod(self.scale)))

    def scaled(self, factor: float | np.ndarray, about: np.ndarray | None = None) -> "LinearMapping":
        """The same mapping with all scales times a factor, or each times its own (3,).

        The offset stays, or with ``about`` (3,), a point of the slave, the place to which that is mapped.
        """
        scale = self.scale * factor
        moved = 0.0 if about is None else (self.scale - scale) * (self.rotation @ about)
        return replace(self, scale=scale, offset=self.offset + moved)

    def succeeds(self, master: MeasuredSet, points: np.ndarray) -> bool:
        """Whether every slave point (N, 3) lies in the master's space."""
        return bool(master.contains(self.apply(points)).all())


@dataclass(frozen=True, eq=False)
class VoxelSet:
    """Voxels of the world lattice that hold a point; ``occupied`` has the shape of ``block``."""

    block: LatticeBlock
    occupied: np.ndarray

    @classmethod
    def of(cls, points: np.ndarray, voxel_size_m: float) -> "VoxelSet":
        """The voxels of points (N, 3) [m]; ResourceError where their box has too many."""
        block = block_around(points.min(axis=0), points.max(axis=0), voxel_size_m)
        if block.size > MOST_VOXELS:
            raise ResourceError("voxel_size_m", f"{voxel_size_m} makes {block.size:.3g} voxels; 2^30 are allowed")
        check_voxels(block, 1)
        occupied = np.zeros(block.shape, bool)
        occupied[tuple(block.places(points).T)] = True
        return cls(block, occupied)

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Whether the voxel of each point (N, 3) [m] is in the set, (N,) bool."""
        cells = self.block.places(points)
        inside = ((cells >= 0) & (cells < self.block.shape)).all(axis=1)
        cells[~inside] = 0
        return inside & self.occupied[tuple(cells.T)]

    @property
    def volume_m3(self) -> float:
        """Volume of the voxels."""
        return int(np.count_nonzero(self.occupied)) * self.block.voxel_size_m**3


@dataclass(frozen=True, eq=False)
class ServedShape:
    """The part of an alpha shape of labelled positions that lies next to the served ones.

    Of each tetrahedron every point goes with the corner that weighs most, in barycentric coordinates; the ``reasons``
    (N,) int8 of the shape's points are SERVED, or the number of the constraint that blocks them.
    """

    shape: AlphaShape
    reasons: np.ndarray

    def reason(self, points: np.ndarray) -> np.ndarray:
        """Of each point (N, 3) [m] SERVED, the constraint that blocks it, or OUT_OF_REACH, (N,) int8."""
        delaunay, found = self.shape.located, np.full(len(points), OUT_OF_REACH, np.int8)
        inside = np.flatnonzero(self.shape.contains(points))
        own = delaunay.find_simplex(points[inside])
        to = delaunay.transform[own]
        weights = np.einsum("tij,tj->ti", to[:, :3], points[inside] - to[:, 3])
        weights = np.column_stack([weights, 1 - weights.sum(axis=1)])
        corner = np.take_along_axis(delaunay.simplices[own], weights.argmax(axis=1)[:, None], axis=1)[:, 0]
        found[inside] = self.reasons[corner]
        return found

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Whether each point (N, 3) [m] is served, (N,) bool."""
        return self.reason(points) == SERVED

    @property
    def volume_m3(self) -> float:
        """Volume of the served part: a corner has a quarter of its tetrahedron."""
        # No product of BLAS, whose sum depends on its threads.
        return float((self.shape.sixfold_m3 * self._served_corners.mean(axis=1)).sum() / 6)

    @property
    def holds_served(self) -> bool:
        """Whether some tetrahedron has served corners alone."""
        return bool(self._served_corners.all(axis=1).any())

    def served(self) -> AlphaShape:
        """The tetrahedra of served corners alone."""
        kept = self.shape.kept.copy()
        kept[kept] = self._served_corners.all(axis=1)
        return replace(self.shape, kept=kept)

    @property
    def _served_corners(self) -> np.ndarray:
        """Whether the corners of every kept tetrahedron are served, (K, 4)."""
        return self.reasons[self.shape.delaunay.simplices[self.shape.kept]] == SERVED


@dataclass(frozen=True, eq=False)
class ServedVoxels:
    """Voxels by what is said of most positions in them; ``reasons`` int8 has the shape of ``block``."""

    block: LatticeBlock
    reasons: np.ndarray

    @classmethod
    def of(cls, points: np.ndarray, reasons: np.ndarray, voxel_size_m: float) -> "ServedVoxels":
        """Voxels of points (N, 3) [m], each SERVED or blocked by a constraint (N,); of a tie, served."""
        whole = VoxelSet.of(points, voxel_size_m)
        at = np.ravel_multi_index(tuple(whole.block.places(points).T), whole.block.shape)
        pairs, counts = np.unique(np.stack([at, reasons]), axis=1, return_counts=True)
        order = np.lexsort((-pairs[1], counts))  # what is written last stays: most positions, then what is served
        found = np.full(whole.block.shape, OUT_OF_REACH, np.int8)
        found.ravel()[pairs[0, order]] = pairs[1, order]
        return cls(whole.block, found)

    def reason(self, points: np.ndarray) -> np.ndarray:
        """Of each point (N, 3) [m] SERVED, the constraint that blocks it, or OUT_OF_REACH, (N,) int8."""
        cells = self.block.places(points)
        inside = ((cells >= 0) & (cells < self.block.shape)).all(axis=1)
        cells[~inside] = 0
        return np.where(inside, self.reasons[tuple(cells.T)], np.int8(OUT_OF_REACH))

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Whether each point (N, 3) [m] is served, (N,) bool."""
        return self.reason(points) == SERVED

    @property
    def holds_served(self) -> bool:
        """Whether some voxel is served."""
        return bool((self.reasons == SERVED).any())

    @property
    def volume_m3(self) -> float:
        """Volume of the served voxels."""
        return int(np.count_nonzero(self.reasons == SERVED)) * self.block.voxel_size_m**3


@dataclass(frozen=True, eq=False)
class ScaleCurve:
    """Share of the slave's points inside the master, by factor on the scales; both (M,)."""

    factors: np.ndarray
    inside: np.ndarray


def scale_curve(
    master: MeasuredSet,
    points: np.ndarray,
    mapping: LinearMapping,
    factors: np.ndarray,
    about: np.ndarray | None = None,
) -> ScaleCurve:
    """Share of points (N, 3) inside the master at each factor (M,) on the mapping's scales."""
    inside = [master.contains(mapping.scaled(factor, about).apply(points)).mean() for factor in factors]
    return ScaleCurve(factors, np.array(inside))


def largest_factor(
    master: MeasuredSet, points: np.ndarray, mapping: LinearMapping, curve: ScaleCurve, about: np.ndarray | None = None
) -> float | None:
    """The largest factor at which every point is inside, to a millionth, near the last success of the curve.

    None where the curve has none. A narrower gap between two of its factors is not seen.
    """
    succeeded = np.flatnonzero(curve.inside == 1.0)
    if len(succeeded) == 0:
        return None
    last = succeeded[-1]
    if last == len(curve.factors) - 1:
        return float(curve.factors[last])
    low, high = float(curve.factors[last]), float(curve.factors[last + 1])
    return _bisected(lambda factor: mapping.scaled(factor, about).succeeds(master, points), low, high)


def best_mapping(
    master: MeasuredSet,
    box: tuple[np.ndarray, np.ndarray],
    points: np.ndarray,
    start: LinearMapping,
    *,
    scale_bounds: tuple[float, float],
    uniform: bool,
    offset_bounds: Sequence[tuple[float, float]] | None,
    seed: int = 0,
) -> LinearMapping | None:
    """The mapping of largest volume that succeeds, of scales and offsets within bounds; None where none was found.

    Scales are ``start``'s times one number (``uniform``) or three, within ``scale_bounds``; the offset is ``start``'s,
    or lies within ``offset_bounds``. Differential evolution (Storn and Price 1997) over the distance of a subset of
    the points to the boundary of the master, which lies in ``box``; then all points are put to the exact test, the
    scales grown or shrunk until it is just met, and an offset moved as long as that lets them grow. A local optimum of
    the exact test, to about 0.5 % of the scale with an offset.
    """
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    about = None if offset_bounds is None else middle
    rough = _rough_optimum(master, box, points, start, scale_bounds, uniform, offset_bounds, middle, seed)
    shares = rough.scale / start.scale
    low, high = max(INWARD, scale_bounds[0] / shares.min()), min(OUTWARD, scale_bounds[1] / shares.max())
    curve = scale_curve(master, points, rough, np.linspace(low, max(low, high), LAST_STEPS), about)
    factor = largest_factor(master, points, rough, curve, about)
    if factor is None:
        return None
    found = rough.scaled(factor, about)
    if offset_bounds is not None:
        found = _moved(master, points, found, start.scale * scale_bounds[1], offset_bounds, middle, np.ptp(box))
    if not uniform:
        found = _grown(master, points, found, start.scale * scale_bounds[1], about)
    return found if _violation(found.offset, offset_bounds) < TOUCH * np.ptp(box) else None


def _rough_optimum(master, box, points, start, scale_bounds, uniform, offset_bounds, middle, seed) -> LinearMapping:
    """The optimum for a subset of the points and a field of distances; searched are scales and place of the middle."""
    field = _DistanceField(master, box)
    extremes = np.unique(np.concatenate([points.argmin(axis=0), points.argmax(axis=0)]))
    few = points[np.unique(np.linspace(0, len(points) - 1, SEARCH_POINTS).astype(int))]
    few = np.concatenate([few, points[extremes]])
    scales = 1 if uniform else 3
    largest = float(np.prod(start.scale)) * scale_bounds[1] ** 3

    def mapping(x: np.ndarray) -> LinearMapping:
        scaled = start.scaled(x[0] if uniform else x[:3])
        if offset_bounds is None:
            return scaled
        return replace(scaled, offset=x[scales:] - scaled.scale * (start.rotation @ middle))

    def cost(x: np.ndarray) -> float:
        candidate = mapping(x)
        outside = max(-field.least(candidate.apply(few)), 0.0) + _violation(candidate.offset, offset_bounds)
        return outside if outside > 0 else -candidate.volume_factor / largest

    places = [] if offset_bounds is None else list(zip(*box, strict=True))
    bounds = [scale_bounds] * scales + places
    return mapping(differential_evolution(cost, bounds, rng=seed, tol=1e-6, maxiter=150, popsize=12, polish=False).x)


def _moved(
    master: MeasuredSet,
    points: np.ndarray,
    mapping: LinearMapping,
    most: np.ndarray,
    offset_bounds: Sequence[tuple[float, float]],
    about: np.ndarray,
    extent: float,
) -> LinearMapping:
    """The mapping with its offset moved, by ever smaller steps, wherever its scales can grow then."""
    step, grows = extent / FIELD_CELLS, 1 + GROWTH
    while step > extent * SMALLEST_STEP:
        places = (replace(mapping, offset=mapping.offset + step * way) for way in WAYS)
        larger = (place.scaled(grows, about) for place in places)
        allowed = (m for m in larger if (m.scale <= most).all() and _violation(m.offset, offset_bounds) == 0)
        better = next((m for m in allowed if m.succeeds(master, points)), None)
        if better is None:
            step /= 2
        else:
            mapping = better.scaled(_largest_growth(master, points, better, most, about), about)
    return mapping


def _largest_growth(
    master: MeasuredSet, points: np.ndarray, mapping: LinearMapping, most: np.ndarray, about: np.ndarray
) -> float:
    """The largest factor on the scales of a mapping that succeeds, near 1."""
    high = min(OUTWARD, float((most / mapping.scale).min()))
    return _bisected(lambda factor: mapping.scaled(factor, about).succeeds(master, points), 1.0, high, 12)


def _violation(offset: np.ndarray, bounds: Sequence[tuple[float, float]] | None) -> float:
    """How far an offset lies outside its bounds [m]."""
    if bounds is None:
        return 0.0
    low, high = np.array(bounds).T
    return float(np.maximum(low - offset, 0).sum() + np.maximum(offset - high, 0).sum())


def _grown(
    master: MeasuredSet, points: np.ndarray, mapping: LinearMapping, most: np.ndarray, about: np.ndarray | None
) -> LinearMapping:
    """The mapping with each scale by itself, one after the other, grown as far as all points stay inside."""
    for axis in range(3):
        high = min(OUTWARD, most[axis] / mapping.scale[axis])
        if high > 1:
            one = np.arange(3) == axis

            def stretched(factor: float, one: np.ndarray = one, mapping: LinearMapping = mapping) -> LinearMapping:
                return mapping.scaled(np.where(one, factor, 1.0), about)

            mapping = stretched(_bisected(lambda factor: stretched(factor).succeeds(master, points), 1.0, high))
    return mapping


def _bisected(succeeds: Callable[[float], bool], low: float, high: float, bisections: int = BISECTIONS) -> float:
    """Where success ends between a factor that succeeds and a larger one, less what rounding may take."""
    for _ in range(bisections):
        middle = (low + high) / 2
        low, high = (middle, high) if succeeds(middle) else (low, middle)
    return low * (1 - TOUCH) if succeeds(low * (1 - TOUCH)) else low


class _DistanceField:
    """Signed distance to the boundary of a space, positive inside, interpolated between cells [m]."""

    def __init__(self, space: MeasuredSet, box: tuple[np.ndarray, np.ndarray]):
        lower, upper = box
        self.edge = float(np.cbrt(np.prod(np.maximum(upper - lower, 1e-9)))) / FIELD_CELLS
        margin = 4
        shape = np.ceil((upper - lower) / self.edge).astype(int) + 2 * margin
        self.first = lower - (margin - 0.5) * self.edge
        centers = np.argwhere(np.ones(shape, bool)) * self.edge + self.first
        inside = space.contains(centers).reshape(shape)
        within, without = (np.asarray(distance_transform_edt(cells)) for cells in (inside, ~inside))
        self.distance = (within - without) * self.edge

    def least(self, points: np.ndarray) -> float:
        """The smallest distance of points (N, 3); beyond the field, that of its border and the way there."""
        at = (points - self.first) / self.edge
        last = np.array(self.distance.shape) - 1
        way = np.linalg.norm(at - np.clip(at, 0, last), axis=1) * self.edge
        return float((map_coordinates(self.distance, np.clip(at, 0, last).T, order=1) - way).min())
