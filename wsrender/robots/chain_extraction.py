"""From a compiled MuJoCo model to the Chain between a base and a tip."""

import copy
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import mujoco
import numpy as np

from wsrender.errors import ModelError
from wsrender.notices import Notice
from wsrender.robots import branches, frames
from wsrender.robots.chain import Chain
from wsrender.robots.compiled_model import CompiledModel
from wsrender.robots.couplings import Couplings, refuse_loops
from wsrender.robots.frames import Frame, joints_of, transform
from wsrender.robots.gripper_tip import gripper_notices
from wsrender.robots.inertials import MASSLESS
from wsrender.robots.kinematics import FAR
from wsrender.robots.limits import Drive, coordinate_limits, effort_limits, joint_name
from wsrender.robots.loaded_robot import LoadedRobot

MAX_JOINTS = 16
MOST_NOTED = 4  # faults that one notice tells
LARGEST_NUMBER = 1e9  # of metres, radians, kilograms: beyond it, products overflow single precision


def extract(
    compiled: CompiledModel,
    base: str | None,
    tip: str | None,
    name: str,
    source_hash: str,
    limits: Mapping[str, tuple[float, float]],
    field: str,
) -> LoadedRobot:
    """The robot between the frames ``base`` and ``tip`` (see ``frames.choose``) of a compiled model.

    The chain is read from MuJoCo's own kinematics with its joints at ``qpos0``; everything else is held at
    ``qpos0`` too, followers where their leaders put them, and its mass belongs to the joint that carries
    it. Joints held by a coupling become part of the fixed links; a leader on another branch is a coordinate.
    ``limits`` of joints, by name [rad or m], go before those of the model. Raises ModelError.
    """
    model = compiled.model
    base_frame, tip_frame = frames.choose(model, base, tip)
    bodies = _bodies_between(model, base_frame, tip_frame)
    _refuse_faults(compiled, bodies, limits, base_frame, tip_frame, field)
    couplings = Couplings(model, field)
    leaders, drives = _drives(model, bodies, couplings, field)
    aside = branches.leaders_aside(model, leaders, drives)
    _refuse_leaders(compiled, aside, limits, field)
    met = [*bodies, *(int(model.jnt_bodyid[drive.joint]) for drive in aside)]
    moving = [*drives, *branches.moving_bodies(model, aside, base_frame)]
    carrier = _carriers(model, [drive.joint for drive in moving])
    refuse_loops(model, carrier, field)
    for body, fault in compiled.inertia_faults.items():
        if carrier[body] >= 0:
            raise ModelError(field, fault)
    reference = couplings.reference_qpos()
    geometry = _Geometry.at_reference(model, moving, reference, base_frame, tip_frame)
    lower, upper, periodic, notices = coordinate_limits(model, [*drives, *aside], leaders, limits, field)
    names = tuple(joint_name(model, leader) for leader in leaders)
    chain = Chain(
        name=name, base_frame=base_frame.name, tip_frame=tip_frame.name, joint_names=names,
        lower_limits=lower, upper_limits=upper, periodic=periodic,
        effort_limits=effort_limits(model, leaders), has_inertia=_has_inertia(model, carrier),
        leader_is_revolute=np.array([_is_hinge(model, leader) for leader in leaders]),
        **_links(model, geometry, [(drive, 1) for drive in drives]),
    )  # fmt: skip
    if len(moving) > len(drives) and chain.has_inertia:
        order = branches.serial_order(model, [drive.joint for drive in moving], len(drives))
        links = _links(model, geometry, [(moving[number], sign) for number, sign in order])
        chain = replace(chain, with_branches=replace(chain, **links))
    _check(chain.dynamic, field)
    qpos, dofs = (addresses[[drive.joint for drive in drives]] for addresses in (model.jnt_qposadr, model.jnt_dofadr))
    return LoadedRobot(
        model, chain, source_hash, qpos, dofs, reference,
        notices=(
            *compiled.notices, *_limit_notices(compiled, limits), *_notes_off_chain(compiled, met),
            *notices, *(gripper_notices(model, tip_frame, drives) if tip is None else ()),
        ),
        leaders=tuple((int(model.jnt_qposadr[drive.joint]), drive.source) for drive in aside),
        branches=tuple((int(model.jnt_dofadr[drive.joint]), drive.source) for drive in moving[len(drives) :]),
    )  # fmt: skip


def _bodies_between(model: mujoco.MjModel, base: Frame, tip: Frame) -> list[int]:
    """Bodies of the path below the base body, the tip's body included."""
    path = frames.path(model, tip.body)
    return path[path.index(base.body) + 1 :]


def _refuse_faults(
    compiled: CompiledModel,
    bodies: list[int],
    limits: Mapping[str, tuple[float, float]],
    base: Frame,
    tip: Frame,
    field: str,
) -> None:
    model = compiled.model
    for body in bodies:
        if fault := _fault(compiled, body, limits):
            raise ModelError(field, fault)
        for joint in frames.joints_of(model, body):
            kind = {mujoco.mjtJoint.mjJNT_FREE: "free", mujoco.mjtJoint.mjJNT_BALL: "ball"}
            if word := kind.get(mujoco.mjtJoint(model.jnt_type[joint])):
                raise ModelError(
                    field,
                    f"{joint_name(model, joint)!r} is a {word} joint on the chain from {base.name!r} to "
                    f"{tip.name!r}; only hinges and slides are supported: name a base below it"
                    + (f", such as {name!r}" if (name := model.body(body).name) else ""),
                )
    joints = [joint for body in bodies for joint in frames.joints_of(model, body)]
    if not joints:
        raise ModelError(field, f"there is no joint between base {base.name!r} and tip {tip.name!r}")
    if len(joints) > MAX_JOINTS:
        raise ModelError(
            field,
            f"{len(joints)} joints lie between base {base.name!r} and tip {tip.name!r}; at most {MAX_JOINTS} "
            "are supported",
        )


def _drives(
    model: mujoco.MjModel, bodies: list[int], couplings: Couplings, field: str
) -> tuple[list[int], list[Drive]]:
    """Leaders, the joints whose values are the coordinates, by what they move first, and the joints that move."""
    joints = [joint for body in bodies for joint in frames.joints_of(model, body)]
    leaders: list[int] = []
    drives = []
    for joint in joints:
        leader = couplings.leader(joint)
        if leader is None:
            continue
        scale, offset = couplings.linear(joint)
        if scale != 0.0:
            leaders += [leader] if leader not in leaders else []
            zero = float(model.qpos0[model.jnt_qposadr[leader]])
            drives.append(Drive(joint, leaders.index(leader), scale, offset - scale * zero))
    if not leaders:
        names = ", ".join(joint_name(model, joint) for joint in joints)
        raise ModelError(field, f"no joint of the chain is free to move: couplings hold {names}")
    return leaders, drives


def _refuse_leaders(
    compiled: CompiledModel, aside: list[Drive], limits: Mapping[str, tuple[float, float]], field: str
) -> None:
    """Raises ModelError for a leader on another branch that could not be on the chain."""
    for drive in aside:
        if fault := _fault(compiled, int(compiled.model.jnt_bodyid[drive.joint]), limits):
            raise ModelError(field, f"{fault} (it leads a joint of the chain)")


def _fault(compiled: CompiledModel, body: int, limits: Mapping[str, tuple[float, float]]) -> str:
    """What forbids a chain through the joints of a body; empty for nothing, or nothing that ``limits`` do not mend."""
    faults = [fault for fault in compiled.joint_faults if fault.body == body]
    unmended = [fault.message for fault in faults if not (fault.by_limits and fault.joint in limits)]
    return compiled.path_faults.get(body, "") or (unmended[0] if unmended else "")


def _notes_off_chain(compiled: CompiledModel, bodies: list[int]) -> list[Notice]:
    """What is wrong with joints off the chain: they stand still, so it does not matter to it."""
    faults = [fault.message for fault in compiled.joint_faults if fault.body not in bodies]
    if not faults:
        return []
    more = f", and {len(faults) - MOST_NOTED} more" if len(faults) > MOST_NOTED else ""
    return [Notice("joints_off_chain", f"off the chain, where it stands still: {'; '.join(faults[:MOST_NOTED])}{more}")]


def _limit_notices(compiled: CompiledModel, limits: Mapping[str, tuple[float, float]]) -> list[Notice]:
    if not (names := [name for name in compiled.unset_limits if name not in limits]):
        return []
    message = f"the limits of {', '.join(names)} are both 0, which leaves no motion; taken as no limits"
    return [Notice("limits_unset", message, "limits give them a range", "robot.limits")]


def _carriers(model: mujoco.MjModel, joints: list[int]) -> np.ndarray:
    """Number of the moving joint that carries each body, −1 for the base, (nbody,)."""
    carrier = np.full(model.nbody, -1)
    for body in range(1, model.nbody):
        carrier[body] = carrier[model.body_parentid[body]]
        for joint in frames.joints_of(model, body):
            carrier[body] = joints.index(joint) if joint in joints else carrier[body]
    return carrier


@dataclass(frozen=True)
class _Geometry:
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
    ) -> "_Geometry":
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
    """Copies with everything but what is fixed to the world itself moved ``by`` (3,) [m]."""
    model, data = copy.copy(model), copy.copy(data)
    for body in np.flatnonzero(model.body_parentid == 0)[1:]:
        joints = joints_of(model, body)
        if len(joints) and model.jnt_type[joints[0]] == mujoco.mjtJoint.mjJNT_FREE:
            at = model.jnt_qposadr[joints[0]]
            data.qpos[at : at + 3] += by
        model.body_pos[body] += by
        if model.body_mocapid[body] >= 0:
            data.mocap_pos[model.body_mocapid[body]] += by
    return model, data


def _links(model: mujoco.MjModel, geometry: _Geometry, joints: list[tuple[Drive, int]]) -> dict[str, Any]:
    """The fields of a Chain that have an entry for each of its joints, and ``T_tip``.

    Joints with sign −1 undo the motion of what they name, and carry nothing themselves.
    """
    drives, signs = [drive for drive, _ in joints], np.array([sign for _, sign in joints])
    carrier = _carriers(model, [drive.joint if sign > 0 else -1 for drive, sign in joints])
    joint = np.array([_joint_frame(model, geometry.data, drive.joint) for drive in drives])
    before = np.concatenate([geometry.base[None], joint[:-1]])
    mass, center, inertia = _composite(model, geometry.data, joint, carrier)
    armature = model.dof_armature[model.jnt_dofadr[[drive.joint for drive in drives]]]
    return {
        "joint_is_revolute": np.array([_is_hinge(model, drive.joint) for drive in drives]),
        "joint_source": np.array([drive.source for drive in drives]),
        "joint_scale": signs * [drive.scale for drive in drives],
        "joint_offset": signs * [drive.offset for drive in drives],
        "T_joint": np.array([_inverse(T) @ T_next for T, T_next in zip(before, joint, strict=True)]),
        "T_tip": _inverse(joint[-1]) @ geometry.tip,
        "mass": mass,
        "center_of_mass": center,
        "inertia": inertia,
        "armature": np.where(signs > 0, armature, 0.0),
    }


def _joint_frame(model: mujoco.MjModel, data: mujoco.MjData, joint: int) -> np.ndarray:
    """World frame on the joint's anchor: its body's axes, turned the shortest way to make z the axis."""
    rotation = data.xmat[model.jnt_bodyid[joint]].reshape(3, 3)
    return transform(data.xanchor[joint], rotation @ _turn_z_to(rotation.T @ data.xaxis[joint]))


def _turn_z_to(axis: np.ndarray) -> np.ndarray:
    """Rotation (3, 3) the shortest way from z to a unit ``axis``: 1 + K + K²/(1 + cos), K = [z × axis]."""
    x, y, z = axis
    if z < -0.5:  # half a turn about x first keeps the denominator away from 0
        half_turn = np.diag([1.0, -1.0, -1.0])
        return half_turn @ _turn_z_to(half_turn @ axis)
    K = np.array([[0.0, 0.0, x], [0.0, 0.0, y], [-x, -y, 0.0]])
    return np.eye(3) + K + K @ K / (1.0 + z)


def _inverse(T: np.ndarray) -> np.ndarray:
    R = T[:3, :3].T
    return transform(-R @ T[:3, 3], R)


def _is_hinge(model: mujoco.MjModel, joint: int) -> bool:
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
    R = T[:3, :3].T @ data.ximat[bodies].reshape(-1, 3, 3)
    at = (data.xipos[bodies] - T[:3, 3]) @ T[:3, :3]
    mass = float(m.sum())
    center = m @ at / mass if mass > 0.0 else np.zeros(3)
    about_own = np.einsum("bij,bj,bkj->ik", R, moments, R)
    d = at - center
    # parallel axes (Huygens–Steiner): Σ m (|d|² 1 − d dᵀ)
    moved = np.einsum("b,bi,bi->", m, d, d) * np.eye(3) - np.einsum("b,bi,bj->ij", m, d, d)
    return mass, center, about_own + moved


def _has_inertia(model: mujoco.MjModel, carrier: np.ndarray) -> bool:
    carried = carrier >= 0
    return bool((model.body_mass[carried] > MASSLESS).any() or (model.body_inertia[carried] > MASSLESS).any())


def _check(chain: Chain, field: str) -> None:
    for name in ("T_joint", "T_tip", "mass", "center_of_mass", "inertia", "armature", "joint_offset"):
        if not (np.abs(getattr(chain, name)) <= LARGEST_NUMBER).all():
            raise ModelError(field, f"the model's numbers are too large: {name} is beyond {LARGEST_NUMBER:g}")
