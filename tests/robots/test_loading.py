"""The doors: paths, texts, library names, DH tables; meshes; what may be read from disk."""

import contextlib
import hashlib
import os
import struct
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest

import wsrender as ws
from wsrender import robots
from wsrender.documents.robot import DHTable
from wsrender.errors import ModelError

INERTIAL = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
MJCF = f"""<mujoco model="arm"><worldbody><body name="link"><joint name="j" axis="0 0 1"/>{INERTIAL}
  <site name="tool" pos="1 0 0"/></body></worldbody></mujoco>"""
URDF = """<robot name="arm"><link name="base"/><link name="link"/>
  <link name="end"/>
  <joint name="j" type="continuous"><parent link="base"/><child link="link"/></joint>
  <joint name="e" type="fixed"><parent link="link"/><child link="end"/>
    <origin xyz="1 0 0"/></joint></robot>"""


def tetrahedron_stl():
    """A binary STL of the tetrahedron with the unit vectors and the origin as corners."""
    corners = np.vstack([np.zeros(3), np.eye(3)])
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    triangles = b"".join(struct.pack("<12fH", *np.zeros(3), *corners[list(face)].ravel(), 0) for face in faces)
    return bytes(80) + struct.pack("<I", len(faces)) + triangles


def with_mesh(inertial, file="parts/body.stl", compiler='meshdir="meshes"'):
    return f"""<mujoco><compiler {compiler}/><asset><mesh name="m" file="{file}"/></asset><worldbody>
      <body name="link"><joint name="j" axis="0 0 1"/>{inertial}<geom type="mesh" mesh="m" density="1000"/>
      <site name="tool" pos="1 0 0"/></body></worldbody></mujoco>"""


@pytest.mark.parametrize(("text", "file"), [(MJCF, "arm.xml"), (URDF, "arm.urdf"), (URDF, "arm.xml"), (MJCF, "a.urdf")])
def test_files_are_told_apart_by_their_root(tmp_path, text, file):
    path = tmp_path / file
    path.write_text(text)
    for source in (path, str(path)):
        robot = robots.load(source)
        assert (robot.chain.name, robot.chain.joint_names) == ("arm", ("j",))
        assert robot.source_hash == hashlib.sha256(text.encode()).hexdigest()


def test_a_path_and_a_text_make_the_same_chain(tmp_path):
    path = tmp_path / "arm.xml"
    path.write_bytes(b"\xef\xbb\xbf" + MJCF.encode())  # with the mark that editors leave
    by_path, by_text = robots.load(path).chain, robots.load_mjcf(MJCF).chain
    assert by_path.content_hash == by_text.content_hash
    assert robots.load_mjcf(MJCF.encode()).chain.content_hash == by_text.content_hash


def test_names(tmp_path):
    path = tmp_path / "nameless.xml"
    path.write_text(MJCF.replace(' model="arm"', ""))
    assert robots.load(path).chain.name == "nameless"
    assert robots.load(path, name="mine").chain.name == "mine"
    assert robots.load("ur5e").chain.name == "ur5e"


def test_a_dh_table():
    table = DHTable(convention="modified", rows=[{"joint": "revolute"}, {"joint": "revolute", "a": 0.5}])
    assert robots.load(table).chain.joint_names == ("joint1", "joint2")


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("no_such_robot", "no_such_robot.*ur5e"),
        ("no/such/file", "there is no file 'no/such/file'"),
        ("robot.urdf", "there is no file 'robot.urdf'"),
        (Path("/"), "the folder '/' has too much in it; allowed: 5000 models and meshes"),
        ("<html/>", "the root element is <html>; <mujoco> is needed"),
    ],
)
def test_sources_that_are_not_there(source, message):
    with pytest.raises(ModelError, match=message):
        robots.load(source)


@pytest.mark.parametrize(
    ("compiler", "file"),
    [
        ('meshdir="meshes"', "parts/body.stl"),
        ('assetdir="meshes/parts" strippath="true"', "other/body.stl"),
        ("", "meshes/parts/body.stl"),
    ],
)
def test_meshes_beside_a_file_give_inertia(tmp_path, compiler, file):
    (tmp_path / "meshes/parts").mkdir(parents=True)
    (tmp_path / "meshes/parts/body.stl").write_bytes(tetrahedron_stl())
    (tmp_path / "arm.xml").write_text(with_mesh("", file, compiler))
    chain = robots.load(tmp_path / "arm.xml").chain
    assert chain.mass[0] == pytest.approx(1000 / 6)
    np.testing.assert_allclose(chain.center_of_mass[0], [0.25, 0.25, 0.25], atol=1e-6)


def test_meshes_that_no_inertia_needs_are_not_loaded(tmp_path):
    (tmp_path / "body.stl").write_bytes(b"not a mesh at all")
    (tmp_path / "arm.xml").write_text(with_mesh(INERTIAL, "body.stl", ""))
    assert robots.load(tmp_path / "arm.xml").chain.mass[0] == 1.0


def test_missing_meshes_are_dropped_with_one_warning(tmp_path):
    (tmp_path / "arm.xml").write_text(with_mesh(INERTIAL))
    with pytest.warns(robots.ModelWarning, match="meshes/parts/body.stl, ….: the files are not there") as caught:
        robot = robots.load(tmp_path / "arm.xml")
    assert len(caught) == 1
    assert (robot.model.ngeom, robot.chain.mass[0]) == (0, 1.0)


def test_a_missing_mesh_that_gives_the_inertia_is_an_error(tmp_path):
    (tmp_path / "arm.xml").write_text(with_mesh(""))
    message = "the inertia of body 'link' comes from meshes/parts/body.stl, which is not there"
    with pytest.raises(ModelError, match=message):
        robots.load(tmp_path / "arm.xml")


def test_uploaded_meshes():
    chain = robots.load_mjcf(with_mesh(""), assets={"parts/body.stl": tetrahedron_stl()}).chain
    assert chain.mass[0] == pytest.approx(1000 / 6)


def test_a_mesh_written_out_in_the_model():
    text = with_mesh("").replace('file="parts/body.stl"', 'vertex="0 0 0 1 0 0 0 1 0 0 0 1"')
    assert robots.load_mjcf(text).chain.mass[0] == pytest.approx(1000 / 6)


@pytest.mark.parametrize(
    "scenery",
    [
        '<asset><texture name="t" type="2d" file="{0}"/><material name="t" texture="t"/></asset>',
        '<asset><hfield name="h" file="{0}"/></asset><worldbody><geom type="hfield" hfield="h"/></worldbody>',
        '<asset><mesh name="h" file="{0}"/></asset><worldbody><geom type="mesh" mesh="h"/></worldbody>',
        '<deformable><skin file="{0}"/></deformable>',
        '<asset><skin file="{0}"/></asset>',
        '<extension><plugin plugin="mujoco.sdf.bolt"><instance name="{0}"/></plugin></extension>',
    ],
)
@pytest.mark.filterwarnings("ignore::wsrender.robots.ModelWarning")
def test_texts_never_read_files(tmp_path, scenery):
    """A named pipe without a writer would block whoever opens it."""
    pipe = tmp_path / "pipe.stl"
    os.mkfifo(pipe)
    text = MJCF.replace("<worldbody>", scenery.format(pipe) + "<worldbody>", 1)
    assert robots.load_mjcf(text).chain.joint_names == ("j",)


def test_scenery_is_left_out():
    text = MJCF.replace(
        "<worldbody>",
        """<option timestep="-5"/><size memory="900G"/><visual><global offwidth="99"/></visual>
        <contact><exclude body1="link" body2="nobody"/></contact><keyframe><key qpos="1 2 3"/></keyframe>
        <sensor><jointpos joint="nothing"/></sensor>
        <worldbody><light pos="0 0 1"/><camera name="c"/><geom size="1" material="gold"/></worldbody>
        <worldbody>""",
    )
    assert robots.load_mjcf(text).chain.content_hash == robots.load_mjcf(MJCF).chain.content_hash


def test_mujoco_leaves_no_log_behind(tmp_path):
    """Coaxial joints on massless links make the inertia singular, of which MuJoCo would write a log."""
    code = """
from wsrender import robots
robots.load_urdf('''<robot name="r"><link name="a"/><link name="b"/><link name="c"><inertial><mass value="1"/>
<inertia ixx="1e5" ixy="0" ixz="0" iyy="1e5" iyz="0" izz="1e5"/></inertial></link>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>
<joint name="k" type="continuous"><parent link="b"/><child link="c"/></joint></robot>''')
"""
    root = Path(__file__).parents[2]
    environment = os.environ | {"PYTHONPATH": str(root)}
    subprocess.run([sys.executable, "-W", "error", "-c", code], cwd=tmp_path, env=environment, check=True, timeout=60)
    assert list(tmp_path.iterdir()) == []


def test_importing_the_package_loads_no_mujoco():
    code = "import sys, wsrender.robots; sys.exit('mujoco' in sys.modules)"
    root = Path(__file__).parents[2]
    subprocess.run([sys.executable, "-c", code], cwd=root, check=True, timeout=60)


def test_without_mujoco_the_extra_is_named():
    code = """
import sys
sys.modules["mujoco"] = None
from wsrender import robots
from wsrender.errors import MissingExtraError
try:
    robots.load_mjcf("<mujoco/>")
except MissingExtraError as error:
    sys.exit('pip install ".[engine]"' not in str(error))
sys.exit(1)
"""
    root = Path(__file__).parents[2]
    subprocess.run([sys.executable, "-c", code], cwd=root, check=True, timeout=60)


@pytest.mark.parametrize("source", [None, 3, [1], {"library": "ur5e"}])
def test_what_is_no_source_is_refused(source):
    with pytest.raises(ws.InputError, match="source: must be a library name, the path or text of an MJCF"):
        ws.load_robot(source)


def test_a_placement_may_be_a_dict():
    fields = {"position_m": [1, 2, 3], "rpy_deg": [0, 0, 90]}
    placed, expected = (ws.load_robot("ur5e", placement=each) for each in (fields, ws.Transform(**fields)))
    assert (placed.forward_kinematics(np.zeros(6)) == expected.forward_kinematics(np.zeros(6))).all()
    with pytest.raises(ws.DocumentError, match="place: is not a known field"):
        ws.load_robot("ur5e", tool={"place": [1, 2, 3]})


ODD = URDF.replace('"1 0 0"', '"1000 0 0"')


@pytest.mark.parametrize(
    "act",
    [
        lambda path: ws.load_robot(path),
        lambda path: robots.load(path),
        lambda path: robots.load_path(path),
        lambda path: robots.load_urdf(ODD),
        lambda path: ws.evaluate_indices(path, [0.1], ["manipulability"], device="cpu"),
        lambda path: ws.execute({"analysis": "indices_at", "robot": {"urdf": ODD}, "configurations": [[0]]}),
    ],
)
def test_warnings_point_at_the_line_of_the_caller(tmp_path, act):
    path = tmp_path / "arm.urdf"
    path.write_text(ODD)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        with contextlib.suppress(ws.InputError):  # a job is refused
            act(str(path))
    assert [warning.category for warning in caught] == [robots.ModelWarning]
    assert (caught[0].filename, caught[0].lineno) == (__file__, act.__code__.co_firstlineno)
