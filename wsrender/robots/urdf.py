"""URDF: its links and joints, checked, as they stand in the file."""

import math
from dataclasses import dataclass, field, replace
from xml.etree.ElementTree import Element

import numpy as np

from wsrender.errors import ModelError
from wsrender.robots import xacro_files
from wsrender.robots.xml_source import MAX_DEPTH, number, numbers

JOINT_TYPES = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
_MOVABLE = ("revolute", "continuous", "prismatic")
_INFINITE = {sign + word for sign in ("", "+", "-") for word in ("inf", "infinity")}


@dataclass(frozen=True)
class Pose:
    """Of a frame in another: position [m] and rotation, a unit quaternion (4,)."""

    position: np.ndarray
    quat_wxyz: np.ndarray


def quat_of_rpy(rpy: np.ndarray) -> np.ndarray:
    """Unit quaternion wxyz (4,) of roll, pitch, yaw [rad] about fixed axes, R = Rz Ry Rx."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy / 2), np.sin(rpy / 2)
    return np.array(
        [
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        ]
    )


@dataclass(frozen=True)
class Inertial:
    """Mass [kg] and inertia [kg m²], (3, 3) about the centre of mass, axes of ``pose``."""

    pose: Pose
    mass: float
    inertia: np.ndarray


@dataclass(frozen=True)
class UrdfShape:
    """A geometry: ``box`` (edges), ``cylinder`` or ``capsule`` (radius, length), ``sphere`` (radius) [m], or ``mesh``.

    Of an ``ellipsoid`` the half axes. ``kind`` is the name of its element, whatever that is; ``rgba`` None where no
    colour is stated.
    """

    pose: Pose
    kind: str
    size: tuple[float, ...] = ()
    file: str = ""
    scale: str = ""  # of a mesh, as it is written
    name: str = ""
    rgba: tuple[float, ...] | None = None


@dataclass(frozen=True)
class Link:
    """A ``<link>``; ``inertial`` is None where the file gives none."""

    name: str
    inertial: Inertial | None
    visuals: tuple[UrdfShape, ...]
    collisions: tuple[UrdfShape, ...]


@dataclass(frozen=True)
class Mimic:
    """Value of a joint = multiplier × value of ``leader`` + offset."""

    leader: str
    multiplier: float
    offset: float


@dataclass(frozen=True)
class Joint:
    """A ``<joint>``; ``limits`` [rad or m] are None without ``<limit>``, ``effort``, ``velocity`` 0 where not stated.

    ``pose`` is the child's in the parent's frame while the joint is at zero; ``axis`` (3,) and ``anchor`` (3,) [m], a
    point of it, are in the child's frame. ``fault`` says why nothing can be known of how it moves; empty where all of
    it can be read.
    """

    name: str
    kind: str
    parent: str
    child: str
    pose: Pose
    axis: np.ndarray
    limits: tuple[float, float] | None = None
    effort: float = 0.0
    velocity: float = 0.0
    mimic: Mimic | None = None
    fault: str = ""
    anchor: np.ndarray = field(default_factory=lambda: np.zeros(3))

    @property
    def movable(self) -> bool:
        """Whether the joint has one degree of freedom."""
        return self.kind in _MOVABLE and not self.fault


@dataclass(frozen=True)
class LoopJoint:
    """A joint beside the tree: it ties two links that are in it already."""

    name: str
    first: str
    second: str


@dataclass(frozen=True)
class Urdf:
    """A tree of links: every link but ``root`` is the child of one joint, parents before children.

    A URDF has no ``loops``; an SDF may.
    """

    name: str
    root: str
    links: dict[str, Link]
    joints: dict[str, Joint]
    loops: tuple[LoopJoint, ...] = ()


def read_urdf(robot: Element, field: str) -> Urdf:
    """Links and joints of the ``<robot>`` element; raises ModelError naming what is wrong with them."""
    _refuse_xacro(robot, field)
    colors = {each.get("name", ""): rgba for each in robot.findall("material") if (rgba := _rgba(each, field))}
    links = [_link(element, colors, field) for element in robot.findall("link")]
    joints = [_joint(element, field) for element in robot.findall("joint")]
    if not links:
        raise ModelError(field, "the URDF has no <link>")
    by_name = _unique(links, "link", field)
    _unique(joints, "joint", field)
    root, ordered = _tree(by_name, joints, field)
    return Urdf(robot.get("name", ""), root, by_name, {joint.name: joint for joint in ordered})


def _refuse_xacro(robot: Element, field: str) -> None:
    if tag := xacro_files.unexpanded(robot):
        remedy = "give the path of the file, or run it through xacro first"
        raise ModelError(field, f"<{tag}> is not expanded: {remedy}")


def _unique(items: list, kind: str, field: str) -> dict:
    by_name = {item.name: item for item in items}
    if len(by_name) < len(items):
        names = [item.name for item in items]
        twice = next(name for name in names if names.count(name) > 1)
        raise ModelError(field, f"two {kind}s are named {twice!r}; names must be unique")
    return by_name


def _name(element: Element, field: str) -> str:
    name = element.get("name", "").strip()
    if not name:
        raise ModelError(field, f"a <{element.tag}> has no name")
    return name


def _pose(parent: Element, field: str, where: str) -> Pose:
    origin = parent.find("origin")
    get = {} if origin is None else origin.attrib
    xyz, rpy = (
        np.array(numbers(get.get(key, "0 0 0") or "0 0 0", 3, field, f"{where}: origin {key}"))
        for key in ("xyz", "rpy")
    )
    return Pose(xyz, quat_of_rpy(rpy))


def _link(element: Element, colors: dict[str, tuple[float, ...]], field: str) -> Link:
    name = _name(element, field)
    where = f"link {name!r}"
    inertial = element.find("inertial")
    shapes: dict[str, list[UrdfShape]] = {"visual": [], "collision": []}
    for tag, found in shapes.items():
        for part in element.findall(tag):
            geometry = part.find("geometry")
            if geometry is not None and len(geometry):
                found.append(_shape(geometry[0], part, colors, field, where))
    stated = None if inertial is None else _inertial(inertial, field, where)
    return Link(name, stated, tuple(shapes["visual"]), tuple(shapes["collision"]))


def _shape(element: Element, part: Element, colors: dict[str, tuple[float, ...]], field: str, where: str) -> UrdfShape:
    keys, size = _SIZES.get(element.tag, ()), []
    for key in keys:
        size += numbers(element.get(key, ""), 3 if element.tag in ("box", "ellipsoid") else 1, field, f"{where}: {key}")
    material = part.find("material")
    rgba = None if material is None else _rgba(material, field) or colors.get(material.get("name", ""))
    file = "" if keys else element.get("filename", element.tag)
    name, scale = part.get("name", ""), element.get("scale", "")
    return UrdfShape(_pose(part, field, where), element.tag, tuple(size), file, scale, name, rgba)


_SIZES = {
    "box": ("size",),
    "ellipsoid": ("radii",),
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
    "sphere": ("radius",),
}


def _rgba(material: Element, field: str) -> tuple[float, ...] | None:
    """The colour that a material states, None where it states none that can be read."""
    color = material.find("color")
    try:
        return None if color is None else tuple(numbers(color.get("rgba", ""), 4, field, "rgba"))
    except ModelError:
        return None


def _inertial(element: Element, field: str, where: str) -> Inertial:
    mass, inertia = element.find("mass"), element.find("inertia")
    if mass is None or inertia is None:
        missing = "mass" if mass is None else "inertia"
        raise ModelError(field, f"{where}: its <inertial> has no <{missing}>")
    moments = {
        key: number(inertia.get(key, "0" if key in ("ixy", "ixz", "iyz") else ""), field, f"{where}: {key}")
        for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
    }
    rows = [["ixx", "ixy", "ixz"], ["ixy", "iyy", "iyz"], ["ixz", "iyz", "izz"]]
    matrix = np.array([[moments[key] for key in row] for row in rows])
    return Inertial(_pose(element, field, where), number(mass.get("value", ""), field, f"{where}: mass"), matrix)


def _joint(element: Element, field: str) -> Joint:
    """The joint; what is wrong with its motion alone is its fault, an error only on a chain through it."""
    name, kind = _name(element, field), element.get("type", "")
    where = f"joint {name!r}"
    ends = {}
    for end in ("parent", "child"):
        tag = element.find(end)
        ends[end] = "" if tag is None else tag.get("link", "").strip()
        if not ends[end]:
            raise ModelError(field, f"{where} has no <{end} link=…>")
    still = Joint(name, kind, ends["parent"], ends["child"], _pose(element, field, where), np.array([1.0, 0.0, 0.0]))
    try:
        return _moving(still, element, field, where)
    except ModelError as error:
        return replace(still, fault=error.message)


def _moving(joint: Joint, element: Element, field: str, where: str) -> Joint:
    if joint.kind not in JOINT_TYPES:
        raise ModelError(field, f"{where} has type {joint.kind!r}; allowed: {', '.join(JOINT_TYPES)}")
    limits, most = _limits(element, joint.kind, field, where)
    axis = _axis(element, joint.kind, field, where)
    return replace(joint, axis=axis, limits=limits, **most, mimic=_mimic(element, field, where))


def _axis(element: Element, kind: str, field: str, where: str) -> np.ndarray:
    tag = element.find("axis")
    text = "1 0 0" if tag is None else tag.get("xyz", "1 0 0")
    if kind not in _MOVABLE:
        return np.array([1.0, 0.0, 0.0])
    axis = np.array(numbers(text, 3, field, f"{where}: axis"))
    if (length := np.abs(axis).max()) == 0.0:
        raise ModelError(field, f"{where}: its axis is {text!r}; it must not be zero")
    return axis / length


def _limits(element: Element, kind: str, field: str, where: str) -> tuple[tuple[float, float] | None, dict[str, float]]:
    tag = element.find("limit")
    if tag is None:
        return None, {}
    most = {name: _most(tag.get(name, "0"), field, f"{where}: its {name} limit") for name in ("effort", "velocity")}
    if kind not in ("revolute", "prismatic"):
        return None, most
    lower, upper = (_limit(tag.get(end, "0"), field, f"{where}: {end} limit") for end in ("lower", "upper"))
    return (lower, upper), most


def _limit(text: str, field: str, where: str) -> float:
    """A limit, infinite where it is written so."""
    infinite = text.strip().lower() in _INFINITE
    return math.copysign(math.inf, -1 if "-" in text else 1) if infinite else number(text, field, where)


def _most(text: str, field: str, where: str) -> float:
    """Limit of effort or velocity; 0 (none) where it is infinite."""
    if text.strip().lower() in _INFINITE and "-" not in text:
        return 0.0
    if (most := number(text, field, where)) < 0.0:
        raise ModelError(field, f"{where} is {most:g}; it must not be negative")
    return most


def _mimic(element: Element, field: str, where: str) -> Mimic | None:
    tag = element.find("mimic")
    if tag is None:
        return None
    multiplier, offset = (
        number(tag.get(key, default), field, f"{where}: mimic {key}")
        for key, default in (("multiplier", "1"), ("offset", "0"))
    )
    return Mimic(tag.get("joint", "").strip(), multiplier, offset)


def _tree(links: dict[str, Link], joints: list[Joint], field: str) -> tuple[str, list[Joint]]:
    """The root link, and the joints with parents before children."""
    children: dict[str, list[Joint]] = {name: [] for name in links}
    parent_joint: dict[str, str] = {}
    for joint in joints:
        for link in (joint.parent, joint.child):
            if link not in links:
                raise ModelError(field, f"joint {joint.name!r} refers to link {link!r}, which does not exist")
        if joint.child in parent_joint:
            both = f"{parent_joint[joint.child]!r} and {joint.name!r}"
            raise ModelError(field, f"link {joint.child!r} is the child of two joints: {both}")
        parent_joint[joint.child] = joint.name
        children[joint.parent].append(joint)
    roots = [name for name in links if name not in parent_joint]
    if len(roots) > 1:
        shown = ", ".join(roots[:8])
        raise ModelError(field, f"links {shown} have no parent joint: a URDF is one tree with one root")
    ordered = [] if not roots else _descend(roots[0], children, field)
    if len(ordered) < len(joints):
        loop = next(joint.child for joint in joints if joint not in ordered)
        raise ModelError(field, f"the joints form a cycle through link {loop!r}")
    return roots[0], ordered


def _descend(root: str, children: dict[str, list[Joint]], field: str) -> list[Joint]:
    ordered: list[Joint] = []
    level = children[root]
    for _ in range(MAX_DEPTH):
        ordered += level
        level = [joint for parent in level for joint in children[parent.child]]
        if not level:
            return ordered
    raise ModelError(field, f"links are nested deeper than {MAX_DEPTH} joints")
