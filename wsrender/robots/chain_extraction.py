"""From a compiled MuJoCo model to the Chain between a base and a tip."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from difflib import get_close_matches

import mujoco
import numpy as np

from wsrender.errors import InputError, ModelError
from wsrender.notices import Notice
from wsrender.robots import branches, frames
from wsrender.robots.body_extraction import BodySource
from wsrender.robots.chain import Chain
from wsrender.robots.chain_links import Geometry, carriers, is_hinge, links_of
from wsrender.robots.compiled_model import CompiledModel
from wsrender.robots.couplings import Couplings, refuse_loops
from wsrender.robots.frames import Frame
from wsrender.robots.gripper_tip import gripper_notices
from wsrender.robots.inertials import MASSLESS
from wsrender.robots.limits import Drive, coordinate_limits, effort_limits, joint_name, velocity_limits
from wsrender.robots.loaded_robot import LoadedRobot

MAX_JOINTS = 16
MOST_NOTED = 4  # faults that one notice tells
LARGEST_NUMBER = 1e9  # of metres, radians, kilograms: beyond it, products overflow single precision


@dataclass(frozen=True)
class Given:
    """What goes before the model's numbers, by joint: limits [rad or m], efforts [N m or N], speeds [rad/s or m/s].

    ``reference``: where joints beside the chain stand [rad or m].
    """

    limits: Mapping[str, tuple[float, float]]
    efforts: Mapping[str, float]
    velocities: Mapping[str, float]
    reference: Mapping[str, float]


def extract(
    compiled: CompiledModel, base: str | None, tip: str | None, name: str, source_hash: str, given: Given, field: str
) -> LoadedRobot:
    """The robot between the frames ``base`` and ``tip`` (see ``frames.choose``) of a compiled model.

    The chain is read from MuJoCo's own kinematics with its joints at ``qpos0``; everything else is held at its
    reference, or at ``qpos0`` too, followers where their leaders put them, and its mass belongs to the joint that
    carries it. Joints held by a coupling become part of the fixed links; a leader on another branch is a coordinate,
    and what follows a coordinate there moves its bodies.
    Raises ModelError, InputError for a reference of what does not stand still, or efforts and speeds of what does.
    """
    model, limits = compiled.model, given.limits
    base_frame, tip_frame = frames.choose(model, base, tip)
    bodies = _bodies_between(model, base_frame, tip_frame)
    _refuse_faults(compiled, bodies, limits, base_frame, tip_frame, field)
    couplings = Couplings(model, field)
    leaders, drives = _drives(model, bodies, couplings, field)
    aside = branches.leaders_aside(model, leaders, drives)
    _refuse_leaders(compiled, aside, limits, field)
    met = [*bodies, *(int(model.jnt_bodyid[drive.joint]) for drive in aside)]
    carrier = carriers(model, [drive.joint for drive in (*drives, *branches.moving_bodies(model, aside, base_frame))])
    refuse_loops(model, carrier, field)
    following, still = _followers_aside(compiled, couplings, leaders, drives, limits)
    moving = [*drives, *branches.moving_bodies(model, [*aside, *following], base_frame)]
    carrier = carriers(model, [drive.joint for drive in moving])
    for body, fault in compiled.inertia_faults.items():
        if carrier[body] >= 0:
            raise ModelError(field, fault)
    qpos = couplings.reference_qpos(_off_chain(model, couplings, leaders, drives, given.reference))
    geometry = Geometry.at_reference(model, moving, qpos, base_frame, tip_frame)
    driven, n = [*drives, *aside, *following], len(leaders)
    _refuse_unknown(model, driven, given)
    lower, upper, periodic, notices = coordinate_limits(model, [*drives, *aside], leaders, limits, field)
    names = tuple(joint_name(model, leader) for leader in leaders)
    chain = Chain(
        name=name, base_frame=base_frame.name, tip_frame=tip_frame.name, joint_names=names,
        lower_limits=lower, upper_limits=upper, periodic=periodic,
        efforts=effort_limits(model, driven, n, given.efforts),
        velocity_limits=velocity_limits(model, driven, n, compiled.velocity_limits, given.velocities),
        has_inertia=_has_inertia(model, carrier),
        leader_is_revolute=np.array([is_hinge(model, leader) for leader in leaders]),
        **links_of(model, geometry, [(drive, 1) for drive in drives]),
    )  # fmt: skip
    if len(moving) > len(drives) and chain.has_inertia:
        order = branches.serial_order(model, [drive.joint for drive in moving], len(drives))
        links = links_of(model, geometry, [(moving[number], sign) for number, sign in order])
        chain = replace(chain, with_branches=replace(chain, **links))
    _check(chain.dynamic, field)
    joints, dofs = (addresses[[drive.joint for drive in drives]] for addresses in (model.jnt_qposadr, model.jnt_dofadr))
    return LoadedRobot(
        model, chain, source_hash, joints, dofs, qpos,
        notices=(
            *compiled.notices, *_limit_notices(compiled, limits), *_notes_off_chain(compiled, met),
            *notices, *still, *(gripper_notices(model, tip_frame, drives) if tip is None else ()),
        ),
        gravity=compiled.gravity,
        aside=(*aside, *following),
        branches=tuple(moving[len(drives) :]),
        body_source=BodySource(
            compiled.with_geometry, chain, base_frame, tip_frame, couplings, qpos, leaders, drives, aside, field
        ),
    )  # fmt: skip


def _refuse_unknown(model: mujoco.MjModel, driven: list[Drive], given: Given) -> None:
    """Raises InputError for efforts and speeds of what no coordinate of the chain moves."""
    known = list(dict.fromkeys(joint_name(model, drive.joint) for drive in driven))
    for field, values in (("effort_limits", given.efforts), ("velocity_limits", given.velocities)):
        for name in values:
            if name not in known:
                raise InputError(f"{field}.{name}", f"is no joint of the chain; allowed: {', '.join(known)}")


def _off_chain(
    model: mujoco.MjModel, couplings: Couplings, leaders: list[int], drives: list[Drive], reference: Mapping[str, float]
) -> dict[int, float]:
    """The joints of a reference, and their values [rad or m].

    Raises InputError for one that moves, follows another, is no hinge or slide, or that the model does not have.
    """
    moving = {*leaders, *(drive.joint for drive in drives)}
    kinds = (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE)
    single = [joint for joint in range(model.njnt) if mujoco.mjtJoint(model.jnt_type[joint]) in kinds]
    free = {joint_name(model, joint): joint for joint in single if couplings.leader(joint) == joint}
    known = {name: joint for name, joint in free.items() if joint not in moving}
    for name in reference:
        if name not in known:
            hint = get_close_matches(name, known, n=1)
            allowed = f"did you mean {hint[0]!r}?" if hint else f"allowed: {', '.join(known) or 'none'}"
            raise InputError(f"reference.{name}", f"is no joint that stands still beside the chain; {allowed}")
    return {known[name]: value for name, value in reference.items()}


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


def _followers_aside(
    compiled: CompiledModel,
    couplings: Couplings,
    leaders: list[int],
    drives: list[Drive],
    limits: Mapping[str, tuple[float, float]],
) -> tuple[list[Drive], tuple[Notice, ...]]:
    """Joints off the path that follow a coordinate and can be known to, and that others stand still."""
    found, refused = branches.followers_aside(compiled.model, couplings, leaders, drives)
    can = [drive for drive in found if not _fault(compiled, int(compiled.model.jnt_bodyid[drive.joint]), limits)]
    if not refused:
        return can, ()
    told = f"{_some([error.message for error in refused])}; off it, what they carry stands still"
    return can, (Notice("followers_off_chain", told, "make them linear if they carry much", "robot"),)


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
    return [Notice("joints_off_chain", f"off the chain, where it stands still: {_some(faults)}")]


def _some(told: list[str]) -> str:
    more = f", and {len(told) - MOST_NOTED} more" if len(told) > MOST_NOTED else ""
    return "; ".join(told[:MOST_NOTED]) + more


def _limit_notices(compiled: CompiledModel, limits: Mapping[str, tuple[float, float]]) -> list[Notice]:
    if not (names := [name for name in compiled.unset_limits if name not in limits]):
        return []
    message = f"the limits of {', '.join(names)} are both 0, which leaves no motion; taken as no limits"
    return [Notice("limits_unset", message, "limits give them a range", "robot.limits")]


def _has_inertia(model: mujoco.MjModel, carrier: np.ndarray) -> bool:
    carried = carrier >= 0
    return bool((model.body_mass[carried] > MASSLESS).any() or (model.body_inertia[carried] > MASSLESS).any())


def _check(chain: Chain, field: str) -> None:
    for name in ("T_joint", "T_tip", "mass", "center_of_mass", "inertia", "armature", "joint_offset"):
        if not (np.abs(getattr(chain, name)) <= LARGEST_NUMBER).all():
            raise ModelError(field, f"the model's numbers are too large: {name} is beyond {LARGEST_NUMBER:g}")
