"""Links of a serial chain: where its joints stand in a model, and what moves with each."""

import copy
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from wsrender.robots import frames
from wsrender.robots.frames import Frame, joints_of, transform
from wsrender.robots.inertials import MASSLESS
from wsrender.robots.kinematics import FAR
from wsrender.robots.limits import Drive
from wsrender.robots.small_matrices import applied, product


def carriers(model: mujoco.MjModel, joints: list[int]) -> np.ndarray:
    """Number of the moving joint that carries each body, −1 for the base, (nbody,)."""
    carrier = np.full(model.nbody, -1)
    for body in range(1, model.nbody):
        carrier[body] = carrier[model.body_parentid[body]]
        for joint in frames.joints_of(model, body):
            carrier[body] = joints.index(joint) if joint in joints else carrier[body]
    return carrier


@dataclass(frozen=True)
class Geometry:
    """Places of everything with the moving joints at ``qpos0``: all, the base (4, 4), the tip (4, 4).

    They are in the world, or where the first joint is far from its origin, in axes through that: differences of large
    numbers would lose digits of the links.
    """

    data: mujoco.MjData
    base: np.ndarray
    tip: np.ndarray

    @classmethod
    def at_reference(
        cls, model: mujoco.MjModel, drives: list[Drive], reference: np.ndarray, base: Frame, tip: Frame
    ) -> "Geometry":
        """Of a model with ``drives`` at ``qpos0``, and all else at its ``reference`` (nq,)."""
        data = mujoco.MjData(model)
        data.qpos[:] = reference
        moving = model.jnt_qposadr[[drive.joint for drive in drives]]
        data.qpos[moving] = model.qpos0[moving]
        mujoco.mj_kinematics(model, data)
        anchors = data.xanchor[[drive.joint for drive in drives]]
        size = max(np.ptp(anchors, axis=0).max(), np.abs(tip.pose(data)[:3, 3] - anchors[0]).max())
        T_base = base.pose(data)
        if np.abs(anchors[0]).max() > FAR * size:
            model, data = _moved(model, data, -anchors[0])
            mujoco.mj_kinematics(model, data)
            T_base = base.pose(data) if base.body else transform(T_base[:3, 3] - anchors[0], T_base[:3, :3])
        return cls(data, T_base, tip.pose(data))


def _moved(model: mujoco.MjModel, data: mujoco.MjData, by: np.ndarray) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Copies with everything but sites that are fixed to the world itself moved ``by`` (3,) [m]."""
    model, data = copy.copy(model), copy.copy(data)
    model.geom_pos[model.geom_bodyid == 0] += by
    for body in np.flatnonzero(model.body_parentid == 0)[1:]:
        joints = joints_of(model, body)
        if len(joints) and model.jnt_type[joints[0]] == mujoco.mjtJoint.mjJNT_FREE:
            at = model.jnt_qposadr[joints[0]]
            data.qpos[at : at + 3] += by
        model.body_pos[body] += by
        if model.body_mocapid[body] >= 0:
            data.mocap_pos[model.body_mocapid[body]] += by
    return model, data


def links_of(model: mujoco.MjModel, geometry: Geometry, joints: list[tuple[Drive, int]]) -> dict[str, Any]:
    """The fields of a Chain that have an entry for each of its joints, and ``T_tip``.

    Joints with sign −1 undo the motion of what they name, and carry nothing themselves.
    """
    drives, signs = [drive for drive, _ in joints], np.array([sign for _, sign in joints])
    carrier = carriers(model, [drive.joint if sign > 0 else -1 for drive, sign in joints])
    joint = np.array([joint_frame(model, geometry.data, drive.joint) for drive in drives])
    before = np.concatenate([geometry.base[None], joint[:-1]])
    mass, center, inertia = _composite(model, geometry.data, joint, carrier)
    armature = model.dof_armature[model.jnt_dofadr[[drive.joint for drive in drives]]]
    return {
        "joint_is_revolute": np.array([is_hinge(model, drive.joint) for drive in drives]),
        "joint_source": np.array([drive.source for drive in drives]),
        "joint_scale": signs * [drive.scale for drive in drives],
        "joint_offset": signs * [drive.offset for drive in drives],
        "T_joint": np.array([product(inverse(T), T_next) for T, T_next in zip(before, joint, strict=True)]),
        "T_tip": product(inverse(joint[-1]), geometry.tip),
        "mass": mass,
        "center_of_mass": center,
        "inertia": inertia,
        "armature": np.where(signs > 0, armature, 0.0),
    }


def joint_frame(model: mujoco.MjModel, data: mujoco.MjData, joint: int) -> np.ndarray:
    """World frame on the joint's anchor: its body's axes, turned the shortest way to make z the axis."""
    rotation = data.xmat[model.jnt_bodyid[joint]].reshape(3, 3)
    return transform(data.xanchor[joint], product(rotation, _turn_z_to(applied(rotation.T, data.xaxis[joint]))))


def _turn_z_to(axis: np.ndarray) -> np.ndarray:
    """Rotation (3, 3) the shortest way from z to a unit ``axis``: 1 + K + K²/(1 + cos), K = [z × axis]."""
    x, y, z = axis
    if z < -0.5:  # half a turn about x first keeps the denominator away from 0
        half_turn = np.diag([1.0, -1.0, -1.0])
        return product(half_turn, _turn_z_to(applied(half_turn, axis)))
    K = np.array([[0.0, 0.0, x], [0.0, 0.0, y], [-x, -y, 0.0]])
    return np.eye(3) + K + product(K, K) / (1.0 + z)


def inverse(T: np.ndarray) -> np.ndarray:
    """Inverse of a rigid transform (4, 4)."""
    R = T[:3, :3].T
    return transform(-applied(R, T[:3, 3]), R)


def is_hinge(model: mujoco.MjModel, joint: int) -> bool:
    """Whether a joint turns about an axis."""
    return model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE


def _composite(
    model: mujoco.MjModel, data: mujoco.MjData, joint: np.ndarray, carrier: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mass (L,), centre of mass (L, 3) and inertia about it (L, 3, 3) of what each joint (L, 4, 4) carries."""
    count = len(joint)
    mass, center, inertia = np.zeros(count), np.zeros((count, 3)), np.zeros((count, 3, 3))
    for link, T in enumerate(joint):
        bodies = np.flatnonzero(carrier == link)
        stated = _rigid_sum(model, data, bodies, T, MASSLESS)
        # The negligible values that MuJoCo needs stay only where nothing else keeps M(q) regular.
        regular = np.linalg.eigvalsh(stated[2])[0] > MASSLESS
        mass[link], center[link], inertia[link] = stated if regular else _rigid_sum(model, data, bodies, T, 0.0)
    return mass, center, inertia


def _rigid_sum(
    model: mujoco.MjModel, data: mujoco.MjData, bodies: np.ndarray, T: np.ndarray, floor: float
) -> tuple[float, np.ndarray, np.ndarray]:
    """Mass, centre of mass (3,) and inertia about it (3, 3) of ``bodies`` in the frame ``T`` (4, 4).

    Masses [kg] and moments [kg m²] up to ``floor`` count as 0.
    """
    m, moments = model.body_mass[bodies], model.body_inertia[bodies]
    m, moments = np.where(m > floor, m, 0.0), np.where(moments > floor, moments, 0.0)
    R = product(T[:3, :3].T, data.ximat[bodies].reshape(-1, 3, 3))
    at = applied(T[:3, :3].T, data.xipos[bodies] - T[:3, 3])
    mass = float(m.sum())
    center = applied(at.T, m) / mass if mass > 0.0 else np.zeros(3)
    about_own = np.einsum("bij,bj,bkj->ik", R, moments, R)
    d = at - center
    # parallel axes (Huygens–Steiner): Σ m (|d|² 1 − d dᵀ)
    moved = np.einsum("b,bi,bi->", m, d, d) * np.eye(3) - np.einsum("b,bi,bj->ij", m, d, d)
    return mass, center, about_own + moved
