"""MJCF → MuJoCo model; without its geometry, mesh files are read only where an inertia is computed from them."""

import copy
import math
from collections.abc import Collection, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

import mujoco

from wsrender.documents.robot import MountJoint
from wsrender.errors import ModelError
from wsrender.notices import Notice
from wsrender.robots import mjcf, mjcf_text, xml_source
from wsrender.robots.compiled_model import MUJOCO_ERRORS, CompiledModel, JointFault, Purpose, quiet, refusal
from wsrender.robots.hulls import with_small_hulls
from wsrender.robots.inertials import compile_with_inertials
from wsrender.robots.length_unit import in_metres, to_metres
from wsrender.robots.mesh_files import ReadMesh
from wsrender.robots.mount import BODY, add_joints

VELOCITIES = "velocity_limits"  # of all joints, in the model's order [rad/s or m/s]
VISIBLE_GROUPS = 3  # MuJoCo shows groups 0, 1, 2 unless told otherwise


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


def compile_mjcf(
    root: Element, read_mesh: ReadMesh, field: str, length_unit_m: float = 1.0, mount: Sequence[MountJoint] = ()
) -> CompiledModel:
    """The compiled model of a ``<mujoco>`` element (changed in the process), its lengths in ``length_unit_m``.

    ``mount``: joints that carry all of its bodies. Geometry that needs a mesh stays only where it gives a body its
    inertia; meshes that are not there are dropped with one notice, and noted as inertia faults where that leaves a body
    without inertia. Ranges that are upside down or empty, which MuJoCo would take for none, are joint faults. Raises
    ModelError.
    """
    if mount:
        mjcf.carried(root, BODY)
    whole, velocities, gravity = copy.deepcopy(root), _velocity_limits(root, field), _gravity(root, field)
    spec, files = _spec_of(root, field)
    joint_faults = _range_faults(spec)
    faults, missing = _drop_geometry(spec, files, read_mesh)
    to_metres(spec, length_unit_m)
    add_joints(spec, mount)
    model, inertia_faults, notices = compile_with_inertials(spec, field)
    return CompiledModel(
        model,
        root.get("model", ""),
        partial(_with_geometry, whole, read_mesh, field, length_unit_m, mount),
        inertia_faults=inertia_faults | {body.id: fault for body, fault in faults},
        joint_faults=tuple(JointFault(joint.parent.id, joint.name, fault, True) for joint, fault in joint_faults),
        velocity_limits=in_metres(model, _of_joints(velocities, model, field, len(mount)), length_unit_m),
        gravity=gravity,
        notices=_dropped(missing) + notices,
    )


def _velocity_limits(root: Element, field: str) -> list[float]:
    """What the ``<custom>`` numeric of that name says; empty where there is none."""
    found = [each for each in root.iterfind("custom/numeric") if each.get("name") == VELOCITIES]
    words = found[-1].get("data", "").split() if found else []
    return [xml_source.number(word, field, f"<numeric> {VELOCITIES!r}") for word in words]


def _of_joints(velocities: list[float], model: mujoco.MjModel, field: str, mounting: int) -> list[float]:
    """With none for the joints of the mount, which are the first."""
    if velocities and (len(velocities) != model.njnt - mounting or min(velocities) < 0):
        message = f"must be {model.njnt - mounting} numbers, one for each joint, 0 where it has none, not {velocities}"
        raise ModelError(field, f"<numeric> {VELOCITIES!r} {message}")
    return velocities and [0.0] * mounting + velocities


def _gravity(root: Element, field: str) -> tuple[float, ...] | None:
    found = [each.attrib["gravity"] for each in root.iterfind("option") if "gravity" in each.attrib]
    return tuple(xml_source.numbers(found[-1], 3, field, "<option> gravity")) if found else None


def _with_geometry(
    root: Element,
    read_mesh: ReadMesh,
    field: str,
    length_unit_m: float,
    mount: Sequence[MountJoint],
    purpose: Purpose,
) -> tuple[mujoco.MjModel, tuple[Notice, ...]]:
    """See `CompiledModel.with_geometry`. What is seen but cannot be had is left out, with one notice."""
    flags = [flag.get("filterparent") for flag in root.iterfind("option/flag") if "filterparent" in flag.attrib]
    spec, files = _spec_of(copy.deepcopy(root), field, ["contact"] if purpose == "collision" else [])
    _range_faults(spec)
    spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    missing = _keep_geometry(spec, files, read_mesh, purpose, field)
    to_metres(spec, length_unit_m)
    add_joints(spec, mount)
    model, _, _ = compile_with_inertials(spec, field)
    simplified: tuple[Notice, ...] = ()
    if purpose == "collision":
        model, simplified = with_small_hulls(spec, model, field)
    for margins in (model.geom_margin, model.geom_gap, model.pair_margin, model.pair_gap):
        margins[:] = 0.0
    if flags and flags[-1] == "disable":
        model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_FILTERPARENT
    return model, _dropped(missing) + simplified


def _keep_geometry(
    spec: mujoco.MjSpec, files: dict[str, str], read_mesh: ReadMesh, purpose: Purpose, field: str
) -> list[str]:
    """Removes the geometry from files that is for another purpose, and reads the rest; returns missing files."""
    geoms = list(spec.geoms)
    paired = {name for pair in spec.pairs for name in (pair.geomname1, pair.geomname2)}
    colliding = [geom for geom in geoms if geom.contype or geom.conaffinity or geom.name in paired]
    wanted = {id(geom) for geom in (colliding if purpose == "collision" else shown(geoms))}
    contents: dict[str, bytes | None] = {}
    for geom in filter(_needs_file, geoms):
        file = files.get(geom.meshname, "")
        if file and id(geom) in wanted and file not in contents:
            contents[file] = read_mesh(file)
        there = geom.meshname in files and (not file or contents.get(file) is not None)
        there |= geom.type == mujoco.mjtGeom.mjGEOM_HFIELD and spec.hfield(geom.hfieldname) is not None
        if id(geom) in wanted and not there and purpose == "collision":
            what = f"its file {file!r} is not there, or is too large" if file else "there are no shapes of its kind"
            if geom.type == mujoco.mjtGeom.mjGEOM_HFIELD:
                what = "heights are read from the attribute elevation alone; give them so, or as an item height_field"
            raise ModelError(field, f"geom {geom.name!r} of body {geom.parent.name!r} may collide, but {what}")
        if id(geom) not in wanted or not there:
            spec.delete(geom)
    _keep_meshes(spec, files, contents)
    if purpose == "visual":
        for mesh in spec.meshes:
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL  # a picture's need not be closed
    return [file for file, content in contents.items() if content is None]


def shown(geoms: Iterable[Any]) -> list[Any]:
    """Geoms, each with ``rgba`` and ``group``, that are seen: in MuJoCo's visible groups, or where none is there, all.

    Collision shapes are in others by custom.
    """
    clear = [geom for geom in geoms if geom.rgba[3] > 0.0]
    return [geom for geom in clear if geom.group < VISIBLE_GROUPS] or clear


def _spec_of(root: Element, field: str, keep: Collection[str] = ()) -> tuple[mujoco.MjSpec, dict[str, str]]:
    """The model that an element describes, which is changed, and the file of each mesh in it."""
    mjcf.sanitized(root, field, keep)
    folder, strip = mjcf.directories(root)
    spec = _parsed(mjcf.text(root), field)
    return spec, {mesh.name: _file(mesh.file, folder, strip) for mesh in spec.meshes}


def _dropped(missing: list[str]) -> tuple[Notice, ...]:
    if not missing:
        return ()
    message = f"geometry of {len(missing)} meshes is dropped ({missing[0]}, …): the files are not there"
    return (Notice("meshes_missing", message),)


def _parsed(text: str, field: str) -> mujoco.MjSpec:
    try:
        with quiet():
            spec = mujoco.MjSpec.from_string(text)
    except MUJOCO_ERRORS as error:
        raise refusal(error, field) from error
    # A simulation of the muscles, as long as the model asks for, whose results are of no use here.
    spec.compiler.LRopt.mode = mujoco.mjtLRMode.mjLRMODE_NONE
    return spec


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
