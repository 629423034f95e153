"""Self-motions: curves of configurations that hold one pose, traced from postures on them."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial import KDTree

from wsrender.reach.posture_solver import PoseHolder
from wsrender.short_repr import short_repr

STEP = 0.05  # rad and reaches: between points of a curve
FINEST = 1 / 256  # of a step: where no shorter one goes on, the curve ends in a singular configuration
MOST_POINTS = 20_000  # of a curve, either way from where it is begun
TURNING = 0.95  # least cosine of the angle between the directions of two steps
TOGETHER = 4  # curves of a pose that are traced before one looks what they explain


@dataclass(frozen=True, eq=False)
class SelfMotion:
    """Configurations (P, n) [rad or m] that hold the pose number ``pose``, in order, two neighbours a step apart.

    ``closed``: the first follows on the last; else both ends are at joint limits, or at ``singular`` configurations.
    ``reasons`` (P,) text: the constraint that blocks each, "" of free ones; none without constraints.
    """

    pose: int
    configurations: np.ndarray
    closed: bool
    singular: bool
    reasons: np.ndarray = field(default_factory=lambda: np.zeros(0, str))

    __repr__ = short_repr

    def __len__(self) -> int:
        return len(self.configurations)


def self_motions(
    holder: PoseHolder, pose: np.ndarray, q: np.ndarray, T: np.ndarray, step: float = STEP
) -> list[SelfMotion]:
    """The curves through postures ``q`` (K, n) of poses by number ``pose`` (K,) of ``T`` (N, 4, 4), turns apart.

    Every curve goes through one of the postures at least, and every posture stands on one of the curves.
    """
    found: list[SelfMotion] = []
    left = np.arange(len(q))
    while len(left):
        begun = np.concatenate([np.zeros(0, int), *_spread(left, pose[left])])
        for start, (points, closed, singular) in zip(
            begun, traced(holder, q[begun], T[pose[begun]], step), strict=True
        ):
            own = left[pose[left] == pose[start]]
            if start not in own:
                continue  # it is on a curve that another posture has begun
            found.append(SelfMotion(int(pose[start]), points, closed, singular))
            explained = own[near_curve(holder, points, closed, q[own]) < step / 4]
            left = np.setdiff1d(left, np.append(explained, start))
    return sorted(found, key=lambda curve: curve.pose)


def _spread(left: np.ndarray, pose: np.ndarray) -> Iterator[np.ndarray]:
    """Of every pose up to TOGETHER postures, far from each other in their order."""
    for number in np.unique(pose):
        own = left[pose == number]
        yield own[np.unique(np.linspace(0, len(own) - 1, TOGETHER).astype(int))]


def near_curve(holder: PoseHolder, points: np.ndarray, closed: bool, q: np.ndarray) -> np.ndarray:
    """Distances [rad or reaches] of configurations (M, n) from a curve through points (P, n), about, (M,)."""
    ends = np.concatenate([points, points[:1]]) if closed else points
    parts = np.linspace(0, 1, 8, endpoint=False)[:, None, None]
    between = ends[:-1] + parts * holder.difference(ends[1:] - ends[:-1])
    dense = np.concatenate([points, between.reshape(-1, points.shape[1])])
    return KDTree(_embedded(holder, dense)).query(_embedded(holder, q))[0]


def _embedded(holder: PoseHolder, q: np.ndarray) -> np.ndarray:
    """Coordinates whose distances are those of configurations, turns apart: hinges on circles."""
    hinges = holder.chain.revolute
    turning, others = q[:, hinges], (q / holder.scale)[:, ~hinges]
    return np.hstack([others, np.cos(turning), np.sin(turning)])


def traced(holder: PoseHolder, q: np.ndarray, T: np.ndarray, step: float) -> list[tuple[np.ndarray, bool, bool]]:
    """From each of ``q`` (M, n), which hold ``T`` (M, 4, 4): points (P, n), whether closed, whether singular ends.

    Predictor along the null vector of the Jacobian, corrector `PoseHolder.polished` (Allgower, Georg 1990), both ways
    from the start; a joint that comes to its limit ends a curve there.
    """
    M = len(q)
    start, poses = np.concatenate([q, q]), np.concatenate([T, T])
    first = holder.null_vectors(start)
    at, along = start.copy(), np.concatenate([first[:M], -first[M:]])
    h, gone = np.full(2 * M, step), np.zeros(2 * M)
    paths: list[list[np.ndarray]] = [[] for _ in range(2 * M)]
    closed, singular = np.zeros(2 * M, bool), np.zeros(2 * M, bool)
    active = np.arange(2 * M)
    for _ in range(MOST_POINTS):
        if not len(active):
            break
        asked = at[active] + h[active, None] * holder.along(along[active])
        outside = ((asked < holder.chain.lower_limits) | (asked > holder.chain.upper_limits)) & ~holder.chain.periodic
        stopped = outside.any(axis=1)
        moved, off = holder.polished(asked, poses[active], outside)
        direction = holder.null_vectors(moved)
        direction *= np.where(np.einsum("mk,mk->m", direction, along[active]) < 0, -1.0, 1.0)[:, None]
        straight = np.einsum("mk,mk->m", direction, along[active]) > TURNING
        near = holder.distances(moved, asked) < np.where(stopped, 1.5, 0.5) * h[active]
        good = holder.holds(off) & near & (straight | stopped)
        for k in np.flatnonzero(good):
            paths[active[k]].append(moved[k])
        gone[active[good]] += h[active[good]]
        at[active[good]], along[active[good]] = moved[good], direction[good]
        stuck = ~good & (h[active] <= FINEST * step)
        h[active] = np.where(good, np.minimum(2 * h[active], step), h[active] / 2)
        back = holder.difference(start[active] - at[active]) / holder.scale
        home = np.linalg.norm(back, axis=1) < 1.2 * h[active]
        ahead = np.einsum("mk,mk->m", back[:, holder.moving], along[active]) >= 0
        closed[active] = good & home & ahead & (gone[active] > 3 * step)
        singular[active] |= stuck
        active = active[~(closed[active] | (good & stopped) | stuck)]
    singular[active] = True
    return [
        _joined(q[k], paths[k], paths[M + k], bool(closed[k]), bool(singular[k] | singular[M + k])) for k in range(M)
    ]


def _joined(
    q: np.ndarray, ahead: list[np.ndarray], behind: list[np.ndarray], closed: bool, singular: bool
) -> tuple[np.ndarray, bool, bool]:
    if closed:
        return np.array([q, *ahead]), True, False
    return np.array([*behind[::-1], q, *ahead]), False, singular
