"""MJCF → MuJoCo model; mesh files are read only where an inertia is computed from them."""

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from xml.etree.ElementTree import Element

import mujoco

from wsrender.errors import ModelError
from wsrender.notices import Notice
from wsrender.robots import mjcf, mjcf_text
from wsrender.robots.compiled_model import MUJOCO_ERRORS, CompiledModel, JointFault, quiet, refusal
from wsrender.robots.inertials import compile_with_inertials
from wsrender.robots.length_unit import to_metres

MAX_MESH_BYTES = 256 * 2**20

ReadMesh = Callable[[str], bytes | None]  # file name in the model → its bytes, None where it is not there


def from_assets(assets: Mapping[str, bytes]) -> ReadMesh:
    """Reads meshes from a mapping of file names, as the model writes them, to bytes; never from disk."""
    by_last_part = {Path(name).name: content for name, content in assets.items()}
    return lambda name: assets.get(name, by_last_part.get(Path(name).name))


def from_folder(folder: Path) -> ReadMesh:
    """Reads meshes relative to ``folder``: for files of the user's own."""

    def read(name: str) -> bytes | None:
        path = folder / name
        if not path.is_file() or path.stat().st_size > MAX_MESH_BYTES:
            return None
        return path.read_bytes()

    return read


def text_of(source: mujoco.MjSpec | mujoco.MjModel, field: str) -> str:
    """MJCF text of a model that was made with MuJoCo in Python. Raises ModelError where there is none.

    An MjSpec is compiled first, with the meshes that it names: what MuJoCo writes of it has six digits.
    """
    if isinstance(source, mujoco.MjModel):
        return mjcf_text.text_of(source, field)
    model, faults, _ = compile_with_inertials(source.copy(), field)
    for fault in faults.values():
        raise ModelError(field, fault)
    return mjcf_text.text_of(model, field)


def compile_mjcf(root: Element, read_mesh: ReadMesh, field: str, length_unit_m: float = 1.0) -> CompiledModel:
    """The compiled model of a ``<mujoco>`` element (changed in the process), its lengths in ``length_unit_m``.

    Geometry that needs a mesh stays only where it gives a body its inertia; meshes that are not there are
    dropped with one notice, and noted as inertia faults where that leaves a body without inertia. Ranges that are
    upside down or empty, which MuJoCo would take for none, are joint faults. Raises ModelError.
    """
    mjcf.sanitized(root, field)
    folder, strip = mjcf.directories(root)
    spec = _parsed(mjcf.text(root), field)
    joint_faults = _range_faults(spec)
    files = {mesh.name: _file(mesh.file, folder, strip) for mesh in spec.meshes}
    faults, missing = _drop_geometry(spec, files, read_mesh)
    to_metres(spec, length_unit_m)
    model, inertia_faults, notices = compile_with_inertials(spec, field)
    return CompiledModel(
        model,
        root.get("model", ""),
        inertia_faults=inertia_faults | {body.id: fault for body, fault in faults},
        joint_faults=tuple(JointFault(joint.parent.id, joint.name, fault, True) for joint, fault in joint_faults),
        notices=_dropped(missing) + notices,
    )


def _dropped(missing: list[str]) -> tuple[Notice, ...]:
    if not missing:
        return ()
    message = f"geometry of {len(missing)} meshes is dropped ({missing[0]}, …): the files are not there"
    return (Notice("meshes_missing", message),)


def _parsed(text: str, field: str) -> mujoco.MjSpec:
    try:
        with quiet():
            return mujoco.MjSpec.from_string(text)
    except MUJOCO_ERRORS as error:
        raise refusal(error, field) from error


def _range_faults(spec: mujoco.MjSpec) -> list[tuple[mujoco.MjsJoint, str]]:
    """Joints whose ranges are upside down or empty; they are compiled without limits."""
    faults = []
    for joint in spec.joints:
        low, high = joint.range
        if joint.limited != mujoco.mjtLimited.mjLIMITED_FALSE and low >= high and (low, high) != (0.0, 0.0):
            name = joint.name or joint.parent.name
            faults.append((joint, f"joint {name!r}: its range is {low:g} … {high:g}; the first must be below"))
            joint.limited = mujoco.mjtLimited.mjLIMITED_FALSE
    return faults


def _file(file: str, folder: str, strip: bool) -> str:
    """Path of a mesh file relative to the model; empty for a mesh written out in the model."""
    name = Path(file.replace("\\", "/")).name if strip else file
    return str(Path(folder) / name) if file else ""


def _drop_geometry(
    spec: mujoco.MjSpec, files: dict[str, str], read_mesh: ReadMesh
) -> tuple[list[tuple[mujoco.MjsBody, str]], list[str]]:
    """Removes what cannot or need not be loaded; returns inertia faults by body and missing files."""
    faults = []
    contents: dict[str, bytes | None] = {}
    for geom in list(spec.geoms):
        if not _needs_file(geom):
            continue
        file = files.get(geom.meshname, "")
        if file and file not in contents:
            contents[file] = read_mesh(file)
        inline = geom.meshname in files and not file
        gives_inertia = _gives_inertia(spec, geom)
        if gives_inertia and not inline and contents.get(file) is None:
            body = geom.parent
            source = file or "geometry"
            faults.append((body, f"the inertia of body {body.name!r} comes from {source}, which is not there"))
        if not gives_inertia or not (inline or contents.get(file) is not None):
            spec.delete(geom)
    _keep_meshes(spec, files, contents)
    return faults, [file for file, content in contents.items() if content is None]


def _needs_file(geom: mujoco.MjsGeom) -> bool:
    kinds = (mujoco.mjtGeom.mjGEOM_HFIELD, mujoco.mjtGeom.mjGEOM_SDF, mujoco.mjtGeom.mjGEOM_MESH)
    return bool(geom.meshname) or geom.type in kinds


def _gives_inertia(spec: mujoco.MjSpec, geom: mujoco.MjsGeom) -> bool:
    compiler, body = spec.compiler, geom.parent
    rule = mujoco.mjtInertiaFromGeom
    if compiler.inertiafromgeom == rule.mjINERTIAFROMGEOM_FALSE or body == spec.worldbody:
        return False
    if compiler.inertiafromgeom == rule.mjINERTIAFROMGEOM_AUTO and body.explicitinertial:
        return False
    low, high = compiler.inertiagrouprange
    massive = geom.density > 0.0 if math.isnan(geom.mass) else geom.mass > 0.0
    return massive and low <= geom.group <= high


def _keep_meshes(spec: mujoco.MjSpec, files: dict[str, str], contents: dict[str, bytes | None]) -> None:
    """Drops the meshes that no geometry uses any more and attaches the bytes of the others."""
    used = {geom.meshname for geom in spec.geoms}
    assets = {}
    for mesh in list(spec.meshes):
        if mesh.name not in used:
            spec.delete(mesh)
        elif file := files[mesh.name]:
            content = contents[file]
            assert content is not None
            mesh.file = f"{len(assets)}-{Path(file).name}"
            assets[mesh.file] = content
    spec.assets = assets
