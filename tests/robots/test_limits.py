"""Joint and effort limits of the chain."""

import numpy as np
import pytest

from wsrender import robots
from wsrender.errors import ModelError


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


def test_a_slide_needs_limits():
    assert robots.load_mjcf(arm('range="-1 2"', kind="slide")).chain.upper_limits[0] == 2.0
    with pytest.raises(ModelError, match="joint 'j' has no limits: give its range"):
        robots.load_mjcf(arm(kind="slide"))


def coupled(coefficient, range_of_follower=""):
    return f"""<mujoco><compiler angle="radian"/><worldbody><body><joint name="a"/><geom size=".1"/>
      <body pos="1 0 0"><joint name="b" {range_of_follower}/><geom size=".1"/></body></body></worldbody>
      <equality><joint joint1="b" joint2="a" polycoef="0 {coefficient} 0 0 0"/></equality></mujoco>"""


def test_coupled_hinges_without_limits():
    assert robots.load_mjcf(coupled(-2)).chain.periodic[0]  # both return after a turn of the leader
    with pytest.raises(ModelError, match="joint 'a' has no limits"):
        robots.load_mjcf(coupled(0.5))
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
    ],
)
def test_effort_limits(joint, actuator, effort):
    efforts = robots.load_mjcf(arm(joint, actuator)).chain.effort_limits
    assert efforts is None if effort is None else efforts[0] == effort
