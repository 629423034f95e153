"""Joints off the path from base to tip that move with coordinates of the chain: leaders, and what follows.

They move no frame of the path, but bodies of their own, which the inertia matrix counts: M(q) = Cᵀ M_joints C over the
joints of the path and these. A serial chain has the same M with every one as a joint where it stands on the tree, and
after it and those that it carries a joint without mass that undoes its motion.
"""

from collections.abc import Iterator, Sequence

import mujoco

from wsrender.errors import ModelError
from wsrender.robots import frames
from wsrender.robots.couplings import Couplings
from wsrender.robots.frames import Frame
from wsrender.robots.limits import Drive


def leaders_aside(model: mujoco.MjModel, leaders: list[int], drives: list[Drive]) -> list[Drive]:
    """The leaders that are no joints of the path, each moving by its own coordinate."""
    on_path = {drive.joint for drive in drives}
    zeros = [float(model.qpos0[model.jnt_qposadr[leader]]) for leader in leaders]
    return [Drive(leader, k, 1.0, -zeros[k]) for k, leader in enumerate(leaders) if leader not in on_path]


def moving_bodies(model: mujoco.MjModel, aside: list[Drive], base: Frame) -> list[Drive]:
    """Those that move a body against the base: one that carries the base moves none."""
    above = {joint for body in frames.path(model, base.body) for joint in frames.joints_of(model, body)}
    return [drive for drive in aside if drive.joint not in above]


def followers_aside(
    model: mujoco.MjModel, couplings: Couplings, leaders: list[int], drives: list[Drive]
) -> tuple[list[Drive], list[ModelError]]:
    """The joints off the path that follow a coordinate of the chain; for those not linear in it why they cannot."""
    known = {*leaders, *(drive.joint for drive in drives)}
    followers, refused = [], []
    for joint in range(model.njnt):
        leader = couplings.leader(joint)
        if joint in known or leader not in leaders:
            continue
        try:
            scale, offset = couplings.linear(joint)
        except ModelError as error:
            refused.append(error)
            continue
        if scale != 0.0:
            zero = float(model.qpos0[model.jnt_qposadr[leader]])
            followers.append(Drive(joint, leaders.index(leader), scale, offset - scale * zero))
    return followers, refused


def serial_order(model: mujoco.MjModel, joints: Sequence[int], path: int) -> list[tuple[int, int]]:
    """(number, 1) of a joint and (number, −1) of what undoes it, in the order of the serial chain.

    ``joints``: those of the path, ``path`` of them from base to tip, then those aside.
    """
    children: dict[int, list[int]] = {}
    for number in range(path, len(joints)):
        children.setdefault(_carrier(model, joints, joints[number]), []).append(number)

    def branches(carrier: int) -> Iterator[tuple[int, int]]:
        for number in children.get(carrier, ()):
            yield number, 1
            yield from branches(number)
            yield number, -1

    order = [*branches(-1)]
    for number in range(path):
        order += [(number, 1), *branches(number)]
    return order


def _carrier(model: mujoco.MjModel, joints: Sequence[int], joint: int) -> int:
    """Number of the joint that moves ``joint`` itself, −1 for none."""
    body = int(model.jnt_bodyid[joint])
    before = [*frames.joints_of(model, body)]
    before = before[: before.index(joint)]
    while True:
        for other in reversed(before):
            if other in joints:
                return joints.index(other)
        if not body:
            return -1
        body = int(model.body_parentid[body])
        before = [*frames.joints_of(model, body)]
