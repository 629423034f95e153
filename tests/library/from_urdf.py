"""The start of a library robot: ``python -m tests.library.from_urdf URDF NAME --base LINK --tip LINK``.

Writes ``mjcf/NAME/NAME.xml`` of the chain between two links: a body for each joint that moves, in its URDF frame;
limits, speeds, efforts and inertials as they are stated, right angles written as 1.5708 made exact; shapes fitted to
the collision shapes, or to what is seen of a link that has none (`tests.library.fit`). What is fixed to a link of the
chain belongs to it, unless beyond the tip.
"""

import argparse
import math
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import mujoco
import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

from tests.library.fit import Shape, excess, fit
from tests.library.second_sources import exact
from wsrender.robots import library

CONFIGURATIONS = 400  # by which pairs that the fit brought to touch are found
NO_MASS = "1e-12"  # of links whose mass no source gives [kg, kg m²]
OFTEN, SELDOM = 1 / 3, 0.05  # of them: shapes that touch so often while hulls of their meshes touch so seldom
ALWAYS = 0.9  # of them: links that touch so often do at their joint


@dataclass
class Link:
    """What moves with a joint, in its frame: inertials (mass, centre, tensor about it) and what may collide."""

    name: str
    joint: Element | None
    T_parent: np.ndarray  # (4, 4) in the frame of the link before
    inertials: list[tuple[float, np.ndarray, np.ndarray]] = field(default_factory=list)
    meshes: list[trimesh.Trimesh] = field(default_factory=list)
    shapes: list[Shape] = field(default_factory=list)
    excess: float = 0.0  # [m] of the shapes about the meshes


def links_of(urdf: Path, base: str, tip: str, bodies: list[str] | None = None) -> tuple[list[Link], np.ndarray]:
    """Links of the chain, the base's first, and the tip (4, 4) in the frame of the last.

    ``bodies``: only these URDF links have shapes and masses; None: all that the chain carries.
    """
    root = ElementTree.parse(urdf).getroot()  # a file of a package that we trust
    elements = {link.get("name"): link for link in root.iterfind("link")}
    above = {joint.find("child").get("link"): joint for joint in root.iterfind("joint")}
    path = [tip]
    while path[-1] != base:
        path.append(above[path[-1]].find("parent").get("link"))
    path.reverse()
    links, T = [Link("base", None, np.eye(4))], np.eye(4)
    for name in path:
        joint = above[name] if name != base else None
        if joint is not None:
            T = T @ _origin(joint)
        if joint is not None and joint.get("type") != "fixed":
            links.append(Link(name, joint, T))
            T = np.eye(4)
        _collect(links[-1], name, T, elements, above, set(path), urdf, bodies, beyond=name == tip)
    return links, T


def _collect(link, name, T, elements, above, path, urdf, bodies, beyond=False):
    if bodies is None or name in bodies:
        _add(link, elements[name], T, urdf)
    for child, joint in above.items() if not beyond else ():
        if joint.find("parent").get("link") == name and joint.get("type") == "fixed" and child not in path:
            _collect(link, child, T @ _origin(joint), elements, above, path, urdf, bodies)


def _add(link: Link, element: Element, T: np.ndarray, urdf: Path) -> None:
    inertial = element.find("inertial")
    if inertial is not None and float(inertial.find("mass").get("value")) > 0:
        at, values = T @ _origin(inertial), inertial.find("inertia").attrib
        xx, yy, zz, xy, xz, yz = (float(values[key]) for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        mass = float(inertial.find("mass").get("value"))
        link.inertials.append((mass, at[:3, 3], at[:3, :3] @ tensor @ at[:3, :3].T))
    for collision in element.findall("collision") or element.findall("visual"):
        at = T @ _origin(collision)
        link.meshes.append(_solid(collision.find("geometry")[0], urdf).apply_transform(at))


def _solid(shape: Element, urdf: Path) -> trimesh.Trimesh:
    if shape.tag == "box":
        return trimesh.creation.box(_numbers(shape.get("size")))
    if shape.tag == "sphere":
        return trimesh.creation.icosphere(3, float(shape.get("radius")))
    if shape.tag in ("cylinder", "capsule"):
        make = getattr(trimesh.creation, shape.tag)
        return make(radius=float(shape.get("radius")), height=float(shape.get("length")))
    mesh = trimesh.load(_file(shape.get("filename"), urdf), force="mesh")
    return mesh.apply_scale(_numbers(shape.get("scale", "1 1 1")))


def _file(name: str, urdf: Path) -> Path:
    """A mesh beside the URDF, or below the nearest folder above it that has the package's path."""
    relative = name.split("://", 1)[-1].lstrip("/")
    for folder in urdf.resolve().parents:
        for part in (relative, relative.partition("/")[2]):
            if part and (folder / part).is_file():
                return folder / part
    raise FileNotFoundError(f"{name}, of {urdf}")


def _origin(element: Element) -> np.ndarray:
    T, origin = np.eye(4), element.find("origin")
    if origin is not None:
        T[:3, :3] = Rotation.from_euler("xyz", _numbers(origin.get("rpy", "0 0 0"))).as_matrix()
        T[:3, 3] = _numbers(origin.get("xyz", "0 0 0"))
    return exact(T)


def _numbers(text: str) -> list[float]:
    return [float(word) for word in text.split()]


def mjcf(name: str, links: list[Link], T_tip: np.ndarray, description: str, source: str, exclude=(), hulls=None):
    """The MJCF (an element) of a chain; with ``hulls`` (a folder) those of the meshes stand for the shapes."""
    root = Element("mujoco", model=name)
    compiler = SubElement(root, "compiler", angle="radian", autolimits="true")
    if not all(link.inertials for link in links[1:]):  # MuJoCo asks for a mass of all that moves
        compiler.attrib |= {"boundmass": NO_MASS, "boundinertia": NO_MASS}
    custom = SubElement(root, "custom")
    speeds = [float(_limit(link).get("velocity", 0)) for link in links[1:]]
    if any(speeds):
        SubElement(custom, "numeric", name="velocity_limits", data=_words(speeds))
    SubElement(custom, "text", name="description", data=description)
    SubElement(custom, "text", name="source", data=source)
    default = SubElement(root, "default")
    SubElement(default, "geom", group="3", mass="0")
    assets = SubElement(root, "asset") if hulls else None
    world = SubElement(root, "worldbody")
    if links[0].meshes:
        _geoms(SubElement(world, "body", name="base"), links[0], assets, hulls)
    parent = world
    for link in links[1:]:
        parent = SubElement(parent, "body", name=link.name, **_pose(link.T_parent))
        if link.inertials:
            _inertial(parent, link.inertials)
        _joint(parent, link.joint)
        _geoms(parent, link, assets, hulls)
    SubElement(parent, "site", name="tool", **_pose(T_tip))
    if links[0].meshes:
        exclude = [("base", links[1].name), *exclude]
    if exclude:
        contact = SubElement(root, "contact")
        for one, other in exclude:
            SubElement(contact, "exclude", body1=one, body2=other)
    return root


def _limit(link: Link) -> Element:
    limit = link.joint.find("limit")
    return Element("limit") if limit is None else limit


def _joint(body: Element, joint: Element) -> None:
    limit = joint.find("limit")
    attributes = {"name": joint.get("name"), "type": "slide" if joint.get("type") == "prismatic" else "hinge"}
    attributes["axis"] = _words(_axis(joint))
    if joint.get("type") != "continuous":
        attributes["range"] = f"{limit.get('lower', '0')} {limit.get('upper', '0')}"
    effort = 0.0 if limit is None else float(limit.get("effort", 0))
    if effort > 0:
        attributes["actuatorfrcrange"] = _words([-effort, effort])
    SubElement(body, "joint", **attributes)


def _axis(joint: Element) -> np.ndarray:
    axis = joint.find("axis")
    return np.array([1.0, 0.0, 0.0] if axis is None else _numbers(axis.get("xyz")))


def _inertial(body: Element, inertials: list[tuple[float, np.ndarray, np.ndarray]]) -> None:
    mass = sum(part[0] for part in inertials)
    center = sum(part[0] * part[1] for part in inertials) / mass
    tensor = np.zeros((3, 3))
    for part, at, own in inertials:
        shift = at - center
        tensor += own + part * (shift @ shift * np.eye(3) - np.outer(shift, shift))
    six = [tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[0, 1], tensor[0, 2], tensor[1, 2]]
    SubElement(body, "inertial", pos=_words(center), mass=_words([mass]), fullinertia=_words(six))


def _geoms(body: Element, link: Link, assets: Element | None, hulls: Path | None) -> None:
    if assets is None:
        for shape in link.shapes:
            SubElement(body, "geom", **shape.mjcf())
        return
    for k, mesh in enumerate(link.meshes):
        name = f"{body.get('name')}_{k}"
        mesh.convex_hull.export(hulls / f"{name}.stl")
        SubElement(assets, "mesh", name=name, file=str(hulls / f"{name}.stl"), inertia="convex")
        SubElement(body, "geom", type="mesh", mesh=name)


def _pose(T: np.ndarray) -> dict[str, str]:
    attributes = {}
    if T[:3, 3].any():
        attributes["pos"] = _words(T[:3, 3])
    if not np.array_equal(T[:3, :3], np.eye(3)):
        x, y, z, w = Rotation.from_matrix(T[:3, :3]).as_quat(canonical=True)
        attributes["quat"] = _words([w, x, y, z], 16)
    return attributes


def _words(values, digits: int = 9) -> str:
    return " ".join(f"{round(float(value), 16) + 0.0:.{digits}g}" for value in values)


def fit_shapes(links: list[Link], parts: int = 0) -> None:
    """Fit every link's shapes to its collision meshes, about its own joint's axis and the next one's."""
    for link, after in zip(links, [*links[1:], None], strict=True):
        if link.meshes:
            whole = trimesh.util.concatenate(link.meshes)
            axes = [(np.zeros(3), _axis(link.joint))] if link.joint is not None else []
            if after is not None:
                axes.append((after.T_parent[:3, 3], after.T_parent[:3, :3] @ _axis(after.joint)))
            link.shapes = fit(whole, axes, parts)
            link.excess = excess(whole, link.shapes)


def touching(text: str, seed: int = 1) -> tuple[dict[tuple[str, str], float], float]:
    """In which share of random configurations bodies touch, by their names, and any two do."""
    model = mujoco.MjModel.from_xml_string(text)
    data, found, some = mujoco.MjData(model), {}, 0
    low, high = np.where(model.jnt_limited[:, None], model.jnt_range, [-math.pi, math.pi]).T
    for q in np.random.default_rng(seed).uniform(low, high, (CONFIGURATIONS, model.njnt)):
        data.qpos[:] = q
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        pairs = {tuple(sorted(model.geom_bodyid[c.geom].tolist())) for c in data.contact if c.dist < 0}
        some += bool(pairs)
        for pair in pairs:
            found[pair] = found.get(pair, 0) + 1 / CONFIGURATIONS
    names = {pair: (model.body(pair[0]).name, model.body(pair[1]).name) for pair in found}
    return {names[pair]: share for pair, share in found.items()}, some / CONFIGURATIONS


def text_of(root: Element) -> str:
    """The file's text."""
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode") + "\n"


def write(
    name: str, links: list[Link], T_tip: np.ndarray, description: str, source: str, hulls: Path, parts: int = 0
) -> dict[tuple[str, str], tuple[float, float]]:
    """Write a robot's model; two links that touch by the fit alone, with one between them, are excluded.

    Hulls of such a pair's meshes hardly ever touch in random configurations, and its shapes do in many; or its shapes
    nearly always do, as their housings overlap. Returns the excluded pairs, with the shares of configurations in which
    shapes and hulls touch. ``hulls``: a folder for the meshes meanwhile; ``parts``: see `fit`.
    """
    fit_shapes(links, parts)
    order = ["base", *(link.name for link in links[1:])]
    fitted, _ = touching(text_of(mjcf(name, links, T_tip, description, source)))
    real, _ = touching(text_of(mjcf(name, links, T_tip, description, source, hulls=hulls)))
    exclude = {}
    for pair, share in sorted(fitted.items(), key=lambda item: [order.index(one) for one in item[0]]):
        seldom = real.get(pair, 0) == 0 or (real[pair] < SELDOM and share > OFTEN)
        if share > ALWAYS or (seldom and order.index(pair[1]) - order.index(pair[0]) == 2):
            exclude[pair] = share, real.get(pair, 0.0)
    folder = library.find("ur5e").parent.parent / name
    folder.mkdir(exist_ok=True)
    text = text_of(mjcf(name, links, T_tip, description, source, list(exclude)))
    (folder / f"{name}.xml").write_text(text, encoding="utf-8")
    return exclude


def main() -> None:
    """Write a robot's model file from a URDF."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("urdf", type=Path)
    parser.add_argument("name")
    parser.add_argument("--base", required=True)
    parser.add_argument("--tip", required=True)
    parser.add_argument("--bodies", nargs="*")
    parser.add_argument("--description", default="")
    parser.add_argument("--source", default="")
    parser.add_argument("--hulls", type=Path, required=True, help="a folder for convex hulls")
    parser.add_argument("--parts", type=int, default=0, help="into how many a link that is not convex may be cut")
    given = parser.parse_args()
    links, T_tip = links_of(given.urdf, given.base, given.tip, given.bodies)
    exclude = write(given.name, links, T_tip, given.description, given.source, given.hulls, given.parts)
    for link in links:
        print(f"{link.name}: {len(link.shapes)} shapes, at most {1000 * link.excess:.0f} mm beyond the mesh")
    print(f"excluded: {exclude}")


if __name__ == "__main__":
    main()
