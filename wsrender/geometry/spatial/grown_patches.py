"""Patches of a boundary of which points and normals are known: primitives grown from seeds, the rest in free forms.

A seed is a few neighbouring crossings. The primitive fitted to them takes in what is connected to them and lies on it
within the tolerance, is fitted again, and so on (region growing, Besl & Jain 1988). The points that do not lie on it do
not count in the fits: they are robust by that. Nothing is drawn at random.
"""

from dataclasses import replace
from typing import Any

import numpy as np
from scipy.optimize import least_squares
from scipy.sparse import csr_array

from wsrender.geometry.components import components
from wsrender.geometry.spatial.cells import SpatialCellLoops
from wsrender.geometry.spatial.critical_sets import CrossedSurfaces
from wsrender.geometry.spatial.patches import FRAGMENT, Patch, in_order, neighbours, rows_of, smooth
from wsrender.geometry.spatial.surfaces import Fit, FoundPoints, Primitive, SmoothPoints, candidates, fit_of, nearest

_SEED = 40  # crossings, at least, that a primitive is first fitted to
_FITTED = 1500  # crossings of a region that count in a fit, spread evenly: more change nothing
_ROUNDS = 30
_ALIGNED = 0.02  # sine between the normals of crossings and of their primitive
_AXIAL = (1e-6, 1e-3)  # of normals without and with errors
_LOOSE, _MORE = 8.0, 0.1  # so many tolerances may take in this share more
_ALL = 2.0  # tolerances within which all of a region or part are on a primitive: few of many are so far off
_WHOLE = 24  # crossings, at least, of a part with sharp edges all around that may be a primitive
# What a least-squares fit may move: candidates farther from the points than this share of their extent are no start.
_START = 0.05
_STEP = 1e-7  # of a number, relative to the points' extent, for its slope
_NUMBERS = {
    "plane": (),
    "sphere": ("radius",),
    "cylinder": ("radius",),
    "cone": ("half_angle",),
    "torus": ("radius", "tube_radius"),
}


def grown_patches(
    crossed: CrossedSurfaces, loops: SpatialCellLoops, tolerance: float, width: float
) -> tuple[list[Patch], np.ndarray, CrossedSurfaces]:
    """The patches, those with most crossings first; the patch (C,) of each crossing; the crossings.

    A primitive grows within ``tolerance`` [m] and stands only where eight tolerances would hardly take in more: a
    surface that leaves a primitive slowly is none. Crossings beside it and so near take its normals, for theirs may be
    those of an edge. Free forms that touch smoothly are one patch.
    """
    a, b = (loops.crossing[pairs] for pairs in neighbours(loops))
    a, b = np.unique(np.sort(np.stack([a, b], axis=1), axis=1), axis=0).T
    growth = _Growth(crossed.point, crossed.normal.copy(), a, b, tolerance)
    fits = growth.primitives()
    normal, part = growth.normal, growth.part
    _join_those_on(fits, growth, a, b)
    left = part < 0
    joined = left[a] & left[b] & smooth(normal[a], normal[b])
    rest = components(len(part), a[joined], b[joined])
    part[left] = len(fits) + np.unique(rest[left], return_inverse=True)[1]
    _join_fragments(part, len(fits), a, b)
    patches = []
    for rows in rows_of(np.unique(part, return_inverse=True)[1]):
        k = part[rows[0]]
        if k < len(fits):
            patches.append(Patch(rows, (), fit_of(fits[k].primitive, crossed.point[rows], normal[rows]), exact=True))
        else:
            fit = best_refined_fit(crossed.point[rows], normal[rows], _ALL * tolerance)
            exact = fit is not None and len(rows) >= _WHOLE and _is(fit, _ALL * tolerance)
            smooth_points = SmoothPoints(crossed.point[rows], normal[rows], width)
            patches.append(Patch(rows, (), fit, exact, FoundPoints() if fit is None else smooth_points))
    return *in_order(patches, len(part)), replace(crossed, normal=normal)


def best_refined_fit(points: np.ndarray, normals: np.ndarray, tolerance: float) -> Fit | None:
    """The simplest primitive within ``tolerance`` [m] of points (N, 3), by least squares; else the nearest."""
    extent = np.ptp(points, axis=0).max()
    few = _spread(np.arange(len(points)))
    fits = []
    for primitive in candidates(points[few], normals[few], _AXIAL):
        found = primitive
        if np.abs(primitive.distance(points[few])[0]).max() <= _START * extent:
            found = refined(primitive, points[few])
        fit = fit_of(found, points, normals)
        if _is(fit, tolerance):
            return fit
        fits.append(fit)
    return nearest(fits)


def _is(fit: Fit, tolerance: float) -> bool:
    """Whether points and normals are the primitive's but for their errors."""
    return fit.residual <= tolerance and fit.misaligned <= _ALIGNED


def refined(primitive: Primitive, points: np.ndarray) -> Primitive:
    """The primitive with the least squares of distances to points (N, 3) near it (Levenberg & Marquardt)."""
    size = np.ptp(points, axis=0).max()
    lengths = np.array([1.0 if name == "half_angle" else size for name in _NUMBERS[primitive.kind]])
    numbers = np.array([getattr(primitive, name) for name in _NUMBERS[primitive.kind]])
    # The axis turns about two directions across it.
    across = np.empty((0, 3)) if primitive.axis is None else np.linalg.svd(primitive.axis[None])[2][1:]

    def changed(x: np.ndarray) -> Primitive:
        axis = primitive.axis
        if axis is not None:
            axis = axis + x[3:5] @ across
            axis = axis / np.linalg.norm(axis)
        values = numbers + lengths * x[3 + len(across) :]
        return replace(
            primitive,
            point=primitive.point + size * x[:3],
            axis=axis,
            **dict(zip(_NUMBERS[primitive.kind], values.tolist(), strict=True)),
        )

    def slopes(x: np.ndarray) -> np.ndarray:
        """A shift changes distances by −gradient · shift, a small turn ω by −ω · (offset × gradient)."""
        here = changed(x)
        distance, gradient = here.distance(points)
        columns = [-gradient]
        if here.axis is not None and primitive.axis is not None:
            turns = np.cross(here.axis, across) / np.linalg.norm(primitive.axis + x[3:5] @ across)
            columns.append(-np.cross(points - here.point, gradient) @ turns.T / size)
        for name, length in zip(_NUMBERS[primitive.kind], lengths, strict=True):
            beside = replace(here, **{name: getattr(here, name) + _STEP * length})
            columns.append((beside.distance(points)[0] - distance)[:, None] / (_STEP * size))
        return np.concatenate(columns, axis=1)

    count = 3 + len(across) + len(numbers)
    jac: Any = slopes  # annotated as text in SciPy
    solved = least_squares(
        lambda x: changed(x).distance(points)[0] / size,
        np.zeros(count),
        jac,
        method="lm",
        xtol=1e-14,
        ftol=1e-14,
        gtol=1e-14,
        max_nfev=20 * count,
    )
    return changed(solved.x)


class _Growth:
    """Crossings at ``point`` with ``normal`` (C, 3), joined a to b (E,), and the region ``part`` (C,) of each or -1."""

    def __init__(self, point: np.ndarray, normal: np.ndarray, a: np.ndarray, b: np.ndarray, tolerance: float):
        self.point, self.normal, self.tolerance = point, normal, tolerance
        self.part = np.full(len(point), -1)
        bend = np.linalg.norm(normal[a] - normal[b], axis=1)
        joined = smooth(normal[a], normal[b])
        self._bend = np.zeros(len(point))
        for ends in (a, b):
            np.maximum.at(self._bend, ends, np.where(joined, bend, np.inf))
        a, b = a[joined], b[joined]
        ones = np.ones(2 * len(a), np.int8)
        self._graph = csr_array((ones, (np.r_[a, b], np.r_[b, a])), shape=(len(point), len(point)))
        self._a, self._b = a, b

    def primitives(self) -> list[Fit]:
        """Regions that are primitives, from seeds where the surface bends least."""
        found: list[Fit] = []
        tried = np.zeros(len(self.point), bool)
        for seed in np.argsort(self._bend, kind="stable"):
            if tried[seed] or self.part[seed] >= 0 or not np.isfinite(self._bend[seed]):
                continue
            around = self._around(int(seed))
            tried[around] = True
            fit = best_refined_fit(self.point[around], self.normal[around], self.tolerance)
            if len(around) >= _SEED and fit is not None and self._on(fit.primitive, around).all():
                grown = self._grown(fit, int(seed))
                if grown is not None:
                    rows, fit = grown
                    self.part[rows] = len(found)
                    found.append(fit)
        return found

    def _around(self, seed: int) -> np.ndarray:
        """The seed and those crossings around it that are in no region, at least `_SEED` if there are as many."""
        rows = np.array([seed])
        while len(rows) < _SEED:
            more = np.unique(np.r_[rows, self._graph[rows].indices])
            more = more[self.part[more] < 0]
            if len(more) == len(rows):
                break
            rows = more
        return rows

    def _grown(self, fit: Fit, seed: int) -> tuple[np.ndarray, Fit] | None:
        """The region of a seed and its fit; None where it is too small or its primitive is left slowly."""
        rows = np.empty(0, int)
        for _ in range(_ROUNDS):
            more = self._connected(fit.primitive, seed)
            if len(more) <= len(rows):
                break
            rows = more
            again = best_refined_fit(self.point[rows], self.normal[rows], _ALL * self.tolerance)
            if again is None or again.residual > _ALL * self.tolerance:
                break
            fit = again
        if len(rows) < FRAGMENT:
            return None
        rows = self._connected(fit.primitive, seed)
        loose = self._connected(fit.primitive, seed, _LOOSE)
        return (rows, fit) if len(rows) >= FRAGMENT and len(loose) <= (1 + _MORE) * len(rows) else None

    def _on(self, primitive: Primitive, rows: np.ndarray, tolerances: float = 1.0) -> np.ndarray:
        distance, gradient = primitive.distance(self.point[rows])
        sine = np.linalg.norm(np.cross(gradient, self.normal[rows]), axis=1)
        return (np.abs(distance) <= tolerances * self.tolerance) & (sine <= _ALIGNED)

    def _connected(self, primitive: Primitive, seed: int, tolerances: float = 1.0) -> np.ndarray:
        """Rows in no region that are on a primitive and connected to the seed by others; none if the seed is not."""
        on = self._on(primitive, np.arange(len(self.point)), tolerances) & (self.part < 0)
        kept = on[self._a] & on[self._b]
        label = components(len(on), self._a[kept], self._b[kept])
        return np.flatnonzero(on & (label == label[seed]) & on[seed])


def _join_those_on(fits: list[Fit], growth: _Growth, a: np.ndarray, b: np.ndarray) -> None:
    """Give crossings beside a region that lie on its primitive to it, whatever their normals: those of edges."""
    part, normal = growth.part, growth.normal
    for _ in range(3):
        for one, two in ((a, b), (b, a)):
            beside = (part[one] >= 0) & (part[two] < 0)
            for k in np.unique(part[one[beside]]):
                rows = np.unique(two[beside & (part[one] == k)])
                distance, gradient = fits[k].primitive.distance(growth.point[rows])
                on = (np.abs(distance) <= _LOOSE * growth.tolerance) & (part[rows] < 0)
                outward = np.sign((gradient * normal[rows]).sum(axis=1, keepdims=True))
                part[rows[on]] = k
                normal[rows[on]] = (gradient * outward)[on]


def _join_fragments(part: np.ndarray, primitives: int, a: np.ndarray, b: np.ndarray) -> None:
    """Give small free forms to the free form beside them that they have most neighbours in, if there is one."""
    count = np.bincount(part)
    for k in np.flatnonzero((count > 0) & (count < FRAGMENT)):
        if k < primitives:
            continue
        beside = np.r_[part[b[part[a] == k]], part[a[part[b] == k]]]
        beside = beside[(beside != k) & (beside >= primitives)]
        if len(beside):
            part[part == k] = np.bincount(beside).argmax()


def _spread(rows: np.ndarray) -> np.ndarray:
    return rows[:: -(-len(rows) // _FITTED)] if len(rows) else rows
