"""Kinematics and inertia of a Chain in plain NumPy: slow, obvious, float64."""

import numpy as np


def joint_frames(chain, q):
    """Frames of the joints after their motion, and of the tool, in the world: (L, 4, 4), (4, 4)."""
    T, frames = chain.T_world_base, []
    for i in range(len(chain.joint_source)):
        displacement = chain.joint_scale[i] * q[chain.joint_source[i]] + chain.joint_offset[i]
        T = T @ chain.T_joint[i] @ joint_motion(chain.joint_is_revolute[i], displacement)
        frames.append(T)
    return np.array(frames), T @ chain.T_tip @ chain.T_tip_tool


def joint_motion(revolute, displacement):
    """(4, 4) rotation about z, or translation along z, by ``displacement`` [rad or m]."""
    T = np.eye(4)
    if revolute:
        c, s = np.cos(displacement), np.sin(displacement)
        T[:2, :2] = [[c, -s], [s, c]]
    else:
        T[2, 3] = displacement
    return T


def forward_kinematics(chain, q):
    """(4, 4) pose of the tool in the world."""
    return joint_frames(chain, q)[1]


def point_jacobian(chain, frames, point, count):
    """(6, L) Jacobian of a world point carried by joint ``count - 1``: rows linear, then angular."""
    J = np.zeros((6, len(frames)))
    for i in range(count):
        axis, origin = frames[i, :3, 2], frames[i, :3, 3]
        if chain.joint_is_revolute[i]:
            J[:3, i], J[3:, i] = np.cross(axis, point - origin), axis
        else:
            J[:3, i] = axis
    return J


def coupling(chain):
    """(L, n) derivative of the joint displacements by the configuration."""
    S = np.zeros((len(chain.joint_source), chain.n))
    for i, source in enumerate(chain.joint_source):
        S[i, source] = chain.joint_scale[i]
    return S


def jacobian(chain, q):
    """(6, n) geometric Jacobian at the tool, world axes."""
    frames, T = joint_frames(chain, q)
    return point_jacobian(chain, frames, T[:3, 3], len(frames)) @ coupling(chain)


def inertia_matrix(chain, q):
    """(n, n) joint-space inertia: Σ m JᵥᵀJᵥ + JωᵀI Jω over the links, plus armature."""
    frames, _ = joint_frames(chain, q)
    M = np.diag(chain.armature).astype(float)
    for i, T in enumerate(frames):
        center = T[:3, :3] @ chain.center_of_mass[i] + T[:3, 3]
        J = point_jacobian(chain, frames, center, i + 1)
        M += chain.mass[i] * J[:3].T @ J[:3] + J[3:].T @ T[:3, :3] @ chain.inertia[i] @ T[:3, :3].T @ J[3:]
    S = coupling(chain)
    return S.T @ M @ S
