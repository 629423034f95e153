"""Hybrid mechanisms: serial joints before or after a parallel one.

At given values of the serial joints a hybrid is a parallel mechanism that stands elsewhere (joints before it) and whose
platform is seen from the last link (joints after it). Its workspace is the union over the values.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from wsrender.documents.legs import SerialJoint
from wsrender.documents.mechanism import MechanismSpec
from wsrender.engine import OrientationCounts
from wsrender.errors import InputError
from wsrender.mechanisms.mechanism import Mechanism, mechanism_of
from wsrender.mechanisms.membership import AxisBox, count_at, in_base_frame, placed_box, reachable_box
from wsrender.robot import Robot

BATCH = 1 << 14
MOST_BATCHES = 512  # eight million positions tried


@dataclass(frozen=True, eq=False)
class Variant:
    """A hybrid at the values ``q`` (n,) of its serial joints [rad or m], ``before`` then ``after``: a mechanism.

    Its platform is the link beyond the joints after it.
    """

    q: np.ndarray
    mechanism: Mechanism
    before: tuple[SerialJoint, ...]
    after: tuple[SerialJoint, ...]

    @property
    def turned_base(self) -> np.ndarray:
        """The rotation of the carried base against the fixed one, (3, 3)."""
        return serial_transform(self.before, self.q)[:3, :3]

    def rotations(self, fixed: np.ndarray) -> np.ndarray:
        """Orientations (N, 3, 3) of the fixed base's frame in that of the carried base.

        The platform of a delta keeps the orientation of its own base, whatever is asked.
        """
        return fixed if self.mechanism.translational else self.turned_base.T @ fixed

    @property
    def revolute(self) -> tuple[bool, ...]:
        """Whether each joint turns, or slides: before, actuated and after, as in the Jacobian that `composed` gives."""
        before, after = (tuple(j.type == "revolute" for j in joints) for joints in (self.before, self.after))
        return before + self.mechanism.revolute + after

    def composed(self, J: np.ndarray, poses: np.ndarray) -> np.ndarray:
        """Jacobian (N, 6, k) of all joints, before, actuated and after, in axes of the fixed base.

        ``J`` (N, m, n): that of the parallel part at platform poses (N, 4, 4), both in the frame of the carried base.
        """
        T_before = serial_transform(self.before, self.q)
        T_after = serial_transform(self.after, self.q[len(self.before) :])
        tool = poses[:, :3, 3] @ T_before[:3, :3].T + T_before[:3, 3]
        R_platform = np.broadcast_to(T_before[:3, :3], (len(poses), 3, 3))
        if not self.mechanism.translational:
            R_platform = R_platform @ poses[:, :3, :3] @ T_after[:3, :3].T
        T_platform = np.broadcast_to(np.eye(4), (len(poses), 4, 4)).copy()
        T_platform[:, :3, :3] = R_platform
        T_platform[:, :3, 3] = tool - R_platform @ T_after[:3, 3]
        parallel = np.zeros((len(poses), 6, J.shape[2]))
        for first in range(0, J.shape[1], 3):
            parallel[:, first : first + 3] = T_before[:3, :3] @ J[:, first : first + 3]
        fixed = np.broadcast_to(np.eye(4), T_platform.shape)
        before, after = np.split(self.q, [len(self.before)])
        columns = [_columns(self.before, before, fixed, tool), parallel, _columns(self.after, after, T_platform, tool)]
        return np.concatenate(columns, axis=2)


def _columns(joints: Sequence[SerialJoint], q: np.ndarray, T: np.ndarray, tool: np.ndarray) -> np.ndarray:
    """Columns (N, 6, n) of joints that begin at frames T (N, 4, 4), for tool points (N, 3), in the frame of T."""
    found = np.zeros((len(T), 6, len(joints)))
    for k, joint in enumerate(joints):
        before = T @ serial_transform(joints[:k], q[:k])
        axis = before[:, :3, :3] @ (np.array(joint.axis) / np.linalg.norm(joint.axis))
        if joint.type == "revolute":
            point = before[:, :3, :3] @ np.array(joint.position_m) + before[:, :3, 3]
            found[:, :3, k], found[:, 3:, k] = np.cross(axis, tool - point), axis
        else:
            found[:, :3, k] = axis
    return found


def variants(spec: MechanismSpec, robots: Sequence[Robot] | None = None) -> list[Variant]:
    """The mechanism of a document at every combination of levels of its serial joints; one where it has none."""
    mechanism = mechanism_of(spec, robots)
    joints = (*spec.before, *spec.after)
    axes = [np.linspace(*joint.limits, joint.levels) for joint in joints]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(joints)) if joints else np.zeros((1, 0))
    return [hybrid_at(mechanism, spec, q) for q in grid]


def from_middle(found: Sequence[Variant]) -> list[Variant]:
    """In the order of their distance from the middle of the ranges."""
    q = np.array([variant.q for variant in found])
    distance = ((q - (q.min(axis=0) + q.max(axis=0)) / 2) ** 2).sum(axis=1)
    return [found[k] for k in np.argsort(distance, kind="stable")]


def middle(found: Sequence[Variant]) -> Variant:
    """The one in the middle of the ranges."""
    return from_middle(found)[0]


def reachable_box_of(found: Sequence[Variant], rotations: np.ndarray) -> AxisBox | None:
    """A box, world, that holds every position reached by any variant; None where their legs' reaches do not meet."""
    boxes = [(v.mechanism, reachable_box(v.mechanism, v.rotations(rotations))) for v in found]
    placed = [placed_box(mechanism, box) for mechanism, box in boxes if not box.empty]
    if not placed:
        return None
    return AxisBox(np.min([box.lower for box in placed], axis=0), np.max([box.upper for box in placed], axis=0))


def reached_by_any(
    found: Sequence[Variant],
    positions: np.ndarray,
    rotations: np.ndarray,
    *,
    device: str = "auto",
    threads: int | None = None,
) -> np.ndarray:
    """Whether positions (N, 3), world, are reached at any of the orientations (M, 3, 3) by any variant, (N,) bool."""
    inside = np.zeros(len(positions), bool)
    for variant in found:
        mechanism, left = variant.mechanism, np.flatnonzero(~inside)
        there = in_base_frame(mechanism, positions[left])
        counts = count_at(mechanism, there, variant.rotations(rotations), device=device, threads=threads)
        inside[left[counts.cells[counts.reached > 0]]] = True
    return inside


Counted = Callable[[Variant, np.ndarray, np.ndarray], OrientationCounts]
"""(variant, rotations (M, 3, 3) of the carried base, their weights (M,)) → at how many each place is reached."""


def count_union(
    found: Sequence[Variant],
    count: Counted,
    rotations: np.ndarray,
    weights: np.ndarray,
    places: int,
    progress: Callable[[int], None] | None = None,
) -> OrientationCounts:
    """At how many of the orientations (M, 3, 3) each of ``places`` is reached by any variant; cells count from 0.

    ``progress``: called with the orientations done.
    """
    if len(found) == 1:
        return count(found[0], found[0].rotations(rotations), weights)
    reached, weighted = np.zeros((2, places), np.int32)
    parts = []
    for number, (rotation, weight) in enumerate(zip(rotations[:, None], weights, strict=True)):
        hit = np.zeros(places, bool)
        for variant in found:
            counts = count(variant, variant.rotations(rotation), np.ones(1, np.int32))
            hit[counts.cells[counts.reached > 0]] = True
            parts.append(counts)
        reached += hit
        weighted += hit * weight
        if progress:
            progress(number + 1)
    cells = np.flatnonzero(reached)
    return OrientationCounts(cells, reached[cells], weighted[cells], *OrientationCounts.totals(parts))


def added(each: Sequence[OrientationCounts]) -> OrientationCounts:
    """The sums over several sets of counts of the same places: at how many of all their poses each is reached."""
    cells, place = np.unique(np.concatenate([counts.cells for counts in each]), return_inverse=True)
    reached, weights = np.zeros((2, len(cells)), np.int64)
    np.add.at(reached, place, np.concatenate([counts.reached for counts in each]))
    np.add.at(weights, place, np.concatenate([counts.weights for counts in each]))
    return OrientationCounts(cells, reached, weights, *OrientationCounts.totals(each))


def hybrid_at(mechanism: Mechanism, spec: MechanismSpec, q: np.ndarray) -> Variant:
    """A document's hybrid at values (n,) of its serial joints; ``mechanism``: its parallel part alone."""
    count = len(spec.before)
    T_before, T_after = serial_transform(spec.before, q[:count]), serial_transform(spec.after, q[count:])
    T_platform_tool = T_after.copy()
    if mechanism.translational:
        T_platform_tool[:3, :3] = np.eye(3)
    R, t = T_platform_tool[:3, :3], T_platform_tool[:3, 3]
    carried = replace(
        mechanism,
        T_world_base=mechanism.T_world_base @ T_before,
        platform=(mechanism.platform - t) @ R,
        platform_cone_axis=mechanism.platform_cone_axis @ R,
        numeric=tuple(leg.seen_from(T_after) for leg in mechanism.numeric),
        bodies=mechanism.bodies and mechanism.bodies.carried(T_before, T_platform_tool),
    )
    return Variant(q, carried, spec.before, spec.after)


def serial_transform(joints: Sequence[SerialJoint], q: np.ndarray) -> np.ndarray:
    """Frame after the joints in that before them, (4, 4); of ``q`` the first values."""
    T = np.eye(4)
    for joint, value in zip(joints, q, strict=False):
        axis = np.array(joint.axis) / np.linalg.norm(joint.axis)
        step = np.eye(4)
        step[:3, 3] = joint.position_m
        if joint.type == "revolute":
            step[:3, :3] = Rotation.from_rotvec(value * axis).as_matrix()
        else:
            step[:3, 3] += value * axis
        T = T @ step
    return T


def workspace_points(
    spec: MechanismSpec, count: int, *, device: str = "auto", threads: int | None = None
) -> np.ndarray:
    """The first ``count`` points of a Sobol set that the platform reaches without being turned, (N, 3) [m], world.

    Fewer where eight million points of the box around the workspace hold fewer; InputError where they hold none.
    """
    from scipy.stats.qmc import Sobol

    found, level = variants(spec), np.eye(3)[None]
    box = reachable_box_of(found, level)
    points, sobol = np.zeros((0, 3)), Sobol(3, scramble=False)
    for _ in range(MOST_BATCHES):
        if box is None or len(points) >= count:
            break
        tried = box.lower + sobol.random(BATCH) * (box.upper - box.lower)
        reached = reached_by_any(found, tried, level, device=device, threads=threads)
        points = np.concatenate([points, tried[reached]])
    if not len(points):
        raise InputError("mechanism", "reaches no position without being turned")
    return points[:count]
