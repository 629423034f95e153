"""Hybrid mechanisms: serial joints before or after a parallel one.

At given values of the serial joints a hybrid is a parallel mechanism that stands elsewhere (joints before it) and whose
platform is seen from the last link (joints after it). Its workspace is the union over the values.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from wsrender.engine import count_orientations_at
from wsrender.parallel.mechanism import Mechanism, mechanism_of
from wsrender.parallel.membership import Box, in_base_frame, leg_test, placed_box, reachable_box
from wsrender.spec.mechanism import MechanismSpec
from wsrender.spec.serial_joints import SerialJoint


@dataclass(frozen=True, eq=False)
class Variant:
    """A hybrid at the values ``q`` (n,) of its serial joints [rad or m], before then after: a mechanism.

    ``turned_base`` (3, 3): the rotation of the carried base against the fixed one.
    """

    q: np.ndarray
    mechanism: Mechanism
    turned_base: np.ndarray

    def rotations(self, fixed: np.ndarray) -> np.ndarray:
        """Orientations (N, 3, 3) of the fixed base's frame in that of the carried base.

        The platform of a delta keeps the orientation of its own base, whatever is asked.
        """
        return fixed if self.mechanism.translational else self.turned_base.T @ fixed


def variants(spec: MechanismSpec) -> list[Variant]:
    """The mechanism of a document at every combination of levels of its serial joints; one where it has none."""
    mechanism = mechanism_of(spec)
    joints = (*spec.before, *spec.after)
    axes = [np.linspace(*joint.limits, joint.levels) for joint in joints]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(joints)) if joints else np.zeros((1, 0))
    return [_variant(mechanism, spec, q) for q in grid]


def middle(found: Sequence[Variant]) -> Variant:
    """The one in the middle of the ranges."""
    q = np.array([variant.q for variant in found])
    return found[int(((q - (q.min(axis=0) + q.max(axis=0)) / 2) ** 2).sum(axis=1).argmin())]


def reachable_box_of(found: Sequence[Variant], rotations: np.ndarray) -> Box | None:
    """A box, world, that holds every position reached by any variant; None where their legs' reaches do not meet."""
    boxes = [(v.mechanism, reachable_box(v.mechanism, v.rotations(rotations))) for v in found]
    placed = [placed_box(mechanism, box) for mechanism, box in boxes if not box.empty]
    if not placed:
        return None
    return Box(np.min([box.lower for box in placed], axis=0), np.max([box.upper for box in placed], axis=0))


def reached_by_any(
    found: Sequence[Variant], positions: np.ndarray, rotations: np.ndarray, *, device: str = "auto"
) -> np.ndarray:
    """Whether positions (N, 3), world, are reached at any of the orientations (M, 3, 3) by any variant, (N,) bool."""
    inside = np.zeros(len(positions), bool)
    for variant in found:
        mechanism, left = variant.mechanism, np.flatnonzero(~inside)
        there = in_base_frame(mechanism, positions[left])
        counts = count_orientations_at(leg_test(mechanism), there, variant.rotations(rotations), device=device)
        inside[left] = counts.reached > 0
    return inside


def _variant(mechanism: Mechanism, spec: MechanismSpec, q: np.ndarray) -> Variant:
    count = len(spec.before)
    T_before, T_after = serial_transform(spec.before, q[:count]), serial_transform(spec.after, q[count:])
    t = T_after[:3, 3]
    R = np.eye(3) if mechanism.translational else T_after[:3, :3]
    carried = replace(
        mechanism,
        T_world_base=mechanism.T_world_base @ T_before,
        platform=(mechanism.platform - t) @ R,
        platform_cone_axis=mechanism.platform_cone_axis @ R,
    )
    return Variant(q, carried, T_before[:3, :3])


def serial_transform(joints: Sequence[SerialJoint], q: np.ndarray) -> np.ndarray:
    """Frame after the joints in that before them, (4, 4)."""
    T = np.eye(4)
    for joint, value in zip(joints, q, strict=True):
        axis = np.array(joint.axis) / np.linalg.norm(joint.axis)
        step = np.eye(4)
        step[:3, 3] = joint.position_m
        if joint.type == "revolute":
            step[:3, :3] = Rotation.from_rotvec(value * axis).as_matrix()
        else:
            step[:3, 3] += value * axis
        T = T @ step
    return T
