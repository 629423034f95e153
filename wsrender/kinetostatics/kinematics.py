"""Position and Jacobian of one posture in a few microseconds, by MuJoCo, for loops of a kilohertz.

Here, and in what else such a loop evaluates, ``A.dot(b)`` stands for ``A @ b``: of matrices this small it takes half
the time.
"""

from dataclasses import dataclass

import mujoco
import numpy as np

from wsrender.robot import Robot, robot_with_model
from wsrender.robots import frames
from wsrender.robots.plausibility import need_ranges
from wsrender.short_repr import short_repr


@dataclass(eq=False, slots=True)
class Posture:
    """A configuration ``q`` (n,), and in the world frame: tip ``position`` (3,) [m], ``rotation`` (3, 3).

    ``J`` (6, n) is the geometric Jacobian, rows linear then angular; ``columns`` (6, L) that of the L joints, of which
    coupled ones share a coordinate.
    """

    q: np.ndarray
    position: np.ndarray
    rotation: np.ndarray
    J: np.ndarray
    columns: np.ndarray

    __repr__ = short_repr


class PostureKinematics:
    """Float64 kinematics of a robot's model, one posture at a time.

    Raises InputError for a user-defined robot, and for one whose joints have no usable limits.
    """

    def __init__(self, robot: Robot):
        loaded = robot_with_model(robot)._loaded
        self.chain = chain = loaded.chain
        self._model, self._data = loaded.model, mujoco.MjData(loaded.model)
        base, tip = frames.choose(loaded.model, robot.base, robot.tip)
        need_ranges(chain, "robot.limits")
        loaded.set_configuration(self._data, chain.within(0.5))  # what is off the chain stays where it is now
        mujoco.mj_kinematics(self._model, self._data)
        T_world_model = chain.T_world_base @ np.linalg.inv(base.pose(self._data))
        self._R_world, self._p_world = np.ascontiguousarray(T_world_model[:3, :3]), T_world_model[:3, 3].copy()
        self._turn = np.kron(np.eye(2), self._R_world)  # of linear and angular rows
        self._upright = bool(np.array_equal(self._R_world, np.eye(3)))
        local = np.linalg.inv(_body_pose(self._data, tip.body)) @ tip.pose(self._data) @ chain.T_tip_tool
        self._tip_body, self._tip = tip.body, np.hstack([local[:3, 3:], local[:3, :3]])
        self._body_position, self._body_rotation = self._data.xpos[tip.body], self._data.xmat[tip.body].reshape(3, 3)
        self._qpos, self._addresses = self._data.qpos, _run(loaded.qpos_addresses)
        self._zero = loaded.model.qpos0[loaded.qpos_addresses] + chain.joint_offset
        self._dofs, self._shape = _run(loaded.dof_addresses), (6, loaded.model.nv)
        self.coupling = None if np.array_equal(loaded.coupling, np.eye(chain.n)) else loaded.coupling
        """Displacements of the L joints by the n coordinates, (L, n); None: they are the same."""

    def at(self, q: np.ndarray) -> Posture:
        """The posture of a configuration (n,) of finite numbers [rad or m]."""
        model, data, coupling = self._model, self._data, self.coupling
        self._qpos[self._addresses] = (q if coupling is None else coupling @ q) + self._zero
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)  # mj_jac needs it
        columns = np.empty(self._shape)
        tip = self._body_rotation.dot(self._tip)
        position, rotation = tip[:, 0] + self._body_position, tip[:, 1:]
        mujoco.mj_jac(model, data, columns[:3], columns[3:], position, self._tip_body)
        columns = columns[:, self._dofs]
        if not self._upright:
            columns, rotation = self._turn @ columns, self._R_world @ rotation
            position = self._R_world @ position
        position += self._p_world
        J = columns if coupling is None else columns @ coupling
        return Posture(q, position, rotation, J, columns)


def _run(addresses: np.ndarray) -> np.ndarray | slice:
    """Addresses as a slice where they follow each other: NumPy is quicker with it."""
    first = int(addresses[0])
    return slice(first, first + len(addresses)) if (np.diff(addresses) == 1).all() else addresses


def _body_pose(data: mujoco.MjData, body: int) -> np.ndarray:
    return frames.transform(data.xpos[body], data.xmat[body].reshape(3, 3))
