"""A library robot evaluated by MuJoCo alone, from its model file: nothing of wsrender but the names of its frames."""

from dataclasses import dataclass
from functools import cached_property

import mujoco
import numpy as np

from tests.reference import mujoco_kinematics


@dataclass(frozen=True, eq=False)
class References:
    """Poses (N, 4, 4), Jacobians (N, 6, n) and inertia matrices (N, n, n) of a placed robot with a tool."""

    pose: np.ndarray
    jacobian: np.ndarray
    inertia: np.ndarray


class MujocoRobot:
    """MuJoCo's model of an MJCF file, with its base placed in the world and a tool at its tip."""

    def __init__(self, path, joints, tip, placement=None, tool=None):
        self.model = mujoco.MjModel.from_xml_path(str(path))
        self.joints, self.tip = list(joints), tip
        self.placement = np.eye(4) if placement is None else placement
        self.tool = np.eye(4) if tool is None else tool

    @cached_property
    def _dofs(self):
        return mujoco_kinematics.dofs(self.model, self.joints)

    def at(self, q):
        """The references at configurations ``q`` (N, n)."""
        pose, jacobian, inertia = zip(*(self._at(row) for row in q), strict=True)
        return References(np.array(pose), np.array(jacobian), np.array(inertia))

    def _at(self, row):
        model = self.model
        data = mujoco_kinematics.at(model, dict(zip(self.joints, row, strict=True)))
        frame = mujoco_kinematics.pose(model, data, self.tip) @ self.tool
        J = np.zeros((6, model.nv))
        mujoco.mj_jac(model, data, J[:3], J[3:], frame[:3, 3], self._body)
        J = J[:, self._dofs]
        R = self.placement[:3, :3]
        J = np.concatenate([R @ J[:3], R @ J[3:]])
        return self.placement @ frame, J, mujoco_kinematics.inertia_matrix(model, data, self.joints)

    @cached_property
    def _body(self):
        site = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_SITE, self.tip)
        return self.model.site_bodyid[site] if site >= 0 else self.model.body(self.tip).id
