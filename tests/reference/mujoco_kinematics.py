"""Kinematics and inertia from MuJoCo's own functions, on a model compiled from the untouched source."""

import mujoco
import numpy as np


def at(model, displacements):
    """MjData of a model with the named joints at the given values, the others at ``qpos0``."""
    data = mujoco.MjData(model)
    for name, value in displacements.items():
        data.qpos[model.joint(name).qposadr[0]] = value
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_crb(model, data)
    return data


def pose(model, data, frame):
    """(4, 4) world pose of a site or body."""
    T = np.eye(4)
    site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, frame)
    item = data.site(frame) if site >= 0 else data.body(frame)
    T[:3, :3], T[:3, 3] = item.xmat.reshape(3, 3), item.xpos
    return T


def dofs(model, joints):
    """Addresses of the named joints among the degrees of freedom."""
    return [int(model.joint(name).dofadr[0]) for name in joints]


def jacobian(model, data, frame, joints):
    """(6, len(joints)) Jacobian of a site or body frame: rows linear, then angular, world axes."""
    J = np.zeros((6, model.nv))
    site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, frame)
    body = model.site_bodyid[site] if site >= 0 else model.body(frame).id
    mujoco.mj_jac(model, data, J[:3], J[3:], pose(model, data, frame)[:3, 3], body)
    return J[:, dofs(model, joints)]


def inertia_matrix(model, data, joints):
    """(len(joints),) * 2 joint-space inertia, armature included."""
    M = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, M)
    return M[np.ix_(dofs(model, joints), dofs(model, joints))]
