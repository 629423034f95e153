"""Torques against gravity and inertia matrices of a chain, by the host in float64."""

import numpy as np

from wsrender.robots.chain import Chain


def gravity_torques(chain: Chain, q: np.ndarray, gravity: np.ndarray) -> np.ndarray:
    """Torques and forces (N, n) [N m or N] that hold the arm at ``q`` (N, n).

    In ``gravity`` [m/s²] along world axes, (3,), or (N, 3) of each.
    """
    gravity = gravity[..., None, :]
    T = chain.frames(q)[:, :-1]
    axes, origins, centers = T[..., :3, 2], T[..., :3, 3], _centers(chain, T)
    beyond = np.cumsum(chain.mass[::-1])[::-1]
    moments = np.cumsum((chain.mass[:, None] * centers)[:, ::-1], axis=1)[:, ::-1]  # about the world's origin
    turning = np.cross(moments - beyond[:, None] * origins, gravity)
    pulls = np.where(chain.joint_is_revolute[:, None], turning, beyond[:, None] * gravity)
    return -(axes * pulls).sum(axis=2) @ chain.coupling


def inertia_matrices(chain: Chain, q: np.ndarray) -> np.ndarray:
    """Joint-space inertia matrices (N, n, n) at ``q`` (N, n): the kinetic energy of every body, and armatures."""
    T = chain.frames(q)[:, :-1]
    axes, origins, centers = T[..., :3, 2], T[..., :3, 3], _centers(chain, T)
    R, L = T[..., :3, :3], len(chain.mass)
    turns = chain.joint_is_revolute[:, None]
    moved = np.tri(L)[:, :, None]  # body k by joints up to k
    arms = centers[:, :, None] - origins[:, None]
    linear = np.where(turns, np.cross(axes[:, None], arms), axes[:, None]) * moved
    angular = np.where(turns, axes, 0.0)[:, None] * moved
    about = R @ chain.inertia @ R.swapaxes(-1, -2)
    M = np.einsum("k,nkir,nkjr->nij", chain.mass, linear, linear)
    M += np.einsum("nkrs,nkir,nkjs->nij", about, angular, angular) + np.diag(chain.armature)
    return chain.coupling.T @ M @ chain.coupling


def _centers(chain: Chain, T: np.ndarray) -> np.ndarray:
    """Centres of mass of the bodies in the world, (N, L, 3) [m]."""
    return T[..., :3, 3] + np.einsum("nkrs,ks->nkr", T[..., :3, :3], chain.center_of_mass)
