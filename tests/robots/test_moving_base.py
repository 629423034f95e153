"""A base that moves, as joints before those of its arm, beside the same arm placed."""

import numpy as np
import pytest

import wsrender as ws
from wsrender.documents.placements import mounted, placed
from wsrender.robots.moving_base import MovingBase

FAR = np.array([5e5, 4e6, 30.0, 0, 0, 0])
RANGES = [[1, 1, 0, 0, 0, 1], [1, 1, 1, 1, 1, 1], [0, 1, 0, 0, 1, 0], [0, 0, 0, 0, 0, 1], [0, 0, 0, 0, 0, 0]]


@pytest.mark.parametrize("mounting", ["floor", "wall"])
@pytest.mark.parametrize("ranges", RANGES)
@pytest.mark.parametrize("origin", [0 * FAR, FAR])
def test_its_arm_stands_where_the_placed_one_does(ranges, origin, mounting):
    robot = ws.load_robot("puma560", placement=ws.Transform(position_m=(0.1, 0.2, 0.3), rpy_deg=(10, 20, 30)))
    half = np.array([1, 0.5, 0.3, 1.0, 0.5, 3.0]) * ranges
    middle = origin + np.array([0.3, -0.2, 0.1, 0.2, 0.3, 1.0])
    base = MovingBase(middle - half, middle + half, mounted(mounting) @ robot.chain.T_world_base)
    chain = base.carrying(robot.chain)
    random = np.random.default_rng(1)
    assert chain.n == 6 + sum(ranges) == len(chain.joint_names)
    for _ in range(3):
        coordinates = random.uniform(base.lower, base.upper)[None]
        q = random.uniform(robot.lower_limits, robot.upper_limits)[None]
        degrees = coordinates * ([1] * 3 + [180 / np.pi] * 3)
        there = robot.chain.placed(placed(degrees)[0] @ base.T_frame_base)
        values = base.configurations(coordinates)
        assert (values >= chain.lower_limits[: values.shape[1]]).all()
        found = chain.frames(np.hstack([values, q]))[:, sum(ranges) :]
        assert found == pytest.approx(there.frames(q), abs=1e-12 + 4e-16 * np.abs(origin).max())
    assert chain.reach < 5
