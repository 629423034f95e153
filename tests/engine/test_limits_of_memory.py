"""Memory does not grow with the samples; what does not fit is refused with its numbers; bounds are kept."""

import importlib
import resource
import sys
from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest
import warp as wp

import wsrender as ws
from tests.collision.test_labels import pipeline
from tests.engine.test_voxels import executed, job
from tests.run.simple_robots import planar_arm_with_masses
from wsrender import run
from wsrender.analyses.workspace.partial import SWEEP
from wsrender.documents.constraints import Constraints
from wsrender.engine import SweepPlan, devices_of
from wsrender.engine.memory import CACHE_LINE, device_memory
from wsrender.engine.sweep_plan import _chunk_size, _fair_share
from wsrender.errors import InputError, NumericalError, ResourceError
from wsrender.robot.constraints import constraints_for


def peak_bytes():
    """Largest resident memory of this process so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def swept(count):
    return ws.analyze(
        "phantom_omni",
        ws.Random(count, seed=0),
        indices=["manipulability", "inverse_condition_number"],
        voxel_size_m=0.01,
        device="cpu",
    )


def test_memory_does_not_grow_with_the_samples():
    swept(20_000_000)
    before = peak_bytes()
    result = swept(40_000_000)
    assert result.volume.count.sum() == 40_000_000
    # A single byte kept per sample would show.
    assert peak_bytes() - before < 15_000_000


def test_chunks_are_smaller_where_labels_of_a_sample_take_more(monkeypatch):
    robot, (device,) = ws.load_robot("ur5e"), devices_of("cpu")
    constraints = constraints_for(robot, Constraints(self_collision=True))
    plan = SweepPlan(pipeline(robot, ws.Random(1 << 20), constraints))
    for size, chunk in ((1 << 6, 1 << 18), (1 << 10, 1 << 16), (1 << 40, 256)):
        monkeypatch.setattr("wsrender.engine.collision.bytes_per_sample", lambda _, size=size: size)
        assert _chunk_size(plan, 1 << 20, device) == chunk


def test_labelled_sweeps_go_in_half_as_many_chunks():
    """Eight a thread, or four, of each of which a few samples are settled one by one."""
    robot, workers = ws.load_robot("ur5e"), devices_of("cpu") * 2
    for constraints, chunks in (((), 8), (constraints_for(robot, Constraints(self_collision=True)), 4)):
        plan = SweepPlan(pipeline(robot, ws.Random(1 << 22), constraints))
        assert _fair_share(plan, 1 << 22, workers) == (1 << 22) // (2 * chunks)


def test_voxels_that_do_not_fit_are_refused_with_their_numbers():
    message = (
        r"voxel_size_m: 2e-05 gives \d+ x \d+ x \d+ voxels, [\d.]+ GiB of records; [\d.]+ GiB are free on cpu, "
        r"too little for 32 parts: choose larger voxels or fewer statistics"
    )
    with pytest.raises(ResourceError, match=message):
        ws.analyze("phantom_omni", ws.Random(1000), voxel_size_m=2e-5, device="cpu")


def test_large_lattices_take_the_memory_of_their_occupied_voxels(monkeypatch, tmp_path):
    """From sweep to files and back, but for the arrays that are asked for, and the surface's byte per voxel."""
    fine = {"robot": "phantom_omni", "sampling": ws.Random(20_000, seed=3), "device": "cpu"}
    names = ["manipulability", "inverse_condition_number"]
    module = importlib.import_module("wsrender.volume.voxels")
    monkeypatch.setattr(module, "available_bytes", lambda: 12_000_000)
    result = ws.analyze(**fine, indices=names, voxel_size_m=0.002, voxel_statistics=["count", "maximum", "mean"])
    result.save(tmp_path / "out")
    loaded = ws.Result.load(tmp_path / "out")
    voxels = result.volume.voxels
    assert np.prod(voxels.shape) > 1_000_000 > 40 * len(voxels.cells) and voxels.count.sum() == 20_000
    for volume in (result.volume, loaded.volume):
        with pytest.raises(ResourceError, match=r"volume: \d+ x \d+ x \d+ voxels need .* 0\.0 GiB are free: take"):
            _ = volume.count
        assert volume.occupied.sum() == len(voxels.cells)
        with monkeypatch.context() as less, pytest.raises(ResourceError, match=r"0\.0 GiB are free"):
            less.setattr(module, "available_bytes", lambda: 1_000_000)
            _ = volume.occupied
    monkeypatch.undo()
    np.testing.assert_array_equal(loaded.volume.count, result.volume.count)
    for statistic in ("maximum", "mean"):
        for name in names:
            array = result.volume.statistics[statistic][name]
            np.testing.assert_array_equal(loaded.volume.statistics[statistic][name], array)
            np.testing.assert_array_equal(np.isnan(array), result.volume.count == 0)
    at = tuple(result.volume.voxels.at)
    np.testing.assert_array_equal(result.volume.count[at], voxels.count)


def test_few_samples_of_many_voxels_keep_one_thread_busy(monkeypatch):
    """Private records of two threads would take twice the memory, or twice the slabs."""
    slabs = importlib.import_module("wsrender.engine.slabs")
    plan = run.plan(job("float32", keep_map=False, device="cpu")).pipeline
    monkeypatch.setattr(slabs, "available_bytes", lambda: 2**40)
    few, many = (slabs.fitted(plan.block, SweepPlan(plan).shape, devices_of("cpu") * 2, n)[0] for n in (100, 10**9))
    assert (len(few), len(many)) == (1, 2)


@pytest.mark.parametrize("constraints", [None, {"region": {"box": {"lower_m": [None, 0.05, None]}}}])
@pytest.mark.parametrize("method", ["random", "grid"])
def test_slabs_of_the_lattice_change_no_bit(method, constraints, precision, device, monkeypatch):
    sampling = {"grid": {"method": "grid", "per_joint": 7}, "random": {"method": "random", "count": 20_000, "seed": 1}}
    choice = {"sampling": sampling[method], "constraints": constraints}
    document = job(precision, device=device, keep_map=False, **choice)
    _, expected, plan = executed(document)
    shape, done = SweepPlan(plan.pipeline).shape, []
    block_bytes = plan.pipeline.block.size * shape.bytes_per_voxel
    slabs = importlib.import_module("wsrender.engine.slabs")
    monkeypatch.setattr(slabs, "SHARE", 0.0)
    free = block_bytes // 3 / slabs.SHARE_SLAB  # of one worker
    if device == "cuda":
        monkeypatch.setattr(slabs, "SHARE_SLAB", free * slabs.SHARE_SLAB / devices_of(device)[0].free_memory)
    monkeypatch.setattr(slabs, "available_bytes", lambda: free)
    assert len(slabs.fitted(plan.pipeline.block, shape, devices_of(device)[:1], 20_000)[1]) in (4, 5)
    monkeypatch.setattr(importlib.import_module("wsrender.engine.sweep_plan"), "VOXELS_FETCHED", 777)  # many parts
    found = run.run_shard(plan, 0, done.append, threads=1).sweep
    for name in SWEEP:
        assert getattr(found, name).tobytes() == getattr(expected, name).tobytes(), name
    assert len(found.blocked) == (0 if constraints is None else len(np.unique(found.blocked_cells))) != 1
    assert found.samples == expected.samples and len(np.unique(np.diff(done) >= 0)) == 1 and done[-1] <= found.samples


def test_a_value_beyond_its_bound_fails_the_job():
    """Bounds of dynamic and user indices come from a coarse first pass and may be passed."""
    document = job("float32", 5000)
    plan = run.plan(document)
    plan.pipeline = replace(plan.pipeline, bounds=(1e-6, 1.0))
    message = r"index manipulability reaches 0\.\d+, beyond 1e-06, the bound of its entry"
    with pytest.raises(NumericalError, match=message):
        run.run_shard(plan, 0)


def test_a_value_may_be_as_large_as_its_bound_and_no_larger():
    plan = run.plan(job("float32", 5000))
    largest = run.run_shard(plan, 0).sweep.maximum.astype(np.float64)[3]
    for bound, allowed in ((largest, True), (np.nextafter(largest, 0), False)):
        plan.pipeline = replace(plan.pipeline, bounds=(bound, 1.0))
        with nullcontext() if allowed else pytest.raises(NumericalError, match="index manipulability reaches"):
            run.run_shard(plan, 0)


def test_bounds_are_no_larger_than_they_have_to_be():
    """A planar arm of .5 and .4 m: its Jacobian's columns are at most .9 and .4 m long, so σ₁σ₂ ≤ (.9² + .4²) / 2.

    A dynamic index may take twice the maximum of the first pass. Looser bounds would take digits from the sums.
    """
    names = ["manipulability", "inverse_condition_number", "dynamic_manipulability"]
    options = {"task": ["x", "y"], "indices": names, "voxel_size_m": 0.1, "device": "cpu", "refined_volume": None}
    robot = planar_arm_with_masses()
    result = ws.analyze(robot, ws.Sobol(2**16), **options)
    bounds = run.plan(result.document["job"], robot).pipeline.bounds
    assert bounds[:2] == pytest.approx([1.01 * (0.9**2 + 0.4**2) / 2, 1.01])
    assert bounds[2] == pytest.approx(2 * result.document["indices"][names[2]]["maximum"], rel=1e-3)


@pytest.mark.parametrize("chunk_size", [1, 2**20, 2**31, 2**40])
def test_no_chunk_overflows_32_bit_counts(chunk_size, device):
    module = importlib.import_module("wsrender.engine.sweep_plan")
    plan = run.plan(job("float32", keep_map=False)).pipeline
    (own,) = devices_of(device)
    assert 256 <= module._chunk_size(SweepPlan(plan), chunk_size, own) <= module.FOLD_AFTER < 2**31


@pytest.mark.parametrize("voxel_size_m", [1e-10, 2e-10])
def test_voxels_too_small_to_number_are_refused(voxel_size_m):
    with pytest.raises(InputError, match=r"voxel_size_m: .* is too small for a workspace of"):
        ws.analyze("phantom_omni", ws.Random(256), voxel_size_m=voxel_size_m, device="cpu")


@pytest.mark.parametrize("size", [1, 1000, 1 << 22])
def test_memory_of_records_starts_with_a_cache_line(size):
    """Else every record lies across two lines, and random access to large lattices takes half as long again."""
    (device,) = devices_of("cpu")
    values = device_memory(size, wp.int32, device)
    assert values.ptr % CACHE_LINE == 0 and values.size == size
    values.fill_(7)
    assert (values.numpy() == 7).all()


def test_a_map_that_does_not_fit_is_refused_with_its_numbers():
    document = job("float32", sampling={"method": "random", "count": 10**12, "seed": 1}, max_samples=10**13)
    message = r"keep_map: makes a job of \d+\.\d GiB of memory; [\d.]+ GiB are free: take fewer samples or columns"
    with pytest.raises(ResourceError, match=message):
        run.plan(document)


@pytest.mark.parametrize(("share", "fits"), [(0.99, False), (1.01, True)])
def test_a_map_takes_its_rows_twice(share, fits, monkeypatch):
    """Those of the chunks, and what they are joined to."""
    document = job("float32", 10**6)
    plan = run.plan(document)
    rows, taken = 4 * 10**6 * SweepPlan(plan.pipeline).shape.n_rows, plan.cost.memory_bytes
    assert 2 * rows < taken < 3 * rows
    cost = importlib.import_module("wsrender.analyses.cost")
    monkeypatch.setattr(cost, "available_bytes", lambda: share * taken / cost.SHARE)
    with nullcontext() if fits else pytest.raises(ResourceError, match="keep_map: "):
        run.plan(document)


def test_many_threads_do_not_refuse_what_one_can_do(monkeypatch):
    plan = run.plan(job("float32", keep_map=False, device="cpu")).pipeline
    slabs = importlib.import_module("wsrender.engine.slabs")
    block_bytes = plan.block.size * SweepPlan(plan).shape.bytes_per_voxel
    workers = devices_of("cpu") * 64
    for fitting, chosen in ((1, 1), (5, 5), (64, 64)):
        monkeypatch.setattr(slabs, "available_bytes", lambda fitting=fitting: fitting * block_bytes / slabs.SHARE + 1)
        found, parts = slabs.fitted(plan.block, SweepPlan(plan).shape, workers, 10**9)
        assert len(found) == chosen and parts == [plan.block]
    monkeypatch.setattr(slabs, "available_bytes", lambda: block_bytes / slabs.SHARE_SLAB / 12)
    found, parts = slabs.fitted(plan.block, SweepPlan(plan).shape, workers, 10**9)
    assert len(found) == 1 and 12 <= len(parts) <= slabs.MOST_SLABS
    assert sum(slab.shape[0] for slab in parts) == plan.block.shape[0]
