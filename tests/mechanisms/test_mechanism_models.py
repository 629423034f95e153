"""The MuJoCo models of mechanisms: they load, hold their home, and close their loops where a pose is called reached."""

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.mechanisms.mechanisms import mechanism, poses_of
from wsrender.mechanisms.five_bar import WORKING_MODES, FiveBar
from wsrender.mechanisms.inverse_kinematics import inverse_kinematics
from wsrender.robots import library

POSES = 1000
# Where poses are drawn: lower and upper corner, largest turn [rad]. Below: actuated joints, and bodies of the links.
DRAWN = {
    "stewart_gough": ([-0.3, -0.3, 0.35], [0.3, 0.3, 0.75], 0.5),
    "six_pus": ([-0.9, -0.9, 1.3], [0.9, 0.9, 2.4], 0.4),
    "delta": ([-0.6, -0.6, -1.0], [0.6, 0.6, -0.5], 0.0),
}
ACTUATED = {"stewart_gough": "leg{}", "six_pus": "slider{}", "delta": "crank{}"}
LINKS = {"stewart_gough": ("leg{}",), "six_pus": ("link{}",), "delta": ("rod{}a", "rod{}b")}


def model_of(name):
    (path,) = (found.path for found in library.mechanisms() if found.name == name)
    return mujoco.MjModel.from_xml_path(str(path))


def drawn_poses(name, count):
    low, high, turn = DRAWN[name]
    random = np.random.default_rng(2)
    poses = poses_of(random.uniform(low, high, (count, 3)))
    axes = random.normal(size=(count, 3))
    axes *= (turn * random.random(count) ** (1 / 3) / np.linalg.norm(axes, axis=1))[:, None]
    poses[:, :3, :3] = Rotation.from_rotvec(axes).as_matrix() if turn else np.eye(3)
    return poses


def assembled(name, model, data, pose, values):
    """Put platform and actuated joints there, and point every link at its joint of the platform."""
    data.qpos[:] = 0
    quat = Rotation.from_matrix(pose[:3, :3]).as_quat(scalar_first=True)
    data.joint("platform").qpos[:] = [*pose[:3, 3], *quat]
    for k, value in enumerate(values, start=1):
        data.joint(ACTUATED[name].format(k)).qpos[0] = value
    mujoco.mj_kinematics(model, data)
    for k in range(1, len(values) + 1):
        for link in LINKS[name]:
            body = data.body(link.format(k))
            part = link.format(k).removeprefix("rod").removeprefix("link").removeprefix("leg")
            reach = data.site(f"platform{part}").xpos - body.xpos
            x, y, z = body.xmat.reshape(3, 3).T @ reach / np.linalg.norm(reach)
            data.joint(f"leg{part}_x").qpos[0] = np.arctan2(-y, z)  # Rx(a) Ry(b) z
            data.joint(f"leg{part}_y").qpos[0] = np.arcsin(np.clip(x, -1, 1))
    mujoco.mj_forward(model, data)
    closed = data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
    return np.abs(data.efc_pos[closed]).max()


def limits_of(name, model, legs):
    return np.array([model.joint(ACTUATED[name].format(k)).range for k in range(1, legs + 1)]).T


@pytest.mark.parametrize("name", DRAWN)
def test_reached_poses_close_the_loop(name):
    """1,000 of them, with the actuated values of the inverse kinematics, within MuJoCo's own limits."""
    model, mech = model_of(name), mechanism(name)
    data = mujoco.MjData(model)
    poses = drawn_poses(name, 40 * POSES)
    legs = inverse_kinematics(mech, poses)
    chosen = np.flatnonzero(legs.feasible)[:POSES]
    assert len(chosen) == POSES
    for i in chosen:
        assert assembled(name, model, data, poses[i], legs.values[i]) < 1e-9
    lower, upper = limits_of(name, model, len(mech.kinds))
    values = legs.values[chosen]
    assert ((values >= lower - 1e-9) & (values <= upper + 1e-9)).all()


def just_outside(mech, inside, outside):
    """Positions (N, 3) a tenth of a micrometre beyond the boundary, between ones inside and ones outside."""
    low, high = np.zeros(len(inside)), np.ones(len(inside))
    for _ in range(60):
        middle = (low + high) / 2
        feasible = inverse_kinematics(mech, poses_of(inside + middle[:, None] * (outside - inside))).feasible
        low, high = np.where(feasible, middle, low), np.where(feasible, high, middle)
    away = outside - inside
    return inside + (high + 1e-7 / np.linalg.norm(away, axis=1))[:, None] * away


def nearest_values(mech, position):
    """Actuated values that bring each link closest to its joint, where it is out of reach."""
    reach = position + mech.platform - mech.base
    along = (reach * mech.axis).sum(axis=1)
    angle = np.arctan2((reach * np.cross(mech.axis, mech.zero)).sum(axis=1), (reach * mech.zero).sum(axis=1))
    return np.where(np.array(mech.kinds) == "PUS", along, angle)


@pytest.mark.parametrize("name", DRAWN)
def test_poses_just_outside_do_not(name):
    """A limit of the model is passed, or a loop does not close."""
    model, mech = model_of(name), mechanism(name)
    data = mujoco.MjData(model)
    positions = drawn_poses(name, 4000)[:, :3, 3]
    reached = inverse_kinematics(mech, poses_of(positions)).feasible
    beyond = just_outside(mech, positions[reached][:100], positions[~reached][:100])
    legs = inverse_kinematics(mech, poses_of(beyond))
    assert len(beyond) > 50 and not legs.feasible.any() and legs.inside.all()
    lower, upper = limits_of(name, model, len(mech.kinds))
    for position, values in zip(beyond, legs.values, strict=True):
        if np.any((values < lower) | (values > upper)):  # false where there is no value
            continue
        values = np.where(np.isnan(values), nearest_values(mech, position), values)
        assert assembled(name, model, data, poses_of([position])[0], values) > 1e-10


@pytest.mark.parametrize("name", [*DRAWN, "five_bar"])
def test_models_stay_at_home_in_a_simulation(name):
    """Half a second with actuators that hold the home: loops stay closed, the tool stays within a few millimetres."""
    model = model_of(name)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    closed = data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
    assert np.abs(data.efc_pos[closed]).max() < 1e-9
    home = data.site("tool").xpos.copy()
    for _ in range(500):
        mujoco.mj_step(model, data)
    assert np.linalg.norm(data.site("tool").xpos - home) < 5e-3
    assert np.abs(data.efc_pos[data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY]).max() < 1e-3


def test_the_five_bar_of_the_paper():
    """[CB]: cranks at 90°, 90° hold the tool at (3, 12)."""
    model = model_of("five_bar")
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.site("tool").xpos, [3, 12, 0], atol=1e-9)


@pytest.mark.parametrize("mode", WORKING_MODES)
def test_the_five_bar_closes_its_loop_where_it_reaches(mode):
    """At 1,000 points with the angles of the inverse kinematics; a point a little outside leaves it open."""
    model, five_bar = model_of("five_bar"), FiveBar.symmetric(6, 8, 5)
    data = mujoco.MjData(model)

    def opening(theta_1, theta_2, theta_3, theta_4):
        values = {"theta1": theta_1, "elbow1": theta_3 - theta_1, "theta2": theta_2, "elbow2": theta_4 - theta_2}
        for joint, value in values.items():
            data.joint(joint).qpos[0] = value
        mujoco.mj_forward(model, data)
        closed = data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
        return np.abs(data.efc_pos[closed]).max(), data.site("tool").xpos[:2]

    points = np.random.default_rng(5).uniform([-7, -13], [13, 13], (3 * POSES, 2))
    angles = five_bar.inverse_kinematics(points, mode)
    reached = np.flatnonzero(~np.isnan(angles[:, 0]))[:POSES]
    assert len(reached) == POSES
    for k in reached:
        gap, tool = opening(*angles[k])
        assert gap < 1e-12 and np.abs(tool - points[k]).max() < 1e-12
    for angle in np.linspace(0.2, 1.2, 20):  # the left leg stretched towards points 1e-6 beyond its reach
        point = (13 + 1e-6) * np.array([np.cos(angle), np.sin(angle)])
        assert np.isnan(five_bar.inverse_kinematics(point, mode)).all()
        right = five_bar.leg_angles(point[None], 1, 1 if mode[1] == "+" else -1)
        assert opening(angle, right[0][0], angle, right[1][0])[0] > 1e-7


def test_models_are_listed_apart_from_robots():
    names = [found.name for found in library.mechanisms()]
    assert names == ["delta", "five_bar", "six_pus", "stewart_gough"]
    assert not set(names) & set(library.names())
    assert [found.joints for found in library.mechanisms()] == [3, 2, 6, 6]
    assert all(found.description and found.source for found in library.mechanisms())
