"""What stands still in an MJCF file: its shapes that may collide and that no joint moves."""

from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

import mujoco

from wsrender.errors import ModelError
from wsrender.robots import includes, mesh_files, xml_source
from wsrender.robots.compiled_model import building
from wsrender.robots.frames import transform
from wsrender.robots.mesh_files import ReadMesh
from wsrender.robots.mjcf_model import compile_mjcf
from wsrender.robots.pairs import collides
from wsrender.robots.shapes import Shape, shape_of
from wsrender.robots.uploaded import uploaded_content

BASE = -1  # frame of what stands still


def scene_of_path(path: str | Path, length_unit_m: float = 1.0) -> tuple[Shape, ...]:
    """The fixed shapes of an .xml file of the user's own, with the files that it includes and meshes, in its world.

    ``length_unit_m``: its unit of length [m]. Raises ModelError.
    """
    path = Path(path)
    content = xml_source.read(path, "path")
    read_mesh = mesh_files.from_folder(path.parent)
    return _fixed(
        content,
        "path",
        read_mesh,
        length_unit_m,
        lambda root: includes.put_in(root, read_mesh, repr(str(path.parent)), "path"),
    )


def scene_of_text(text: str | bytes, length_unit_m: float = 1.0, field: str = "mjcf") -> tuple[Shape, ...]:
    """The same of MJCF text; no file is read."""
    return _fixed(text, field, mesh_files.from_assets({}), length_unit_m)


def uploaded_scene(sha256: str, length_unit_m: float = 1.0) -> tuple[Shape, ...]:
    """The same of a model that was uploaded to a server; see `wsrender.robots.uploaded`."""
    return scene_of_text(uploaded_content(sha256, "model"), length_unit_m, "model")


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
