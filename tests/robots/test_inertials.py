"""Inertias that MuJoCo refuses, and robots without any."""

import mujoco
import numpy as np
import pytest

from tests.reference import chain_kinematics as reference
from tests.reference import mujoco_kinematics as by_mujoco
from wsrender import robots
from wsrender.errors import ModelError

Q = np.array([0.4, -0.9])


def mjcf(first, second, compiler=""):
    return f"""<mujoco><compiler angle="radian" {compiler}/><worldbody>
      <body name="one"><joint name="a" axis="0 0 1"/>{first}
        <body name="two" pos=".5 0 .1" euler=".2 .3 .4"><joint name="b" axis="0 1 0"/>{second}
          <site name="tool" pos=".3 0 0"/></body></body></worldbody></mujoco>"""


def inertial(moments, mass=2.0, key="diaginertia"):
    return f'<inertial pos=".1 .2 .3" mass="{mass}" {key}="{moments}"/>'


GOOD = inertial("1 1.2 1.5")


def link_inertia(text):
    """Mass, centre and inertia of the chain's last link, in the axes of its body."""
    robot = robots.load_mjcf(text)
    chain, data = robot.chain, mujoco.MjData(robot.model)
    mujoco.mj_kinematics(robot.model, data)
    frames, _ = reference.joint_frames(chain, np.zeros(chain.n))
    R = data.body("two").xmat.reshape(3, 3).T @ frames[-1, :3, :3]
    return chain.mass[-1], R @ chain.inertia[-1] @ R.T


def test_a_robot_without_masses_has_no_inertia():
    chain = robots.load_mjcf(mjcf("", "")).chain
    assert not chain.has_inertia
    assert chain.mass.max() < 1e-12


@pytest.mark.parametrize(("first", "second"), [(GOOD, ""), ("", GOOD)])
def test_a_massless_link_beside_others_gets_a_negligible_mass(first, second):
    chain = robots.load_mjcf(mjcf(first, second)).chain
    assert chain.has_inertia
    assert sorted(chain.mass)[1] == pytest.approx(2.0)
    assert 0.0 < sorted(chain.mass)[0] < 1e-12


def test_masses_that_the_chain_does_not_move_do_not_count():
    text = mjcf("", "").replace("<worldbody>", f'<worldbody><body name="stand">{GOOD}</body>')
    assert not robots.load_mjcf(text).chain.has_inertia


def test_a_negligible_bound_in_the_file_counts_as_none():
    bound = 'boundmass="1e-12" boundinertia="1e-12"'
    assert not robots.load_mjcf(mjcf("", "", bound)).chain.has_inertia
    assert robots.load_mjcf(mjcf("", "", 'boundmass=".1" boundinertia=".01"')).chain.has_inertia


def test_armature_is_kept():
    text = mjcf(GOOD, GOOD).replace('name="b"', 'name="b" armature="0.35"')
    plain, geared = robots.load_mjcf(mjcf(GOOD, GOOD)).chain, robots.load_mjcf(text).chain
    difference = reference.inertia_matrix(geared, Q) - reference.inertia_matrix(plain, Q)
    np.testing.assert_allclose(difference, np.diag([0, 0.35]), atol=1e-15)


@pytest.mark.parametrize(
    "stated",
    [
        inertial("1 1 3"),
        inertial("3 1 1"),
        inertial("1 2 4 .3 -.2 .1", key="fullinertia"),
    ],
)
@pytest.mark.parametrize("compiler", ["", 'balanceinertia="true"'])
def test_an_inertia_that_breaks_the_triangle_inequality_is_used_as_stated(stated, compiler):
    with pytest.warns(robots.ModelWarning, match="inertia of two breaks the triangle inequality") as caught:
        mass, inertia = link_inertia(mjcf(GOOD, stated, compiler))
    assert len(caught) == 1
    numbers = [float(word) for word in stated.split('"')[-2].split()]
    xx, yy, zz, xy, xz, yz = [*numbers, 0, 0, 0][:6]
    np.testing.assert_allclose(inertia, [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], atol=1e-14)
    assert mass == 2.0


def test_mujoco_has_the_stated_inertia_too():
    with pytest.warns(robots.ModelWarning):
        robot = robots.load_mjcf(mjcf(GOOD, inertial("1 1 3")))
    data = by_mujoco.at(robot.model, {"a": Q[0], "b": Q[1]})
    M = by_mujoco.inertia_matrix(robot.model, data, ("a", "b"))
    np.testing.assert_allclose(reference.inertia_matrix(robot.chain, Q), M, atol=1e-14)


@pytest.mark.parametrize(
    "moments", ["0 0 0", "0 1 1", "1 1 2", "0.1 0.2 0.30000000000000004", "0.3 0.1 0.2", "1e-18 1e-18 1e-18"]
)
def test_point_masses_rods_and_plates_are_real(moments):
    mass, inertia = link_inertia(mjcf(GOOD, inertial(moments)))  # warnings are errors
    np.testing.assert_allclose(inertia, np.diag([float(word) for word in moments.split()]), atol=2e-13)
    assert mass == 2.0


def test_full_inertias_are_exact():
    rng = np.random.default_rng(2)
    for scale in (1.0, 1e-3, 1e-6):
        A = rng.normal(size=(3, 3))
        second = A @ A.T
        tensor = scale * (np.trace(second) * np.eye(3) - second)
        words = " ".join(repr(float(tensor[i])) for i in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)))
        _, inertia = link_inertia(mjcf(GOOD, inertial(words, key="fullinertia")))
        np.testing.assert_allclose(inertia, tensor, atol=1e-14 * scale)


@pytest.mark.parametrize(
    ("stated", "message"),
    [
        (inertial("1 1 1", mass=-2), "link 'two': its mass is -2 kg; it must not be negative"),
        (inertial("1 -1 1"), "link 'two': its inertia is -1; it must not be negative"),
        (inertial("1 1 1 2 0 0", key="fullinertia"), "inertia is not positive .principal moment -1 kg m²"),
        (inertial("1 nan 1"), "<inertial>: diaginertia is 'nan'; a finite number is needed"),
        (inertial("1 1 1", mass="inf"), "<inertial>: mass is 'inf'; a finite number is needed"),
    ],
)  # fmt: skip
def test_inertias_that_are_refused(stated, message):
    with pytest.raises(ModelError, match=message):
        robots.load_mjcf(mjcf(GOOD, stated))


def test_an_impossible_inertia_off_the_chain_does_no_harm():
    bad = '<body name="antenna"><inertial pos="0 0 0" mass="1" fullinertia="1 1 1 2 0 0"/></body>'
    text = mjcf(GOOD, GOOD).replace("<worldbody>", f"<worldbody>{bad}")
    assert robots.load_mjcf(text).chain.has_inertia


def test_inertia_comes_from_geometry_in_mjcf_but_not_in_urdf():
    sphere = '<geom size=".1" density="1000"/>'
    mass = robots.load_mjcf(mjcf(sphere, sphere)).chain.mass
    np.testing.assert_allclose(mass, 4000 * np.pi / 3 * 1e-3)
    shape = '<visual><geometry><sphere radius=".1"/></geometry></visual>'
    urdf = f"""<robot name="r"><link name="a">{shape}</link><link name="b">{shape}</link>
      <joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint></robot>"""
    assert not robots.load_urdf(urdf).chain.has_inertia
