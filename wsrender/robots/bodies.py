"""Bodies of a robot: its shapes in the frames of a chain, and which of them may collide."""

from dataclasses import dataclass, field, replace

import mujoco
import numpy as np

from wsrender.notices import Notice
from wsrender.robots.chain import Chain
from wsrender.robots.shapes import Shape
from wsrender.short_repr import short_repr


@dataclass(frozen=True, eq=False)
class Bodies:
    """Shapes of a robot, the chain in whose frames they stand, and the model with them.

    ``chain`` has the coordinates of the robot's own. Where leaders or followers on other branches move bodies, it has
    their joints too, each undone after what it carries: see `Chain.dynamic`. ``pairs`` (P, 2) int are places in
    ``shapes`` of two that may collide, within the robot: shapes of the world of the model's file are its surroundings,
    in no pair but those of ``around`` (A, 2). Off the chain, everything is at its reference. ``tip``: the model's body
    that carries the end effector.
    """

    model: mujoco.MjModel
    chain: Chain
    shapes: tuple[Shape, ...]
    pairs: np.ndarray
    reference_qpos: np.ndarray  # (nq,) [rad or m]
    addresses: np.ndarray  # (L,) int: where ``qpos`` has each joint of the chain, -1 for one that undoes another
    notices: tuple[Notice, ...] = ()
    around: np.ndarray = field(default_factory=lambda: np.zeros((0, 2), int))
    tip: int = 0

    __repr__ = short_repr

    def placed_as(self, chain: Chain) -> "Bodies":
        """The same, its base, tool and limits those of another copy of the robot's chain."""
        names = ("lower_limits", "upper_limits", "periodic", "T_world_base", "T_tip_tool")
        return replace(self, chain=replace(self.chain, **{name: getattr(chain, name) for name in names}))

    def poses(self, q: np.ndarray) -> np.ndarray:
        """Poses of the shapes in the world at ``q`` (N, n) [rad or m], (N, S, 4, 4)."""
        frames = self.chain.frames(q)[:, :-1]
        base = np.broadcast_to(self.chain.T_world_base, (len(q), 1, 4, 4))
        carriers = np.concatenate([frames, base], axis=1)[:, [shape.frame for shape in self.shapes]]
        return carriers @ np.array([shape.T_frame_shape for shape in self.shapes]).reshape(-1, 4, 4)

    def qpos(self, q: np.ndarray) -> np.ndarray:
        """``MjData.qpos`` of ``model`` at ``q`` (N, n) [rad or m], (N, nq)."""
        chain, moves = self.chain, self.addresses >= 0
        qpos, addresses = np.tile(self.reference_qpos, (len(q), 1)), self.addresses[moves]
        displacement = chain.joint_scale * q[:, chain.joint_source] + chain.joint_offset
        qpos[:, addresses] = self.model.qpos0[addresses] + displacement[:, moves]
        return qpos

    def overlapping(self, q: np.ndarray) -> np.ndarray:
        """Whether two shapes of ``pairs`` overlap at ``q`` (N, n) [rad or m], (N,) bool; by MuJoCo's own pipeline."""
        data, found = mujoco.MjData(self.model), np.zeros(len(q), bool)
        geoms = [shape.geom for shape in self.shapes]
        own = {frozenset((geoms[a], geoms[b])) for a, b in self.pairs}
        for i, qpos in enumerate(self.qpos(q)):
            data.qpos[:] = qpos
            mujoco.mj_kinematics(self.model, data)
            mujoco.mj_collision(self.model, data)
            found[i] = any(contact.dist < 0 and frozenset(contact.geom.tolist()) in own for contact in data.contact)
        return found
