"""Grids whose structure spares evaluations, against the same grids evaluated sample by sample."""

from dataclasses import replace
from functools import cache
from itertools import product
from math import prod

import numpy as np
import pytest
import warp as wp
from hypothesis import given, settings
from hypothesis import strategies as st
from wsrender_kernels.sampling import blocks, sample_space

import wsrender as ws
from tests.lasting import lasting
from tests.run.simple_robots import PlanarClass
from wsrender import run
from wsrender.engine import SweepPlan, devices_of, grid_structure, sweep
from wsrender.engine.grid_structure import block_count, shared_coordinates
from wsrender.engine.voxel_data import volume_data
from wsrender.errors import InputError
from wsrender.robot import as_robot
from wsrender.tolerances import TOLERANCES

PLACEMENT = {"position_m": [0.123, -0.345, 0.567], "rpy_deg": [20, -35, 50]}
LEVELS = {
    "puma560": [5, 3, 4, 2, 3, 2],
    "cartesian": [4, 3, 3, 2, 2, 2],
    "cylindrical": [4, 3, 5, 2, 1, 2],
    "ur5e": [3, 4, 3, 3, 3, 2],
}
# Base levels and repeats of trailing joints that one evaluation stands for.
SPARED = {
    "puma560": (5, 12),
    "cartesian": (4, 8),
    "cylindrical": (4, 4),
    "ur5e": (3, 2),
}
STATISTICS = ["maximum", "minimum", "mean"]
# Last bits differ before a root is taken, which near a singular posture makes much of them.
ROOTS = 6


def planned(robot, precision="float64", device="cpu", **fields):
    return run.plan(
        {
            "analysis": "workspace",
            "robot": {"library": robot, "placement": PLACEMENT},
            "sampling": {"method": "grid", "per_joint": LEVELS[robot]},
            "voxel_size_m": 0.0317,
            "voxel_statistics": STATISTICS,
            "precision": precision,
            "device": device,
            **fields,
        }
    )


def spared_by(plan):
    structure = SweepPlan(plan).structure
    return structure.base_levels, structure.weight


def swept(plan, device="cpu", **execution):
    return sweep(plan, 0, plan.sampling.count, devices_of(device), **execution)


@cache
def direct(robot, precision="float64", device="cpu", **fields):
    """The sample-by-sample volume data, all twelve indices where the robot has them."""
    plan = replace(planned(robot, precision, device, **fields).pipeline, collapse=False)
    assert SweepPlan(plan).sampling_path == "direct"
    partial = swept(plan, device)
    return partial, volume_data(plan, partial, {})


def assert_agree(plan, device, reference, precision):
    (expected, expected_volume), found = reference, swept(plan, device)
    volume = volume_data(plan, found, {})
    assert found.samples == expected.samples == plan.sampling.count
    np.testing.assert_array_equal(found.cells, expected.cells)
    np.testing.assert_array_equal(found.count, expected.count)
    np.testing.assert_array_equal(found.maximum[:3], expected.maximum[:3])
    np.testing.assert_array_equal(found.minimum[:3], expected.minimum[:3])
    occupied = volume.occupied
    for statistic, name in product(STATISTICS, plan.evaluation.indices):
        value = volume.statistics[statistic][name][occupied].astype(np.float64)
        reference = expected_volume.statistics[statistic][name][occupied].astype(np.float64)
        largest = np.nanmax(np.abs(expected_volume.statistics["maximum"][name]))
        error = np.abs((value / largest) ** ROOTS - (reference / largest) ** ROOTS)
        assert error.max() <= ROOTS * TOLERANCES[precision].index, (statistic, name)


CASES = [
    ("linear", "standard", "all"),
    ("linear", "standard", "kinematic"),
    ("linear", "table_1", "all"),
    ("linear", "table_1", "kinematic"),
    ("angular", "standard", "all"),
    ("full", "standard", "kinematic"),
]


@pytest.mark.parametrize(("task", "convention", "indices"), CASES)
def test_collapsed_is_direct(task, convention, indices):
    trailing = task == "linear" and indices == "kinematic"
    plan = planned("puma560", task=task, convention=convention, indices=indices).pipeline
    base, repeats = SPARED["puma560"]
    assert spared_by(plan) == (base, repeats if trailing else 1)
    every = "all" if task != "full" else indices  # one kernel for both sets
    assert_agree(plan, "cpu", direct("puma560", task=task, convention=convention, indices=every), "float64")


@pytest.mark.parametrize("convention", ["standard", "table_1"])
@pytest.mark.parametrize("task", ["linear", "full"])
def test_no_index_depends_on_the_base_joint(task, convention):
    """What the base joint's structure rests on, for every pair; the kernels are those of the other tests."""
    robot = ws.load_robot("ur5e")
    q = np.random.default_rng(3).uniform(robot.lower_limits, robot.upper_limits, (500, 6))
    turned = q + np.random.default_rng(4).uniform(-3, 3, (500, 1)) * np.eye(6)[0]
    one, other = (ws.evaluate_indices(robot, at, "all", task, convention=convention) for at in (q, turned))
    assert len(one) == 12
    for name, values in one.items():
        difference = np.abs(values**ROOTS - other[name] ** ROOTS).max()
        assert difference <= ROOTS * TOLERANCES["float64"].index * (values**ROOTS).max(), name
        assert np.ptp(values) > 0


def test_penalisation_keeps_the_base_joint():
    fields = {"joint_limit_penalty": 10.0}
    plan = planned("puma560", **fields).pipeline
    assert spared_by(plan) == (1, SPARED["puma560"][1])
    assert_agree(plan, "cpu", direct("puma560", **fields), "float64")


@pytest.mark.parametrize("robot", ["cartesian", "cylindrical", "ur5e"])
def test_robots(robot, precision, device):
    plan = planned(robot, precision, device).pipeline
    assert spared_by(plan) == SPARED[robot]
    assert_agree(plan, device, direct(robot, precision, device), precision)


@pytest.mark.parametrize(
    ("changes", "spared"),
    [
        ({"rows": (0, 1)}, (1, 12)),
        ({"rows": (2,), "penalty": 10.0}, (1, 12)),
        ({"rows": (3, 5)}, (1, 1)),
        ({"rows": (3, 4, 5), "penalty": 10.0}, (1, 1)),
        ({"rows": (0, 1, 2, 5)}, (1, 1)),
        ({"convention": "wsrender_code"}, (1, 1)),
        ({"indices": ("manipulability", "dynamic_manipulability")}, (5, 1)),
        ({"indices": ("dynamic_isotropy",), "penalty": 10.0}, (1, 1)),
        ({"indices": ("dynamic_isotropy",), "host_inertia": lambda q: np.eye(6)}, (1, 1)),
        ({"chain": as_robot(PlanarClass()).chain}, (1, 1)),
    ],
    ids=lambda value: "-".join(value) if isinstance(value, dict) else str(value),
)
def test_what_is_spared(changes, spared):
    """Nothing where it would change a number: see the documentation of the structure."""
    plan = planned("puma560").pipeline
    plan = replace(plan, evaluation=replace(plan.evaluation, **changes))
    assert spared_by(plan) == spared
    assert SweepPlan(plan).sampling_path == ("collapsed" if max(spared) > 1 else "direct")


def test_rows_and_other_samplings_are_evaluated_one_by_one():
    assert SweepPlan(planned("puma560", keep_map=True).pipeline).sampling_path == "direct"
    sampling = {"method": "random", "count": 5000, "seed": 1}
    assert SweepPlan(planned("puma560", sampling=sampling).pipeline).sampling_path == "direct"


def test_a_tool_off_the_axes_keeps_the_wrist():
    tool = np.eye(4)
    tool[:3, 3] = 0.01, 0, 0.05
    plan = planned("puma560").pipeline
    plan = replace(plan, evaluation=replace(plan.evaluation, chain=plan.evaluation.chain.placed(T_tip_tool=tool)))
    assert spared_by(plan) == (SPARED["puma560"][0], 1)


def test_coupled_joints_are_evaluated_one_by_one():
    urdf = """<robot name="coupled"><link name="a"/><link name="b"/><link name="c"/>
    <joint name="j1" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
    <joint name="j2" type="revolute"><parent link="b"/><child link="c"/><origin xyz="0.3 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="j1" multiplier="0.5"/></joint></robot>"""
    document = {
        "analysis": "workspace",
        "robot": {"urdf": urdf, "tool": {"position_m": [0.2, 0, 0]}},
        "sampling": {"method": "grid", "per_joint": 9},
        "indices": ["manipulability"],
        "voxel_size_m": 0.01,
    }
    assert SweepPlan(run.plan(document).pipeline).sampling_path == "direct"


def test_chunks_threads_and_shards_change_no_bit(precision):
    plan = planned("puma560", precision).pipeline
    expected = swept(plan, threads=1)
    assert SweepPlan(plan).division == 256 * 60
    for execution in ({"threads": 2, "chunk_size": 1}, {"threads": 3, "chunk_size": 100_000}):
        found = swept(plan, **execution)
        for name in ("extremes", "totals", "cells", "count", "records", "sums"):
            assert getattr(found, name).tobytes() == getattr(expected, name).tobytes(), name


def test_shards_at_multiples_of_the_division():
    document = planned("puma560", "float32", sampling={"method": "grid", "per_joint": [4, 40, 40, 3, 3, 4]}).job
    whole = run.plan(document)
    unit, count = whole.resolved()["shard_unit"], whole.pipeline.sampling.count
    assert unit == 256 * 4 * 36 and count > 2 * unit
    assert whole.resolved()["sampling_path"] == "collapsed"
    shards = [[0, unit], [unit, count - unit]]
    plan = run.plan(document, resolved={**whole.resolved(), "shards": shards})
    done = []
    parts = [run.run_shard(plan, i, done.append) for i in (1, 0)]
    merged = run.finish(plan, run.merge(plan, *parts))
    expected = run.finish(whole, run.run_shard(whole, 0))
    assert merged.document["provenance"]["sampling_path"] == "collapsed"
    assert lasting(merged.document) == lasting(expected.document)


@pytest.mark.parametrize(
    ("levels", "shared"),
    [
        ([16] * 6, 4),  # 16 x 16 samples are a block
        ([10] * 6, 3),  # 1000 samples fill four blocks to 98 %
        ([5, 4, 6, 3, 3, 4], 0),  # 216 fill one to 84, 864 four to 84 %
        ([2] * 8, 0),
        ([3, 1, 255], 2),
        ([7], 0),
    ],
)
def test_leading_coordinates_that_blocks_share(levels, shared):
    plan = replace(planned("puma560").pipeline.sampling, levels=np.array(levels), count=prod(levels))
    assert shared_coordinates(plan) == shared
    assert shared_coordinates(replace(plan, method="random")) == 0


@given(st.integers(1, 2000), st.integers(0, 10**6), st.integers(1, 5000))
@settings(derandomize=True, max_examples=200, deadline=None, database=None)
def test_blocks_cover_a_range_once(run_, first, count):
    """The samples of the tasks' blocks, as the kernel takes them, are those of the range, each run apart."""
    number, expected = block_count(run_, first, count), first
    for start, size in block_ranges(run_, first, count, number):
        assert start == expected and 0 < size <= 256 and start // run_ == (start + size - 1) // run_
        expected += size
    assert expected == first + count


@cache
def block_kernel():
    block_of, Space = blocks(wp.float64, 1, 1), sample_space(wp.float64, 1)

    @wp.kernel(module="unique", enable_backward=False)
    def block_ranges_kernel(space: Space, first: wp.int64, count: wp.int64, out: wp.array2d(dtype=wp.int64)):
        start, size = block_of(space, first, count, wp.tid())
        out[wp.tid(), 0] = start
        out[wp.tid(), 1] = wp.int64(size)

    return block_ranges_kernel


def block_ranges(run_, first, count, number):
    space = sample_space(wp.float64, 1)()
    space.run = run_
    out = wp.empty((number, 2), dtype=wp.int64, device="cpu")
    wp.launch(block_kernel(), number, [space, first, count], [out], device="cpu")
    return out.numpy()


@pytest.mark.parametrize("fields", [{"joint_limit_penalty": 10.0}, {"indices": "all"}], ids=str)
def test_shared_coordinates_change_no_position(fields, precision, monkeypatch):
    """Runs of 15 x 17 samples, one short of a block; voxels and positions equal to the bit, indices to rounding."""
    sampling = {"method": "grid", "per_joint": [3, 2, 2, 3, 15, 17]}
    plan = replace(planned("ur5e", precision, sampling=sampling, **fields).pipeline, collapse=False)
    assert shared_coordinates(SweepPlan(plan).structure.evaluated) == 4
    found = swept(plan)
    in_chunks = swept(plan, threads=2, chunk_size=1)
    assert in_chunks.records.tobytes() == found.records.tobytes() and (in_chunks.sums == found.sums).all()
    monkeypatch.setattr(grid_structure, "MOSTLY_FULL", 2.0)
    assert shared_coordinates(SweepPlan(plan).structure.evaluated) == 0
    assert_agree(plan, "cpu", (found, volume_data(plan, found, {})), precision)


def test_counts_beyond_32_bits():
    """Wrist repeats are multiplied on the host: a block of samples may stand for more than 2^32."""
    sampling = {"method": "grid", "per_joint": [2, 2, 2, 40_000, 40_000, 1]}
    result = ws.run.execute(
        {
            "analysis": "workspace",
            "robot": {"library": "puma560"},
            "sampling": sampling,
            "max_samples": 10**12,
            "device": "cpu",
            "voxel_size_m": 0.0317,
        }
    )
    assert result.volume.count.sum() == result.document["sampling"]["samples"] == 8 * 40_000**2
    assert set(np.unique(result.volume.count)) <= {0, 40_000**2, 2 * 40_000**2}


def test_a_grid_above_the_limit_is_refused_as_before():
    with pytest.raises(InputError, match="max_samples"):
        planned("puma560", sampling={"method": "grid", "per_joint": 60})
