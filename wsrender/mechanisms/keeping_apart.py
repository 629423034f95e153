"""Whether a mechanism's bodies keep apart at poses, and in which postures of its legs.

Legs in closed form stand on any combination of their branches. Of a serial leg first the posture is asked in which its
inverse kinematics ends, then, where bodies collide, all that are known: combinations of the legs' postures in which
each keeps apart by itself, one after the other, until bodies keep apart. A pose is unreachable where they never do, if
closed forms know all postures, or where those collide that no posture moves; else undecided.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wsrender.mechanisms.bodies import FirstPair, Segments, Solids
from wsrender.mechanisms.inverse_kinematics import LegSolutions, inverse_kinematics
from wsrender.mechanisms.mechanism import Mechanism
from wsrender.mechanisms.serial_leg import LegPostures
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE

POSES, COMBINATIONS = 1 << 13, 1 << 8  # at a time: of single postures, and of all
MOST_TRIES = 1000  # combinations of postures of a pose


@dataclass(frozen=True, eq=False)
class Stand:
    """How a mechanism stands at N poses: labels (N,) int8, as of `InverseSolver`, of poses that all legs reach.

    ``q``: of each serial leg configurations (N, n), in which the bodies keep apart where the label is REACHABLE.
    """

    label: np.ndarray
    q: tuple[np.ndarray, ...]


def stand(
    mechanism: Mechanism,
    poses: np.ndarray,
    *,
    fixed: np.ndarray | None = None,
    device: str = "cpu",
    threads: int | None = None,
) -> Stand:
    """Of platform poses (N, 4, 4), base frame, that all legs reach; unreachable where those in closed form do not.

    ``fixed``: as of `Solids.collisions`, where serial joints carry the base.
    """
    q = tuple(leg.solve(poses, device=device, threads=threads).q.copy() for leg in mechanism.numeric)
    if mechanism.bodies is None:
        return Stand(np.full(len(poses), REACHABLE, np.int8), q)
    label, branches = np.full(len(poses), UNREACHABLE, np.int8), mechanism.on_each_branch()
    for branch in branches:
        for part in _parts(np.flatnonzero(label != REACHABLE), POSES):
            single = [LegPostures.single(each[part]) for each in q]
            _settle(mechanism.bodies, branch, poses, fixed, part, single, label, q)
    if mechanism.numeric:
        for part in _parts(np.flatnonzero(label != REACHABLE), COMBINATIONS):
            known = [leg.postures(poses[part], device=device, threads=threads) for leg in mechanism.numeric]
            label[part] = UNREACHABLE
            for branch in branches:
                left = np.flatnonzero(label[part] != REACHABLE)
                postures = [each.at(left) for each in known]
                _settle(mechanism.bodies, branch, poses, fixed, part[left], postures, label, q)
    return Stand(label, q)


def bodies_apart(mechanism: Mechanism, poses: np.ndarray, **execution: int | str | None) -> np.ndarray:
    """Whether some posture is known in which the bodies keep apart, as `stand` has it, (N,) bool."""
    if mechanism.bodies is None:
        return np.ones(len(poses), bool)
    return stand(mechanism, poses, **execution).label == REACHABLE  # type: ignore[arg-type]


def collision_at(mechanism: Mechanism, pose: np.ndarray) -> str:
    """Which bodies collide at a pose (4, 4) that all legs reach, in words; empty where they keep apart."""
    bodies, found = mechanism.bodies, stand(mechanism, pose[None])
    if bodies is None or found.label[0] == REACHABLE:
        return ""
    legs = inverse_kinematics(mechanism, pose[None])
    frames = [leg.frames(leg_q) for leg, leg_q in zip(bodies.serial, found.q, strict=True)]
    number, names = bodies.collisions(segments(mechanism, legs), pose[None], frames)
    more = "" if found.label[0] == UNREACHABLE else ", in this posture, and others in every other that was found"
    return f"collision: {names[number[0] - 1]} come too near{more}"


def segments(mechanism: Mechanism, legs: LegSolutions) -> list[Segments]:
    """The links of legs in closed form, towards the platform, and cranks, (N, 2, 3) [m] each."""
    links = np.stack([legs.elbows, legs.joints], axis=2)
    cranks = np.stack([np.broadcast_to(mechanism.base, legs.elbows.shape), legs.elbows], axis=2)
    return [
        {"link": links[:, k]} | ({"crank": cranks[:, k]} if crank > 0 else {})
        for k, crank in enumerate(mechanism.crank)
    ]


def _parts(at: np.ndarray, size: int) -> list[np.ndarray]:
    return [at[first : first + size] for first in range(0, len(at), size)]


def _of(fixed: np.ndarray | None, at: np.ndarray) -> np.ndarray | None:
    return None if fixed is None else fixed[at]


def _settle(
    bodies: Solids,
    branch: Mechanism,
    poses: np.ndarray,
    fixed: np.ndarray | None,
    at: np.ndarray,
    postures: Sequence[LegPostures],
    label: np.ndarray,
    q: Sequence[np.ndarray],
) -> None:
    """Label poses ``at`` (M,) on a branch, of which ``postures`` of serial legs are known, and note those that do."""
    if not len(at):
        return
    legs = inverse_kinematics(branch, poses[at])
    lines = segments(branch, legs.at(legs.feasible))
    left = np.flatnonzero(legs.feasible)
    clear = bodies.alone(lines, poses[at[left]], _of(fixed, at[left])).number == 0
    left, lines = left[clear], [{part: line[clear] for part, line in leg.items()} for leg in lines]
    known = [each.at(left) for each in postures]
    search = _Combinations(bodies, known, lines, poses[at[left]], _of(fixed, at[left]))
    chosen, exhausted = search.run()
    some = (chosen >= 0).all(axis=1)
    for k, each in enumerate(postures):
        q[k][at[left[some]]] = each.q[left[some], chosen[some, k]]
    label[at[left[some]]] = REACHABLE
    every = np.all(np.array([each.complete for each in postures], bool).reshape(-1, len(at)), axis=0)
    doubtful = left[~some & ~(exhausted & every[left])]
    label[at[doubtful]] = UNDECIDED


class _Combinations:
    """Postures of every serial leg in which bodies keep apart, at M poses."""

    def __init__(
        self,
        bodies: Solids,
        postures: Sequence[LegPostures],
        lines: Sequence[Segments],
        poses: np.ndarray,
        fixed: np.ndarray | None,
    ):
        self.bodies, self.count = bodies, len(poses)
        self.frames, self.free = [], []
        for k, known in enumerate(postures):
            pose, number = np.nonzero(known.there)
            frames = bodies.serial[k].frames(known.q[pose, number])
            rows = [{part: line[pose] for part, line in leg.items()} for leg in lines]
            found = FirstPair(len(pose), bodies.margin_m)
            apart = bodies.of_leg(found, k, frames, rows, poses[pose], _of(fixed, pose)).number == 0
            free, place = known.there.copy(), np.zeros(known.there.shape, np.int64)
            free[pose, number], place[pose, number] = apart, np.arange(len(pose))
            self.free.append(free)
            self.frames.append((frames, place))

    def run(self) -> tuple[np.ndarray, np.ndarray]:
        """Numbers (M, K) of postures of K legs, -1 where there is none; whether all combinations were tried, (M,)."""
        legs = len(self.free)
        chosen, depth = np.full((self.count, legs), -1), np.zeros(self.count, np.int64)
        tries = np.zeros(self.count, np.int64)
        while True:
            open_ = (depth >= 0) & (depth < legs) & (tries < MOST_TRIES)
            if not open_.any():
                break
            for k in range(legs):
                self._advance(k, np.flatnonzero(open_ & (depth == k)), chosen, depth)
            tries += open_
        chosen[depth < legs] = -1
        return chosen, depth < 0

    def _advance(self, k: int, rows: np.ndarray, chosen: np.ndarray, depth: np.ndarray) -> None:
        """Take the next posture of leg ``k`` at some poses; on to the next leg where it is clear of those before."""
        later = self.free[k][rows] & (np.arange(self.free[k].shape[1]) > chosen[rows, k][:, None])
        some = later.any(axis=1)
        chosen[rows, k] = np.where(some, later.argmax(axis=1) if later.shape[1] else -1, -1)
        depth[rows[~some]] -= 1
        rows = rows[some]
        found = FirstPair(len(rows), self.bodies.margin_m)
        T = self._frames(k, rows, chosen)
        for other in range(k):
            self.bodies.of_two(found, other, k, self._frames(other, rows, chosen), T)
        depth[rows[found.number == 0]] += 1

    def _frames(self, k: int, rows: np.ndarray, chosen: np.ndarray) -> np.ndarray:
        frames, place = self.frames[k]
        return frames[place[rows, chosen[rows, k]]]
