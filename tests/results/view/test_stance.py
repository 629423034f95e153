"""A robot that nobody has posed stands as an arm does: above its base, ahead, bent, and free of itself."""

import numpy as np
import pytest

import wsrender as ws
from tests.collision.robots import collides
from wsrender.results.view import robot_view
from wsrender.results.view.stance import _costs, stance
from wsrender.robots import library


def stood(robot):
    """Its configuration in a view (n,), and its frames there."""
    (shown,) = robot_view(robot).manifest["robots"]
    q = np.array(shown["home"])
    return q, robot.chain.frames(q[None])[0]


@pytest.mark.parametrize("name", sorted(library.names()))
def test_library_robots(name):
    robot = ws.load_robot(name)
    q, _ = stood(robot)
    assert (q >= robot.lower_limits).all() and (q <= robot.upper_limits).all()
    whole = robot.chain.revolute & (robot.upper_limits - robot.lower_limits >= 2 * np.pi)
    assert np.abs(q[whole]).max(initial=0.0) <= np.pi
    assert not collides(robot, q[None])[0]


@pytest.mark.parametrize("name", ["ur5e", "franka_panda", "kuka_iiwa14", "puma560", "stanford_arm"])
def test_arms_are_bent_and_ahead(name):
    robot = ws.load_robot(name)
    _, frames = stood(robot)
    at = frames[:, :3, 3]
    assert (at[:, 2] > -1e-9).all()
    x, y, _ = at[-1]
    assert x > 0 > y  # where the eye is at first
    straight = np.linalg.norm(np.diff(at, axis=0), axis=1).sum()
    assert 0.3 * straight < np.linalg.norm(at[-1] - at[0]) < 0.85 * straight


def test_they_look_the_same_way_however_their_base_is_turned():
    turned = ws.load_robot("ur5e").placed(ws.Transform(rpy_deg=(0.0, 0.0, 130.0)))
    x, y, _ = stood(turned)[1][-1, :3, 3]
    assert x > 0 > y


def cost(chain, q):
    """What a posture (n,) costs, by hand, in reaches: of each part what is said of it."""
    base, up = chain.T_world_base[:3, 3], np.array([0.0, 0.0, 1.0])
    frames = chain.frames(q[None])[0]
    at = [(T[:3, 3] - base) / chain.reach for T in frames]
    total = float(np.linalg.norm(at[-1] - [0.48, -0.43, 0.30]))
    for point in at[1:]:
        total += 5.0 * max(0.0, 0.03 - point @ up)  # below what the base stands on
    total += 0.1 * float(frames[-1][:3, 2] @ up)  # a tool that looks down
    total -= 0.3 * min(0.6, max(float(point @ up) for point in at))  # an elbow that stands high
    points = [at[0]]
    for point in at[1:]:
        points += [(points[-1] + point) / 2, point]
    for i, a in enumerate(points):
        for j in range(i + 1, len(points)):
            along = sum(float(np.linalg.norm(points[k + 1] - points[k])) for k in range(i, j))
            if along > 0.24:  # no neighbours
                total += 5.0 * max(0.0, 0.12 - float(np.linalg.norm(points[j] - a)))
    for value, lower, upper in zip(q, chain.lower_limits, chain.upper_limits, strict=True):
        low, high = max(lower, -np.pi), min(upper, np.pi)  # all of them hold 0
        total += 0.03 * abs(2 * (value - low) / (high - low) - 1)
    return total


ROWS = [{"d": 0.3, "alpha": np.pi / 2}, {"a": 0.5}, {"a": 0.4, "limits_deg": [-150, 120], "alpha": 0.7}, {"a": 0.2}]
FOLDS = {"a": 0.45, "limits_deg": [-170, 170]}


@pytest.mark.parametrize("rows", [ROWS, [{"d": 0.1, "alpha": np.pi / 2}, FOLDS, FOLDS, FOLDS]])
def test_each_part_of_what_a_posture_costs_weighs_what_is_said(rows):
    chain = ws.load_robot(ws.DHTable(convention="standard", rows=rows)).chain
    q = np.random.default_rng(0).uniform(chain.within(0.0), chain.within(1.0), (300, 4))
    expected = [cost(chain, each) for each in q]
    assert np.ptp(expected) > 2  # low, folded and stretched ones
    np.testing.assert_allclose(_costs(chain, q), expected, atol=1e-12)


def test_the_best_of_all_postures_is_found():
    """Of an arm whose postures in steps of 15° can all be tried."""
    rows = [{"d": 0.3, "alpha": np.pi / 2, "limits_deg": [-180, 180]}, {"a": 0.5, "limits_deg": [-180, 180]},
            {"a": 0.4, "limits_deg": [-150, 120]}]  # fmt: skip
    chain = ws.load_robot(ws.DHTable(convention="standard", rows=rows)).chain
    steps = [np.deg2rad(np.arange(low, high + 1, 15.0)) for low, high in ((-180, 180), (-180, 180), (-150, 120))]
    every = np.stack(np.meshgrid(*steps, indexing="ij"), axis=-1).reshape(-1, 3)
    best = every[_costs(chain, every).argmin()]
    np.testing.assert_allclose(stance(chain), best, atol=1e-12)


def test_arms_on_a_wall_stand_as_they_do_on_a_floor():
    robot = ws.load_robot("ur5e")
    on_a_wall = robot.placed(ws.Transform(rpy_deg=(0.0, 60.0, 0.0)))
    np.testing.assert_array_equal(stance(on_a_wall.chain), stance(robot.chain))
    leaning = robot.placed(ws.Transform(rpy_deg=(0.0, 20.0, 50.0)))
    assert not np.array_equal(stance(leaning.chain), stance(robot.chain))  # seen from the same side
