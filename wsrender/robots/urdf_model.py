"""URDF → MuJoCo model, link by link; MuJoCo's own URDF reader fuses, guesses and skips too much."""

import warnings
from xml.etree.ElementTree import Element

import mujoco
import numpy as np

from wsrender.robots.compiled_model import CompiledModel
from wsrender.robots.inertials import compile_with_inertials
from wsrender.robots.model_warning import ModelWarning
from wsrender.robots.urdf import Joint, Link, Mimic, Shape, Urdf, read_urdf

_SHAPES = {
    "box": mujoco.mjtGeom.mjGEOM_BOX,
    "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
    "sphere": mujoco.mjtGeom.mjGEOM_SPHERE,
}


def compile_urdf(robot: Element, field: str) -> CompiledModel:
    """The compiled model of a ``<robot>`` element.

    Every link, fixed or not, becomes a body of its name; the root link stands still in the world. Inertia
    comes from ``<inertial>`` alone. Primitive shapes are kept as massless geometry, meshes are dropped with
    one ModelWarning. Floating and planar joints are held at zero, and noted as faults of the path through
    them, as are revolute joints whose limits are missing or equal. Limits that are both 0, as exporters
    write them where none were set, count as none, with one ModelWarning. Raises ModelError.
    """
    urdf = read_urdf(robot, field)
    spec = mujoco.MjSpec()
    spec.modelname = urdf.name
    spec.compiler.degree = False
    spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    _add_links(spec, urdf)
    _add_mimics(spec, urdf)
    _warn_of_meshes(urdf)
    _warn_of_unset_limits(urdf)
    model, inertia_faults = compile_with_inertials(spec, field)
    path_faults = {
        model.body(joint.child).id: fault for joint in urdf.joints.values() if (fault := _fault(joint, urdf.joints))
    }
    return CompiledModel(model, urdf.name, path_faults, inertia_faults)


def _add_links(spec: mujoco.MjSpec, urdf: Urdf) -> None:
    world = spec.worldbody
    bodies = {urdf.root: world if urdf.root == "world" else world.add_body(name=urdf.root)}
    _fill(bodies[urdf.root], urdf.links[urdf.root])
    for joint in urdf.joints.values():
        body = bodies[joint.parent].add_body(name=joint.child, pos=joint.pose.position, quat=joint.pose.quat_wxyz)
        bodies[joint.child] = body
        _fill(body, urdf.links[joint.child])
        if joint.movable:
            _add_joint(body, joint)


def _fill(body: mujoco.MjsBody, link: Link) -> None:
    for shape in link.shapes:
        if shape.kind != "mesh" and min(shape.size) > 0.0:
            _add_shape(body, shape)
    if link.inertial is None:
        return
    xx, xy, xz, _, yy, yz, _, _, zz = link.inertial.inertia.ravel()
    body.explicitinertial = True
    body.mass, body.fullinertia = link.inertial.mass, [xx, yy, zz, xy, xz, yz]
    body.ipos, body.iquat = link.inertial.pose.position, link.inertial.pose.quat_wxyz


def _add_shape(body: mujoco.MjsBody, shape: Shape) -> None:
    size = np.zeros(3)
    if shape.kind == "cylinder":
        size[:2] = shape.size[0], shape.size[1] / 2
    else:
        size[: len(shape.size)] = np.array(shape.size) / (2 if shape.kind == "box" else 1)
    body.add_geom(
        type=_SHAPES[shape.kind], size=size, pos=shape.pose.position, quat=shape.pose.quat_wxyz,
        contype=0, conaffinity=0,
    )  # fmt: skip


def _add_joint(body: mujoco.MjsBody, joint: Joint) -> None:
    slide = joint.kind == "prismatic"
    added = body.add_joint(
        name=joint.name,
        type=mujoco.mjtJoint.mjJNT_SLIDE if slide else mujoco.mjtJoint.mjJNT_HINGE,
        axis=joint.axis,
    )
    if joint.limits is not None and joint.limits[0] < joint.limits[1]:
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


def _leader(mimic: Mimic, joint: Joint, joints: dict[str, Joint]) -> Joint | None:
    """The joint that ``joint`` follows, movable or fixed; None if there is no such joint."""
    leader = joints.get(mimic.leader)
    usable = leader is not None and leader.name != joint.name and (leader.movable or leader.kind == "fixed")
    return leader if usable else None


def _fault(joint: Joint, joints: dict[str, Joint]) -> str:
    """Why the joint cannot be on a chain; empty if it can."""
    if joint.kind in ("floating", "planar"):
        return f"joint {joint.name!r} is {joint.kind}: name a base below it"
    if joint.mimic is not None:
        if _leader(joint.mimic, joint, joints) is None:
            return f"joint {joint.name!r} mimics {joint.mimic.leader!r}, which is no other joint of one freedom"
        return ""
    if joint.kind == "revolute" and joint.limits is None:
        return f"revolute joint {joint.name!r} has no <limit>: give its limits, or make it continuous"
    if joint.limits is not None and joint.limits[0] == joint.limits[1] != 0.0:
        return (
            f"joint {joint.name!r}: its limits are both {joint.limits[0]:g}, which leaves no motion; "
            "give its limits, or make it continuous or fixed"
        )
    return ""


def _warn_of_meshes(urdf: Urdf) -> None:
    files = [shape.file for link in urdf.links.values() for shape in link.shapes if shape.kind == "mesh"]
    if files:
        warnings.warn(
            f"geometry of {len(files)} meshes is dropped ({files[0]}, …): kinematics and inertia do not need it",
            ModelWarning,
            stacklevel=2,
        )


def _warn_of_unset_limits(urdf: Urdf) -> None:
    names = [joint.name for joint in urdf.joints.values() if joint.kind == "revolute" and joint.limits == (0.0, 0.0)]
    if names:
        warnings.warn(
            f"the limits of {', '.join(names)} are both 0, which leaves no motion; taken as no limits",
            ModelWarning,
            stacklevel=2,
        )
