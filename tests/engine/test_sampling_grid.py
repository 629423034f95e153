"""Grids: every combination of evenly spaced joint values, the last joint fastest."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

import wsrender as ws
from wsrender.engine import configurations
from wsrender.errors import InputError, ResourceError
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.tolerances import epsilon


def arm(*limits_deg):
    """A planar arm with these limits [°], None for a joint without."""
    rows = [{"a": 0.2} | ({} if limits is None else {"limits_deg": limits}) for limits in limits_deg]
    return ws.load_robot(ws.DHTable(convention="standard", rows=rows, name="arm")).chain


ARM = arm((-30, 50), (0, 90), (-170, 170))


def grid(chain, per_joint, precision="float64", **options):
    return configurations(replace(tip_pipeline(chain, ws.Grid(per_joint, **options)), precision=precision))


@pytest.mark.parametrize("levels", [(2, 3, 4), (1, 31, 1), (5, 3, 17), (8, 8, 4), (1, 1, 257), (10, 10, 10), (1, 1, 1)])
def test_a_grid_is_the_product_of_even_intervals(levels, precision):
    values = [
        np.linspace(low, high, count) if count > 1 else [(low + high) / 2]
        for low, high, count in zip(ARM.lower_limits, ARM.upper_limits, levels, strict=True)
    ]
    expected = np.array(list(itertools.product(*values)))
    found = grid(ARM, levels, precision)
    assert found.shape == (np.prod(levels), 3)
    assert np.abs(found - expected).max() <= 4 * epsilon(precision) * np.pi


def test_both_limits_are_met_exactly(precision):
    found = grid(ARM, (7, 4, 9), precision)
    for limit, extreme in ((ARM.lower_limits, found.min(axis=0)), (ARM.upper_limits, found.max(axis=0))):
        assert (extreme == limit.astype(precision)).all()


def test_one_number_serves_all_joints():
    assert len(grid(ARM, 5)) == 125
    assert [len(np.unique(column)) for column in grid(ARM, 5).T] == [5, 5, 5]


def test_a_periodic_joint_takes_no_posture_twice(precision):
    found = grid(arm(None, (-10, 10)), (8, 2), precision)
    expected = -np.pi + 2 * np.pi * np.arange(1, 9) / 8
    assert np.abs(found[::2, 0] - expected).max() <= 4 * epsilon(precision) * np.pi


def test_limits_of_a_full_turn_are_an_interval_with_both_ends():
    found = grid(arm((-180, 180)), 5)[:, 0]
    assert found == pytest.approx([-np.pi, -np.pi / 2, 0, np.pi / 2, np.pi], abs=1e-15)


def test_locked_joints_keep_their_value(precision):
    found = grid(ARM, 4, precision, locked={"joint2": 0.3})
    assert len(found) == 16
    assert (found[:, 1] == np.float64(0.3).astype(precision)).all()
    same = grid(ARM, (4, 4), precision, locked={"joint2": 0.3})
    assert (same == found).all()


def test_all_joints_locked_is_one_sample():
    found = grid(ARM, 4, locked={"joint1": 0.1, "joint2": 0.3, "joint3": -1.0})
    assert found.tolist() == [[0.1, 0.3, -1.0]]


def test_levels_beyond_32_bits_of_index():
    pipeline = tip_pipeline(ARM, ws.Grid((3000, 3001, 3002)))
    assert pipeline.sampling.count == 3000 * 3001 * 3002
    index = np.array([0, 2**32 - 1, 2**32, 2**33 + 12345, pipeline.sampling.count - 1])
    digits = np.stack(np.unravel_index(index, (3000, 3001, 3002)), axis=1)
    expected = ARM.lower_limits + digits * (ARM.upper_limits - ARM.lower_limits) / [2999, 3000, 3001]
    assert np.abs(configurations(pipeline, index) - expected).max() <= 1e-14


@pytest.mark.parametrize(
    ("per_joint", "locked", "message"),
    [
        ((3, 4), {}, r"sampling.per_joint: 2 numbers for 3 joints"),
        (3, {"elbow": 0.0}, r"sampling.locked.elbow: unknown joint; allowed: joint1, joint2, joint3"),
        (3, {"joint1": 2.0}, r"sampling.locked.joint1: 2.0 is outside the joint's limits"),
    ],
)
def test_refused_grids(per_joint, locked, message):
    with pytest.raises(InputError, match=message):
        plan_sampling(ARM, ws.Grid(per_joint, locked=locked))


def test_too_many_samples_name_the_remedy():
    with pytest.raises(ResourceError, match=r"8e\+09 samples; at most max_samples = 1e\+09: use .* sobol"):
        plan_sampling(ARM, ws.Grid(2000), max_samples=10**9)
