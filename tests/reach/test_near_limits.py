"""Targets whose configurations stand near limits are found, and thin arms' folds told from what is out of reach."""

from importlib import import_module

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.reach.near_limits import ACCURACY, ARMS, MOST_UNDECIDED, offset_chain, tallies, targets_at
from tests.run.simple_robots import gantry
from wsrender.engine import Accuracy, Tries, solve_inverse
from wsrender.reach import InverseSolver, Solutions, refined_volume
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE, Evidence
from wsrender.reach.starts import MOST_CORNERS, corners, towards_limits
from wsrender.robots.reachable_box import reachable_box

COUNT = 100  # targets for each arm, margin and kind; tests/long.py takes 2,000


@pytest.mark.parametrize("arm", ARMS)
def test_targets_near_limits_are_not_called_unreachable(arm):
    for margin, found in tallies(arm, COUNT).items():
        assert found.targets == 2 * COUNT
        assert found.unreachable == 0
        assert found.undecided <= MOST_UNDECIDED[margin] * found.targets


@pytest.mark.parametrize("arm", ["offset chain, 8", "offset chain, 9"])
def test_positions_with_joints_on_limits_are_not_called_unreachable(arm):
    robot = ARMS[arm]()
    random = np.random.default_rng(0)
    q = random.uniform(robot.lower_limits, robot.upper_limits, (20_000, robot.chain.n))
    found = InverseSolver(robot.chain, **ACCURACY).solve(*targets_at(robot, towards_limits(robot.chain, q), "position"))
    assert (found.label == UNREACHABLE).sum() <= 1
    assert (found.label == UNDECIDED).sum() <= 1


def test_poses_out_of_reach_stay_decided():
    robot = offset_chain(7, 2)
    random = np.random.default_rng(1)
    q = random.uniform(robot.lower_limits - 2, robot.upper_limits + 2, (2_000, robot.chain.n))  # most beyond limits
    position, axes = targets_at(robot, q, "pose")
    found = InverseSolver(robot.chain, kind="pose", **ACCURACY).solve(position, axes)
    assert (found.label == UNREACHABLE).mean() > 0.9
    assert (found.label == UNDECIDED).mean() <= 0.005


@pytest.mark.parametrize(
    ("on_limit", "residual_m", "enough"), [(False, 0.1, 32), (True, 0.1, 100), (False, 0.01, 200), (True, 0.01, 200)]
)
def test_ends_on_limits_and_narrow_misses_need_a_long_search(on_limit, residual_m, enough):
    chain = ws.load_robot("franka_panda").chain
    q = (chain.lower_limits + chain.upper_limits) / 2
    q[3] = chain.upper_limits[3] if on_limit else q[3]
    evidence = Evidence(chain, "pose", Accuracy(1e-5, 1e-5, chain.reach / 2), np.zeros(1, bool))
    no, yes, residual = np.zeros(1, bool), np.ones(1, bool), np.full(1, residual_m)
    for _ in range(enough - 1):
        evidence.record(np.arange(1), Tries(q[None], residual, np.zeros(1), no, yes), residual[None])
    assert evidence.label[0] == UNDECIDED
    evidence.record(np.arange(1), Tries(q[None], residual, np.zeros(1), no, yes), residual[None])
    assert evidence.label[0] == UNREACHABLE


@pytest.mark.parametrize("name", ["ur5e", "puma560", "articulated"])
def test_poses_out_of_reach_take_few_tries(name, monkeypatch):
    """No more than six times the 32 that sufficed while ends on limits counted as others do."""
    robot, taken = ws.load_robot(name), []

    def counted(chain, targets, *rest, **options):
        taken.append(len(targets))
        return solve_inverse(chain, targets, *rest, **options)

    low, high = reachable_box(robot.chain, robot.lower_limits, robot.upper_limits)
    position = np.random.default_rng(2).uniform(low, high, (2_000, 3))
    axes = Rotation.random(2_000, random_state=1).as_matrix()
    solver = InverseSolver(robot.chain, kind="pose", **ACCURACY)
    solver.closed = None  # the search alone: a closed form leaves it next to nothing
    found = solver.solve(position, axes)
    searched = (found.label != REACHABLE) & ~found.proven
    monkeypatch.setattr("wsrender.reach.inverse_solver.solve_inverse", counted)
    solver.solve(position[searched], axes[searched])
    print("TRIES", name, sum(taken) / searched.sum(), (found.label == UNDECIDED).sum())
    assert sum(taken) <= 6 * 32 * searched.sum()


@pytest.mark.parametrize("elbow_deg", [None, (-170, 0)], ids=["elbow turns", "elbow stops when stretched"])
def test_the_fold_of_a_thin_arm_is_not_out_of_reach(elbow_deg):
    """Beside the stretched arm of 0.3 and 0.27 m the slope vanishes before the target is reached."""
    rows = [ws.DHRow(alpha_deg=90), ws.DHRow(a=0.3), ws.DHRow(a=0.27, limits_deg=elbow_deg)]
    robot = ws.load_robot(ws.DHTable(convention="standard", rows=rows))
    q = np.random.default_rng(1).uniform(robot.lower_limits, robot.upper_limits, (82_000, 3))
    found = InverseSolver(robot.chain, position_m=6e-9).solve(*targets_at(robot, q, "position"))
    assert (found.label == REACHABLE).all()


def test_measured_false_negatives_include_targets_next_to_limits(monkeypatch):
    """A solver that fails within half a percent of a slide's limit: 3 % of a uniform set of configurations."""
    robot = gantry()

    class FailsNextToLimits(InverseSolver):
        def solve(self, position, orientation=None, progress=None):
            found = super().solve(position, orientation, progress)
            chain = self.chain
            margin = 0.005 * (chain.upper_limits - chain.lower_limits)
            close = (found.q < chain.lower_limits + margin) | (found.q > chain.upper_limits - margin)
            label = np.where(close.any(axis=1), UNREACHABLE, found.label).astype(np.int8)
            return Solutions(found.q, found.distance_m, found.angle_rad, label, found.proven)

    module = import_module("wsrender.reach.reached_set")
    monkeypatch.setattr(module, "InverseSolver", FailsNextToLimits)
    _, found = refined_volume(robot.chain, 0.1, max_points=10_000)
    (tried,) = found.false_negatives
    assert tried.rate > 0.1


def test_corners_of_the_joint_space():
    few, many = offset_chain(5, 0).chain, offset_chain(12, 0).chain
    assert len(np.unique(corners(few), axis=0)) == 2**5
    for chain in (few, many):
        q = corners(chain)
        assert ((q == chain.lower_limits) | (q == chain.upper_limits)).all()
    assert len(q) == MOST_CORNERS
    assert ((q == many.upper_limits).mean(axis=0) > 0.4).all()
