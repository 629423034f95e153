"""Loading robots: a library name, MJCF, URDF or a DH table becomes a compiled model and a chain."""

import hashlib
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any
from xml.etree.ElementTree import Element

import numpy as np

from wsrender import notices
from wsrender.errors import InputError, MissingExtraError, ModelError
from wsrender.robots import archives, includes, library, mesh_files, named_models, xacro_files, xml_source
from wsrender.robots.model_warning import ModelWarning
from wsrender.robots.plausibility import doubts
from wsrender.robots.srdf import disabled_pairs

if TYPE_CHECKING:
    from collections.abc import Callable

    import mujoco

    from wsrender.documents.robot import DHTable, MountJoint
    from wsrender.robots.chain import Chain
    from wsrender.robots.compiled_model import CompiledModel
    from wsrender.robots.loaded_robot import LoadedRobot
    from wsrender.robots.mesh_files import ReadMesh
    from wsrender.robots.packages import Packages
    from wsrender.robots.shapes import Shape

    Limits = Mapping[str, tuple[float, float]]
    Excluded = Sequence[tuple[str, str]]
    Source = str | Path | DHTable | mujoco.MjSpec | mujoco.MjModel

USD_FILES = (".usd", ".usda", ".usdc", ".usdz")
MODEL_FILES = (".xml", ".mjcf", ".urdf", ".xacro", ".sdf", ".world", ".zip", *USD_FILES)  # what their names end in
ROOTS = "<mujoco>, <robot> (URDF) or <sdf> is needed"
_USD = (
    "USD is not read: convert it to URDF, by Isaac Sim's extension isaacsim.asset.exporter.urdf "
    "(File > URDF Exporter), or to MJCF"
)
_FIELD = "model"


def load(
    source: "Source",
    *,
    base: str | None = None,
    tip: str | None = None,
    name: str | None = None,
    placement: np.ndarray | None = None,
    tool: np.ndarray | None = None,
    limits: "Limits | None" = None,
    limits_deg: "Limits | None" = None,
    effort_limits: Mapping[str, float] | None = None,
    velocity_limits: Mapping[str, float] | None = None,
    length_unit_m: float | None = None,
    reference: Mapping[str, float] | None = None,
    srdf: str | None = None,
    exclude: "Excluded" = (),
    attached: "Sequence[Shape]" = (),
    mount: "Sequence[MountJoint]" = (),
    packages: "Packages | None" = None,
    xacro: "Mapping[str, Any] | None" = None,
    entry: str | None = None,
) -> "LoadedRobot":
    """The robot of a name, of a path to or the text of an MJCF, URDF or SDF file, of a DH table, MjSpec or MjModel.

    A name is one of the library, or of another program's for such a robot, or of a collection: menagerie:…,
    robot_descriptions:…, example-robot-data:… (see `wsrender.robots.named_models`).

    A string is text if it begins with <, a path if it ends in .xml, .urdf, .xacro or .zip or has a folder in it.
    ``base`` and ``tip`` name a site, body or link. The base is the world by default. The tip is by default the site
    ``tool``, else the only end of the model that a joint moves, else the link ``tool0``; a site goes before a body of
    its name.
    ``placement`` is the base frame in the world and ``tool`` the tool frame in the tip frame, (4, 4) each.
    ``limits`` (``limits_deg``: hinges in degrees) of joints of the chain by name, (lower, upper) [rad or m], go before
    the model's, as do ``effort_limits`` [N m or N] and ``velocity_limits`` [rad/s or m/s] of joints by name.
    ``length_unit_m`` is the model's unit of length [m]; given, no length is doubted. ``reference`` is
    where joints beside the chain stand, by name [rad or m], instead of at the model's zero. ``srdf`` is SRDF
    text, whose disabled pairs of links do not collide, nor do those of ``exclude``, pairs of names of shapes or bodies.
    ``attached``: shapes that the tip carries, in its frame. ``mount``: joints that carry the base, which then must be
    the world; they are the first of the chain. ``packages``: folders of ROS packages by name, before all others, and
    ``xacro``: arguments of a xacro file by name; ``entry``: which file of a ZIP or folder is the model, where several
    could be; these for a path alone.
    Raises ModelError, FrameNotFoundError, InputError; gives a ModelWarning for each of the robot's notices.
    """
    options = {"base": base, "tip": tip, "name": name, "placement": placement, "tool": tool}
    options |= {"limits": limits, "limits_deg": limits_deg, "length_unit_m": length_unit_m}
    options |= {"effort_limits": effort_limits, "velocity_limits": velocity_limits}
    options |= {"reference": reference, "srdf": srdf, "exclude": exclude, "attached": attached, "mount": mount}
    source, xacro, packages = named_models.resolved(source, xacro, packages)
    kind, value = described(source)
    if kind == "path":
        options |= {"packages": packages, "xacro": xacro, "entry": entry}
    elif stray := [name for name, given in (("packages", packages), ("xacro", xacro), ("entry", entry)) if given]:
        raise InputError(stray[0], "goes with the path of a file alone")
    loaders = {"library": load_library, "path": load_path, "dh": load_dh, "mjcf": load_mjcf, "urdf": load_urdf}
    return loaders[kind](value, **options)


def described(source: "Source") -> tuple[str, Any]:
    """What the robot of a job document says of what `load` takes: the field of its source, and the value there.

    Raises InputError for what is no source, ModelError for text that is no model.
    """
    from wsrender.documents.robot import DHTable

    if of_mujoco(source):
        return "mjcf", _mjcf_model().text_of(source, _FIELD)
    if isinstance(source, DHTable):
        return "dh", source
    if isinstance(source, Path):
        return "path", str(source)
    if not isinstance(source, str):
        kinds = "a library name, the path or text of an MJCF (.xml) or URDF file, a DHTable, MjSpec or MjModel"
        raise InputError("source", f"must be {kinds}, not {type(source).__name__}")
    if source.lstrip("\ufeff \t\r\n").startswith("<"):
        return ("urdf" if xml_source.parse(source, _FIELD).tag in ("robot", "sdf") else "mjcf"), source
    is_path = source.lower().endswith(MODEL_FILES) or "/" in source or "\\" in source
    return "path" if is_path else "library", source


def of_mujoco(source: Any) -> bool:
    """Whether a source is a model that was made with MuJoCo in Python: an MjSpec or an MjModel."""
    mujoco = sys.modules.get("mujoco")  # one that is not imported has made nothing
    return mujoco is not None and isinstance(source, mujoco.MjSpec | mujoco.MjModel)


def load_library(robot: str, **options) -> "LoadedRobot":
    """The library's ``robot``; ``options`` as in ``load``. Raises ModelError listing the names."""
    path = library.find(robot)
    return load_path(path, **{**options, "name": options.get("name") or path.stem})


def load_dh(table: "DHTable", **options) -> "LoadedRobot":
    """The robot of a DH table; ``options`` as in ``load``."""
    from wsrender.robots import dh

    return load_mjcf(dh.to_mjcf(table), **options, said=dh.doubts(table))


def load_path(
    path: str | Path,
    *,
    packages: "Packages | None" = None,
    xacro: "Mapping[str, Any] | None" = None,
    entry: str | None = None,
    **options,
) -> "LoadedRobot":
    """The robot of a file of the user's own, MJCF, URDF or SDF by its root element; ``options`` as in ``load``.

    Files that an MJCF or SDF includes and meshes that an inertia is computed from are read relative to it, other meshes
    when shapes are asked for; nothing else is. A xacro file is expanded first, a folder read as a ZIP of it would be.
    """
    path = Path(path)
    if archives.is_path(path):
        for name, given in (("packages", packages), ("xacro", xacro)):
            if given:
                raise InputError(name, f"goes with the path of a model, and {path.name} is a folder or a ZIP of one")
        return load_archive(archives.of_path(path, _FIELD), entry=entry, **options)
    if (remedy := library.for_mechanism(path)) is not None:
        raise ModelError(_FIELD, remedy)
    if entry is not None:
        raise InputError("entry", f"goes with a ZIP or a folder, and {path.name} is neither")
    content = xml_source.read(path, _FIELD)
    if path.suffix.lower() in USD_FILES or content[:8] == b"PXR-USDC":
        raise ModelError(_FIELD, _USD)
    root = xml_source.parse(content, _FIELD)
    if root.tag == "robot" and (xacro_files.is_xacro(path, root) or xacro):
        content = xacro_files.expanded(path, xacro or {}, packages or {}, _FIELD)
        root = xml_source.parse(content, _FIELD)
    elif xacro:
        raise InputError("xacro", f"goes with a xacro file; the root element of {path.name} is <{root.tag}>")
    read = mesh_files.from_folder(path.parent, packages)
    return _from_files(root, content, read, repr(str(path.parent)), path.stem, **options)


def load_archive(content: bytes, *, entry: str | None = None, **options) -> "LoadedRobot":
    """The robot of a ZIP of models and meshes; no file is read, and none written. ``options`` as in ``load``."""
    archive = archives.Archive(content, entry, _FIELD)
    text = archive.model()
    stem = PurePosixPath(archive.entry).stem
    return _from_files(xml_source.parse(text, _FIELD), text, archive.read, "the archive", stem, **options)


def _from_files(root: Element, content: bytes, read: "ReadMesh", place: str, stem: str, **options) -> "LoadedRobot":
    """The robot of a model file, named ``stem`` where it has no name, and of those that ``read`` reads in a place."""
    options = {**options, "name": options.get("name") or root.get("model") or root.get("name")}
    if root.tag != "sdf":  # which says its name further in
        options["name"] = options["name"] or stem
    if root.tag == "robot":
        return _from_urdf(root, content, read, **options)
    if root.tag == "sdf":
        return _from_sdf(root, content, read, **options)
    if root.tag != "mujoco":
        raise ModelError(_FIELD, f"the root element is <{root.tag}>; {ROOTS}")
    content = b"".join([content, *includes.put_in(root, read, place, _FIELD)])
    return _from_mjcf(root, content, read, **options)


def load_mjcf(text: str | bytes, *, assets: Mapping[str, bytes] | None = None, **options) -> "LoadedRobot":
    """The robot of MJCF text; no file is read. ``options`` as in ``load``.

    ``assets`` maps names of mesh files, as the text writes them, to their bytes.
    """
    root = _root(text, "mujoco")
    return _from_mjcf(root, text, mesh_files.from_assets(assets or {}), **options)


def load_urdf(text: str | bytes, *, assets: Mapping[str, bytes] | None = None, **options) -> "LoadedRobot":
    """The robot of URDF or SDF text; no file is read. ``options`` as in ``load``, ``assets`` as in ``load_mjcf``."""
    if (root := xml_source.parse(text, _FIELD)).tag == "sdf":
        return _from_sdf(root, text, mesh_files.from_assets(assets or {}), **options)
    return _from_urdf(_root(text, "robot"), text, mesh_files.from_assets(assets) if assets else None, **options)


def _mjcf_model():
    try:
        from wsrender.robots import mjcf_model
    except ModuleNotFoundError as error:
        if error.name != "mujoco":
            raise
        raise MissingExtraError("mujoco", "engine") from error
    return mjcf_model


def _root(text: str | bytes, tag: str) -> Element:
    root = xml_source.parse(text, _FIELD)
    if root.tag != tag:
        raise ModelError(_FIELD, f"the root element is <{root.tag}>; <{tag}> is needed")
    return root


def _from_mjcf(root: Element, text: str | bytes, read_mesh: "ReadMesh", **options) -> "LoadedRobot":
    compile_mjcf = partial(_mjcf_model().compile_mjcf, root, read_mesh, _FIELD)
    return _loaded(compile_mjcf, text, **options)


def _from_urdf(root: Element, text: str | bytes, read_mesh: "ReadMesh | None", **options) -> "LoadedRobot":
    _mjcf_model()
    from wsrender.robots.urdf_model import compile_urdf

    return _loaded(partial(compile_urdf, root, read_mesh, _FIELD), text, **options)


def _from_sdf(root: Element, text: str | bytes, read: "ReadMesh", **options) -> "LoadedRobot":
    _mjcf_model()
    from wsrender.robots.compiled_model import building
    from wsrender.robots.sdf import read_sdf
    from wsrender.robots.urdf_model import compile_tree

    with building(_FIELD):
        tree, included = read_sdf(root, read, _FIELD)
    content = b"".join([text.encode() if isinstance(text, str) else text, *included])
    options = {**options, "name": options.get("name") or tree.name}
    return _loaded(partial(compile_tree, tree, read, _FIELD), content, **options)


def _loaded(
    compile_model: "Callable[[float, Sequence[MountJoint]], CompiledModel]",
    text: str | bytes,
    *,
    base=None,
    tip=None,
    name=None,
    placement=None,
    tool=None,
    limits=None,
    limits_deg=None,
    effort_limits=None,
    velocity_limits=None,
    length_unit_m=None,
    reference=None,
    srdf=None,
    exclude=(),
    attached=(),
    mount=(),
    held=(),
    said=(),
) -> "LoadedRobot":
    """The robot of a model that ``compile_model`` makes of its unit of length and mount; warns of its notices.

    ``held``: joints that need no limits; ``said``: notices of the source itself.
    """
    from wsrender.robots.chain_extraction import Given, extract
    from wsrender.robots.compiled_model import building

    if mount and base is not None:
        raise InputError("mount", f'must not be given with a "base", here {base!r}: it carries all of the model')
    source_hash = hashlib.sha256(text.encode() if isinstance(text, str) else text).hexdigest()
    given = dict(limits or {}) | {joint: tuple(np.radians(ends)) for joint, ends in (limits_deg or {}).items()}
    with building(_FIELD):
        compiled = compile_model(1.0 if length_unit_m is None else length_unit_m, mount)
        called = name or compiled.name or "robot"
        own = Given(given, effort_limits or {}, velocity_limits or {}, reference or {})
        robot = extract(compiled, base, tip, called, source_hash, own, _FIELD)
    _check_limits(robot.chain, limits or {}, limits_deg or {})
    chain = robot.chain.placed(_rigid("placement", placement), _rigid("tool", tool))
    confirmed = {*given, *(joint.name for joint in mount)}
    found = (*said, *robot.notices, *doubts(chain, confirmed, length_unit_m is not None, held))
    notices.warn(found, ModelWarning)
    disabled = disabled_pairs(srdf) if srdf is not None else ()
    source = replace(robot.body_source, attached=tuple(attached), excluded=tuple(exclude), disabled=disabled)
    loaded = replace(robot, chain=chain, notices=found, body_source=source)
    if exclude:
        _ = loaded.bodies  # which have the names that it must keep to
    return loaded


def _check_limits(chain: "Chain", limits: "Limits", limits_deg: "Limits") -> None:
    """Raises InputError for limits of what is no coordinate of the chain, and for a slide's in degrees."""
    revolute = dict(zip(chain.joint_names, chain.revolute, strict=True))
    for field, given in (("limits", limits), ("limits_deg", limits_deg)):
        for joint in given:
            if joint not in revolute:
                names = ", ".join(chain.joint_names)
                raise InputError(f"{field}.{joint}", f"is no joint of the chain that leads itself; allowed: {names}")
            if field == "limits_deg" and not revolute[joint]:
                raise InputError(f"{field}.{joint}", 'is a slide: give it in metres, in "limits"')


def _rigid(field: str, T: np.ndarray | None) -> np.ndarray | None:
    """A checked rigid (4, 4) transform."""
    if T is None:
        return None
    T = np.asarray(T, float)
    if T.shape != (4, 4) or not np.isfinite(T).all():
        raise InputError(field, f"must be a (4, 4) array of finite numbers, not of shape {T.shape}")
    R = T[:3, :3]
    turned = np.abs(R @ R.T - np.eye(3)).max() < 1e-9 and np.linalg.det(R) > 0.0
    if not turned or np.abs(T[3] - [0, 0, 0, 1]).max() > 0.0:
        raise InputError(field, "must be a rigid transform: rotation matrix, position, last row 0 0 0 1")
    return T
