"""Parts and gaps of a set that pass between the planes of a lattice, and planes through them.

Where a joint turns a little beyond a singular posture an arm reaches a lip that may be thinner than a cell, and no
corner of a lattice may lie in it. Points of the critical sets are tried: those with positions that are reached on one
side only are on the boundary. From there the part, or the gap, goes on along the axis of the lattice that is nearest
to the normal.
"""

from dataclasses import dataclass

import numpy as np

from wsrender.geometry.spatial.cells import CellLattice, Membership, Report
from wsrender.geometry.spatial.critical_sets import CriticalSet
from wsrender.geometry.spatial.inverse import ThreeJointInverse

_BESIDE = 1e-4  # of a cell: where, to both sides of a surface, it is told whether it is on the boundary
_STEPS = 16  # of a cell, in which thickness is told: thinner parts are left out
_MOST = 160  # displacements of a joint that are tried
_INNER = 0.1  # of the thickness: planes are not nearer to either surface
_TRIED = 64  # places of a plane, of a cell


@dataclass(frozen=True, eq=False)
class ThinParts:
    """Pieces of parts and gaps, each without a plane through it from ``low`` to ``high`` (K,) [m] along ``axis`` (K,).

    ``volume`` (K,) [m³]: half of each, for both of its surfaces are seen.
    """

    axis: np.ndarray
    low: np.ndarray
    high: np.ndarray
    volume: np.ndarray

    def planes(self, width: float, least: float, most: int) -> list[np.ndarray]:
        """Where planes across x, y and z go through the pieces, at most so many: first through most volume.

        Fewer where the pieces that none goes through have less than ``least`` [m³]; ``width`` [m] of a cell.
        """
        left = np.ones(len(self.axis), bool)
        planes: list[list[float]] = [[], [], []]
        for _ in range(most):
            if self.volume[left].sum() <= least:
                break
            _, axis, at = max((*self._fullest(left & (self.axis == k), k, width / _TRIED),) for k in range(3))
            planes[axis].append(at)
            left &= ~((self.axis == axis) & (self.low < at) & (at < self.high))
        return [np.array(each) for each in planes]

    def _fullest(self, rows: np.ndarray, axis: int, step: float) -> tuple[float, int, float]:
        """The largest volume of pieces that a plane across an axis goes through, the axis, and where that is [m]."""
        if not rows.any():
            return 0.0, axis, 0.0
        start = self.low[rows].min()
        first = np.floor((self.low[rows] - start) / step).astype(int) + 1
        beyond = np.maximum(np.ceil((self.high[rows] - start) / step).astype(int), first)
        places = beyond.max() + 1
        begun, ended = (np.bincount(each, self.volume[rows], places) for each in (first, beyond))
        through = np.cumsum(begun - ended)
        full = np.flatnonzero(through >= through.max() * (1 - 1e-9))
        together = full[: np.append(np.diff(full) > 1, True).argmax() + 1]
        return float(through.max()), axis, float(start + together[len(together) // 2] * step)


def thin_parts(sets: list[CriticalSet], inverse: ThreeJointInverse, lattice: CellLattice, report: Report) -> ThinParts:
    """What passes between the planes of a lattice with at least one surface that has a joint at its stop."""

    def reaches(points: np.ndarray) -> np.ndarray:
        report(len(points))
        return inverse.reaches(points)

    nothing = ThinParts(np.empty(0, int), np.empty(0), np.empty(0), np.empty(0))
    found = [nothing]
    for each in (each for each in sets if each.stops):
        found += _beside(each, reaches, lattice)
    columns = zip(*((part.axis, part.low, part.high, part.volume) for part in found), strict=True)
    return ThinParts(*(np.concatenate(column) for column in columns))


def _beside(each: CriticalSet, reaches: Membership, lattice: CellLattice) -> list[ThinParts]:
    """The parts on one side of a critical set and the gaps on the other."""
    p, normal, area = _sampled(each, lattice.width)
    near = _BESIDE * lattice.width * normal
    ahead = reaches(p + near)
    rows = np.flatnonzero(ahead != reaches(p - near))
    p, normal, area = p[rows], normal[rows], area[rows]
    axis = np.abs(normal).argmax(axis=1)
    slope = normal[np.arange(len(p)), axis]
    into = np.where(ahead[rows], 1.0, -1.0) * np.sign(slope)
    return [
        _pieces(p, axis, way, area * np.abs(slope), _thickness(p, axis, way, held, reaches, lattice.width), lattice)
        for way, held in ((into, True), (-into, False))
    ]


def _pieces(
    p: np.ndarray, axis: np.ndarray, way: np.ndarray, across: np.ndarray, thickness: np.ndarray, lattice: CellLattice
) -> ThinParts:
    """Those of known ``thickness`` (N,) [m] from points p (N, 3) that no plane of the lattice goes through."""
    begin = p[np.arange(len(p)), axis]
    end = begin + way * thickness
    low, high = np.minimum(begin, end), np.maximum(begin, end)
    missed = np.isfinite(thickness)
    for k, planes in enumerate(lattice.axes):
        missed &= (axis != k) | (np.searchsorted(planes, low) == np.searchsorted(planes, high))
    inner = _INNER * (high - low)
    columns = axis, low + inner, high - inner, across * thickness / 2
    return ThinParts(*(column[missed] for column in columns))


def _thickness(
    p: np.ndarray, axis: np.ndarray, way: np.ndarray, held: bool, reaches: Membership, width: float
) -> np.ndarray:
    """How far (N,) [m] from p (N, 3), along an axis forward or back, all is reached, or nothing if not ``held``.

    At most what it is; NaN for what is not thinner than a cell, or too thin.
    """
    thickness = np.full(len(p), np.nan)
    rows, unit = np.arange(len(p)), np.eye(3)[axis] * way[:, None]
    for step in range(1, _STEPS + 1):
        on = reaches(p[rows] + step / _STEPS * width * unit[rows]) == held
        thickness[rows[~on]] = (step - 1) / _STEPS * width
        rows = rows[on]
    return np.where(thickness > 0, thickness, np.nan)


def _sampled(each: CriticalSet, width: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points (N, 3) [m] of a critical set with a stop, about a cell apart, normals there and areas (N,) around."""
    arm, free = each.arm, each.free
    ends = np.stack([arm.low, (arm.low + arm.high) / 2, arm.high])
    spread = np.stack(np.meshgrid(*ends.T, indexing="ij"), axis=-1).reshape(-1, arm.n)
    speed = np.linalg.norm(arm.motion(spread)[1], axis=1).max(axis=0)[free]
    extent = (arm.high - arm.low)[free]
    counts = np.clip(np.ceil(extent * speed / width), 1, _MOST).astype(int)
    steps = extent / counts
    grid = [start + (np.arange(n) + 0.5) * by for start, n, by in zip(arm.low[free], counts, steps, strict=True)]
    d = np.zeros((counts.prod(), arm.n))
    d[:, free] = np.stack(np.meshgrid(*grid, indexing="ij"), axis=-1).reshape(-1, len(free))
    p, J, _ = arm.motion(each.held(d))
    across = np.cross(J[:, :, free[0]], J[:, :, free[1]])
    return p, each.normal(J), np.linalg.norm(across, axis=1) * steps.prod()
