"""Nearness of joint limits and ellipsoids of a tip, against closed forms."""

import numpy as np
import pytest

import wsrender as ws
from wsrender.analyses.kinetostatic_field.pictures import limits_and_ellipsoids
from wsrender.kinetostatics import posture_tables
from wsrender.kinetostatics.force_fields import ellipsoids, limit_nearness
from wsrender.results.drawing import save_figure


def planar():
    rows = [ws.DHRow(a=0.5), ws.DHRow(a=0.3, limits_deg=(-90, 90))]
    return ws.load_robot(ws.DHTable(convention="standard", rows=rows))


@pytest.mark.parametrize(("degrees", "nearness"), [(0, 0.0), (45, 0.5), (-90, 1.0), (80, 8 / 9), (100, 1.0)])
def test_nearness_of_a_limit(degrees, nearness):
    field = ws.force_field(planar(), task=["x", "y"])
    assert limit_nearness(field, np.radians([170, degrees])) == pytest.approx([0, nearness])


def test_ellipsoids_hold_what_unit_rates_and_torques_do():
    rng = np.random.default_rng(0)
    J = rng.normal(size=(3, 4)) * 0.2
    axes, velocity, force = ellipsoids(J)
    assert axes @ axes.T == pytest.approx(np.eye(3))
    rates = rng.normal(size=(200, 4))
    speeds = J @ (rates / np.linalg.norm(rates, axis=1)[:, None]).T
    assert (((axes @ speeds) / velocity[:, None]) ** 2).sum(axis=0).max() <= 1 + 1e-12
    directions = rng.normal(size=(200, 3))
    forces = directions / np.linalg.norm(J.T @ directions.T, axis=0)[:, None]  # |J' F| = 1
    assert (((forces @ axes.T) / force) ** 2).sum(axis=1) == pytest.approx(np.ones(200))


def test_a_singular_posture_has_a_flat_velocity_and_a_cut_force_ellipsoid():
    J = planar().jacobian([0.3, 0.0])[0][:3]
    _, velocity, force = ellipsoids(J)
    assert velocity == pytest.approx([np.hypot(0.8, 0.3), 0, 0], abs=1e-12)
    assert force == pytest.approx(np.array([1, 10, 10]) / velocity[0])


def test_picture(tmp_path):
    robot = ws.load_robot("ur5e")
    q = robot.lower_limits + 0.7 * (robot.upper_limits - robot.lower_limits)
    tables = posture_tables(ws.force_field(robot), q)
    assert tables["posture"]["limit_nearness"] == pytest.approx([0, *[0.4] * 6, 0])
    assert tables["posture"]["position"][-1] == pytest.approx(robot.forward_kinematics(q)[0][:3, 3])
    save_figure(limits_and_ellipsoids(tables["posture"], tables["ellipsoids"]), tmp_path / "posture.png")
    assert (tmp_path / "posture.png").stat().st_size > 20_000
    with pytest.raises(ws.InputError, match="axis, force, velocity are needed"):
        limits_and_ellipsoids(tables["posture"], tables["posture"])
