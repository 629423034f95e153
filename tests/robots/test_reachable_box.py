"""The box that voxel records are kept for holds every position, and not much more where it can be known."""

import numpy as np
import pytest

import wsrender as ws
from tests.run.simple_robots import gantry, planar_arm
from wsrender.robots import library
from wsrender.robots.reachable_box import reachable_box

ROBOTS = [name for name in library.names() if name not in ("five_bar", "delta")]


@pytest.mark.parametrize("name", ROBOTS)
def test_holds_every_position(name):
    placement = ws.Transform(position_m=(0.3, -0.1, 0.2), rpy_deg=(10, 20, 30))
    robot = ws.load_robot(name, placement=placement)
    lower, upper = robot.lower_limits, robot.upper_limits
    random = np.random.default_rng(1)
    shares = random.beta(0.3, 0.3, (20_000, len(lower)))
    positions = robot.forward_kinematics(lower + shares * (upper - lower), device="cpu")[:, :3, 3]
    low, high = reachable_box(robot.chain, lower, upper)
    assert (positions >= low - 1e-9).all()
    assert (positions <= high + 1e-9).all()


def test_is_exact_for_slides_and_flat_for_a_planar_arm():
    robot = gantry()
    low, high = reachable_box(robot.chain, robot.lower_limits, robot.upper_limits)
    assert low == pytest.approx([0.005, -0.395, 0.005])
    assert high == pytest.approx([0.295, -0.005, 0.195])
    chain = planar_arm().chain
    low, high = reachable_box(chain, chain.lower_limits, chain.upper_limits)
    assert low[2] == high[2] == 0.0
    # The second joint's arc is enclosed in a box before the first joint turns it.
    assert (high[:2] >= 0.9).all()
    assert (high[:2] < 0.99).all()


def test_a_quarter_turn_is_exact():
    chain = ws.load_robot(ws.DHTable(convention="standard", rows=[ws.DHRow(a=0.5, limits_deg=(30, 120))])).chain
    low, high = reachable_box(chain, chain.lower_limits, chain.upper_limits)
    assert low == pytest.approx([-0.25, 0.5 * np.sin(np.pi / 6), 0.0], abs=1e-12)
    assert high == pytest.approx([0.5 * np.cos(np.pi / 6), 0.5, 0.0], abs=1e-12)
