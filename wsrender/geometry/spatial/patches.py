"""Patches of a boundary: parts of one surface that are connected, each with what generates it and what it is."""

from dataclasses import dataclass, field, replace

import numpy as np

from wsrender.geometry.components import components
from wsrender.geometry.spatial.cells import SpatialCellLoops
from wsrender.geometry.spatial.critical_sets import NONE, CriticalSet, CrossedSurfaces
from wsrender.geometry.spatial.surfaces import Fit, FoundPoints, Surface, best_fit, surface_of

_SMOOTH = np.cos(np.radians(30.0))  # between neighbouring crossings of one surface
FRAGMENT = 60  # crossings: with fewer a patch is part of a larger one of the same surface, if there is any
_EXACT = 1e-9  # distance of points from their primitive that is rounding, relative to the arm's size


@dataclass(frozen=True, eq=False)
class Patch:
    """A connected part of one surface, of the crossings ``rows`` (K,).

    ``sets``: the critical sets that generate it; none where it was found by its points alone. ``fit``: the nearest
    primitive, which the patch is if ``exact``; None of too few points. ``found``: the surface of a patch that
    is neither a primitive nor generated.
    """

    rows: np.ndarray
    sets: tuple[CriticalSet, ...]
    fit: Fit | None
    exact: bool
    found: Surface = field(default_factory=FoundPoints)

    @property
    def kind(self) -> str:
        """plane, sphere, cylinder, cone, torus or free_form."""
        return self.fit.primitive.kind if self.fit is not None and self.exact else "free_form"

    @property
    def method(self) -> str:
        """How the surface was found: ``critical_set`` or ``fitted``."""
        return "critical_set" if self.sets else "fitted"

    @property
    def surface(self) -> Surface:
        """What lines meet."""
        primitive = self.fit.primitive if self.fit is not None and self.exact else None
        return surface_of(primitive, self.sets[0] if self.sets else None, self.found)


def boundary_patches(
    sets: list[CriticalSet], crossed: CrossedSurfaces, loops: SpatialCellLoops, size: float
) -> tuple[list[Patch], np.ndarray]:
    """The patches, those with most crossings first, and the patch (C,) of each crossing."""
    a, b = (loops.crossing[pairs] for pairs in neighbours(loops))
    label = crossed.critical_set
    joined = (label[a] == label[b]) & smooth(crossed.normal[a], crossed.normal[b])
    part = components(len(label), a[joined], b[joined])
    fits = [_fit(rows, sets, crossed, size) for rows in rows_of(part)]
    across = np.unique(np.sort(np.stack([part[a], part[b]], axis=1), axis=1), axis=0)
    same = np.array([_same(fits[i], fits[j], size) for i, j in across], bool).reshape(-1)
    whole = components(len(fits), *across[same].T)
    patches = [_merged([fits[i] for i in np.flatnonzero(whole == k)]) for k in range(whole.max(initial=-1) + 1)]
    patches = _with_fragments(patches, crossed.point)
    return in_order(patches, len(label))


def in_order(patches: list[Patch], crossings: int) -> tuple[list[Patch], np.ndarray]:
    """The patches, those with most crossings first, and the patch (C,) of each crossing."""
    patches = sorted(patches, key=lambda patch: (-len(patch.rows), patch.rows[0]))
    patch_of = np.empty(crossings, int)
    for k, patch in enumerate(patches):
        patch_of[patch.rows] = k
    return patches, patch_of


def neighbours(loops: SpatialCellLoops) -> tuple[np.ndarray, np.ndarray]:
    """Every two pairs (loop, crossing) of one loop."""
    starts = np.flatnonzero(np.diff(loops.loop, prepend=-1))
    counts = np.diff(starts, append=len(loops.loop))
    pairs = []
    for count in np.unique(counts):
        members = starts[counts == count][:, None] + np.arange(count)
        i, j = np.triu_indices(count, 1)
        pairs.append(np.stack([members[:, i].ravel(), members[:, j].ravel()]))
    a, b = np.concatenate(pairs, axis=1) if pairs else np.empty((2, 0), int)
    return a, b


def smooth(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Whether normals (N, 3) can be of neighbouring crossings of one surface, (N,) bool."""
    return (a * b).sum(axis=1) >= _SMOOTH


def rows_of(part: np.ndarray) -> list[np.ndarray]:
    """The rows of each part, by its number (N,)."""
    order = np.argsort(part, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(part[order])) + 1) if len(part) else []


def _fit(rows: np.ndarray, sets: list[CriticalSet], crossed: CrossedSurfaces, size: float) -> Patch:
    fit = best_fit(crossed.point[rows], crossed.normal[rows], _EXACT * size)
    exact = fit is not None and fit.exact(_EXACT * size)
    index = crossed.critical_set[rows[0]]
    generators = () if index == NONE else (sets[index],)
    return Patch(rows, generators, fit, exact)


def _same(a: Patch, b: Patch, size: float) -> bool:
    """Whether two neighbours lie on the same primitive."""
    if not (a.exact and b.exact) or a.fit is None or b.fit is None:
        return False
    return a.fit.primitive.same_as(b.fit.primitive, 1e3 * _EXACT * size)


def _with_fragments(patches: list[Patch], points: np.ndarray) -> list[Patch]:
    """Patches with the fragments of their surface: what cells cannot resolve belongs to the nearest patch.

    Where parts of the boundary are nearer to each other than a cell is wide, their patches fall into pieces.
    """
    whole = [patch for patch in patches if len(patch.rows) >= FRAGMENT]
    pieces: dict[int, list[Patch]] = {k: [] for k in range(len(whole))}
    alone = []
    for fragment in (patch for patch in patches if len(patch.rows) < FRAGMENT):
        same = [k for k, patch in enumerate(whole) if _continues(fragment, patch)]
        if not same:
            alone.append(fragment)
            continue
        middle = points[fragment.rows].mean(axis=0)
        nearest = min(same, key=lambda k: float(((points[whole[k].rows] - middle) ** 2).sum(axis=1).min()))
        pieces[nearest].append(fragment)
    return [_merged([patch, *pieces[k]]) for k, patch in enumerate(whole)] + alone


def _continues(fragment: Patch, patch: Patch) -> bool:
    """Whether what generates a fragment generates a patch, and they are not of two primitives."""
    kinds = {fragment.kind, patch.kind} - {"free_form"}
    return set(fragment.sets) <= set(patch.sets) and len(kinds) < 2


def _merged(parts: list[Patch]) -> Patch:
    largest = max(parts, key=lambda part: len(part.rows))
    generators = dict.fromkeys(each for part in [largest, *parts] for each in part.sets)
    residual = max((part.fit.residual for part in parts if part.fit is not None), default=0.0)
    fit = None if largest.fit is None else replace(largest.fit, residual=residual)
    return Patch(np.sort(np.concatenate([part.rows for part in parts])), tuple(generators), fit, largest.exact)
