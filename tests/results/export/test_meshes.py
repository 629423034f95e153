"""Meshes in files: GLB as glTF 2.0 has it, parsed here byte by byte."""

import json
import struct

import numpy as np
import pytest
import trimesh

import wsrender as ws
from tests.results.export.sample_data import random_volume
from wsrender.results.export import read_mesh, write_mesh

JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942
FLOAT, UINT = 5126, 5125


def parsed(path):
    """Asset, positions (V, 3) and triangles (F, 3) of the only mesh of a GLB file, in the frame of its scene."""
    data = path.read_bytes()
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack_from("<II", data, 12)
    tree = json.loads(data[20 : 20 + size])
    assert kind == JSON_CHUNK and size % 4 == 0
    binary_size, kind = struct.unpack_from("<II", data, 20 + size)
    binary = data[28 + size : 28 + size + binary_size]
    assert kind == BINARY_CHUNK
    (mesh,) = tree["meshes"]
    (primitive,) = mesh["primitives"]

    def values(number):
        accessor = tree["accessors"][number]
        view = tree["bufferViews"][accessor["bufferView"]]
        dtype = {FLOAT: "<f4", UINT: "<u4"}[accessor["componentType"]]
        width = {"SCALAR": 1, "VEC3": 3}[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        return np.frombuffer(binary, dtype, accessor["count"] * width, start).reshape(-1, width)

    nodes = [node for node in tree["nodes"] if "mesh" in node]
    for node in tree["nodes"]:  # positions are where they are: nothing moves the mesh
        np.testing.assert_array_equal(node.get("matrix", np.eye(4).ravel()), np.eye(4).ravel())
        assert not node.keys() & {"rotation", "translation", "scale"}
    assert len(nodes) == 1
    return tree["asset"], values(primitive["attributes"]["POSITION"]), values(primitive["indices"]).reshape(-1, 3)


@pytest.fixture
def tower():
    """A box 0.1 × 0.2 × 1 m whose lower corner is at (1, 2, 3) of the world frame: it stands upright."""
    mesh = trimesh.creation.box((0.1, 0.2, 1.0))
    return mesh.apply_translation((1.05, 2.1, 3.5))


def test_glb_has_y_up_and_metres(tower, tmp_path):
    write_mesh(tower, tmp_path / "tower.glb")
    asset, positions, triangles = parsed(tmp_path / "tower.glb")
    np.testing.assert_allclose(positions.min(axis=0), [1, 3, -2.2], atol=1e-6)  # (x, z, −y)
    np.testing.assert_allclose(positions.max(axis=0), [1.1, 4, -2], atol=1e-6)
    a, b, c = (positions[triangles[:, k]].astype(float) for k in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6  # positive: faces look outwards still
    assert volume == pytest.approx(0.02, rel=1e-4)
    assert asset["version"] == "2.0" and asset["extras"]["up"] == "+Y" and asset["extras"]["unit"] == "m"


@pytest.mark.parametrize("ending", ["glb", "ply", "stl", "obj"])
def test_what_is_read_back_stands_as_it_stood(tower, tmp_path, ending):
    before = tower.vertices.copy()
    write_mesh(tower, tmp_path / f"tower.{ending}")
    read = read_mesh(tmp_path / f"tower.{ending}")
    np.testing.assert_allclose(read.bounds, [[1, 2, 3], [1.1, 2.2, 4]], atol=1e-6)
    assert read.volume == pytest.approx(0.02, rel=1e-4)
    np.testing.assert_array_equal(tower.vertices, before)


def test_files_of_the_first_version_are_read_as_they_are(tower, tmp_path):
    tower.export(tmp_path / "tower.glb")  # z up: what 0.1.0 wrote
    np.testing.assert_allclose(read_mesh(tmp_path / "tower.glb").bounds, [[1, 2, 3], [1.1, 2.2, 4]], atol=1e-6)


def test_files_of_other_programs_have_y_up(tower, tmp_path):
    write_mesh(tower, tmp_path / "tower.glb")
    data = (tmp_path / "tower.glb").read_bytes()
    size = struct.unpack_from("<I", data, 12)[0]
    tree = json.loads(data[20 : 20 + size])
    tree["asset"] = {"version": "2.0", "generator": "Khronos glTF Blender I/O"}
    text = json.dumps(tree).encode().ljust(size)
    (tmp_path / "tower.glb").write_bytes(data[:20] + text + data[20 + size :])
    np.testing.assert_allclose(read_mesh(tmp_path / "tower.glb").bounds, [[1, 2, 3], [1.1, 2.2, 4]], atol=1e-6)


def test_the_surface_of_a_result_stands_upright_in_its_file(tmp_path):
    volume = random_volume((4, 5, 9), names=("manipulability",))
    ws.Result({"analysis": "workspace"}, volume=volume).save(tmp_path / "out")
    _, positions, _ = parsed(tmp_path / "out/surface.glb")
    lower, upper = read_mesh(tmp_path / "out/surface.ply").bounds
    np.testing.assert_allclose(positions.min(axis=0), [lower[0], lower[2], -upper[1]], atol=1e-6)
    np.testing.assert_allclose(positions.max(axis=0), [upper[0], upper[2], -lower[1]], atol=1e-6)
    frames = {each["name"]: each["frame"] for each in ws.Result.load(tmp_path / "out").document["artifacts"]}
    assert (frames["surface.glb"], frames["surface.ply"]) == ("world, +Y up", "world")


@pytest.mark.parametrize("ending", ["ply", "glb"])
@pytest.mark.parametrize("origin", [(500000.0, 4649776.0, 120.0), (1.0, 2.0, 3.0)])
def test_a_mesh_keeps_its_shape_wherever_it_stands(tmp_path, ending, origin):
    """Far from the origin too, where single precision has steps of half a metre."""
    ball = trimesh.creation.icosphere(2, 1.0)
    ball.apply_translation(origin)
    ball.face_attributes["surface"] = np.arange(len(ball.faces), dtype=np.int32)
    write_mesh(ball, tmp_path / f"ball.{ending}")
    read = read_mesh(tmp_path / f"ball.{ending}")
    np.testing.assert_allclose(read.vertices, ball.vertices, rtol=0, atol=1e-6)
    np.testing.assert_array_equal(read.faces, ball.faces)
    if ending == "ply":
        np.testing.assert_array_equal(read.face_attributes["surface"], ball.face_attributes["surface"])


def test_stl_of_a_mesh_far_away_is_refused(tmp_path):
    ball = trimesh.creation.icosphere(2, 1.0)
    ball.apply_translation((5e5, 0, 0))
    with pytest.raises(ws.InputError, match=r"ball.stl: the mesh is 5e\+05 m from .*; write .ply or .glb"):
        write_mesh(ball, tmp_path / "ball.stl")
    assert not list(tmp_path.iterdir())
