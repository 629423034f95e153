"""What `load_robot` takes: files that include others, text, and models that were made with MuJoCo in Python."""

import mujoco
import numpy as np
import pytest

import wsrender as ws
from tests.robots.test_cases import FOLDER
from wsrender import robots
from wsrender.errors import ModelError
from wsrender.robot import as_robot, robot_of_spec
from wsrender.robots.library import find, names

URDF = (FOLDER / "05-mimic-crooked-axis/m.urdf").read_text()
MJCF = """<mujoco model="arm"><compiler angle="radian"/><worldbody><body name="a" pos="1 2 3" euler=".1 .2 .3">
  <joint name="j" axis="1 2 3" ref=".2" range="-1 1" armature=".1" actuatorfrcrange="-7 7"/>
  <geom type="box" size=".1 .2 .3" pos=".1 0 .2" euler="0 .3 0"/>
  <body pos=".4 0 0"><joint type="slide" axis="0 1 1" range="0 .5"/><geom size=".1" pos=".2 0 0"/>
  <body name="c" pos=".3 .1 0"><joint name="k" axis="0 1 0.2" range="-2 2"/><geom size=".05" pos=".1 0 0"/>
  <site name="tool" pos=".2 0 .1" euler="0 0 .4"/></body></body></body></worldbody>
  <equality><joint joint1="k" joint2="j" polycoef=".1 -.5 0 0 0"/></equality>
  <actuator><motor joint="j" gear="10" ctrlrange="-.5 .5"/></actuator></mujoco>"""


def same(a, b, atol=1e-14):
    """Whether two robots are one arm to rounding."""
    assert a.joint_names == b.joint_names
    q = np.random.default_rng(1).uniform(a.lower_limits, a.upper_limits, (5, a.chain.n))
    for what in ("forward_kinematics", "jacobian", *(["inertia_matrix"] if a.has_inertia else [])):
        np.testing.assert_allclose(getattr(a, what)(q, device="cpu"), getattr(b, what)(q, device="cpu"), atol=atol)
    for name in ("lower_limits", "upper_limits", "periodic", "effort_limits"):
        np.testing.assert_array_equal(getattr(a.chain, name), getattr(b.chain, name))


@pytest.mark.parametrize(("text", "tip"), [(MJCF, None), (URDF, "tip"), ("\ufeff\n " + MJCF, "tool")])
def test_text_is_a_source(tmp_path, text, tip):
    path = tmp_path / "robot.xml"
    path.write_text(text.lstrip("\ufeff\n "))
    robot = ws.load_robot(text, tip=tip)
    same(robot, ws.load_robot(path, tip=tip))
    assert robot.spec is not None and robot.spec.source == ("urdf" if text == URDF else "mjcf")
    assert as_robot(text).joint_names == robot.joint_names


def test_specs_and_models_of_mujoco_are_sources():
    right, spec = ws.load_robot(MJCF), mujoco.MjSpec.from_string(MJCF)
    for source in (spec, spec.compile()):
        robot = as_robot(source)
        same(robot, right)
        assert robot.name == "arm"
        assert robot.spec is not None
        same(robot_of_spec(robot.spec), right)  # the job document holds it whole


@pytest.mark.parametrize("name", names())
def test_a_compiled_model_is_the_robot_of_its_text(name):
    """Every robot of the library, by way of MuJoCo's own compiled model."""
    model = mujoco.MjModel.from_xml_path(str(find(name)))
    same(ws.load_robot(model), ws.load_robot(name), atol=1e-12)


def test_meshes_of_a_spec_give_inertia(tmp_path):
    corners = "0 0 0 1 0 0 0 1 0 0 0 1"
    text = f"""<mujoco><asset><mesh name="m" vertex="{corners}"/></asset><worldbody><body name="a">
      <joint range="-1 1"/><geom type="mesh" mesh="m"/><site name="tool" pos="1 0 0"/></body></worldbody></mujoco>"""
    spec = mujoco.MjSpec.from_string(text)
    same(ws.load_robot(spec), ws.load_robot(text))
    same(ws.load_robot(spec.compile()), ws.load_robot(text))


def test_equalities_that_a_compiled_model_cannot_say():
    tendons = """<tendon><fixed name="t"><joint joint="j" coef="1"/></fixed></tendon><equality>
      <tendon name="belt" tendon1="t"/></equality></mujoco>"""
    model = mujoco.MjModel.from_xml_string(MJCF.replace("</mujoco>", tendons))
    with pytest.raises(ModelError, match="equality 'belt' couples tendons; give the model's MJCF text or its MjSpec"):
        ws.load_robot(model)


def test_ties_of_a_compiled_model_are_kept():
    text = MJCF.replace("<equality>", '<equality><connect name="rod" body1="c" body2="a" anchor="0 0 0"/>')
    with pytest.raises(ModelError, match="equality 'rod' ties a, c into a closed loop"):
        ws.load_robot(mujoco.MjModel.from_xml_string(text))


ARM = """<mujoco><worldbody><body name="a"><joint name="j" range="-60 60"/><include file="{}"/>
  <site name="tool" pos="1 0 0"/></body></worldbody></mujoco>"""


def write(folder, **files):
    for name, text in files.items():
        (folder / name).write_text(text)
    return folder / "main"


def test_included_files_stand_where_they_are_named(tmp_path):
    """Nested, in a body and at the top; names are relative to the main file."""
    path = write(
        tmp_path,
        main='<mujoco model="m"><include file="compiler"/><include file="arm"/></mujoco>',
        compiler='<mujocoinclude><compiler angle="degree"/></mujocoinclude>',
        arm=ARM.format("geom"),
        geom='<mujocoinclude><geom size=".1"/><geom size=".2"/></mujocoinclude>',
    )
    robot = robots.load_path(path)
    assert robot.chain.upper_limits == pytest.approx(np.pi / 3)
    assert robot.model.ngeom == 2
    (tmp_path / "geom").write_text('<mujocoinclude><geom size=".3"/></mujocoinclude>')
    assert robots.load_path(path).source_hash != robot.source_hash


@pytest.mark.parametrize(
    ("included", "message"),
    [
        ("absent", "the included file 'absent' is not in '.*'"),
        ("main", "'main' is included twice"),
        ("broken", "not well-formed XML"),
        ("entity", "document types, entities and external references are refused"),
        ("", "the included file '' is not in"),
    ],
)
def test_includes_that_are_refused(tmp_path, included, message):
    path = write(tmp_path, main=ARM.format(included), broken="<a>", entity='<!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>')
    with pytest.raises(ModelError, match=message):
        robots.load_path(path)


def test_text_includes_nothing():
    with pytest.raises(ModelError, match=r"includes are refused .*: inline the file, by putting what is inside"):
        ws.load_robot(ARM.format("/etc/passwd"))
