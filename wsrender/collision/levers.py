"""How far points of one solid move, seen from another, when a joint between them turns."""

import numpy as np

from wsrender.collision.solids import Solid
from wsrender.robots.chain import Chain

STEPS = 360  # of a joint's range at which a lever is measured; what lies between is bounded


class Levers:
    """Levers of solids in a chain; those that pairs of the same joints have in common are measured once."""

    def __init__(self, chain: Chain):
        self.chain = chain
        self._known: dict[tuple[int, int, range], float] = {}
        self._solids: list[Solid] = []  # kept, for their ids stand for them

    def rates(self, a: Solid, b: Solid) -> dict[int, float]:
        """Upper bound of how much the signed distance of two solids changes by a unit of every coordinate between them.

        ``a`` is carried by the lower joint. By coordinate [m/rad, or 1 of a slide]: a rigid motion that moves no point
        of one solid by more than d changes the signed distance by no more than d, for its support function changes by
        no more.
        """
        between = range(a.joint + 1, b.joint + 1)
        found: dict[int, float] = {}
        for joint in between:
            turns = self.chain.joint_is_revolute[joint]
            lever = min(self._of(joint, a, between), self._of(joint, b, between)) if turns else 1.0
            source = int(self.chain.joint_source[joint])
            found[source] = found.get(source, 0.0) + abs(float(self.chain.joint_scale[joint])) * lever
        return found

    def _of(self, joint: int, solid: Solid, between: range) -> float:
        key = joint, id(solid), between
        if key not in self._known:
            self._known[key] = _lever(self.chain, joint, solid, between)
            self._solids.append(solid)
        return self._known[key]


def _lever(chain: Chain, joint: int, solid: Solid, between: range) -> float:
    """Largest distance of a solid's points from a joint's axis while the other joints between move [m]."""
    after = solid.joint >= joint
    path = [k for k in between if (joint < k <= solid.joint if after else solid.joint < k < joint)]
    if not path:
        T = solid.T if after else np.linalg.inv(chain.T_joint[joint]) @ solid.T
        return _from_axis(T[None], solid)
    if len(path) == 1 and chain.joint_is_revolute[path[0]]:
        return _around_one(chain, joint, solid, path[0], after)
    # In general: the distance from the axis is at most that from a point on it, over all links between.
    reach = np.linalg.norm(solid.T[:3, 3]) + solid.bounding_radius
    steps = [*path, joint] if not after else path
    return float(
        reach + sum(np.linalg.norm(chain.T_joint[k][:3, 3]) for k in steps) + sum(_slide(chain, k) for k in path)
    )


def _around_one(chain: Chain, joint: int, solid: Solid, other: int, after: bool) -> float:
    """The same where one joint that turns lies between: measured all round, and what lies between two steps added."""
    source = chain.joint_source[other]
    low, high = chain.lower_limits[source], chain.upper_limits[source]
    moved = chain.joint_scale[other] * np.linspace(low, high, STEPS) + chain.joint_offset[other]
    turn = np.tile(np.eye(4), (STEPS, 1, 1))
    turn[:, 0, 0] = turn[:, 1, 1] = np.cos(moved)
    turn[:, 1, 0] = np.sin(moved)
    turn[:, 0, 1] = -turn[:, 1, 0]
    if after:
        T = chain.T_joint[other] @ turn @ solid.T
        own = _from_axis(solid.T[None], solid)
    else:
        T = np.linalg.inv(chain.T_joint[joint]) @ np.linalg.inv(turn) @ np.linalg.inv(chain.T_joint[other]) @ solid.T
        own = _from_axis((np.linalg.inv(chain.T_joint[other]) @ solid.T)[None], solid)
    return _from_axis(T, solid) + own * float(np.ptp(moved)) / (STEPS - 1)


def _from_axis(T: np.ndarray, solid: Solid) -> float:
    """Largest distance of a solid's points from the z axis over its frames (N, 4, 4) [m]."""
    if not np.isfinite(solid.bounding_radius):
        return np.inf
    if solid.kind == "ellipsoid":
        return float(np.linalg.norm(T[:, :2, 3], axis=1).max()) + solid.bounding_radius
    points = T[:, :3, :3] @ solid.points.T + T[:, :3, 3:]
    return float(np.hypot(points[:, 0], points[:, 1]).max()) + solid.radius + solid.disc


def _slide(chain: Chain, joint: int) -> float:
    """How far a joint slides at most [m]."""
    if chain.joint_is_revolute[joint]:
        return 0.0
    source = chain.joint_source[joint]
    ends = np.array([chain.lower_limits[source], chain.upper_limits[source]])
    return float(np.abs(chain.joint_scale[joint] * ends + chain.joint_offset[joint]).max())
