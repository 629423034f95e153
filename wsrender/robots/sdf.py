"""SDF (Gazebo's format): links and joints of its models as the tree of a URDF, with loops where it has some.

Kinematics, inertias, limits, and shapes are read; what moves by itself, plugins and sensors are not.
"""

import heapq
import math
import posixpath
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np
from scipy.spatial.transform import Rotation

from wsrender.errors import ModelError
from wsrender.robots import xml_source
from wsrender.robots.mesh_files import ADDRESS
from wsrender.robots.sdf_frames import MODEL, MOST_STEPS, WORLD, Frames, pose_of, relative_to
from wsrender.robots.urdf import Inertial, Joint, Link, LoopJoint, Mimic, Pose, Urdf, UrdfShape
from wsrender.robots.xml_source import number, numbers

MAX_FILES = 100  # that are included
ONE_FREEDOM = ("revolute", "continuous", "prismatic")
_OTHERS = ("ball", "universal", "revolute2", "screw", "gearbox")
_SIZES = {
    "box": (("size", 3),),
    "cylinder": (("radius", 1), ("length", 1)),
    "capsule": (("radius", 1), ("length", 1)),
    "sphere": (("radius", 1),),
    "ellipsoid": (("radii", 3),),
}
_ENDLESS = 1e16  # SDF's own word for no limit

ReadFile = Callable[[str], bytes | None]


def read_sdf(sdf: Element, read: ReadFile, model_field: str) -> tuple[Urdf, list[bytes]]:
    """The tree of links of an ``<sdf>`` element, whose root is the world; and the files that it includes.

    Poses in the tree are at zero of all joints. What nothing joins to the world stands still where its pose is, as the
    root link of a URDF does. Links of a nested model are named ``model::link``. Of several joints to a link, those of
    one freedom make the tree before others, and those left over are loops. Raises ModelError.
    """
    reading = _Reading(read, model_field)
    version = _version(sdf.get("version", ""), model_field)
    world = sdf.find("world")
    scope = world if world is not None else sdf
    models = [each for each in scope if each.tag in ("model", "include")]
    if not models:
        raise ModelError(model_field, "the SDF has no <model>")
    single = len(models) == 1
    for each in models:
        reading.model(each, "", WORLD, "", version, 1, single)
    for joint in scope.findall("joint"):
        reading.joint(joint, "", version)
    if not reading.links:
        raise ModelError(model_field, "the SDF has no <link>")
    name = reading.names[0] if single else (scope.get("name") or "world")
    return reading.tree(name), list(reading.contents.values())


@dataclass
class _JointRead:
    """A joint as it is written: its frame is that of its name."""

    name: str
    kind: str
    parent: str
    child: str
    axis: np.ndarray  # (3,) in the joint's frame
    limits: tuple[float, float] | None = None
    effort: float = 0.0
    velocity: float = 0.0
    mimic: Mimic | None = None
    fault: str = ""


@dataclass
class _Reading:
    read: ReadFile
    model_field: str
    links: dict[str, Link] = field(default_factory=dict)
    joints: list[_JointRead] = field(default_factory=list)
    contents: dict[str, bytes] = field(default_factory=dict)
    names: list[str] = field(default_factory=list)
    _axes: list[tuple[_JointRead, Element, str, bool]] = field(default_factory=list)
    _attached: dict[str, str] = field(default_factory=dict)  # of frames and joints: what they are fixed to
    _worlds: set[str] = field(default_factory=set)  # scopes with a link of that name, which is not the world
    _elements: int = 0
    _included: int = 0

    def __post_init__(self) -> None:
        self.frames = Frames(self.model_field)

    def model(
        self, element: Element, prefix: str, above: str, folder: str, version: float, depth: int, bare: bool
    ) -> None:
        """Read a ``<model>`` or ``<include>`` in the scope ``prefix``, whose poses are in the frame ``above``.

        ``folder``: of the file; ``bare``: its links go by their names alone.
        """
        if depth > 20:
            raise ModelError(self.model_field, "models are nested deeper than 20")
        outer = element
        if element.tag == "include":
            element, folder, version = self._file(element, folder)
        self._count(element)
        name = (outer.findtext("name") or "").strip() or element.get("name", "").strip()
        if not name:
            raise ModelError(self.model_field, "a <model> has no name")
        self.names.append(name)
        placed = outer if outer is not element and outer.find("pose") is not None else element
        inner = prefix if bare or outer.get("merge", "").lower() in ("true", "1") else f"{prefix}{name}::"
        frame = f"{prefix}{MODEL}:{name}" if inner == prefix else f"{inner}{MODEL}"
        T = pose_of(placed, "pose", self.model_field, f"model {name!r}")
        reference = self._named(relative_to(placed), prefix) or above
        marker = outer.get("placement_frame") or element.get("placement_frame") or ""
        marker = (outer.findtext("placement_frame") or marker).strip()
        if inner != prefix:
            self.frames.add(f"{prefix}{name}", frame, np.eye(4))
        elif f"{prefix}{MODEL}" not in self.frames.said:
            self.frames.add(f"{prefix}{MODEL}", frame, np.eye(4))
        for nested in element:
            if nested.tag in ("model", "include"):
                self.model(nested, inner, frame, folder, version, depth + 1, False)
        for link in element.findall("link"):
            self._link(link, inner, frame, folder)
        for each in element.findall("frame"):
            self._frame(each, inner, frame)
        static = any((each.findtext("static") or "").strip().lower() in ("true", "1") for each in (outer, element))
        for joint in element.findall("joint"):
            self.joint(joint, inner, version, static)
        if marker:  # the pose is that of another frame of the model: the model's follows from it
            self.frames.add(frame, WORLD, np.eye(4))
            T_model_marker = self.frames.pose(f"{inner}{marker}")
            del self.frames.said[frame]
            self.frames = Frames(self.model_field, self.frames.said)
            T = T @ np.linalg.inv(T_model_marker)
        self.frames.add(frame, reference, T)

    def joint(self, element: Element, prefix: str, version: float, static: bool = False) -> None:
        """Read a ``<joint>`` in a scope; those of ``static`` models do not move."""
        name = prefix + self._name(element)
        where = f"joint {name!r}"
        parent, child = ((element.findtext(end) or "").strip() for end in ("parent", "child"))
        if not parent or not child:
            raise ModelError(self.model_field, f"{where} has no <{'child' if parent else 'parent'}>")
        parent, child = self._named(parent, prefix), self._named(child, prefix)
        reference = self._named(relative_to(element), prefix) or child
        self.frames.add(name, reference, pose_of(element, "pose", self.model_field, where))
        self._attached[name] = child
        kind = "fixed" if static else element.get("type", "")
        found = _JointRead(name, kind, parent, child, np.array([0.0, 0.0, 1.0]))
        self.joints.append(found)
        if kind not in (*ONE_FREEDOM, "fixed"):
            allowed = ", ".join((*ONE_FREEDOM, "fixed"))
            found.fault = f"{where} has type {kind!r}; allowed: {allowed}"
        axis = element.find("axis")
        if kind in ONE_FREEDOM and axis is not None:
            self._axes.append((found, axis, prefix, version < 1.05))
            try:
                self._limits(found, axis, prefix, where)
            except ModelError as error:
                found.fault = error.message

    def tree(self, name: str) -> Urdf:
        """All links and joints as a tree from the world on."""
        for found, axis, prefix, of_model in self._axes:
            self._axis(found, axis, prefix, of_model)
        links = {WORLD: Link(WORLD, None, (), ()), **self.links}
        for joint in self.joints:
            joint.parent, joint.child = (self._link_of(end, joint.name) for end in (joint.parent, joint.child))
        placed, loops = _spanning([WORLD, *self.links], self.joints, self.model_field)
        joints = [self._tree_joint(*each) for each in placed]
        by_name = {joint.name: joint for joint in joints}
        if len(by_name) < len(joints):
            raise ModelError(self.model_field, "two joints have one name; names must be unique")
        return Urdf(name, WORLD, links, by_name, tuple(LoopJoint(each.name, each.parent, each.child) for each in loops))

    def _tree_joint(self, parent: str, child: str, joint: _JointRead | None) -> Joint:
        T_parent, T_child = self.frames.pose(parent), self.frames.pose(child)
        pose = _pose(np.linalg.inv(T_parent) @ T_child)
        if joint is None:
            return Joint(f"{WORLD}::{child}", "fixed", parent, child, pose, np.array([1.0, 0.0, 0.0]))
        T_child_joint = np.linalg.inv(T_child) @ self.frames.pose(joint.name)
        axis = T_child_joint[:3, :3] @ joint.axis
        if child != joint.child:
            axis = -axis  # the parent moves against the child
        kind = joint.kind
        if kind == "revolute" and joint.limits is None:
            kind = "continuous"
        return Joint(
            joint.name, kind, parent, child, pose, axis, joint.limits, joint.effort, joint.velocity, joint.mimic,
            joint.fault, T_child_joint[:3, 3],
        )  # fmt: skip

    def _file(self, include: Element, folder: str) -> tuple[Element, str, float]:
        """The model that an ``<include>`` names, its folder and version. Raises ModelError where it is not there."""
        uri = (include.findtext("uri") or "").strip()
        scheme = ADDRESS.match(uri)
        if not uri or ("://" in uri and scheme is None):
            raise ModelError(self.model_field, f"the included model {uri!r} is not local; models are not downloaded")
        place = uri if scheme else posixpath.join(folder, uri)
        self._included += 1
        if self._included > MAX_FILES:
            raise ModelError(self.model_field, f"more than {MAX_FILES} models are included")
        name = place
        if not place.lower().endswith((".sdf", ".xml", ".world")):
            name = f"{place}/{self._listed(place)}"
        content = self.contents.get(name) or self.read(name)
        if content is None:
            raise ModelError(self.model_field, f"the included model {uri!r} is not there: {name} cannot be read")
        self.contents[name] = content
        root = xml_source.parse(content, self.model_field)
        models = root.findall("model") if root.tag == "sdf" else []
        if len(models) != 1:
            raise ModelError(self.model_field, f"the included file {name} must be an <sdf> of one <model>")
        return models[0], posixpath.dirname(name), _version(root.get("version", ""), self.model_field)

    def _listed(self, place: str) -> str:
        """The newest file that a model's ``model.config`` lists; ``model.sdf`` without one."""
        content = self.read(f"{place}/model.config")
        if content is None:
            return "model.sdf"
        listed = xml_source.parse(content, self.model_field).findall("sdf")
        newest = max(listed, key=lambda each: _version(each.get("version", ""), self.model_field), default=None)
        return "model.sdf" if newest is None else (newest.text or "").strip()

    def _link(self, element: Element, prefix: str, frame: str, folder: str) -> None:
        if (own := self._name(element)) == WORLD:
            self._worlds.add(prefix)
        name = self._named(own, prefix)
        where = f"link {name!r}"
        self.frames.add(
            name, self._named(relative_to(element), prefix) or frame, pose_of(element, "pose", self.model_field, where)
        )
        shapes: dict[str, list[UrdfShape]] = {"visual": [], "collision": []}
        for tag, found in shapes.items():
            for part in element.findall(tag):
                geometry = part.find("geometry")
                if geometry is not None and len(geometry) and geometry[0].tag != "empty":
                    found.append(self._shape(geometry[0], part, folder, where))
        inertial = element.find("inertial")
        stated = None if inertial is None else self._inertial(inertial, where)
        self.links[name] = Link(name, stated, tuple(shapes["visual"]), tuple(shapes["collision"]))

    def _frame(self, element: Element, prefix: str, frame: str) -> None:
        name = prefix + self._name(element)
        said = relative_to(element) or element.get("attached_to", "").strip()
        T = pose_of(element, "pose", self.model_field, f"frame {name!r}")
        self.frames.add(name, self._named(said, prefix) or frame, T)
        if attached := element.get("attached_to", "").strip():
            self._attached[name] = self._named(attached, prefix)

    def _shape(self, element: Element, part: Element, folder: str, where: str) -> UrdfShape:
        size: list[float] = []
        for key, count in _SIZES.get(element.tag, ()):
            size += numbers(element.findtext(key) or "", count, self.model_field, f"{where}: {key}")
        kind, file, scale = element.tag, "", ""
        if kind == "mesh":
            uri, scale = (element.findtext("uri") or "").strip(), (element.findtext("scale") or "").strip()
            file = uri if ADDRESS.match(uri) else posixpath.join(folder, uri)
            kind = "mesh" if element.find("submesh") is None else "submesh"
        return UrdfShape(
            _pose(pose_of(part, "pose", self.model_field, where)), kind, tuple(size), file, scale,
            part.get("name", ""), self._rgba(part),
        )  # fmt: skip

    def _rgba(self, part: Element) -> tuple[float, ...] | None:
        text = part.findtext("material/diffuse") or part.findtext("material/ambient") or ""
        try:
            return tuple(numbers(text, 4, self.model_field, "diffuse")) if text.strip() else None
        except ModelError:
            return None

    def _inertial(self, element: Element, where: str) -> Inertial | None:
        """What a link weighs; None where it is to be computed from its shapes (1.11), which is not done."""
        if element.get("auto", "false").lower() in ("true", "1"):
            return None
        get = element.findtext
        mass = number(get("mass") or "1", self.model_field, f"{where}: mass")
        default = {"ixx": "1", "iyy": "1", "izz": "1", "ixy": "0", "ixz": "0", "iyz": "0"}
        i = {
            key: number(get(f"inertia/{key}") or value, self.model_field, f"{where}: {key}")
            for key, value in default.items()
        }
        matrix = np.array(
            [[i["ixx"], i["ixy"], i["ixz"]], [i["ixy"], i["iyy"], i["iyz"]], [i["ixz"], i["iyz"], i["izz"]]]
        )
        return Inertial(_pose(pose_of(element, "pose", self.model_field, where)), mass, matrix)

    def _limits(self, joint: _JointRead, axis: Element, prefix: str, where: str) -> None:
        limit = axis.find("limit")
        if limit is not None:
            ends = [self._end(limit, end, where) for end in ("lower", "upper")]
            if any(map(math.isfinite, ends)) and joint.kind != "continuous":
                joint.limits = (ends[0], ends[1])
            joint.effort, joint.velocity = (max(self._most(limit, key, where), 0.0) for key in ("effort", "velocity"))
        elif joint.kind == "prismatic":
            joint.limits = (-math.inf, math.inf)
        mimic = axis.find("mimic")
        if mimic is not None:
            ratio, offset, reference = (
                number(mimic.findtext(key) or default, self.model_field, f"{where}: mimic {key}")
                for key, default in (("multiplier", "1"), ("offset", "0"), ("reference", "0"))
            )
            joint.mimic = Mimic(self._named(mimic.get("joint", "").strip(), prefix), ratio, offset - ratio * reference)

    def _end(self, limit: Element, end: str, where: str) -> float:
        sign = -1.0 if end == "lower" else 1.0
        text = (limit.findtext(end) or "").strip()
        if not text or text.lower().lstrip("+-") in ("inf", "infinity"):
            return sign * math.inf
        value = number(text, self.model_field, f"{where}: {end} limit")
        return sign * math.inf if sign * value >= _ENDLESS else value

    def _most(self, limit: Element, key: str, where: str) -> float:
        """Limit of effort or velocity; 0 for none, which SDF says by a negative number or infinity."""
        text = (limit.findtext(key) or "").strip()
        if not text or text.lower().lstrip("+-") in ("inf", "infinity"):
            return 0.0
        value = number(text, self.model_field, f"{where}: its {key} limit")
        return value if value < _ENDLESS else 0.0

    def _axis(self, joint: _JointRead, element: Element, prefix: str, of_model: bool) -> None:
        """The axis in the joint's frame: it is said in that, in one it names, or in the model's (before 1.5)."""
        xyz = element.find("xyz")
        text = "0 0 1" if xyz is None else (xyz.text or "0 0 1")
        try:
            axis = np.array(numbers(text, 3, self.model_field, f"joint {joint.name!r}: axis"))
        except ModelError as error:
            joint.fault = error.message
            return
        if not np.abs(axis).max() > 0.0:
            joint.fault = f"joint {joint.name!r}: its axis is {text!r}; it must not be zero"
            return
        said = (element.findtext("use_parent_model_frame") or "").strip().lower()
        of_model = said in ("true", "1") if said else of_model
        frame = joint.name
        if xyz is not None and (named := (xyz.get("expressed_in") or "").strip()):
            frame = self._named(named, prefix)
        elif of_model:
            frame = f"{prefix}{MODEL}"
        R = self.frames.pose(joint.name)[:3, :3].T @ self.frames.pose(frame)[:3, :3]
        axis /= np.abs(axis).max()
        joint.axis = R @ (axis / np.linalg.norm(axis))

    def _link_of(self, name: str, joint: str) -> str:
        """The link that a joint's end is, or that the frame it names is attached to."""
        steps, at = 0, name
        while at not in self.links and at != WORLD:
            if at not in self._attached or steps > MOST_STEPS:
                raise ModelError(self.model_field, f"joint {joint!r} refers to link {name!r}, which does not exist")
            at, steps = self._attached[at], steps + 1
        return at

    def _named(self, name: str, prefix: str) -> str:
        """The full name of what a scope calls so; empty for an empty name."""
        if name == WORLD and prefix in self._worlds:
            return f"{prefix}{WORLD}_"
        return name if name in ("", WORLD) else prefix + name

    def _name(self, element: Element) -> str:
        name = element.get("name", "").strip()
        if not name:
            raise ModelError(self.model_field, f"a <{element.tag}> has no name")
        return name

    def _count(self, element: Element) -> None:
        self._elements += sum(1 for _ in element.iter())
        if self._elements > xml_source.MAX_ELEMENTS * 5:
            raise ModelError(self.model_field, "the models have too many elements, with those they include")


def _spanning(
    links: list[str], joints: list[_JointRead], model_field: str
) -> tuple[list[tuple[str, str, _JointRead | None]], list[_JointRead]]:
    """A tree over all links from the first on, (parent, child, joint) with parents first; and the joints beside it.

    Joints of one freedom and fixed ones are taken before others, and from parent to child before the other way. Where
    none leads on, the next link that is no child of a joint, else the next, stands still.
    """
    ends: dict[str, list[int]] = {name: [] for name in links}
    for k, joint in enumerate(joints):
        ends[joint.parent].append(k)
        ends[joint.child].append(k)
    children = {joint.child for joint in joints if joint.parent != WORLD}
    waiting = sorted(links[1:], key=lambda name: name in children)  # a stable order
    depth = {links[0]: 0}
    placed: list[tuple[str, str, _JointRead | None]] = []
    used: set[int] = set()
    heap: list[tuple[int, int, Any]] = []

    def reached(link: str) -> None:
        for k in ends[link]:
            joint = joints[k]
            rank = 2 * (joint.kind not in (*ONE_FREEDOM, "fixed")) + (joint.child == link)
            heapq.heappush(heap, (rank, k, link))

    def put(parent: str, child: str, joint: _JointRead | None) -> None:
        depth[child] = depth[parent] + 1
        if depth[child] > xml_source.MAX_DEPTH:
            raise ModelError(model_field, f"links are nested deeper than {xml_source.MAX_DEPTH} joints")
        placed.append((parent, child, joint))
        reached(child)

    reached(links[0])
    at = 0
    while len(depth) < len(links):
        while heap:
            _, k, link = heapq.heappop(heap)
            joint = joints[k]
            other = joint.child if link == joint.parent else joint.parent
            if k not in used and other not in depth:
                used.add(k)
                put(link, other, joint)
        while at < len(waiting) and waiting[at] in depth:
            at += 1
        if at < len(waiting):
            put(links[0], waiting[at], None)
    return placed, [joint for k, joint in enumerate(joints) if k not in used]


def _pose(T: np.ndarray) -> Pose:
    x, y, z, w = Rotation.from_matrix(T[:3, :3]).as_quat()
    return Pose(T[:3, 3], np.array([w, x, y, z]))


def _version(text: str, model_field: str) -> float:
    """1.11 is newer than 1.9: the minor number in hundredths."""
    major, _, minor = text.strip().partition(".")
    if not (major.isdigit() and (minor.isdigit() or not minor) and len(text) < 10):
        raise ModelError(model_field, f"<sdf> has version {text!r}; such as 1.7 is needed")
    return int(major) + int(minor or "0") / 100
