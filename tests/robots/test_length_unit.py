"""Models in millimetres: noticed, converted, confirmed."""

import re

import numpy as np
import pytest

from tests.reference import chain_kinematics as reference
from wsrender import robots

MESH = 1e-6  # MuJoCo holds the vertices of meshes in single precision

# {} stands around lengths, {{}} around what goes by their square. No length is a round number of the reference frames.
IN_METRES = """<mujoco><compiler angle="radian"/><asset><mesh name="wedge" scale="{1} {1} {1}" refpos="0.01 0 0"
    vertex="0 0 0 0.1 0 0 0 0.1 0 0 0 0.1"/></asset>
  <worldbody><frame pos="0 0 {0.2}"><body name="a" pos="0 0 {0.3}">
    <joint name="j" axis="0 1 0" range="-2 2" pos="0 0 {0.05}" armature="{{0.01}}"/>
    <inertial pos="{0.1} 0 0" mass="2" fullinertia="{{0.02}} {{0.03}} {{0.04}} {{0.001}} 0 0"/>
    <body name="b" pos="{0.4} 0 0"><joint name="s" type="slide" axis="1 0 0" range="{-0.1} {0.3}" ref="{0.1}"/>
      <geom type="box" size="{0.1} {0.05} {0.02}" pos="{0.02} 0 0"/>
      <body name="c"><joint name="k" axis="0 0 1" range="-1 1"/><geom type="mesh" mesh="wedge"/>
        <geom type="capsule" size="{0.03}" fromto="0 0 0 {0.2} 0 0"/>
        <body name="d"><joint name="f" type="slide" axis="0 1 0"/><geom size="{0.02}"/>
          <site name="tool" pos="0 0 {0.1}"/>
  </body></body></body></body></frame></worldbody>
  <equality><joint joint1="f" joint2="k" polycoef="{0.02} {0.05} 0 0 0"/></equality></mujoco>"""


def text(unit):
    """The model with its lengths in metres / unit."""

    def written(match):
        return repr(float(match[2]) * unit ** (2 if match[1] else 1))

    return re.sub(r"\{(\{?)(-?[0-9.]+)\}+", written, IN_METRES)


@pytest.mark.parametrize("q", [(0.3, 0.2, -0.4), (-1.5, -0.05, 0.9)])
def test_a_model_in_millimetres_is_converted(q):
    right = robots.load_mjcf(text(1.0)).chain
    chain = robots.load_mjcf(text(1e3), length_unit_m=1e-3).chain
    assert chain.joint_names == ("j", "s", "k")
    np.testing.assert_allclose(chain.lower_limits, right.lower_limits, rtol=1e-12)
    np.testing.assert_allclose(chain.upper_limits, right.upper_limits, rtol=1e-12)
    for quantity in (reference.forward_kinematics, reference.jacobian):
        np.testing.assert_allclose(quantity(chain, q), quantity(right, q), rtol=1e-12, atol=1e-14)
    M = reference.inertia_matrix(right, q)
    np.testing.assert_allclose(reference.inertia_matrix(chain, q), M, atol=MESH * np.abs(M).max())


def arm(length, before="", slide=""):
    return f"""<mujoco><compiler angle="radian"/><worldbody><body>{before}<inertial pos="0 0 0" mass="1"
      diaginertia="1 1 1"/><body><joint name="j" range="-1 1"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <body pos="0.5 0 0"><joint name="k" range="-1 1"/>{slide}<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <site name="tool" pos="{length} 0 0"/></body></body></body></worldbody></mujoco>"""


def rail(limits):
    return f'<joint name="rail" type="slide" range="{limits}"/>'


@pytest.mark.parametrize(
    ("model", "said"),
    [
        (arm(300), "300 m .the tip beyond the last joint alone 300 m."),
        (arm(0.3, slide=rail("0 400")), "401 m .the range of slide 'rail' alone 400 m."),
        (arm(0.3, slide=rail("-400 400")), "401 m .the range of slide 'rail' alone 400 m."),
        (arm(0.3, before=rail("0 400")), "401 m .the range of slide 'rail' alone 400 m."),
    ],
)
def test_lengths_beyond_any_arm_are_doubted_until_confirmed(model, said):
    with pytest.warns(robots.ModelWarning, match=f"{said}; lengths must be in metres, not millimetres") as caught:
        robot = robots.load_mjcf(model)
    assert len(caught) == 1
    assert [(notice.code, notice.field) for notice in robot.notices] == [("units_length", "robot.length_unit_m")]
    assert robots.load_mjcf(model, length_unit_m=1).notices == ()
    assert robots.load_mjcf(model, length_unit_m=1).chain.reach == robot.chain.reach


def test_a_range_that_the_user_gives_a_slide_is_not_doubted():
    assert robots.load_mjcf(arm(0.3, slide=rail("0 400")), limits={"rail": (0, 400)}).notices == ()
    with pytest.warns(robots.ModelWarning, match="300 m .the tip beyond the last joint alone 300 m."):
        robots.load_mjcf(arm(300, slide=rail("0 400")), limits={"rail": (0, 400)})


@pytest.mark.parametrize("model", [arm(19.4), arm(0.3, before=rail("-90 90")), arm(0.3, slide=rail("-9 9"))])
def test_long_arms_and_virtual_bases_are_not_doubted(model):
    assert robots.load_mjcf(model).notices == ()
