"""Positions alone: those of the poses, whatever the sampling, in ranges of samples, and without Jacobians."""

from dataclasses import replace

import numpy as np
import pytest

import wsrender as ws
from wsrender.engine import configurations, devices_of, evaluate_poses, sampled_positions, sweep
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline, tip_pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.tolerances import TOLERANCES
from wsrender.volume.lattice import LatticeBlock

COUNT = 5000
SAMPLINGS = (ws.Sobol(COUNT, seed=3), ws.Random(COUNT, seed=3), ws.BoundaryBiased(COUNT), ws.Grid(4))


class Crank:
    """A planar joint with a link of 0.5 m whose Jacobian nobody may ask for."""

    limits = ((-1.0, 2.0),)

    def forward_kinematics(self, q):
        T = np.tile(np.eye(4), (len(q), 1, 1))
        T[:, 0, 3], T[:, 1, 3] = 0.5 * np.cos(q[:, 0]), 0.5 * np.sin(q[:, 0])
        return T

    def jacobian(self, q):
        assert len(q) < 100, "positions alone need no Jacobian"  # some are taken when the robot is made
        return np.zeros((len(q), 6, 1))


@pytest.mark.parametrize("sampling", SAMPLINGS, ids=lambda each: each.method)
def test_they_are_those_of_the_poses(sampling, precision, device):
    robot = ws.load_robot("ur5e", placement=ws.Transform(position_m=(0.3, -0.2, 5.0)))
    pipeline = replace(tip_pipeline(robot.chain, sampling), precision=precision)
    expected = evaluate_poses(robot.chain, configurations(pipeline), device="cpu")[:, :3, 3]
    found = sampled_positions(pipeline, device)
    assert found.shape == (pipeline.sampling.count, 3) and found.dtype == np.float64
    np.testing.assert_allclose(found, expected, atol=TOLERANCES[precision].position(robot.chain.reach))
    part = sampled_positions(pipeline, device, first=512, count=768, threads=2)
    np.testing.assert_array_equal(part, found[512:1280])


def test_given_configurations_keep_their_order(device):
    robot = ws.load_robot("franka_panda")
    q = np.random.default_rng(1).uniform(robot.chain.lower_limits, robot.chain.upper_limits, (40_000, 7))
    expected = evaluate_poses(robot.chain, q, device="cpu")[:, :3, 3]
    np.testing.assert_allclose(sampled_positions(tip_pipeline(robot.chain, q), device), expected, atol=1e-12)
    assert sampled_positions(tip_pipeline(robot.chain, q[:0]), device).shape == (0, 3)


def test_a_python_robot_is_not_asked_for_jacobians(device):
    from wsrender.robot import as_robot

    chain = as_robot(Crank()).chain
    q = np.linspace(-1, 2, 300)[:, None]
    expected = 0.5 * np.stack([np.cos(q[:, 0]), np.sin(q[:, 0]), 0 * q[:, 0]], axis=1)
    np.testing.assert_allclose(sampled_positions(tip_pipeline(chain, q), device), expected, atol=1e-15)


@pytest.mark.parametrize("sampling", (ws.Sobol(COUNT), ws.Grid(5)), ids=lambda each: each.method)
def test_voxels_count_the_same_samples_without_indices(sampling, precision, device):
    robot = ws.load_robot("articulated")
    plan = plan_sampling(robot.chain, sampling)
    block = LatticeBlock(0.05, (-12, -12, -12), (24, 24, 24))
    found = {}
    for names in ((), ("manipulability", "isotropy")):
        evaluation = Evaluation(robot.chain, names, (0, 1, 2) if names else ())
        statistics, bounds = frozenset({"maximum", "mean"}), (4.0,) * len(names)
        each = Pipeline(evaluation, plan, (), block, statistics, bounds=bounds, precision=precision)
        found[len(names)] = sweep(each, 0, plan.count, devices_of(device))
    alone, both = found[0], found[2]
    # The compiler may fuse other products with sums: a last bit of a position, and so a sample at a voxel's face.
    dense = [np.bincount(part.cells, part.count, block.size) for part in (alone, both)]
    assert dense[0].sum() == plan.count
    assert np.abs(dense[0] - dense[1]).sum() <= (0 if precision == "float64" else 4)
    assert alone.samples == plan.count and alone.records.shape[1] == 0 and alone.sums.shape[1] == 0
    np.testing.assert_allclose(alone.maximum, both.maximum[:3], atol=TOLERANCES[precision].position(1.0))
