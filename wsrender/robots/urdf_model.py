"""URDF or SDF → MuJoCo model, link by link; MuJoCo's own URDF reader fuses, guesses and skips too much."""

import math
from collections.abc import Callable, Sequence
from functools import partial
from xml.etree.ElementTree import Element

import mujoco
import numpy as np

from wsrender.documents.robot import MountJoint
from wsrender.notices import Notice
from wsrender.robots.compiled_model import CompiledModel, JointFault, Purpose
from wsrender.robots.hulls import with_small_hulls
from wsrender.robots.inertials import compile_with_inertials
from wsrender.robots.length_unit import in_metres, to_metres
from wsrender.robots.mesh_files import ReadMesh, from_assets
from wsrender.robots.mount import BODY, add_joints
from wsrender.robots.urdf import Joint, Link, Mimic, Urdf, read_urdf
from wsrender.robots.urdf_shapes import PRIMITIVES, add_primitives, add_shapes

AddShapes = Callable[[mujoco.MjSpec, mujoco.MjsBody, Link], None]

_WORLD = "world"  # what MuJoCo calls the ground


def compile_urdf(
    robot: Element,
    read_mesh: ReadMesh | None,
    field: str,
    length_unit_m: float = 1.0,
    mount: Sequence[MountJoint] = (),
) -> CompiledModel:
    """The compiled model of a ``<robot>`` element, its lengths in ``length_unit_m``; see `compile_tree`."""
    return compile_tree(read_urdf(robot, field), read_mesh, field, length_unit_m, mount)


def compile_tree(
    urdf: Urdf,
    read_mesh: ReadMesh | None,
    field: str,
    length_unit_m: float = 1.0,
    mount: Sequence[MountJoint] = (),
) -> CompiledModel:
    """The compiled model of the links and joints of a URDF or SDF, its lengths in ``length_unit_m``.

    Every link, fixed or not, becomes a body of its name; a link "world" that is not the root is a body of another name
    with a site "world". The root link stands still in the world, or on the joints of a ``mount``. Inertia comes from
    ``<inertial>`` alone, and is left out where no joint moves a link. Primitive shapes are kept as massless geometry,
    meshes are read where shapes are asked for; without ``read_mesh`` there are none, of which there is a notice.
    Floating and planar joints are held at zero, and noted as faults of the path through them. Joints that cannot be
    read, held too, and revolute ones whose limits are missing, equal or upside down are joint faults. Limits that are
    both 0, as exporters write them where none were set, or infinite count as none. Loops are equalities, which no chain
    may lead over. Raises ModelError.
    """
    spec = _spec_of(urdf, add_primitives, bool(mount))
    to_metres(spec, length_unit_m)
    add_joints(spec, mount)
    model, inertia_faults, notices = compile_with_inertials(spec, field)
    joints = [(joint, model.body(_body_name(joint.child, urdf)).id) for joint in urdf.joints.values()]
    return CompiledModel(
        model,
        urdf.name,
        partial(_with_geometry, urdf, read_mesh or from_assets({}), field, length_unit_m, mount),
        path_faults={
            body: f"joint {joint.name!r} is {joint.kind}: name a base below it, such as {joint.child!r}"
            for joint, body in joints
            if joint.kind in ("floating", "planar")
        },
        inertia_faults=inertia_faults,
        joint_faults=tuple(fault for joint, body in joints if (fault := _fault(joint, body, urdf.joints))),
        unset_limits=tuple(j.name for j, _ in joints if j.kind == "revolute" and j.limits == (0.0, 0.0)),
        velocity_limits=in_metres(model, [0.0] * len(mount) + _velocities(urdf, model, len(mount)), length_unit_m),
        notices=notices if read_mesh else (*_dropped_meshes(urdf), *notices),
    )


def _velocities(urdf: Urdf, model: mujoco.MjModel, first: int) -> list[float]:
    return [urdf.joints[model.joint(k).name].velocity for k in range(first, model.njnt)]


def _with_geometry(
    urdf: Urdf, read_mesh: ReadMesh, field: str, length_unit_m: float, mount: Sequence[MountJoint], purpose: Purpose
) -> tuple[mujoco.MjModel, tuple[Notice, ...]]:
    """See `CompiledModel.with_geometry`. What is seen but cannot be had is left out, with one notice.

    A robot without ``<visual>`` is seen by what may collide.
    """
    missing: list[str] = []
    visuals = purpose == "visual" and any(link.visuals for link in urdf.links.values())
    which = "visuals" if visuals else "collisions"
    spec = _spec_of(urdf, partial(add_shapes, purpose, which, read_mesh, missing, field), bool(mount))
    to_metres(spec, length_unit_m)
    add_joints(spec, mount)
    model, _, _ = compile_with_inertials(spec, field)
    if purpose == "collision":
        return with_small_hulls(spec, model, field)
    said = f"{len(missing)} shapes are not drawn: {missing[0]}" if missing else ""
    return model, (Notice("meshes_missing", said),) if said else ()


def _spec_of(urdf: Urdf, add_shapes: AddShapes, carried: bool) -> mujoco.MjSpec:
    spec = mujoco.MjSpec()
    spec.modelname = urdf.name
    spec.compiler.degree = False
    spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    _add_links(spec, urdf, add_shapes, carried)
    _add_mimics(spec, urdf)
    _add_loops(spec, urdf)
    return spec


def _add_links(spec: mujoco.MjSpec, urdf: Urdf, add_shapes: AddShapes, carried: bool) -> None:
    ground = spec.worldbody.add_body(name=BODY) if carried else spec.worldbody
    bodies = {urdf.root: ground if urdf.root == _WORLD else ground.add_body(name=urdf.root)}
    standing = set() if carried else {urdf.root}  # links that no joint moves: what they weigh matters to nothing
    if carried:
        _add_inertial(bodies[urdf.root], urdf.links[urdf.root])
    add_shapes(spec, bodies[urdf.root], urdf.links[urdf.root])
    for joint in urdf.joints.values():
        body = bodies[joint.parent].add_body(
            name=_body_name(joint.child, urdf), pos=joint.pose.position, quat=joint.pose.quat_wxyz
        )
        bodies[joint.child] = body
        if joint.child == _WORLD:
            body.add_site(name=_WORLD)
        add_shapes(spec, body, urdf.links[joint.child])
        if joint.parent in standing and not joint.movable:
            standing.add(joint.child)
        else:
            _add_inertial(body, urdf.links[joint.child])
        if joint.movable:
            _add_joint(body, joint)


def _body_name(link: str, urdf: Urdf) -> str:
    """The link's own name, unless it is MuJoCo's name of the ground, which a site on the body then has."""
    name = link
    while link == _WORLD and name in urdf.links:
        name += "_"
    return name


def _add_inertial(body: mujoco.MjsBody, link: Link) -> None:
    if link.inertial is None:
        return
    xx, xy, xz, _, yy, yz, _, _, zz = link.inertial.inertia.ravel()
    body.explicitinertial = True
    body.mass, body.fullinertia = link.inertial.mass, [xx, yy, zz, xy, xz, yz]
    body.ipos, body.iquat = link.inertial.pose.position, link.inertial.pose.quat_wxyz


def _add_joint(body: mujoco.MjsBody, joint: Joint) -> None:
    slide = joint.kind == "prismatic"
    added = body.add_joint(
        name=joint.name,
        type=mujoco.mjtJoint.mjJNT_SLIDE if slide else mujoco.mjtJoint.mjJNT_HINGE,
        axis=joint.axis,
        pos=joint.anchor,
    )
    if joint.limits is not None and joint.limits[0] < joint.limits[1] and all(map(math.isfinite, joint.limits)):
        added.limited, added.range = mujoco.mjtLimited.mjLIMITED_TRUE, joint.limits
    if joint.effort > 0.0:
        added.actfrclimited = mujoco.mjtLimited.mjLIMITED_TRUE
        added.actfrcrange = (-joint.effort, joint.effort)


def _add_mimics(spec: mujoco.MjSpec, urdf: Urdf) -> None:
    for joint in urdf.joints.values():
        if joint.mimic is None or not joint.movable:
            continue
        leader = urdf.joints.get(joint.mimic.leader)
        moves = leader not in (None, joint) and leader.movable
        equality = spec.add_equality(
            type=mujoco.mjtEq.mjEQ_JOINT,
            objtype=mujoco.mjtObj.mjOBJ_JOINT,
            name1=joint.name,
            name2=joint.mimic.leader if moves else "",
        )
        data = np.zeros(len(equality.data))
        data[:2] = joint.mimic.offset, joint.mimic.multiplier
        equality.data = data


def _add_loops(spec: mujoco.MjSpec, urdf: Urdf) -> None:
    """Ties the links of each loop: by what kind of joint does not matter, as it is only to be known that they are."""
    for loop in urdf.loops:
        first, second = (_body_name(link, urdf) for link in (loop.first, loop.second))
        if first == _WORLD:
            first, second = second, first
        spec.add_equality(
            name=loop.name,
            type=mujoco.mjtEq.mjEQ_CONNECT,
            objtype=mujoco.mjtObj.mjOBJ_BODY,
            name1=first,
            name2="" if second == _WORLD else second,
        )


def _leader(mimic: Mimic, joint: Joint, joints: dict[str, Joint]) -> Joint | None:
    """The joint that ``joint`` follows, movable or fixed; None if there is no such joint."""
    leader = joints.get(mimic.leader)
    usable = leader is not None and leader.name != joint.name and (leader.movable or leader.kind == "fixed")
    return leader if usable else None


def _fault(joint: Joint, body: int, joints: dict[str, Joint]) -> JointFault | None:
    """Why the joint cannot be on a chain; None if it can, or is none of one freedom."""
    message, by_limits = joint.fault, False
    if not message and joint.movable and joint.mimic is not None:
        if _leader(joint.mimic, joint, joints) is None:
            message = f"joint {joint.name!r} mimics {joint.mimic.leader!r}, which is no other joint of one freedom"
    elif not message and joint.movable:
        message, by_limits = _limit_fault(joint), True
    return JointFault(body, joint.name, message, by_limits) if message else None


def _limit_fault(joint: Joint) -> str:
    """What is wrong with the limits of a joint that leads itself; empty where they can be used."""
    if joint.limits is None:
        unlimited = f"revolute joint {joint.name!r} has no <limit>: give its limits, or make it continuous"
        return unlimited if joint.kind == "revolute" else ""
    lower, upper = joint.limits
    if lower > upper:
        return f"joint {joint.name!r}: its lower limit {lower:g} is above its upper limit {upper:g}: give its limits"
    if lower == upper != 0.0:
        return (
            f"joint {joint.name!r}: its limits are both {lower:g}, which leaves no motion; "
            "give its limits, or make it continuous or fixed"
        )
    return ""


def _dropped_meshes(urdf: Urdf) -> tuple[Notice, ...]:
    files = [
        shape.file
        for link in urdf.links.values()
        for shape in (*link.visuals, *link.collisions)
        if shape.kind not in PRIMITIVES
    ]
    if not files:
        return ()
    message = f"geometry of {len(files)} meshes is dropped ({files[0]}, …): kinematics and inertia do not need it"
    return (Notice("meshes_dropped", message),)
