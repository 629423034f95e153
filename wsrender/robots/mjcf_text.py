"""MJCF text of a model that MuJoCo compiled: what moves, weighs, limits and drives it, and what may collide."""

from collections.abc import Iterable
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import mujoco
import numpy as np

from wsrender.errors import ModelError
from wsrender.robots.frames import body_name, joints_of
from wsrender.robots.limits import joint_name
from wsrender.robots.shapes import geom_name, hull_of

_JOINTS = {
    mujoco.mjtJoint.mjJNT_FREE: "free",
    mujoco.mjtJoint.mjJNT_BALL: "ball",
    mujoco.mjtJoint.mjJNT_SLIDE: "slide",
    mujoco.mjtJoint.mjJNT_HINGE: "hinge",
}
_SHAPES = {
    mujoco.mjtGeom.mjGEOM_PLANE: "plane",
    mujoco.mjtGeom.mjGEOM_SPHERE: "sphere",
    mujoco.mjtGeom.mjGEOM_CAPSULE: "capsule",
    mujoco.mjtGeom.mjGEOM_ELLIPSOID: "ellipsoid",
    mujoco.mjtGeom.mjGEOM_CYLINDER: "cylinder",
    mujoco.mjtGeom.mjGEOM_BOX: "box",
}
_TRANSMISSIONS = {mujoco.mjtTrn.mjTRN_JOINT: "joint", mujoco.mjtTrn.mjTRN_JOINTINPARENT: "jointinparent"}


def text_of(model: mujoco.MjModel, field: str) -> str:
    """MJCF text whose chains have the kinematics, inertias, limits and couplings of ``model``, to the last digit.

    Every body states its inertia. Of meshes that may collide there are the convex hulls; others are left out. Raises
    ModelError for equalities of tendons, which the text cannot say.
    """
    root = Element("mujoco", model=model.names.split(b"\0", 1)[0].decode())  # the model's own name comes first
    SubElement(root, "compiler", angle="radian", autolimits="false", inertiafromgeom="false")
    elements = {0: SubElement(root, "worldbody")}
    for body in range(model.nbody):
        if body:
            elements[body] = _body(model, body, elements[int(model.body_parentid[body])])
        _fill(model, body, elements[body])
    _add_hulls(model, SubElement(root, "asset"))
    _add_contacts(model, root)
    _add_equalities(model, SubElement(root, "equality"), field)
    _add_actuators(model, SubElement(root, "actuator"))
    return ElementTree.tostring(root, encoding="unicode")


def _body(model: mujoco.MjModel, body: int, parent: Element) -> Element:
    pose = _pose(model.body_pos, model.body_quat, body)
    element = SubElement(parent, "body", {"name": body_name(model, body)} | pose)
    if model.body_mocapid[body] >= 0:
        element.set("mocap", "true")
    stated = {"mass": _text([model.body_mass[body]]), "diaginertia": _text(model.body_inertia[body])}
    SubElement(element, "inertial", stated | _pose(model.body_ipos, model.body_iquat, body))
    return element


def _fill(model: mujoco.MjModel, body: int, element: Element) -> None:
    for joint in joints_of(model, body):
        _add_joint(model, joint, element)
    for site in np.flatnonzero(model.site_bodyid == body):
        if name := model.site(site).name:
            SubElement(element, "site", {"name": name} | _pose(model.site_pos, model.site_quat, int(site)))
    for geom in np.flatnonzero(model.geom_bodyid == body).tolist():
        of_mesh = _has_hull(model, geom)
        if kind := "mesh" if of_mesh else _SHAPES.get(mujoco.mjtGeom(model.geom_type[geom])):
            keys = ("group", "contype", "conaffinity")
            shape = {"type": kind} | {key: str(getattr(model, f"geom_{key}")[geom]) for key in keys}
            shape |= {"mesh": _hull_name(model, geom)} if of_mesh else {"size": _text(model.geom_size[geom])}
            shape |= {"name": geom_name(model, geom), "rgba": _text(model.geom_rgba[geom])}
            SubElement(element, "geom", shape | _pose(model.geom_pos, model.geom_quat, int(geom)))


def _has_hull(model: mujoco.MjModel, geom: int) -> bool:
    if model.geom_type[geom] != mujoco.mjtGeom.mjGEOM_MESH:
        return False
    return bool(model.mesh_graphadr[model.geom_dataid[geom]] >= 0)


def _hull_name(model: mujoco.MjModel, geom: int) -> str:
    return f"hull{model.geom_dataid[geom]}"


def _add_hulls(model: mujoco.MjModel, section: Element) -> None:
    named = {_hull_name(model, geom): geom for geom in range(model.ngeom) if _has_hull(model, geom)}
    for name, geom in named.items():
        SubElement(section, "mesh", name=name, vertex=_text(hull_of(model, geom)[0].ravel()), inertia="convex")


def _add_contacts(model: mujoco.MjModel, root: Element) -> None:
    if model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_FILTERPARENT:
        SubElement(SubElement(root, "option"), "flag", filterparent="disable")
    section = SubElement(root, "contact")
    for signature in model.exclude_signature:
        first, second = (body_name(model, body) for body in divmod(int(signature), 2**16))
        SubElement(section, "exclude", body1=first, body2=second)
    for pair in zip(model.pair_geom1, model.pair_geom2, strict=True):
        first, second = (geom_name(model, int(geom)) for geom in pair)
        SubElement(section, "pair", geom1=first, geom2=second)


def _add_joint(model: mujoco.MjModel, joint: int, element: Element) -> None:
    kind = _JOINTS[mujoco.mjtJoint(model.jnt_type[joint])]
    added = SubElement(element, "joint", name=joint_name(model, joint), type=kind)
    if kind == "free":
        return
    added.set("pos", _text(model.jnt_pos[joint]))
    added.set("armature", _text([model.dof_armature[model.jnt_dofadr[joint]]]))
    if kind == "ball":
        return
    added.set("axis", _text(model.jnt_axis[joint]))
    added.set("ref", _text([model.qpos0[model.jnt_qposadr[joint]]]))
    _set_range(added, "", model.jnt_limited[joint], model.jnt_range[joint])
    _set_range(added, "actuatorfrc", model.jnt_actfrclimited[joint], model.jnt_actfrcrange[joint])


def _set_range(element: Element, of: str, limited: bool, limits: np.ndarray) -> None:
    element.set(f"{of}limited", "true" if limited else "false")
    if limited:
        element.set(f"{of}range", _text(limits))


def _add_equalities(model: mujoco.MjModel, section: Element, field: str) -> None:
    kinds = mujoco.mjtEq
    for equality in range(model.neq):
        kind = mujoco.mjtEq(model.eq_type[equality])
        name, active = model.equality(equality).name, "true" if model.eq_active0[equality] else "false"
        first, second = int(model.eq_obj1id[equality]), int(model.eq_obj2id[equality])
        said = {"active": active} | ({"name": name} if name else {})
        if kind == kinds.mjEQ_JOINT:
            leader = {"joint2": joint_name(model, second)} if second >= 0 else {}
            follower = {"joint1": joint_name(model, first), "polycoef": _text(model.eq_data[equality, :5])}
            SubElement(section, "joint", follower | leader | said)
        elif kind in (kinds.mjEQ_CONNECT, kinds.mjEQ_WELD):
            anchor = {"anchor": _text(model.eq_data[equality, :3])} if kind == kinds.mjEQ_CONNECT else {}
            bodies = _tied(model, equality, first, second)
            SubElement(section, "connect" if kind == kinds.mjEQ_CONNECT else "weld", bodies | anchor | said)
        elif kind == kinds.mjEQ_TENDON:
            raise ModelError(field, f"equality {name!r} couples tendons; give the model's MJCF text or its MjSpec")


def _tied(model: mujoco.MjModel, equality: int, first: int, second: int) -> dict[str, str]:
    """The bodies that an equality ties, whether by themselves or by sites on them."""
    if model.eq_objtype[equality] == mujoco.mjtObj.mjOBJ_SITE:
        first, second = int(model.site_bodyid[first]), int(model.site_bodyid[second])
    if first <= 0:
        first, second = second, first
    other = {"body2": body_name(model, second)} if second > 0 else {}
    return {"body1": body_name(model, first), **other}


def _add_actuators(model: mujoco.MjModel, section: Element) -> None:
    for actuator in range(model.nu):
        transmission = _TRANSMISSIONS.get(mujoco.mjtTrn(model.actuator_trntype[actuator]))
        if transmission is None:
            continue
        fixed = model.actuator_gaintype[actuator] == mujoco.mjtGain.mjGAIN_FIXED
        unbiased = model.actuator_biastype[actuator] == mujoco.mjtBias.mjBIAS_NONE
        direct = model.actuator_dyntype[actuator] == mujoco.mjtDyn.mjDYN_NONE
        driven = {transmission: joint_name(model, int(model.actuator_trnid[actuator, 0]))}
        driven |= {"gaintype": "fixed" if fixed else "affine", "biastype": "none" if unbiased else "affine"}
        driven |= {"dyntype": "none" if direct else "filter", "gear": _text(model.actuator_gear[actuator])}
        added = SubElement(section, "general", driven, gainprm=_text(model.actuator_gainprm[actuator, :3]))
        _set_range(added, "force", model.actuator_forcelimited[actuator], model.actuator_forcerange[actuator])
        _set_range(added, "ctrl", model.actuator_ctrllimited[actuator], model.actuator_ctrlrange[actuator])


def _pose(positions: np.ndarray, quats: np.ndarray, number: int) -> dict[str, str]:
    return {"pos": _text(positions[number]), "quat": _text(quats[number])}


def _text(values: Iterable[float]) -> str:
    return " ".join(repr(float(value)) for value in values)
