"""Cells that interval arithmetic proves out of reach hold no position, and they are most of those around an arm."""

import numpy as np
import pytest

import wsrender as ws
from tests.reference.exact_volumes import CASES
from wsrender.reach.cover import _filled, covered_cells
from wsrender.robots import library
from wsrender.robots.reachable_box import reachable_box, reachable_boxes
from wsrender.volume.lattice import block_around

ROBOTS = [name for name in library.names() if name not in ("five_bar", "delta")]
EDGE = 0.02


@pytest.mark.parametrize("name", ROBOTS)
def test_every_position_lies_in_a_covered_cell(name):
    robot = ws.load_robot(name, placement=ws.Transform(position_m=(0.3, -0.1, 0.2), rpy_deg=(10, 20, 30)))
    lower, upper = robot.lower_limits, robot.upper_limits
    block = block_around(*reachable_box(robot.chain, lower, upper), EDGE)
    covered = covered_cells(robot.chain, block, 3)
    shares = np.random.default_rng(1).beta(0.3, 0.3, (20_000, len(lower)))
    positions = robot.forward_kinematics(lower + shares * (upper - lower), device="cpu")[:, :3, 3]
    cells = np.floor(positions / EDGE).astype(int) - block.first_voxel
    assert covered[tuple(cells.T)].all()
    plan = covered_cells(robot.chain, block, 2)
    assert plan.shape == block.shape[:2]
    assert plan[tuple(cells[:, :2].T)].all()


@pytest.mark.parametrize(("name", "largest"), [("spherical", 1.5), ("cartesian", 1.5), ("articulated", 2.5)])
def test_a_cover_is_not_much_larger_than_what_is_reached(name, largest):
    chain = ws.load_robot(name).chain
    block = block_around(*reachable_box(chain, chain.lower_limits, chain.upper_limits), 0.01)
    covered = covered_cells(chain, block, 3).sum() * 0.01**3
    assert CASES[name].volume <= covered <= largest * CASES[name].volume


def test_boxes_of_parts_are_those_of_each_part():
    chain = ws.load_robot("franka_panda").chain
    random = np.random.default_rng(0)
    lower, upper = np.sort(random.uniform(chain.lower_limits, chain.upper_limits, (2, 50, chain.n)), axis=0)
    low, high = reachable_boxes(chain, lower, upper)
    for k in range(50):
        alone = reachable_box(chain, lower[k], upper[k])
        assert np.allclose(np.stack([low[k], high[k]]), alone, rtol=0, atol=1e-12)


@pytest.mark.parametrize("shape", [(7,), (6, 5), (4, 6, 5)])
def test_filled_ranges(shape):
    random = np.random.default_rng(2)
    starts, stops = np.sort(random.integers(0, np.array(shape) + 1, (2, 4, len(shape))), axis=0)
    expected = np.zeros(shape, bool)
    for start, stop in zip(starts, stops, strict=True):
        expected[tuple(map(slice, start, stop))] = True
    assert (_filled(starts, stops, shape) == expected).all()
