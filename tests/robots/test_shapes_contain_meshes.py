"""Shapes of library robots contain the meshes that they were fitted to, where a package of test-models has those."""

from importlib.util import find_spec
from pathlib import Path

import mujoco
import numpy as np
import pytest

from wsrender.robots import library

trimesh = pytest.importorskip("trimesh")
KUKA = "xacro/kuka_description"
LINKS = ("base_link", *(f"link_{k}" for k in range(1, 7)))


def agilus(arm):
    """Of KR 6 arms, which differ in links 2 and 4."""
    folders = [arm if link in ("link_2", "link_4") else "kr6_agilus" for link in LINKS]
    return [
        f"{KUKA}/kuka_kr6/meshes/{folder}/collision/{link}.stl" for folder, link in zip(folders, LINKS, strict=True)
    ]


MESHES = {
    "kuka_kr10_r1100_sixx": [f"{KUKA}/kuka_kr10/meshes/kr10r1100sixx/collision/{link}.stl" for link in LINKS],
    "kuka_kr6_r700_sixx": agilus("kr6r700sixx"),
    "kuka_kr6_r900_sixx": agilus("kr6r900sixx"),
    "kuka_kr3_r540": [f"{KUKA}/kuka_kr3/meshes/kr3r540/collision/{link}.stl" for link in LINKS],
    "kuka_kr16_2": [f"{KUKA}/kuka_kr16/meshes/kr16_2/collision/{link}.stl" for link in LINKS],
}


def depths(model, geom, points):
    """How far points (N, 3) of a body's frame are inside a geom (N,) [m], negative outside."""
    R = np.empty(9)
    mujoco.mju_quat2Mat(R, model.geom_quat[geom])
    local = (points - model.geom_pos[geom]) @ R.reshape(3, 3)
    size, kind = model.geom_size[geom], mujoco.mjtGeom(model.geom_type[geom])
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        return (size - np.abs(local)).min(axis=1)
    off, along = np.linalg.norm(local[:, :2], axis=1), np.abs(local[:, 2])
    if kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        return np.minimum(size[0] - off, size[1] - along)
    half = size[1] if kind == mujoco.mjtGeom.mjGEOM_CAPSULE else 0.0
    return size[0] - np.hypot(off, np.maximum(along - half, 0.0))


@pytest.mark.parametrize("name", MESHES)
def test_corners_of_the_meshes_are_inside(name):
    spec = find_spec("rtbdata")
    if spec is None:
        pytest.skip("needs rtb-data, of the extra test-models")
    folder = Path(spec.origin).parent
    model = mujoco.MjModel.from_xml_path(str(library.find(name)))
    for body, file in zip(("base", *(f"link{k}" for k in range(1, 7))), MESHES[name], strict=True):
        points = np.asarray(trimesh.load(folder / file, force="mesh").vertices)
        first, count = model.body(body).geomadr[0], model.body(body).geomnum[0]
        deepest = np.max([depths(model, geom, points) for geom in range(first, first + count)], axis=0)
        assert deepest.min() > -1e-6, (body, deepest.min())
