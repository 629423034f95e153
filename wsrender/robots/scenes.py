"""What stands still in an MJCF file: its shapes that may collide and that no joint moves."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

import mujoco

from wsrender.errors import InputError, ModelError
from wsrender.robots import archives, includes, mesh_files, xml_source
from wsrender.robots.compiled_model import building
from wsrender.robots.frames import transform
from wsrender.robots.mesh_files import ReadMesh
from wsrender.robots.mjcf_model import compile_mjcf
from wsrender.robots.pairs import collides
from wsrender.robots.shapes import Shape, shape_of
from wsrender.robots.uploaded import refuse_entry, uploaded_content

BASE = -1  # frame of what stands still


def scene_of_path(path: str | Path, length_unit_m: float = 1.0, entry: str | None = None) -> tuple[Shape, ...]:
    """The fixed shapes of an .xml file of the user's own, with the files that it includes and meshes, in its world.

    A ZIP or a folder is read as a robot's is, ``entry`` in it. ``length_unit_m``: its unit of length [m]. Raises
    ModelError, InputError.
    """
    path = Path(path)
    if archives.is_path(path):
        return _of_archive(archives.of_path(path, "path"), "path", length_unit_m, entry)
    if entry is not None:
        raise InputError("entry", f"goes with a ZIP or a folder, and {path.name} is neither")
    content = xml_source.read(path, "path")
    read, place = mesh_files.from_folder(path.parent), repr(str(path.parent))
    return _fixed(content, "path", read, length_unit_m, lambda root: includes.put_in(root, read, place, "path"))


def _of_archive(content: bytes, field: str, length_unit_m: float, entry: str | None) -> tuple[Shape, ...]:
    archive = archives.Archive(content, entry, field)
    include = partial(includes.put_in, read=archive.read, place="the archive", field=field)
    return _fixed(archive.model(), field, archive.read, length_unit_m, include)


def scene_of_text(text: str | bytes, length_unit_m: float = 1.0, field: str = "mjcf") -> tuple[Shape, ...]:
    """The same of MJCF text; no file is read."""
    return _fixed(text, field, mesh_files.from_assets({}), length_unit_m)


def uploaded_scene(sha256: str, length_unit_m: float = 1.0, entry: str | None = None) -> tuple[Shape, ...]:
    """The same of a model that was uploaded to a server, or of ``entry`` in a ZIP; see `wsrender.robots.uploaded`."""
    content = uploaded_content(sha256, "model")
    if archives.is_archive(content):
        return _of_archive(content, "model", length_unit_m, entry)
    refuse_entry(entry)
    return scene_of_text(content, length_unit_m, "model")


def _fixed(
    content: str | bytes,
    field: str,
    read_mesh: ReadMesh,
    length_unit_m: float,
    include: Callable[[Element], Any] = lambda root: None,
) -> tuple[Shape, ...]:
    root = xml_source.parse(content, field)
    if root.tag != "mujoco":
        raise ModelError(field, f"the root element is <{root.tag}>; <mujoco> is needed")
    include(root)
    with building(field):
        model, _ = compile_mjcf(root, read_mesh, field, length_unit_m).with_geometry("collision")
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        fixed = [geom for geom in collides(model) if model.body_weldid[model.geom_bodyid[geom]] == 0]
        places = [transform(data.geom_xpos[geom], data.geom_xmat[geom].reshape(3, 3)) for geom in fixed]
        shapes = tuple(shape_of(model, geom, BASE, T, True, field) for geom, T in zip(fixed, places, strict=True))
    if not shapes:
        raise ModelError(field, "holds no shape that may collide and that no joint moves")
    return shapes
