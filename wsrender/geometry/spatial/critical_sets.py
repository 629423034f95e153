"""The critical sets of an arm: some joints stopped, and the others unable to move the end point across a direction.

Where a point lies on the boundary of what an arm reaches, the joints that are not stopped there cannot push it
outwards: their Jacobian has rank 2 (Litvin 1980; Haug et al. 1996). With two joints free every configuration is such a
one, with more those in which the Jacobian is singular. `crossed_surfaces`: which of them the boundary belongs to.
"""

from dataclasses import dataclass

import numpy as np

from wsrender.geometry.spatial.cells import LatticeCrossings
from wsrender.geometry.spatial.inverse import ThreeJointInverse
from wsrender.geometry.spatial.spatial_arm import SpatialArm

_ITERATIONS = 12
_CONVERGED = 1e-9  # distance that is left before the last step, relative to the arm's size
_AT_STOP = 1e-4  # of a radian or of the arm's size: how near a limit a solution is, 1e-8 of a cell from the boundary
_BESIDE = 1e-6  # of a cell: how far the bisected and the computed crossing may be apart
_WITHIN = 1e-6  # of a radian or of the arm's size: limits of joints where edges of the boundary are near

NONE = -1


@dataclass(frozen=True)
class Stop:
    """A joint at one of its limits: its position in the arm, name, "lower" or "upper" and displacement [rad or m]."""

    joint: int
    name: str
    limit: str
    at: float

    @property
    def text(self) -> str:
        """``joint2 lower``."""
        return f"{self.name} {self.limit}"


@dataclass(frozen=True, eq=False)
class Meeting:
    """Where lines meet a surface: distance along each ``s`` (N,) [m], ``normal`` (N, 3), displacements ``d`` (N, n).

    NaN where none was found near the start.
    """

    s: np.ndarray
    normal: np.ndarray
    d: np.ndarray


@dataclass(frozen=True, eq=False)
class CriticalSet:
    """Configurations of an arm with ``stops`` at their limits, in which the other joints reach a surface only."""

    arm: SpatialArm
    stops: tuple[Stop, ...]

    @property
    def free(self) -> np.ndarray:
        """The joints that are not stopped."""
        stopped = {stop.joint for stop in self.stops}
        return np.array([i for i in range(self.arm.n) if i not in stopped])

    @property
    def singular(self) -> bool:
        """Whether the free joints' Jacobian must be singular: more than two are free."""
        return len(self.free) > 2

    def held(self, d: np.ndarray) -> np.ndarray:
        """Displacements (N, n) with the stopped joints at their limits."""
        d = d.copy()
        for stop in self.stops:
            d[:, stop.joint] = stop.at
        return d

    def meet(self, origin: np.ndarray, direction: np.ndarray, start: np.ndarray) -> Meeting:
        """Where lines from ``origin`` (N, 3) [m] along ``direction`` (N, 3) meet the images of the set (Newton).

        The search begins at displacements ``start`` (N, n); normals point along the directions.
        """
        d, s, n = self.held(start), np.zeros(len(start)), np.zeros((len(start), 3))
        left = np.full(len(start), np.inf)
        active = np.arange(len(start))
        for iteration in range(_ITERATIONS):
            p, J, axes = self.arm.motion(d[active])
            along = direction[active]
            if iteration == 0:
                s = ((p - origin) * direction).sum(axis=1) / np.maximum((direction**2).sum(axis=1), 1e-300)
                n = self.normal(J)
            residual = p - origin[active] - s[active, None] * along
            step, left[active] = self._step(residual, J, axes, n[active], along)
            m = len(self.free)
            d[np.ix_(active, self.free)] += step[:, :m]
            s[active] += step[:, m]
            n[active] += step[:, m + 1 :]
            active = active[left[active] > _CONVERGED]  # the step from there has doubled the digits
            if not len(active):
                break
        good = left <= _CONVERGED
        normal = n if self.singular else self.normal(self.arm.motion(d)[1])
        normal = normal * np.sign((normal * direction).sum(axis=1))[:, None]
        return Meeting(
            np.where(good, s, np.nan), np.where(good[:, None], normal, np.nan), np.where(good[:, None], d, np.nan)
        )

    def normal(self, J: np.ndarray) -> np.ndarray:
        """The unit direction (N, 3) that the free joints of Jacobians (N, 3, n) move the end point least along."""
        J = J[:, :, self.free]
        if self.singular:
            return np.linalg.svd(J)[0][:, :, 2]
        normal = np.cross(J[:, :, 0], J[:, :, 1])
        return normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)

    def _step(
        self, residual: np.ndarray, J: np.ndarray, axes: np.ndarray, n: np.ndarray, direction: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Newton's step in free displacements, distance and normal, and what is left before it, relative to the size.

        Unknown are the displacements and the distance s of p − origin = s direction and, of singular
        configurations, the normal: Jᵀn = 0, |n| = 1. Steps of (N, m + 4), the last three 0 if not singular.
        """
        F, m, size = self.free, len(self.free), max(self.arm.size, 1e-300)
        J_free = J[:, :, F]
        A = np.zeros((len(J), m + 4, m + 4))
        A[:, :3, :m], A[:, :3, m] = J_free, -direction
        if not self.singular:
            left = np.abs(residual).max(axis=1) / size
            return np.pad(self._bounded(_solved(A[:, :3, : m + 1], -residual)), ((0, 0), (0, 3))), left
        # d(J_j)/d(d_i) is the axis of the joint nearer to the base across the column of the other.
        first, last = np.minimum.outer(F, F), np.maximum.outer(F, F)
        hessian = np.cross(axes[:, first], J.transpose(0, 2, 1)[:, last])
        A[:, 3 : 3 + m, :m] = np.einsum("nijk,nk->nij", hessian, n)
        A[:, 3 : 3 + m, m + 1 :] = J_free.transpose(0, 2, 1)
        A[:, 3 + m, m + 1 :] = n
        flat, unit = np.einsum("njk,nj->nk", J_free, n), (n * n).sum(axis=1, keepdims=True) - 1
        values = np.concatenate([residual, flat, unit / 2], axis=1)
        columns = np.where(self.arm.revolute[F], size, 1.0)
        left = np.concatenate([residual / size, flat / columns, unit], axis=1)
        return self._bounded(_solved(A, -values)), np.abs(left).max(axis=1)

    def _bounded(self, step: np.ndarray) -> np.ndarray:
        longest = max(1.0, self.arm.size)
        return np.clip(np.nan_to_num(step), -longest, longest)


@dataclass(frozen=True, eq=False)
class CommonCurve:
    """Configurations that two critical sets of an arm of three joints have in common: a curve, on both their images."""

    first: CriticalSet
    second: CriticalSet

    @property
    def stops(self) -> tuple[Stop, ...]:
        """The stops of both."""
        return (*self.first.stops, *self.second.stops)

    @property
    def exists(self) -> bool:
        """Whether the sets stop different joints, at least one."""
        joints = [stop.joint for stop in self.stops]
        return 0 < len(joints) == len(set(joints)) and self.first is not self.second

    def nearest(self, x: np.ndarray, start: np.ndarray) -> np.ndarray:
        """Displacements (N, n) of the curve whose end points are nearest to x (N, 3), from displacements nearby."""
        both = CriticalSet(self.first.arm, self.stops)
        d, F = both.held(start), both.free
        for _ in range(_ITERATIONS):
            p, J, axes = both.arm.motion(d)
            value, gradient = _determinant(J, axes, F)
            if len(F) == 1:  # the curve is that of one joint
                along, back = np.ones((len(d), 1)), np.zeros((len(d), 1))
            else:
                squared = np.maximum((gradient**2).sum(axis=1, keepdims=True), 1e-300)
                along = np.column_stack([-gradient[:, 1], gradient[:, 0]]) / np.sqrt(squared)
                back = -value[:, None] * gradient / squared
            speed = np.einsum("nij,nj->ni", J[:, :, F], along)
            left = x - p - np.einsum("nij,nj->ni", J[:, :, F], back)
            further = (left * speed).sum(axis=1) / np.maximum((speed**2).sum(axis=1), 1e-300)
            step = np.clip(np.nan_to_num(back + further[:, None] * along), -0.3, 0.3)
            d[:, F] += step
        return d


def _determinant(J: np.ndarray, axes: np.ndarray, free: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Determinant of J (N,) and its derivatives (N, m) by the free displacements."""
    gradient = np.zeros((len(J), len(free)))
    for column, k in enumerate(free):
        for j in range(3):
            changed = J.copy()
            changed[:, :, j] = np.cross(axes[:, min(j, k)], J[:, :, max(j, k)])
            gradient[:, column] += np.linalg.det(changed)
    return np.linalg.det(J), gradient


def critical_sets(arm: SpatialArm) -> list[CriticalSet]:
    """Of an arm of three joints: each limit with the other two free, and singular configurations of all three."""
    stops = [Stop(i, arm.names[i], limit, at) for i in range(arm.n) for limit, at in arm.limits_of(i)]
    return [*(CriticalSet(arm, (stop,)) for stop in stops), CriticalSet(arm, ())]


def _solved(A: np.ndarray, b: np.ndarray) -> np.ndarray:
    """A⁻¹ b of each row; least squares where a matrix is singular."""
    try:
        return np.linalg.solve(A, b[:, :, None])[:, :, 0]
    except np.linalg.LinAlgError:
        return (np.linalg.pinv(A, rcond=1e-12) @ b[:, :, None])[:, :, 0]


@dataclass(frozen=True, eq=False)
class CrossedSurfaces:
    """Of every crossing: ``critical_set`` (C,) by index or NONE, ``point`` and outward ``normal`` (C, 3), ``d`` (C, n).

    Where no critical set was met the point is that of the bisection, and the normal along the edge.
    """

    critical_set: np.ndarray
    point: np.ndarray
    normal: np.ndarray
    d: np.ndarray


def crossed_surfaces(
    sets: list[CriticalSet], inverse: ThreeJointInverse, crossings: LatticeCrossings, width: float
) -> CrossedSurfaces:
    """Find them, from all configurations that reach the last points inside."""
    arm = inverse.arm
    solutions = inverse.solutions(crossings.inside)
    unit = np.where(arm.revolute, 1.0, max(arm.size, 1e-300))
    count = len(crossings)
    found = CrossedSurfaces(
        np.full(count, NONE),
        (crossings.inside + crossings.outside) / 2,
        crossings.outward,
        np.full((count, arm.n), np.nan),
    )
    for index, each in enumerate(sets):
        start, near = _starts(each, solutions, unit)
        rows = np.flatnonzero(near & (found.critical_set == NONE))
        meeting = each.meet(crossings.inside[rows], crossings.outward[rows], start[rows])
        good = np.abs(meeting.s) <= _BESIDE * width
        with np.errstate(invalid="ignore"):
            d = arm.nearest_turn(meeting.d)
            good &= (((d >= arm.low - _WITHIN * unit) & (d <= arm.high + _WITHIN * unit)) | arm.full).all(axis=1)
        kept = rows[good]
        found.critical_set[kept], found.normal[kept], found.d[kept] = index, meeting.normal[good], d[good]
        found.point[kept] = crossings.inside[kept] + meeting.s[good, None] * crossings.outward[kept]
    return found


def _starts(each: CriticalSet, solutions: np.ndarray, unit: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of each point the solution (C, n) that is nearest to a critical set, and whether it is near enough (C,)."""
    if each.stops:
        stop = each.stops[0]
        distance = np.abs(solutions[:, :, stop.joint] - stop.at) / unit[stop.joint]
    else:
        sigma = np.linalg.svd(each.arm.motion(np.nan_to_num(solutions).reshape(-1, each.arm.n))[1], compute_uv=False)
        distance = (sigma[:, 2] / np.maximum(sigma[:, 0], 1e-300)).reshape(solutions.shape[:2])
        distance[np.isnan(solutions[:, :, 0])] = np.nan
    distance = np.where(np.isnan(distance), np.inf, distance)
    nearest = distance.argmin(axis=1)
    rows = np.arange(len(solutions))
    least = distance[rows, nearest]
    return solutions[rows, nearest], least <= (_AT_STOP if each.stops else np.finfo(float).max)
