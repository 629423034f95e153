"""Transforms where targets are asked for, and one orientation of many: what forward kinematics gives is reached."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws

RANDOM = np.random.default_rng(3)


@pytest.fixture(scope="module")
def robot():
    return ws.load_robot("ur5e", placement=ws.Transform(position_m=(0.3, -0.2, 0.1), rpy_deg=(20, -30, 140)))


@pytest.fixture(scope="module")
def q():
    return RANDOM.uniform(-2, 2, (5, 6))


@pytest.mark.parametrize("form", [np.asarray, np.ndarray.tolist, list], ids=["array", "nested lists", "list of arrays"])
def test_a_transform_says_position_and_orientation(robot, q, form):
    T = robot.forward_kinematics(q, device="cpu")
    quat = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    far = T.copy()
    far[::2, :3, 3] += 5
    found = ws.reachable(robot, form(far), device="cpu")
    assert list(found.labels) == ["unreachable", "reachable"] * 2 + ["unreachable"]
    assert list(ws.reachable_labels(robot, form(far), device="cpu")) == [0, 1, 0, 1, 0]
    same = ws.reachable(robot, far[:, :3, 3], quat, device="cpu")
    assert np.array_equal(found.configurations, same.configurations)
    held = ws.postures(robot, form(T), device="cpu")
    for k, posture in enumerate(q):
        assert np.abs(held.configurations[held.pose == k] - posture).max(axis=1).min() < 1e-8
    assert ws.reachability(robot, form(far), device="cpu").document["targets"]["reachable"] == 2
    assert len(ws.all_postures(robot, form(T)).tables["postures"]["pose"]) == len(held)


def test_a_single_transform(robot, q):
    T = robot.forward_kinematics(q[0], device="cpu")[0]
    for one in (T, T.tolist(), T[None]):
        assert list(ws.reachable(robot, one, device="cpu").labels) == ["reachable"]
        assert len(ws.postures(robot, one, device="cpu")) == 8


def test_four_points_are_points(robot):
    assert len(ws.reachable(robot, np.full((4, 3), 0.3), device="cpu").labels) == 4
    assert len(ws.reachable(robot, [[0.3, 0.2, 0.3]] * 4, device="cpu").labels) == 4


@pytest.mark.parametrize(
    ("given", "field", "message"),
    [
        ({"points": 2 * np.eye(4)}, "points", "transform 0 is not rigid"),
        ({"points": np.diag([1.0, 1, -1, 1])}, "points", "transform 0 is not rigid"),
        ({"points": [np.eye(4), np.full((4, 4), np.nan)]}, "points", "transform 1 is not rigid"),
        ({"points": [[1, 2, 3, 4]] * 4}, "points", "transform 0 is not rigid"),
        ({"points": np.eye(4), "orientations": [1, 0, 0, 0]}, "orientations", "must not be given beside transforms"),
        ({"points": np.zeros((3, 4))}, "points", r"has shape \(3, 4\)"),
        ({"points": [[0, 0, 0]] * 3, "orientations": [[1, 0, 0, 0]] * 2}, "orientations", "has 2 rows for 3 points"),
    ],
)
def test_what_is_none_is_refused(robot, given, field, message):
    for function in (ws.reachable, ws.reachable_labels):
        with pytest.raises(ws.InputError, match=f"^{field}: {message}"):
            function(robot, **given, device="cpu")


def test_one_orientation_of_all_points(robot):
    points, down = RANDOM.uniform(-0.5, 0.5, (6, 3)), [0, 1, 0, 0]
    one = ws.reachable(robot, points, down, device="cpu")
    each = ws.reachable(robot, points, [down] * 6, device="cpu")
    assert list(one.labels) == list(each.labels) and np.array_equal(one.configurations, each.configurations)
    held = ws.postures(robot, points, down, device="cpu")
    assert np.array_equal(held.configurations, ws.postures(robot, points, [down] * 6, device="cpu").configurations)
    assert np.array_equal(ws.reachable_labels(robot, points, down, device="cpu") == 1, one.labels == "reachable")
