"""Whether a hybrid mechanism reaches poses at any values of its serial joints, levels or not: branch and bound.

The joints' ranges are cut in halves. A cell is dropped where no leg's joint can come, within the cell, to where the leg
reaches it (`leg_bounds`); a pose is reached where the mechanism reaches it at the middle of a cell. What is left when
cells move the platform by less than SETTLED of the mechanism's size, or after MOST_CELLS of a pose, is undecided.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from wsrender.documents.legs import SerialJoint
from wsrender.documents.mechanism import MechanismSpec
from wsrender.mechanisms.leg_bounds import proves_all, surely_unreached
from wsrender.mechanisms.mechanism import Mechanism, mechanism_of
from wsrender.mechanisms.membership import in_base_frame, poses_labelled
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.robot import Robot
from wsrender.robots.frames import inverse_of_rigid
from wsrender.robots.reachable_box import reachable_box

SETTLED = 1e-5  # of the size: a cell that moves the platform by less is not cut any more
MOST_CELLS, MOST_SLOW = 4096, 48  # of a pose, and where every cell asks for a numerical solution or for bodies
BATCH = 1 << 15  # cells at a time
FIRST_CUTS = 3  # of every range, in halves


@dataclass(frozen=True, eq=False)
class SerialSearch:
    """A hybrid with its joints ``before`` and ``after``; ``mechanism``: its parallel part alone."""

    mechanism: Mechanism
    before: tuple[SerialJoint, ...]
    after: tuple[SerialJoint, ...]

    @property
    def joints(self) -> tuple[SerialJoint, ...]:
        """All serial joints."""
        return *self.before, *self.after

    @cached_property
    def proves(self) -> bool:
        """Whether poses that are called unreached are proven to be; else cells of a limited size were tried."""
        return proves_all(self.mechanism)

    @property
    def slow(self) -> bool:
        """Whether serial legs are solved, or bodies asked, at every value of the joints that is tried."""
        return bool(self.mechanism.numeric) or self.mechanism.bodies is not None

    def labels(
        self,
        positions: np.ndarray,
        rotations: np.ndarray,
        *,
        around_m: float = 0.0,
        device: str = "auto",
        threads: int | None = None,
    ) -> np.ndarray:
        """Labels (N,) int8 of poses, as of `InverseSolver`.

        Positions (N, 3), world [m], and orientations against the fixed base, (3, 3) or (N, 3, 3). With ``around_m``
        [m] unreachable means that no position so near is reached either; it is proven, and what is not is undecided,
        what serial legs reach or bodies leave too, which are not asked then.
        """
        most = MOST_SLOW if self.slow else MOST_CELLS
        found = np.full(len(positions), UNREACHABLE, np.int8)
        rotations = np.broadcast_to(rotations, (len(positions), 3, 3))
        at_once = BATCH // 2**FIRST_CUTS
        for first in range(0, len(positions), at_once):
            part = slice(first, first + at_once)
            batch = _Batch(self, in_base_frame(self.mechanism, positions[part]), rotations[part], most, around_m)
            found[part] = batch.run(device, threads)
        return found

    def composed(self, positions: np.ndarray, rotations: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The tool's position (N, 3) and the platform's pose (N, 4, 4) in the carried base.

        Of the tool at positions (N, 3) and orientations (N, 3, 3) of the fixed base, at serial values q (N, K).
        """
        before, after = np.split(q, [len(self.before)], axis=1)
        poses = np.broadcast_to(np.eye(4), (len(q), 4, 4)).copy()
        poses[:, :3, :3], poses[:, :3, 3] = rotations, positions
        carried = inverse_of_rigid(serial_transforms(self.before, before)) @ poses
        T_after = serial_transforms(self.after, after)
        if not self.mechanism.translational:
            return carried[:, :3, 3], carried @ inverse_of_rigid(T_after)
        platform = np.broadcast_to(np.eye(4), carried.shape).copy()
        platform[:, :3, 3] = carried[:, :3, 3] - T_after[:, :3, 3]
        return carried[:, :3, 3], platform

    @cached_property
    def arm_m(self) -> float:
        """How far the joints after the platform may carry the tool from it [m]."""
        return sum((float(np.linalg.norm(joint.position_m)) + _slide(joint) for joint in self.after), 0.0)

    @cached_property
    def platform_m(self) -> float:
        """How far the legs' joints are from the tool at most, as they turn with it [m]."""
        if self.mechanism.translational:
            return 0.0
        tips = [leg.T_platform_tip[:3, 3] for leg in self.mechanism.numeric]
        joints = np.vstack([self.mechanism.platform, *tips])
        return float(np.linalg.norm(joints, axis=1).max()) + self.arm_m

    def levers(self, positions: np.ndarray) -> np.ndarray:
        """By how much each serial joint moves the legs' joints at most, seen from the base that they carry, (N, K).

        In metres per radian or metre, of a tool at positions (N, 3) of the fixed base.
        """
        columns = [*_levers(self.before, positions, self.platform_m)]
        if self.mechanism.translational:
            beyond = 0.0
            for joint in reversed(self.after):
                columns.insert(len(self.before), np.full(len(positions), beyond if joint.type == "revolute" else 1.0))
                beyond += float(np.linalg.norm(joint.position_m)) + _slide(joint)
        else:
            columns += _levers(self.after, np.zeros((len(positions), 3)), self.platform_m - self.arm_m)
        return np.stack(columns, axis=1)

    @cached_property
    def reach_m(self) -> float:
        """How far the tool comes from the origin of the fixed base at most [m]."""
        mechanism = self.mechanism
        legs = np.where(np.array(mechanism.kinds) == "UPS", mechanism.upper, mechanism.crank + mechanism.link)
        rails = np.where(
            np.array(mechanism.kinds) == "PUS", np.maximum(np.abs(mechanism.lower), np.abs(mechanism.upper)), 0.0
        )
        far = np.linalg.norm(mechanism.base, axis=1) + np.linalg.norm(mechanism.platform, axis=1) + legs + rails
        numeric = []
        for leg in mechanism.numeric:
            box = np.abs(reachable_box(leg.chain, leg.chain.lower_limits, leg.chain.upper_limits)).max(axis=0)
            numeric.append(np.linalg.norm(box) + np.linalg.norm(leg.T_platform_tip[:3, 3]))
        carried = sum(np.linalg.norm(joint.position_m) + _slide(joint) for joint in self.before)
        return float(min([*far, *numeric]) + self.arm_m + carried)


class _Batch:
    """The search for some poses of the tool in the fixed base."""

    def __init__(self, search: SerialSearch, positions: np.ndarray, rotations: np.ndarray, most: int, around: float):
        self.search, self.positions, self.rotations, self.most = search, positions, rotations, most
        self.around, self.settled = around, max(SETTLED * search.reach_m, around)
        self.tries = not (around and search.slow)  # what single values are tried for says nothing of what is near
        mechanism = search.mechanism
        none = np.full(3, np.inf)
        self.anywhere = replace(mechanism, region_lower=-none, region_upper=none)
        self.levers = search.levers(positions)
        self.limits = np.array([joint.limits for joint in search.joints])
        self.labels = np.full(len(positions), UNREACHABLE, np.int8)
        self.asked = np.zeros(len(positions), np.int64)

    def run(self, device: str, threads: int | None) -> np.ndarray:
        which, middle, half = self._first_cells()
        while len(which):
            keep = self._open(which, middle, half, device, threads)
            which, middle, half = which[keep], middle[keep], half[keep]
            left = self.labels[which] != REACHABLE
            which, middle, half = which[left], middle[left], half[left]
            done = (self._motion(which, half) <= self.settled) | (self.asked[which] >= self.most)
            if self.search.proves or self.around:
                self.labels[which[done]] = UNDECIDED
            go_on = ~done & (self.labels[which] != UNDECIDED)
            which, middle, half = self._halves(which[go_on], middle[go_on], half[go_on])
        return self.labels

    def _first_cells(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        one_hinge = len(self.limits) == 1 and not self.search.mechanism.numeric
        cuts = 2**FIRST_CUTS if one_hinge else 2
        shares = (np.arange(cuts) + 0.5) / cuts
        grid = np.stack(np.meshgrid(*[shares] * len(self.limits), indexing="ij"), axis=-1).reshape(-1, len(self.limits))
        middles = self.limits[:, 0] + grid * np.ptp(self.limits, axis=1)
        count = len(self.positions)
        which = np.repeat(np.arange(count), len(middles))
        half = np.broadcast_to(np.ptp(self.limits, axis=1) / (2 * cuts), (len(which), len(self.limits)))
        return which, np.tile(middles, (count, 1)), half.copy()

    def _open(self, which, middle, half, device: str, threads: int | None) -> np.ndarray:
        """Which cells may hold a value that reaches their pose, (M,) bool; poses reached in their middles are noted."""
        keep = np.zeros(len(which), bool)
        for first in range(0, len(which), BATCH):
            part = slice(first, first + BATCH)
            at, motion = which[part], self._motion(which[part], half[part])
            tool, platform = self.search.composed(self.positions[at], self.rotations[at], middle[part])
            mechanism = self.search.mechanism
            beyond = np.maximum(mechanism.region_lower - tool, tool - mechanism.region_upper).max(axis=1)
            motion = motion + self.around
            near = (beyond <= motion) & ~surely_unreached(self.anywhere, platform, motion)
            tried = np.flatnonzero(near & (beyond <= 0) & self.tries)
            for some in self._rounds(at, tried):
                fixed = self._fixed(middle[part][some])
                labels, _ = poses_labelled(self.anywhere, platform[some], fixed=fixed, device=device, threads=threads)
                self.labels[at[some[labels == REACHABLE]]] = REACHABLE
            np.add.at(self.asked, at[near], 1)
            keep[part] = near
        return keep

    def _rounds(self, at: np.ndarray, cells: np.ndarray) -> Iterator[np.ndarray]:
        """Cells to be tried together: all, or one of each pose that is not reached yet where tries are slow."""
        if not self.search.slow:
            yield cells
            return
        while len(cells := cells[self.labels[at[cells]] != REACHABLE]):
            first = np.unique(at[cells], return_index=True)[1]
            yield cells[first]
            cells = np.delete(cells, first)

    def _fixed(self, q: np.ndarray) -> np.ndarray | None:
        """The fixed base in the carried one at serial values (M, K), (M, 4, 4), where what stands there is asked."""
        if self.search.mechanism.bodies is None:
            return None
        return inverse_of_rigid(serial_transforms(self.search.before, q[:, : len(self.search.before)]))

    def _motion(self, which: np.ndarray, half: np.ndarray) -> np.ndarray:
        """By how much the legs' joints move within cells at most, from their middles (M,) [m]."""
        return (self.levers[which] * half).sum(axis=1)

    def _halves(self, which, middle, half) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Each cell cut in two along the joint that moves the platform most."""
        rows = np.arange(len(which))
        axis = (self.levers[which] * half).argmax(axis=1)
        half = half.copy()
        half[rows, axis] /= 2
        lower, upper = middle.copy(), middle.copy()
        lower[rows, axis] -= half[rows, axis]
        upper[rows, axis] += half[rows, axis]
        return np.tile(which, 2), np.concatenate([lower, upper]), np.tile(half, (2, 1))


def serial_search(spec: MechanismSpec, robots: Sequence[Robot] | None = None) -> SerialSearch:
    """The search for a document's hybrid; ``robots``: those of its serial legs, if they are loaded."""
    return SerialSearch(mechanism_of(spec, robots), spec.before, spec.after)


def serial_transforms(joints: tuple[SerialJoint, ...], q: np.ndarray) -> np.ndarray:
    """Frames after the joints in that before them at values (N, K), (N, 4, 4)."""
    T = np.broadcast_to(np.eye(4), (len(q), 4, 4)).copy()
    for joint, value in zip(joints, q.T, strict=True):
        axis = np.array(joint.axis) / np.linalg.norm(joint.axis)
        step = np.broadcast_to(np.eye(4), T.shape).copy()
        step[:, :3, 3] = joint.position_m
        if joint.type == "revolute":
            step[:, :3, :3] = Rotation.from_rotvec(value[:, None] * axis).as_matrix()
        else:
            step[:, :3, 3] += value[:, None] * axis
        T = T @ step
    return T


def _slide(joint: SerialJoint) -> float:
    return max(map(abs, joint.limits)) if joint.type == "prismatic" else 0.0


def _levers(joints: tuple[SerialJoint, ...], points: np.ndarray, around: float) -> list[np.ndarray]:
    """Levers (N,) of joints about points (N, 3) before them, and what is within ``around`` [m] of these.

    Of the first joint the distance from its axis; of the others a bound of that from their origin.
    """
    found, far = [], np.linalg.norm(points, axis=1) + around
    for number, joint in enumerate(joints):
        origin = np.array(joint.position_m)
        axis = np.array(joint.axis) / np.linalg.norm(joint.axis)
        lever = far + float(np.linalg.norm(origin))
        if number == 0:
            lever = np.linalg.norm(np.cross(points - origin, axis), axis=1) + around
        found.append(lever if joint.type == "revolute" else np.ones(len(points)))
        far = far + float(np.linalg.norm(origin)) + _slide(joint)
    return found
