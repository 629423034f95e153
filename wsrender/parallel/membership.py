"""What the kernels are asked of a mechanism, and the box that holds its workspace."""

from dataclasses import dataclass

import numpy as np

from wsrender.engine import LegTest, poses_reached
from wsrender.parallel.leg_distance import leg_pairs
from wsrender.parallel.mechanism import Mechanism


def leg_test(mechanism: Mechanism, precision: str = "float64") -> LegTest:
    """What the kernels ask of a mechanism; its subsystems are runs of legs with a common base point ([SNK]'s pairs)."""
    count = len(mechanism.kinds)
    ends = np.array([k + 1 == count or not np.array_equal(*mechanism.base[[k, k + 1]]) for k in range(count)])
    pairs = leg_pairs(mechanism) if mechanism.clearance_m > 0 else []
    return LegTest(mechanism, ends, pairs, precision)


@dataclass(frozen=True, eq=False)
class Box:
    """An axis-aligned box [m]; empty where a lower side is not below the upper one."""

    lower: np.ndarray
    upper: np.ndarray

    @property
    def empty(self) -> bool:
        """Whether it holds nothing."""
        return bool(np.any(self.lower >= self.upper))

    @property
    def volume(self) -> float:
        """Its volume [m³]."""
        return 0.0 if self.empty else float(np.prod(self.upper - self.lower))


def reachable_box(mechanism: Mechanism, rotations: np.ndarray) -> Box:
    """A box, base frame, that holds every position reached at any of the orientations (N, 3, 3).

    Each leg keeps its platform joint in a ball (UPS, cranks) or in a capsule around its rail (PUS).
    """
    legs = zip(mechanism.kinds, mechanism.lower, mechanism.upper, strict=True)
    low, high = mechanism.base.copy(), mechanism.base.copy()
    for k, (kind, lower, upper) in enumerate(legs):
        reach = upper if kind == "UPS" else mechanism.crank[k] + mechanism.link[k]
        ends = np.outer([lower, upper], mechanism.axis[k]) if kind == "PUS" else np.zeros((1, 3))
        low[k] += ends.min(axis=0) - reach
        high[k] += ends.max(axis=0) + reach
    shift = np.einsum("nij,lj->nli", rotations, mechanism.platform)
    lower = np.maximum((low - shift).max(axis=1).min(axis=0), mechanism.region_lower)
    upper = np.minimum((high - shift).min(axis=1).max(axis=0), mechanism.region_upper)
    return Box(lower, upper)


def placed_box(mechanism: Mechanism, box: Box) -> Box:
    """The smallest box in the world that holds a box of the base frame."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    world = in_world(mechanism, box.lower + corners * (box.upper - box.lower))
    return Box(world.min(axis=0), world.max(axis=0))


def in_base_frame(mechanism: Mechanism, positions_world: np.ndarray) -> np.ndarray:
    """Positions (N, 3) of the world in the mechanism's base frame [m]."""
    T = mechanism.T_world_base
    return (positions_world - T[:3, 3]) @ T[:3, :3]


def in_world(mechanism: Mechanism, positions: np.ndarray) -> np.ndarray:
    """Positions (…, 3) of the base frame in the world [m]."""
    return positions @ mechanism.T_world_base[:3, :3].T + mechanism.T_world_base[:3, 3]


def orientations_reached(
    test: LegTest, position: np.ndarray, rotations: np.ndarray, *, device: str = "auto", threads: int | None = None
) -> np.ndarray:
    """Which orientations (N, 3, 3) are reached at one position (3,), base frame, (N,) bool."""
    poses = np.broadcast_to(np.eye(4), (len(rotations), 4, 4)).copy()
    poses[:, :3, :3], poses[:, :3, 3] = rotations, position
    return poses_reached(test, poses, device=device, threads=threads)
