"""MJCF text, made safe for MuJoCo's compiler: what moves and weighs is kept, the scenery is not."""

from collections.abc import Collection
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from wsrender.errors import ModelError
from wsrender.robots.xml_source import MAX_BYTES, MAX_ELEMENTS, number, plain_digits

MOST_MADE = 100_000  # vertices of meshes that MuJoCo makes by itself

# Sections that neither kinematics nor inertia depend on; several of them could read files.
_SCENERY = ("option", "size", "visual", "statistic", "custom", "extension", "deformable", "contact",
            "sensor", "keyframe")  # fmt: skip
_DROPPED = {"camera", "light", "texture", "material", "skin", "plugin"}
# Arrays that are of no use here, and whose sizes a model may choose.
_IDLE = {"user", "actdim", "nsample", "delay", "interp"}
_HOLD_BODIES = ("body", "frame", "replicate")
_REFUSED = {
    "include": "includes are refused where no folder is known to read them from: inline the file, by putting what is "
    "inside its <mujoco> element in the place of <include>, load the model by its path where it stands, or upload its "
    "folder as a ZIP",
    "attach": "attached models are refused: inline the model",
    "model": "model assets are refused: inline the model",
    "composite": "composite bodies are not supported",
    "flexcomp": "flexible bodies are not supported",
}
_NUMERIC = {
    "pos", "quat", "axis", "axisangle", "xyaxes", "zaxis", "euler", "range", "ref", "size", "fromto", "mass",
    "diaginertia", "fullinertia", "armature", "polycoef", "gear", "ctrlrange", "forcerange", "density",
    "actuatorfrcrange", "anchor", "relpose", "vertex", "elevation", "scale", "refpos", "refquat", "boundmass",
    "boundinertia", "settotalmass", "offset", "coef", "margin", "springref", "damping", "stiffness", "params",
}  # fmt: skip


def refuse_includes(mujoco: Element, field: str) -> None:
    """Raises ModelError, with how to inline it, for a model that includes a file: of text, none is read."""
    if next(mujoco.iter("include"), None) is not None:
        raise ModelError(field, _REFUSED["include"])


def sanitized(mujoco: Element, field: str, keep: Collection[str] = ()) -> Element:
    """The ``<mujoco>`` element without scenery and materials, its numbers checked; changed in place.

    ``keep``: sections of scenery that stay. Raises ModelError for elements that read other files or build bodies by
    the thousand, and for numbers that are not finite.
    """
    for section in list(mujoco):
        if section.tag in _SCENERY and section.tag not in keep:
            mujoco.remove(section)
    _clean(mujoco, field)
    _bound_replicas(mujoco, field)
    _bound_made_meshes(mujoco, field)
    return mujoco


def carried(mujoco: Element, name: str) -> None:
    """Puts all bodies into one of a name, in place; shapes that the world itself has stay where they are."""
    carrier = Element("body", name=name)
    for world in mujoco.findall("worldbody"):
        for child in [child for child in world if child.tag in _HOLD_BODIES]:
            world.remove(child)
            carrier.append(child)
    ElementTree.SubElement(mujoco, "worldbody").append(carrier)


def directories(mujoco: Element) -> tuple[str, bool]:
    """Folder of the meshes as the ``<compiler>`` states it, and whether paths are stripped from names.

    The attributes are removed: mesh files are handed to MuJoCo under names of our own.
    """
    folder, strip = "", False
    for compiler in mujoco.findall("compiler"):
        get = compiler.attrib
        folder = get.pop("meshdir", "") or get.pop("assetdir", "") or folder
        strip = get.pop("strippath", "false") == "true" or strip
        for other in ("texturedir", "assetdir", "meshdir"):
            get.pop(other, None)
    return folder, strip


def text(mujoco: Element) -> str:
    """The element as XML text, without declaration."""
    return ElementTree.tostring(mujoco, encoding="unicode")


def _clean(element: Element, field: str) -> None:
    for key in [key for key in element.attrib if key in _IDLE or key == "material" or ":" in key or key == "xmlns"]:
        del element.attrib[key]
    for key in _NUMERIC.intersection(element.attrib):
        _check_numbers(element, key, field)
    for child in list(element):
        if child.tag in _REFUSED and not (child.tag == "model" and element.tag != "asset"):
            raise ModelError(field, _REFUSED[child.tag])
        of_file = child.tag == "hfield" and ("file" in child.attrib or "elevation" not in child.attrib)
        if child.tag in _DROPPED or of_file:
            element.remove(child)
        else:
            _clean(child, field)


def _check_numbers(element: Element, key: str, field: str) -> None:
    name = element.get("name") or element.get("joint") or ""
    for word in element.attrib[key].split():
        number(word, field, f"<{element.tag}> {name!r}: {key}" if name else f"<{element.tag}>: {key}")


def _bound_replicas(mujoco: Element, field: str) -> None:
    elements, characters = _expanded(mujoco, field)
    if elements > MAX_ELEMENTS:
        raise ModelError(field, f"replicas make {elements} elements; at most {MAX_ELEMENTS} are allowed")
    if characters > MAX_BYTES:
        raise ModelError(field, f"replicas make {characters} characters; at most {MAX_BYTES} are allowed")


def _expanded(element: Element, field: str) -> tuple[int, int]:
    """Elements, and characters of their attributes, after replicas are written out."""
    parts = [_expanded(child, field) for child in element]
    times = 1
    if element.tag == "replicate":
        times = max(plain_digits(element.get("count", ""), field, "<replicate>: count"), 1)
    own = sum(map(len, element.attrib.values()))
    return 1 + times * sum(part[0] for part in parts), own + times * sum(part[1] for part in parts)


def _bound_made_meshes(mujoco: Element, field: str) -> None:
    """A mesh that is made of ``params`` has at most the square of the largest in vertices."""
    params = [mesh.get("params", "").split() for mesh in mujoco.iter("mesh")]
    largest = [max(abs(float(word)) for word in words) for words in params if words]
    if (count := sum(each * each for each in largest)) > MOST_MADE:
        raise ModelError(field, f"params of meshes make up to {count:.3g} vertices; at most {MOST_MADE} are allowed")
