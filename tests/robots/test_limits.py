"""Joint and effort limits of the chain."""

import numpy as np
import pytest

from wsrender import robots
from wsrender.errors import InputError, ModelError


def arm(joint="", actuator="", kind="hinge"):
    return f"""<mujoco><compiler angle="radian"/><worldbody><body name="L">
      <joint name="j" type="{kind}" {joint}/><geom size=".1"/><site name="tool" pos="1 0 0"/></body>
      </worldbody>      <actuator>{actuator}</actuator></mujoco>"""


@pytest.mark.parametrize(
    ("joint", "limits", "periodic"),
    [
        ("", (-np.pi, np.pi), True),
        ('range="-0.5 1.5"', (-0.5, 1.5), False),
        ('range="-0.5 1.5" limited="false"', (-np.pi, np.pi), True),
        (f'range="{-np.pi!r} {np.pi!r}"', (-np.pi, np.pi), False),
        ('range="-9 9"', (-9.0, 9.0), False),
        ('ref="1" range="0.5 2"', (0.5, 2.0), False),
    ],
)
def test_limits_of_a_hinge(joint, limits, periodic):
    chain = robots.load_mjcf(arm(joint)).chain
    assert (chain.lower_limits[0], chain.upper_limits[0]) == limits
    assert chain.periodic[0] == periodic


def test_degrees_are_the_default_of_mjcf():
    chain = robots.load_mjcf(arm('range="-90 45"').replace('<compiler angle="radian"/>', "")).chain
    assert (chain.lower_limits[0], chain.upper_limits[0]) == pytest.approx((-np.pi / 2, np.pi / 4))


ENDLESS = "has no usable limits: the workspace has no end; give a range"


@pytest.mark.parametrize("limits", ["", 'range="-1e16 1e16"', 'range="0 3.4e38"', 'range="-999999 999999"'])
def test_a_slide_without_usable_limits_is_endless(limits):
    with pytest.warns(robots.ModelWarning, match=f"joint j {ENDLESS}") as caught:
        robot = robots.load_mjcf(arm(limits, kind="slide"))
    assert len(caught) == 1  # and none of millimetres
    assert [(notice.code, notice.field) for notice in robot.notices] == [("no_usable_limits", "robot.limits")]
    assert (robot.chain.lower_limits[0], robot.chain.upper_limits[0]) == (-np.inf, np.inf)
    assert robot.chain.endless == ("j",)


def test_the_longest_range_that_counts():
    chain = robots.load_mjcf(arm('range="-1e5 1e5"', kind="slide")).chain
    assert (chain.upper_limits[0], chain.endless) == (1e5, ())


@pytest.mark.parametrize("kind", ["slide", "hinge"])
@pytest.mark.parametrize("own", ["", 'range="-3 3"', 'range="2 1"'])
def test_limits_that_are_given_go_before_the_models(kind, own):
    robot = robots.load_mjcf(arm(own, kind=kind), limits={"j": (-0.5, 1.0)})
    assert (robot.chain.lower_limits[0], robot.chain.upper_limits[0]) == (-0.5, 1.0)
    assert not robot.chain.periodic[0]
    assert robot.notices == ()


def test_limits_in_degrees():
    chain = robots.load_mjcf(arm(), limits_deg={"j": (-90, 45)}).chain
    assert (chain.lower_limits[0], chain.upper_limits[0]) == pytest.approx((-np.pi / 2, np.pi / 4))
    with pytest.raises(InputError, match=r'limits_deg\.j: is a slide: give it in metres, in "limits"'):
        robots.load_mjcf(arm('range="0 1"', kind="slide"), limits_deg={"j": (-90, 45)})


def test_limits_of_no_joint_of_the_chain():
    with pytest.raises(InputError, match=r"limits\.k: is no joint of the chain that leads itself; allowed: j"):
        robots.load_mjcf(arm(), limits={"k": (0, 1)})


@pytest.mark.parametrize(
    ("largest", "doubted"), [(12.5, False), (12.6, True), (90, True), (9999, True), (10001, False)]
)
def test_angles_beyond_two_turns_look_like_degrees(largest, doubted):
    text = arm(f'range="0 {largest}"')
    if not doubted:
        assert robots.load_mjcf(text).notices == ()
        return
    with pytest.warns(robots.ModelWarning, match=rf"must be in radians, and look like degrees: j 0 … {largest:g} rad"):
        robot = robots.load_mjcf(text)
    assert [(notice.code, notice.field) for notice in robot.notices] == [("units_angle", "robot.limits_deg")]
    assert robots.load_mjcf(text, limits={"j": (0, largest)}).notices == ()


def coupled(coefficient, range_of_follower=""):
    return f"""<mujoco><compiler angle="radian"/><worldbody><body><joint name="a"/><geom size=".1"/>
      <body pos="1 0 0"><joint name="b" {range_of_follower}/><geom size=".1"/></body></body></worldbody>
      <equality><joint joint1="b" joint2="a" polycoef="0 {coefficient} 0 0 0"/></equality></mujoco>"""


def test_coupled_hinges_without_limits():
    assert robots.load_mjcf(coupled(-2)).chain.periodic[0]  # both return after a turn of the leader
    with pytest.warns(robots.ModelWarning, match=f"joint a {ENDLESS}"):
        assert robots.load_mjcf(coupled(0.5)).chain.endless == ("a",)
    with pytest.warns(robots.ModelWarning, match="it has none of its own, but 'b' allows it -2 … 4"):
        chain = robots.load_mjcf(coupled(0.5, 'range="-1 2"')).chain
    assert (chain.lower_limits[0], chain.upper_limits[0], chain.periodic[0]) == (-2.0, 4.0, False)


@pytest.mark.parametrize(
    ("joint", "actuator", "effort"),
    [
        ("", "", None),
        ('actuatorfrcrange="-5 7"', "", 5.0),
        ("", '<motor joint="j" gear="-10" ctrlrange="-2 2"/>', 20.0),
        ("", '<motor joint="j" gear="10" ctrlrange="-2 2" forcerange="-1 1"/>', 10.0),
        ("", '<position joint="j" kp="5" ctrlrange="-2 2"/>', None),
        ("", '<position joint="j" kp="5" forcerange="-87 87"/>', 87.0),
        ('actuatorfrcrange="-5 5"', '<motor joint="j" gear="10" ctrlrange="-2 2"/>', 5.0),
        ("", '<motor joint="j" ctrlrange="-2 2"/><motor joint="j" ctrlrange="-3 3"/>', 5.0),
        ("", '<motor joint="j"/>', None),
        ('actuatorfrcrange="0 7"', "", None),
    ],
)
def test_effort_limits(joint, actuator, effort):
    efforts = robots.load_mjcf(arm(joint, actuator)).chain.effort_limits
    assert efforts is None if effort is None else efforts[0] == effort


@pytest.mark.parametrize(
    ("joint", "actuator", "efforts"),
    [
        ('actuatorfrcrange="-5 7"', '<motor joint="j" gear="-10" ctrlrange="-.4 2"/>', [-5.0, 4.0]),
        ("", '<general joint="j" gainprm="-2" ctrlrange="-1 3"/><motor joint="j" ctrlrange="-3 1"/>', [-9.0, 3.0]),
    ],
)
def test_efforts_of_both_directions(joint, actuator, efforts):
    assert robots.load_mjcf(arm(joint, actuator)).chain.efforts[:, 0].tolist() == efforts


def test_limits_of_efforts_and_speeds_that_are_given():
    text = coupled(-2, 'actuatorfrcrange="-1 3"')
    chain = robots.load_mjcf(text).chain
    assert chain.efforts[:, 0].tolist() == [-6, 2]  # what b holds, -2 times as much at a
    assert chain.unlimited_velocities == ("a",) and chain.unlimited_efforts == ()
    chain = robots.load_mjcf(text, effort_limits={"a": 5}, velocity_limits={"a": 4, "b": 6}).chain
    assert chain.efforts[:, 0].tolist() == [-11, 7] and chain.velocity_limits.tolist() == [3]
    for field in ("effort_limits", "velocity_limits"):
        with pytest.raises(InputError, match=rf"{field}\.c: is no joint of the chain; allowed: a, b"):
            robots.load_mjcf(text, **{field: {"c": 1}})


def test_followers_beside_the_chain_hold_and_limit_their_leader_too():
    text = coupled(-2, 'actuatorfrcrange="-1 3" range="-.1 .1"').replace("<body pos", '<site name="tool"/><body pos')
    chain = robots.load_mjcf(text, tip="tool", velocity_limits={"b": 6}).chain
    assert chain.joint_names == ("a",) and len(chain.joint_source) == 1
    assert chain.efforts[:, 0].tolist() == [-6, 2] and chain.velocity_limits.tolist() == [3]
    assert chain.periodic[0]  # its own range does not narrow that of the arm


def test_speeds_of_an_mjcf():
    text = arm('range="0 500"', kind="slide").replace(
        "<worldbody>", '<custom><numeric name="velocity_limits" data="{}"/></custom><worldbody>'
    )
    assert robots.load_mjcf(text.format("250"), length_unit_m=0.001).chain.velocity_limits.tolist() == [0.25]
    assert robots.load_mjcf(text.format("0"), length_unit_m=0.001).chain.unlimited_velocities == ("j",)
    for data in ("1 2", "-1"):
        with pytest.raises(ModelError, match="must be 1 numbers, one for each joint, 0 where it has none"):
            robots.load_mjcf(text.format(data))
