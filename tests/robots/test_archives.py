"""ZIPs and folders of models with the files that they lead to: what is read of them, and what is refused."""

import hashlib
import zipfile
from io import BytesIO

import numpy as np
import pytest
import trimesh

import wsrender as ws
from tests.server.hostile import cases
from wsrender.cli.job_command import corrected_robot, job_document
from wsrender.errors import InputError, ModelError
from wsrender.robot import robot_of_spec
from wsrender.robots import archives, load, scenes, uploaded
from wsrender.robots.loading import load_archive

BRICK = trimesh.creation.box((0.1, 0.2, 0.3)).export(file_type="stl")
FILES = {
    "arm/scene.xml": b"""<mujoco model="scene"><include file="parts/arm.xml"/><worldbody>
      <geom name="table" type="mesh" mesh="brick" pos="1 0 0"/></worldbody></mujoco>""",
    "arm/parts/arm.xml": b"""<mujoco><compiler meshdir="assets"/><asset><mesh name="brick" file="brick.stl"/></asset>
      <worldbody><body name="a"><joint name="j" axis="0 0 1" range="-60 60"/><geom type="mesh" mesh="brick"/>
      <site name="tool" pos=".5 0 0"/></body></worldbody></mujoco>""",
    "arm/assets/brick.stl": BRICK,
    "arm/assets/texture.png": b"no part of the model",
}
URDF = """<robot name="r"><link name="a"/><link name="b">
  <collision><geometry><mesh filename="{}"/></geometry></collision></link>
  <joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""


def unpacked(folder, files=FILES):
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    return folder


def test_a_zip_loads_as_its_folder_does(tmp_path):
    folder = unpacked(tmp_path)
    packed = tmp_path / "arm.zip"
    packed.write_bytes(cases.zipped(FILES))
    robots = [load(path) for path in (packed, folder / "arm", folder / "arm" / "scene.xml")]
    q = np.array([[0.7]])
    for robot in robots:
        assert robot.model.joint(0).name == "j" and robot.chain.name == "scene"
        assert robot.chain.upper_limits == pytest.approx(np.pi / 3)
        assert robot.source_hash == robots[0].source_hash
        assert len(robot.bodies.shapes) == len(robot.visuals.shapes) == 2
        np.testing.assert_array_equal(robot.bodies.poses(q), robots[-1].bodies.poses(q))
    for path in (packed, folder / "arm"):
        (shape,) = scenes.scene_of_path(path)
        assert np.ptp(shape.vertices, axis=0).round(6).tolist() == [0.1, 0.2, 0.3]


def test_a_folder_is_packed_to_the_same_bytes_without_what_is_no_part(tmp_path):
    folder = unpacked(tmp_path / "a")
    unpacked(tmp_path / "b", dict(reversed(FILES.items())))
    packed = archives.of_folder(folder, "path")
    assert packed == archives.of_folder(tmp_path / "b", "path")
    names = zipfile.ZipFile(BytesIO(packed)).namelist()
    assert names == ["arm/assets/brick.stl", "arm/parts/arm.xml", "arm/scene.xml"]
    (folder / "arm" / "out.stl").symlink_to("/etc/passwd")
    with pytest.raises(ModelError, match=r"out.stl is a link that leads out of"):
        archives.of_folder(folder, "path")


def test_the_model_is_the_one_that_no_other_includes_or_is_named():
    both = cases.zipped({**FILES, "arm/other.xml": FILES["arm/parts/arm.xml"]})
    with pytest.raises(InputError, match=r"entry: must name one of the models .*: arm/other.xml, arm/scene.xml"):
        load_archive(both)
    assert load_archive(both, entry="arm/scene.xml").chain.name == "scene"
    assert load_archive(both, entry="arm/other.xml").chain.name == "other"
    with pytest.raises(InputError, match=r"entry: 'none.xml' is not in the archive; its models: arm/other.xml"):
        load_archive(both, entry="none.xml")


def test_a_package_of_ros_is_a_folder_or_a_zip(tmp_path):
    """Its package.xml is no model, and says which package the folder is, whatever that is called."""
    files = {
        "package.xml": b"<package format='3'><name>arm_parts</name></package>",
        "urdf/r.urdf": URDF.format("package://arm_parts/meshes/a.stl").encode(),
        "meshes/a.stl": BRICK,
    }
    folder = unpacked(tmp_path / "my_clone", files)
    within = cases.zipped({f"deep/{name}": content for name, content in files.items()})
    for robot in (ws.load_robot(folder), load_archive(cases.zipped(files)), load_archive(within)):
        assert robot.chain.n == 1 and len(robot.bodies.shapes) == 1
    assert archives.Archive(cases.zipped(files), None, "path").read("package://arm_parts/../x/meshes/a.stl") is None
    broken = cases.zipped(files | {"package.xml": b"<package"})
    with pytest.raises(ModelError, match=r"'package://arm_parts/meshes/a.stl' is not there"):
        _ = load_archive(broken).bodies
    (folder / "urdf/r.urdf").rename(folder / "urdf/r.urdf.xacro")
    with pytest.raises(ModelError, match=r"no model: .* but package.xml; a xacro file is loaded by its own path"):
        ws.load_robot(folder)


def test_an_empty_folder_and_a_file_that_is_no_zip(tmp_path):
    with pytest.raises(ModelError, match="the archive has no model"):
        ws.load_robot(tmp_path)
    (tmp_path / "a.zip").write_bytes(b"no zip")
    with pytest.raises(ModelError, match="is no ZIP archive that can be read"):
        ws.load_robot(tmp_path / "a.zip")
    with pytest.raises(ModelError, match=r"there is no file '.*none.zip'"):
        ws.load_robot(tmp_path / "none.zip")


@pytest.mark.parametrize("address", ["meshes/a.stl", "package://arm_parts/meshes/a.stl", "../arm_parts/meshes/a.stl"])
def test_addresses_lead_to_folders_of_the_archive_alone(address, tmp_path):
    place = "r.urdf" if address == "meshes/a.stl" else "urdf/r.urdf"
    mesh = "meshes/a.stl" if address == "meshes/a.stl" else "arm_parts/meshes/a.stl"
    files = {place: URDF.format(address).encode(), mesh: BRICK}
    assert len(load_archive(cases.zipped(files)).bodies.shapes) == 1
    outside = tmp_path / "a.stl"
    outside.write_bytes(BRICK)
    for other in (str(outside), f"file://{outside}", f"package://arm_parts/../../..{outside}", f"../../../..{outside}"):
        robot = load_archive(cases.zipped({place: URDF.format(other).encode(), mesh: BRICK}))
        with pytest.raises(ModelError, match="is not there"):
            _ = robot.bodies


def test_documents_and_commands_take_archives(tmp_path):
    packed = tmp_path / "arm.zip"
    packed.write_bytes(cases.zipped({**FILES, "arm/other.xml": FILES["arm/parts/arm.xml"]}))
    robot = ws.load_robot(packed, entry="arm/scene.xml")
    assert robot_of_spec(robot.spec).chain.upper_limits.tolist() == robot.chain.upper_limits.tolist()
    document = job_document(str(packed))
    assert document["robot"] == {"path": str(packed)}
    assert corrected_robot(document, [], None, entry="arm/scene.xml") == {"path": str(packed), "entry": "arm/scene.xml"}
    assert job_document(f"{tmp_path}/")["robot"] == {"path": f"{tmp_path}/"}
    assert job_document("ur5e")["robot"] == {"library": "ur5e"}
    scene = {"shape": "scene", "path": str(packed), "entry": "arm/scene.xml"}
    job = {
        "analysis": "workspace",
        "robot": {"path": str(packed), "entry": "arm/scene.xml"},
        "sampling": {"method": "grid", "per_joint": 9},
        "constraints": {"self_collision": True},
        "environment": {"items": [scene | {"position_m": [2, 0, 0]}]},
        "device": "cpu",
    }
    assert ws.execute(job).document["sampling"]["samples"] == 9
    with pytest.raises(InputError, match="scene 1/table and a/0 collide in every configuration"):
        ws.execute(job | {"environment": {"items": [scene | {"position_m": [-1, 0, 0]}]}})


@pytest.mark.parametrize("field", ["packages", "xacro", "entry"])
def test_what_says_how_a_file_is_read_goes_with_such_files_alone(field, tmp_path):
    packed = tmp_path / "arm.zip"
    packed.write_bytes(cases.zipped(FILES))
    value = "a" if field == "entry" else {"a": "b"}
    path = unpacked(tmp_path) / "arm" / "scene.xml" if field == "entry" else packed
    with pytest.raises(InputError, match=f"{field}: "):
        ws.load_robot(path, **{field: value})
    with pytest.raises(ws.DocumentError, match=f"{field}.*must be given together with"):
        ws.load_robot("ur5e", **{field: value})


HOSTILE = [case for case in cases.archives("/etc/passwd") if case.upload is not None]


@pytest.mark.parametrize("case", HOSTILE, ids=lambda case: case.name)
def test_the_hostile_collection_is_refused_here_too(case, tmp_path, monkeypatch):
    """By the loader itself, with the error of a wrong model; the long test sends it to a server."""
    sha256 = hashlib.sha256(case.upload).hexdigest()
    (tmp_path / sha256).write_bytes(case.upload)
    monkeypatch.setenv(uploaded.MODELS_VARIABLE, str(tmp_path))
    with pytest.raises((ModelError, InputError)):
        if "scene" in case.name:
            scenes.uploaded_scene(sha256)
        else:
            _ = uploaded.load_uploaded(sha256, "secret" if "entry" in case.name else None).bodies
