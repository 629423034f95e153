"""Files of meshes, from strangers too: STL, OBJ and COLLADA (.dae), read here, and what trimesh reads.

None leads to another file.
"""

import re
import zipfile
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from io import BytesIO
from itertools import chain
from pathlib import Path, PurePosixPath
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np

from wsrender.errors import ModelError
from wsrender.robots import xml_source
from wsrender.robots.packages import Packages, folders_of

MAX_MESH_BYTES = 256 * 2**20
MAX_CORNERS = 6_000_000  # of triangles; the largest meshes of robots have a tenth

ReadMesh = Callable[[str], bytes | None]  # file name in the model → its bytes, None where it is not there
Triangles = tuple[np.ndarray, np.ndarray]  # vertices (V, 3) float64, faces (F, 3) int

_STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
ADDRESS = re.compile(r"(package|model|file)://")


def not_there(name: str) -> str:
    """What is said of a file that a model names and that is not there; of one in a package, how that is found."""
    said, scheme = f"the file {name!r} is not there, or is too large", ADDRESS.match(name)
    if scheme is None or scheme[1] != "package":
        return said
    package = name[scheme.end() :].partition("/")[0]
    places = "above a model that is loaded by its path, in ROS_PACKAGE_PATH and AMENT_PREFIX_PATH"
    return f'{said}: packages are found {places}, or name its folder by packages={{"{package}": …}}'


def from_assets(assets: Mapping[str, bytes]) -> ReadMesh:
    """Reads meshes from a mapping of file names, as the model writes them, to bytes; never from disk."""
    by_last_part = {Path(name).name: content for name, content in assets.items()}
    return lambda name: assets.get(name, by_last_part.get(Path(name).name))


def from_folder(folder: Path, packages: Packages | None = None) -> ReadMesh:
    """Reads meshes relative to ``folder``: for files of the user's own.

    ``package://name/rest`` and ``model://name/rest`` are ``rest`` in a folder of that package or model; see
    `wsrender.robots.packages.folders_of`.
    """

    def read(name: str) -> bytes | None:
        for path in _places(name, folder.absolute(), packages or {}):
            if path.is_file() and path.stat().st_size <= MAX_MESH_BYTES:
                return path.read_bytes()
        return None

    return read


def _places(name: str, folder: Path, packages: Packages) -> Iterator[Path]:
    scheme = ADDRESS.match(name)
    if scheme is None or scheme[1] == "file":
        yield folder / name.removeprefix("file://")
        return
    package, _, rest = name[scheme.end() :].partition("/")
    for root in folders_of(package, folder, packages):
        yield root / rest


def triangles(content: bytes, name: str, field: str) -> Triangles:
    """Vertices (V, 3) and faces (F, 3) of the file ``name``, in the file's unit (COLLADA: metres).

    Raises ModelError for another format, for what cannot be read, for numbers that are not finite, for one without
    triangles, and for one of more than MAX_CORNERS corners.
    """
    suffix = PurePosixPath(name.replace("\\", "/")).suffix.lower()
    readers = {".stl": _stl, ".obj": _obj, ".dae": _collada}
    if suffix not in readers and suffix not in (others := _formats()):
        allowed = ", ".join(sorted({*readers, *others}))
        raise ModelError(field, f"the mesh {name!r} is of a format that is not read; allowed: {allowed}")
    try:
        vertices, faces = readers[suffix](content) if suffix in readers else _by_trimesh(content, suffix)
    except ModelError as error:
        raise ModelError(field, f"the mesh {name!r} cannot be read: {error.message}") from error
    except (ValueError, LookupError, OverflowError, StopIteration) as error:
        raise ModelError(field, f"the mesh {name!r} cannot be read as {suffix}: {error}") from error
    if not len(faces):
        raise ModelError(field, f"the mesh {name!r} has no triangles")
    if faces.size > MAX_CORNERS:
        raise ModelError(field, f"the mesh {name!r} has {len(faces)} triangles; allowed: {MAX_CORNERS // 3}")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise ModelError(field, f"the mesh {name!r} names vertices that it does not have")
    if not np.isfinite(vertices).all():
        raise ModelError(field, f"the mesh {name!r} must hold finite numbers")
    return vertices, faces


def _formats() -> set[str]:
    """Endings of the files that trimesh reads here; some need packages beside it."""
    from trimesh.exchange.load import mesh_formats

    return {f".{each}" for each in mesh_formats()}


def _by_trimesh(content: bytes, suffix: str) -> Triangles:
    """All triangles of a file, its scene flattened, in its own unit; without a resolver, no other file is read."""
    import trimesh

    if suffix == ".gltf" and re.search(rb'"uri"\s*:\s*"(?!data:)', content):
        raise ValueError("it leads to other files: make it a .glb")
    if zipfile.is_zipfile(file := BytesIO(content)):  # .3mf, .3dxml, .zae
        with zipfile.ZipFile(file) as archive:
            if (size := sum(each.file_size for each in archive.infolist())) > MAX_MESH_BYTES:
                raise ValueError(f"it unpacks to {size} bytes; at most {MAX_MESH_BYTES} are allowed")
    try:
        found: Any = trimesh.load_scene(BytesIO(content), file_type=suffix[1:], process=False).to_mesh()
        return np.asarray(found.vertices, np.float64).reshape(-1, 3), np.asarray(found.faces, int).reshape(-1, 3)
    except MemoryError:
        raise
    except Exception as error:  # its readers raise whatever they stumble over
        raise ValueError(" ".join(str(error).split()) or type(error).__name__) from error


def _stl(content: bytes) -> Triangles:
    count = int.from_bytes(content[80:84], "little")
    if len(content) >= 84 and 84 + count * _STL_TRIANGLE.itemsize == len(content):
        corners = np.frombuffer(content, _STL_TRIANGLE, count, 84)["corners"].reshape(-1, 3).astype(float)
    elif content.lstrip()[:5].lower() == b"solid":
        corners = _rows([line.split()[1:] for line in content.splitlines() if line.split()[:1] == [b"vertex"]])
    else:
        raise ValueError(f"{len(content)} bytes are no file of {count} triangles")
    vertices, inverse = np.unique(corners, axis=0, return_inverse=True)
    return vertices, inverse.reshape(-1, 3)


def _obj(content: bytes) -> Triangles:
    lines = [words for line in content.splitlines() if (words := line.split())]
    vertices = _rows([words[1:4] for words in lines if words[0] == b"v"])
    corners: list[list[int]] = []
    seen = 0  # vertices so far: a negative number counts back from the last
    for words in lines:
        seen += words[0] == b"v"
        if words[0] == b"f":
            numbers = [int(word.partition(b"/")[0]) for word in words[1:]]
            corners.append([number - 1 if number > 0 else seen + number for number in numbers])
    return vertices, _fans(corners)


def _collada(content: bytes) -> Triangles:
    """The triangles of a scene in metres; which axis is up is not asked, as RViz does not."""
    root = xml_source.parse(content)
    for element in root.iter():
        element.tag = element.tag.rpartition(":")[2]
    by_id = {f"#{key}": element for element in root.iter() if (key := element.get("id"))}
    unit = root.find("asset/unit")
    metre = float(unit.get("meter", "1")) if unit is not None else 1.0
    parts: list[Triangles] = []
    geometry = cache(lambda url: _geometry(by_id[url], by_id))
    scenes = [by_id[scene.get("url", "")] for scene in root.iterfind("scene/instance_visual_scene")]
    nodes = chain.from_iterable(_nodes(scene, np.diag([metre, metre, metre, 1.0]), by_id, ()) for scene in scenes)
    size = 0
    for count, (node, T) in enumerate(nodes):
        if count == xml_source.MAX_ELEMENTS:
            raise ValueError(f"its nodes are instances of more than {count} others")
        for instance in node.findall("instance_geometry"):
            for vertices, faces in geometry(instance.get("url", "")):
                size += max(len(vertices), faces.size)
                if size > MAX_CORNERS:
                    raise ValueError(f"it has more than {MAX_CORNERS // 3} triangles")
                parts.append((vertices @ T[:3, :3].T + T[:3, 3], faces))
    if not parts:
        return np.zeros((0, 3)), np.zeros((0, 3), int)
    offsets = np.cumsum([0, *(len(vertices) for vertices, _ in parts[:-1])])
    return (
        np.concatenate([vertices for vertices, _ in parts]),
        np.concatenate([faces + offset for offset, (_, faces) in zip(offsets, parts, strict=True)]),
    )


def _nodes(
    parent: Element, T: np.ndarray, by_id: dict[str, Element], above: tuple[Element, ...]
) -> Iterator[tuple[Element, np.ndarray]]:
    """The nodes below a node or scene at ``T`` (4, 4), each at its own; ``above``: those that it is an instance in."""
    for node in [*parent.findall("node"), *(by_id[each.get("url", "")] for each in parent.findall("instance_node"))]:
        if node in above or len(above) > xml_source.MAX_DEPTH:
            raise ValueError("a node is an instance of itself")
        T_node = T @ _placed(node)
        yield node, T_node
        yield from _nodes(node, T_node, by_id, (*above, node))


def _placed(node: Element) -> np.ndarray:
    T = np.eye(4)
    for step in node:
        numbers = np.array((step.text or "").split(), float) if step.tag in _STEPS else np.zeros(0)
        if step.tag == "matrix":
            T = T @ numbers.reshape(4, 4)
        elif step.tag == "translate":
            T[:3, 3] += T[:3, :3] @ numbers
        elif step.tag == "scale":
            T[:3, :3] *= numbers
        elif step.tag == "rotate":
            T[:3, :3] = T[:3, :3] @ _turn(numbers[:3], np.radians(numbers[3]))
        elif step.tag in ("lookat", "skew"):
            raise ValueError(f"<{step.tag}> is not supported")
    return T


_STEPS = ("matrix", "translate", "scale", "rotate")


def _turn(axis: np.ndarray, angle: float) -> np.ndarray:
    """Rotation (3, 3) about an axis by an angle: 1 + sin K + (1 - cos) K² (Rodrigues 1840)."""
    x, y, z = axis / np.linalg.norm(axis)
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def _geometry(geometry: Element, by_id: dict[str, Element]) -> list[Triangles]:
    """The triangles of a geometry's primitives, each with the vertices of its own source."""
    found = []
    for primitive in [each for each in geometry.iterfind("mesh/*") if each.tag in _POLYGONS]:
        inputs = primitive.findall("input")
        stride = 1 + max((int(each.get("offset", "0")) for each in inputs), default=0)
        vertex = next(each for each in inputs if each.get("semantic") == "VERTEX")
        offset = int(vertex.get("offset", "0"))
        positions = next(each for each in by_id[vertex.get("source", "")] if each.get("semantic") == "POSITION")
        values = by_id[positions.get("source", "")].find("float_array")
        vertices = np.array(((values is not None and values.text) or "").split(), float).reshape(-1, 3)
        lists = [np.array((each.text or "").split(), int)[offset::stride] for each in primitive.findall("p")]
        if primitive.tag == "triangles":
            faces = np.concatenate([np.zeros(0, int), *lists]).reshape(-1, 3)
        elif primitive.tag == "polylist":
            counts = np.array((primitive.findtext("vcount") or "").split(), int)
            faces = _fans([part.tolist() for part in np.split(lists[0], np.cumsum(counts)[:-1])]) if lists else None
        else:
            faces = _fans([corners.tolist() for corners in lists])
        if faces is not None:
            found.append((vertices, faces))
    return found


_POLYGONS = ("triangles", "polylist", "polygons")


def _fans(polygons: list[list[int]]) -> np.ndarray:
    """Triangles (F, 3) int of polygons, all from the first corner of each."""
    fans = [(corners[0], *corners[k : k + 2]) for corners in polygons for k in range(1, len(corners) - 1)]
    return np.array(fans, int).reshape(-1, 3)


def _rows(words: list[list[bytes]]) -> np.ndarray:
    """Three numbers in each of N rows, (N, 3) float64."""
    if any(len(row) != 3 for row in words):
        raise ValueError("a vertex has not three numbers")
    return np.array(words, float).reshape(-1, 3)
