"""Distances to obstacles and to the workspace's boundary, against closed forms."""

import numpy as np
import pytest
from scipy.ndimage import map_coordinates

import wsrender as ws
from wsrender.documents.kinetostatics import BoundaryForce, ObstacleForce
from wsrender.documents.robot import Transform
from wsrender.kinetostatics.boundary import BoundaryDistance, boundary_distance
from wsrender.kinetostatics.ramps import ObstacleDistance

POSE = Transform(position_m=(0.1, -0.2, 0.3), rpy_deg=(10, 20, 30))
SIZE = np.array([0.2, 0.4, 0.1])
CORNERS = [(x * SIZE[0] / 2, y * SIZE[1] / 2, z * SIZE[2] / 2) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]


def box_distance(point):
    """Signed distance to the box and its gradient (Quílez, *Distance functions*)."""
    T = POSE.matrix()
    local = T[:3, :3].T @ (point - T[:3, 3])
    q = np.abs(local) - SIZE / 2
    outside = np.maximum(q, 0)
    distance = np.linalg.norm(outside) + min(q.max(), 0)
    gradient = outside if q.max() > 0 else np.eye(3)[q.argmax()]
    return distance, T[:3, :3] @ (gradient / np.linalg.norm(gradient) * np.sign(local))


BOX_IN_A_FILE = '<mujoco><worldbody><geom type="box" size="0.1 0.2 0.05"/></worldbody></mujoco>'


@pytest.mark.parametrize("shape", ["sphere", "box", "mesh", "scene"])
def test_distance_and_direction(shape):
    items = {
        "sphere": {"center_m": POSE.position_m, "radius_m": 0.15},
        "box": {"pose": POSE, "size_m": SIZE.tolist()},
        "mesh": {"pose": POSE, "vertices_m": [*CORNERS, (0, 0, 0)]},
        "scene": {"pose": POSE, "mjcf": BOX_IN_A_FILE},
    }
    obstacle = ObstacleDistance(ObstacleForce(items=[{"shape": shape, **items[shape]}], tip_radius_m=0.01))
    rng = np.random.default_rng(0)
    inside = 0
    for point in rng.uniform(-0.4, 0.4, (400, 3)) * [0.5, 1, 0.5] + POSE.position_m:
        distance, gradient = obstacle.at(point)
        away = point - POSE.position_m
        if shape == "sphere":
            expected = np.linalg.norm(away) - 0.15, away / np.linalg.norm(away)
        else:
            expected = box_distance(point)
        assert distance == pytest.approx(expected[0] - 0.01, abs=1e-7)
        assert gradient == pytest.approx(expected[1], abs=1e-5)
        inside += distance < 0
    assert inside > 20


def test_the_nearest_of_several_counts():
    spheres = [{"shape": "sphere", "center_m": [x, 0, 0], "radius_m": 0.1} for x in (-1.0, 1.0)]
    obstacle = ObstacleDistance(ObstacleForce(items=spheres))
    assert obstacle.at(np.array([0.8, 0, 0]))[0] == pytest.approx(0.1 - 0.005)
    assert obstacle.at(np.array([-0.8, 0, 0]))[1] == pytest.approx([1, 0, 0])


def test_a_flat_mesh_is_refused():
    with pytest.raises(ws.InputError, match=r"obstacles\.items\.0\.vertices_m: enclose no volume"):
        ObstacleDistance(
            ObstacleForce(items=[{"shape": "mesh", "vertices_m": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]}])
        )


def test_a_floor_pushes_upwards():
    robot = ws.load_robot("ur5e")
    q = [0.3, -0.4, 0.9, 0.2, 0.5, 0.0]
    height = robot.forward_kinematics([q])[0, 2, 3]
    floor = ws.HalfSpace(name="floor", point_m=(5, 5, height - 0.015))
    field = ws.force_field(robot, joint_limits=None, conditioning=None, obstacles=ws.Environment([floor]))
    state = field.evaluate(q)
    assert state.obstacle_m == pytest.approx(0.015 - 0.005)
    stiffness = 6.4 / 0.02  # peak force / margin
    assert state.force == pytest.approx([0, 0, stiffness * (0.02 - 0.01)], abs=1e-6)


def shell():
    """Waist, elevation, slide: a thick spherical shell, 0.3 … 0.7 m, all round below 60° of elevation."""
    rows = [
        ws.DHRow(alpha_deg=90),
        ws.DHRow(alpha_deg=90, theta_deg=90, limits_deg=(-60, 60)),
        ws.DHRow(joint="prismatic", limits=(0.3, 0.7)),
    ]
    return ws.load_robot(ws.DHTable(convention="standard", rows=rows))


@pytest.mark.parametrize("refined", [False, True])
def test_boundary_of_a_shell(refined):
    robot = shell()
    boundary = boundary_distance(robot.chain, BoundaryForce(refined=refined, cells=40))
    rng = np.random.default_rng(1)
    errors, tilts = [], []
    for _ in range(300):
        azimuth, elevation = rng.uniform(-np.pi, np.pi), np.radians(rng.uniform(-30, 30))
        radius = rng.uniform(0.28, 0.72)
        radial = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
        distance, gradient = boundary.at(radius * radial)
        nearest = min(radius - 0.3, 0.7 - radius)
        if abs(radius - 0.5) < 2 * boundary.cell_m:
            continue  # the ridge between both walls is rounded off
        errors.append(distance - nearest)
        tilts.append(gradient @ radial * (1 if radius < 0.5 else -1))
    assert np.abs(errors).max() < 1.0 * boundary.cell_m
    assert np.abs(np.mean(errors)) < (0.3 if refined else 0.6) * boundary.cell_m
    assert min(tilts) > 0.85
    assert np.mean(tilts) > 0.97


def test_the_gradient_is_that_of_the_distance():
    boundary = boundary_distance(shell().chain, BoundaryForce(cells=24))
    rng = np.random.default_rng(2)
    for point in rng.uniform(-0.6, 0.6, (100, 3)):
        _, gradient = boundary.at(point)
        steps = 1e-6 * np.eye(3)
        differences = [(boundary.at(point + step)[0] - boundary.at(point - step)[0]) / 2e-6 for step in steps]
        assert gradient == pytest.approx(differences, abs=1e-6)


@pytest.mark.parametrize("dimensions", [1, 2, 3])
def test_the_distance_is_a_cubic_spline(dimensions):
    """Between cells, along axes that lie askew, as SciPy has it."""
    rng = np.random.default_rng(dimensions)
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0][:dimensions]
    values, origin = rng.normal(size=(9, 8, 7)[:dimensions]), rng.normal(size=dimensions)
    boundary = BoundaryDistance(values, axes, origin, cell_m=0.3)

    def expected(u):
        return map_coordinates(values, u.T, order=3, prefilter=False)

    steps = 1e-5 * np.eye(dimensions)
    for u in rng.uniform(1, np.array(values.shape) - 2, (50, dimensions)):
        distance, gradient = boundary.at((origin + 0.3 * u) @ axes)
        slopes = (expected(u + steps) - expected(u - steps)) / 2e-5
        assert distance == pytest.approx(expected(u[None])[0], abs=1e-12)
        assert gradient == pytest.approx(slopes @ axes / 0.3, abs=1e-7)


def test_a_planar_workspace_is_measured_in_its_plane():
    """2R in a tilted plane: an annulus."""
    rows = [ws.DHRow(a=0.5), ws.DHRow(a=0.2)]
    placement = ws.Transform(position_m=(0.1, 0.2, 0.3), rpy_deg=(30, 20, 0))
    robot = ws.load_robot(ws.DHTable(convention="standard", rows=rows), placement=placement)
    boundary = boundary_distance(robot.chain, BoundaryForce(cells=64))
    R, p = placement.matrix()[:3, :3], placement.matrix()[:3, 3]
    for radius in (0.33, 0.4, 0.6, 0.66):
        for angle in np.linspace(0, 6, 20):
            radial = R @ [np.cos(angle), np.sin(angle), 0]
            distance, gradient = boundary.at(p + radius * radial)
            assert distance == pytest.approx(min(radius - 0.3, 0.7 - radius), abs=boundary.cell_m)
            assert abs(gradient @ R[:, 2]) < 1e-9
            assert gradient @ radial * np.sign(0.5 - radius) > 0.9


def test_the_boundary_pushes_inwards():
    field = ws.force_field(
        shell(), joint_limits=None, conditioning=None, boundary={"margin_m": 0.05, "cells": 40}, form="potential"
    )
    q = np.array([0.4, 0.1, 0.69])
    state = field.evaluate(q)
    radial = state.posture.position / np.linalg.norm(state.posture.position)
    assert state.force @ radial < -3
    assert state.boundary_m == pytest.approx(0.01, abs=field._boundary.distance.cell_m)  # type: ignore[union-attr]
    assert field.force([0.4, 0.1, 0.5]) == pytest.approx([0, 0, 0])
