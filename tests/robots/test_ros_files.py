"""Files as ROS has them: xacro with arguments, packages by a map, by ROS_PACKAGE_PATH and by the ament index."""

import json

import numpy as np
import pytest
import trimesh

import wsrender as ws
from wsrender.cli import job_command
from wsrender.errors import DocumentError, InputError, ModelError
from wsrender.robot import robot_of_spec
from wsrender.robots import load, packages

ARM = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="upper" default="1"/>
  <xacro:arg name="tool" default="false"/>
  <xacro:property name="length" value="${2 * 0.15}"/>
  <xacro:include filename="parts/link.xacro"/>
  <xacro:include filename="$(find arm_parts)/joint.xacro"/>
  <xacro:part name="a"/>
  <xacro:part name="b"/>
  <xacro:turning name="j" parent="a" child="b" z="${length}" upper="$(arg upper)"/>
  <xacro:if value="$(arg tool)">
    <xacro:part name="c"/>
    <joint name="end" type="fixed"><parent link="b"/><child link="c"/><origin xyz="${length} 0 0"/></joint>
  </xacro:if>
</robot>"""
LINK = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="part" params="name">
  <link name="${name}"><collision><geometry><mesh filename="package://arm_parts/brick.stl"/></geometry></collision>
  </link></xacro:macro></robot>"""
JOINT = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="turning" params="name parent child z upper">
  <joint name="${name}" type="revolute"><parent link="${parent}"/><child link="${child}"/><origin xyz="0 0 ${z}"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="${upper}" effort="1" velocity="1"/></joint></xacro:macro></robot>"""
BRICK = trimesh.creation.box((0.1, 0.2, 0.3))


@pytest.fixture
def arm(tmp_path):
    """A xacro file that needs a package elsewhere; and that package."""
    package = tmp_path / "elsewhere" / "deep" / "under_another_name"
    (tmp_path / "model" / "parts").mkdir(parents=True)
    package.mkdir(parents=True)
    path = tmp_path / "model" / "arm.urdf.xacro"
    path.write_text(ARM)
    (path.parent / "parts" / "link.xacro").write_text(LINK)
    (package / "joint.xacro").write_text(JOINT)
    (package / "package.xml").write_text("<package><name>arm_parts</name></package>")
    (package / "brick.stl").write_bytes(BRICK.export(file_type="stl"))
    packages._crawled.cache_clear()
    return path, package


def test_xacro_is_expanded_with_arguments(arm):
    path, package = arm
    robot = ws.load_robot(path, packages={"arm_parts": package}, xacro={"upper": 0.5, "tool": True})
    assert robot.tip_frame == "c" and robot.chain.upper_limits.tolist() == [0.5]
    T = robot.forward_kinematics([np.pi / 6])[0]
    np.testing.assert_allclose(T[:3, 3], [0.3 * np.cos(np.pi / 6), 0.15, 0.3], atol=1e-6)
    assert len(robot.bodies.shapes) == 3
    plain = ws.load_robot(path, packages={"arm_parts": package})
    assert plain.tip_frame == "b" and plain.chain.upper_limits.tolist() == [1.0]


def test_packages_are_found_as_ros_finds_them(arm, monkeypatch, tmp_path):
    path, package = arm
    with pytest.raises(ModelError, match=r"package 'arm_parts' is neither .*packages=\{\"arm_parts\": …\}"):
        ws.load_robot(path)
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "elsewhere"))  # by its package.xml, two folders down
    assert len(ws.load_robot(path).bodies.shapes) == 2
    monkeypatch.delenv("ROS_PACKAGE_PATH")
    marker = tmp_path / "install/share/ament_index/resource_index/packages/arm_parts"
    marker.parent.mkdir(parents=True)
    package.rename(tmp_path / "install/share/arm_parts")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "install"))
    with pytest.raises(ModelError, match="package 'arm_parts'"):
        ws.load_robot(path)  # a folder that the index does not know is no package
    marker.touch()
    assert len(ws.load_robot(path).bodies.shapes) == 2


def test_a_package_that_is_named_goes_before_all_others(arm, monkeypatch, tmp_path):
    path, package = arm
    (tmp_path / "model" / "arm_parts").mkdir()
    with pytest.raises(ModelError, match="No such file or directory"):
        ws.load_robot(path)  # the one beside the model has no joint.xacro
    assert ws.load_robot(path, packages={"arm_parts": package}).chain.n == 1


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("${2 * 0.15}", "${2 * nothing}"), "xacro refuses arm.urdf.xacro: .*nothing"),
        (('<xacro:part name="a"/>', '<xacro:absent name="a"/>'), "xacro refuses arm.urdf.xacro: .*absent"),
        (("parts/link.xacro", "parts/other.xacro"), "xacro refuses arm.urdf.xacro: .*other.xacro"),
        (("$(arg upper)", "$(arg never)"), "xacro refuses arm.urdf.xacro: .*never"),
    ],
)
def test_xacro_that_is_wrong_is_refused(arm, change, message):
    path, package = arm
    path.write_text(ARM.replace(*change))
    with pytest.raises(ModelError, match=message):
        ws.load_robot(path, packages={"arm_parts": package})


def test_arguments_that_nothing_asks_for_are_refused(arm):
    path, package = arm
    with pytest.raises(InputError, match=r"xacro.uper: is no argument .*; it asks for: tool, upper"):
        ws.load_robot(path, packages={"arm_parts": package}, xacro={"uper": 1})
    with pytest.raises((InputError, DocumentError), match=r'xacro.*must be given together with "path"'):
        ws.load_robot("ur5e", xacro={"a": 1})
    plain = path.parent / "plain.xml"
    plain.write_text("<mujoco/>")
    with pytest.raises(InputError, match=r"goes with a xacro file; the root element of plain.xml is <mujoco>"):
        ws.load_robot(plain, xacro={"a": 1})


def test_text_is_not_expanded():
    with pytest.raises(ModelError, match="is not expanded: give the path of the file, or run it through xacro first"):
        ws.load_robot(ARM)


def test_a_document_says_how_its_file_is_read(arm):
    path, package = arm
    robot = ws.load_robot(path, packages={"arm_parts": package}, xacro={"tool": True})
    again = robot_of_spec(type(robot.spec).model_validate(json.loads(robot.spec.model_dump_json())))
    assert again.tip_frame == "c" and again._loaded.source_hash == robot._loaded.source_hash
    options = [f"arm_parts={package}"], ["tool=true", "upper=.5"]
    document = {"robot": {"path": str(path)}}
    found = job_command.corrected_robot(document, [], None, *options)
    assert found == {
        "path": str(path),
        "packages": {"arm_parts": str(package)},
        "xacro": {"tool": "true", "upper": ".5"},
    }
    with pytest.raises(InputError, match=r"--xacro: must be NAME=VALUE, not \"tool\""):
        job_command.corrected_robot(document, [], None, [], ["tool"])


WRITERS = {"dae": ["collada"], "3mf": ["lxml", "networkx"]}  # what trimesh needs for these


@pytest.mark.parametrize("suffix", ["stl", "obj", "dae", "ply", "off", "glb", "gltf", "3mf"])
def test_meshes_of_every_format_are_seen_and_collide(suffix, tmp_path):
    """For visuals and collisions alike, with the same corners."""
    for package in WRITERS.get(suffix, ()):
        pytest.importorskip(package, reason=f"needs {package}, of the extra test-models")
    content = (trimesh.Scene(BRICK) if suffix == "glb" else BRICK).export(file_type=suffix)
    if isinstance(content, dict):  # glTF, its buffers beside it
        content = trimesh.exchange.gltf.export_gltf(trimesh.Scene(BRICK), embed_buffers=True)["model.gltf"]
    (tmp_path / f"brick.{suffix}").write_bytes(content.encode() if isinstance(content, str) else content)
    shape = f'<geometry><mesh filename="brick.{suffix}"/></geometry>'
    (tmp_path / "arm.urdf").write_text(
        f'<robot name="r"><link name="a"/><link name="b"><visual>{shape}</visual><collision>{shape}</collision></link>'
        '<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>'
    )
    robot = load(tmp_path / "arm.urdf")
    for shapes in (robot.bodies.shapes, robot.visuals.shapes):
        (shape,) = shapes
        R, p = shape.T_frame_shape[:3, :3], shape.T_frame_shape[:3, 3]
        corners = np.unique((shape.vertices @ R.T + p).round(6), axis=0)
        np.testing.assert_allclose(corners, np.unique(BRICK.vertices.round(6), axis=0), atol=2e-6)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.fbx", b"", "is of a format that is not read; allowed: .*.glb.*.ply"),
        ("a.gltf", b'{"buffers": [{"uri": "/etc/passwd", "byteLength": 9}]}', "leads to other files: make it a .glb"),
        ("a.glb", b"glTF", "cannot be read as .glb"),
        ("a.xyz", b"0 0 0\n1 1 1\n", "has no triangles"),
    ],
)
def test_meshes_that_are_refused(name, content, message):
    from wsrender.robots.mesh_files import triangles

    with pytest.raises(ModelError, match=message):
        triangles(content, name, "model")


def test_a_packed_mesh_that_would_fill_memory_is_refused(monkeypatch):
    pytest.importorskip("lxml", reason="needs lxml, of the extra test-models")
    from wsrender.robots import mesh_files

    content = trimesh.Scene(BRICK).export(file_type="3mf")
    monkeypatch.setattr(mesh_files, "MAX_MESH_BYTES", 100)
    with pytest.raises(ModelError, match=r"unpacks to .* at most 100"):
        mesh_files.triangles(content, "a.3mf", "model")
