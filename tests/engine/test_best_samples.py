"""The best sample of every voxel against the kept rows, whatever the method, the division of work and the files."""

from functools import reduce
from importlib import import_module
from itertools import pairwise

import numpy as np
import pytest

import wsrender as ws
from tests.engine.test_voxels import EDGE, executed, job
from wsrender import run
from wsrender.engine import SweepPlan, devices_of
from wsrender.errors import InputError
from wsrender.volume.volume_data import coarser

COUNT, BEST = 20_000, "inverse_condition_number"
GRID = {"method": "grid", "per_joint": [4, 31, 7, 2, 3, 2]}


def asked(precision="float32", **fields):
    return job(precision, COUNT, best_sample=BEST, refined_volume=None) | fields


def cells(position, edge=EDGE):
    """Voxels of positions as the kernels find them: by the reciprocal of the edge, rounded once."""
    real = position.dtype.type
    return np.floor(position * real(1 / real(edge))).astype(int)


def first_of_the_best(rows, name, edge=EDGE, kept=slice(None)):
    """By voxel the smallest number of the samples that have its largest value."""
    values, found = rows.indices[name], {}
    for number in np.arange(len(values))[kept]:
        cell = tuple(cells(rows.position[number], edge).tolist())
        if cell not in found or values[number] > values[found[cell]]:
            found[cell] = number
    return found


def best_of(volume, name=BEST):
    at = (volume.voxels.at.T + volume.first_voxel).tolist()
    return dict(zip(map(tuple, at), volume.voxels.best[name].tolist(), strict=True))


SAMPLINGS = {
    "random": {"method": "random", "count": COUNT, "seed": 11},
    "sobol": {"method": "sobol", "count": COUNT, "seed": 4},
    "boundary": {"method": "boundary", "count": COUNT, "seed": 4},
    "grid": GRID,
}


@pytest.mark.parametrize("method", SAMPLINGS)
def test_it_is_the_first_of_those_with_the_largest_value(method, device):
    result, _, _ = executed(asked(sampling=SAMPLINGS[method], device=device))
    volume, robot = result.volume, ws.load_robot("phantom_omni")
    assert volume.voxels.best[BEST].dtype == np.uint64
    assert best_of(volume) == first_of_the_best(result.map, BEST)
    for k in range(0, len(volume.voxels.cells), 97):
        q = ws.configuration_of(result, volume.voxels.best[BEST][k])
        corner = (volume.voxels.at[:, k] + volume.first_voxel) * EDGE
        tip = robot.forward_kinematics(q)[0, :3, 3]
        assert (tip > corner - 1e-6).all()
        assert (tip < corner + EDGE + 1e-6).all()
        value = ws.evaluate_indices(robot, q, [BEST], device="cpu")[BEST][0]
        assert value == pytest.approx(volume.voxels.statistics["maximum"][BEST][k], abs=2e-6)


def test_of_a_grid_whose_structure_spares_samples(device):
    result, _, _ = executed(asked(sampling=GRID, keep_map=False, device=device))
    rows, _, _ = executed(asked(sampling=GRID, device=device))
    assert result.document["provenance"]["sampling_path"] == "collapsed"
    each, base = GRID["per_joint"], GRID["per_joint"][0]
    numbers = np.arange(np.prod(each)).reshape(base, -1)
    where = cells(rows.map.position)
    for cell, number in best_of(result.volume).items():
        column = number % numbers.shape[1]
        levels = [level for level in range(base) if tuple(where[numbers[level, column]].tolist()) == cell]
        assert number == numbers[levels[0], column]  # the first level at which this posture is there
        assert number % np.prod(each[3:]) == 0  # joints through the tip at their first levels
        value = rows.map.indices[BEST][number]
        at = tuple(np.subtract(cell, rows.volume.first_voxel))
        assert value == pytest.approx(rows.volume.statistics["maximum"][BEST][at], rel=1e-5, abs=1e-6)


@pytest.mark.parametrize("sampling", [SAMPLINGS["random"], {"method": "grid", "per_joint": [9, 40, 25, 11]}])
def test_of_equal_values_the_smallest_number_in_any_division(sampling, device):
    document = asked(robot={"library": "scara"}, indices=["manipulability"], voxel_size_m=0.2, sampling=sampling)
    document |= {"best_sample": "manipulability", "device": device, "voxel_statistics": None}
    rows, _, _ = executed(document)
    assert not rows.volume.voxels.statistics["maximum"]["manipulability"].any()
    expected = first_of_the_best(rows.map, "manipulability", 0.2)
    assert best_of(rows.volume, "manipulability") == expected
    document |= {"keep_map": False}
    result, whole, plan = executed(document)
    assert best_of(result.volume, "manipulability") == expected
    for threads, chunk_size in ((1, 512), (3, 1024), (4, 256)):
        _, found, _ = executed(document, threads=threads, chunk_size=chunk_size)
        assert found.best.tobytes() == whole.best.tobytes()
    for count in (1, 2, 7):
        for merged in merged_shards(document, plan.samples, count, plan.settled.shard_unit):
            assert merged.best.tobytes() == whole.best.tobytes()


def merged_shards(document, samples, count, unit=256):
    """The sweeps merged of so many shards, which have travelled, in both orders."""
    size = max(samples // count // unit, 1) * unit
    ends = [min(k * size, samples) for k in range(count)] + [samples]
    split = [(first, last - first) for first, last in pairwise(ends) if first < last]
    plan = run.plan(document, resolved={**run.plan(document).resolved(), "shards": split})
    partials = [plan.unpacked(run.run_shard(plan, k, chunk_size=1024).packed()) for k in range(len(split))]
    for order in (partials, partials[::-1]):
        yield reduce(lambda a, b: run.merge(plan, a, b), order).sweep


@pytest.mark.parametrize("count", [1, 2, 7])
def test_shards_merge_in_any_order(count, precision, device):
    document = asked(precision, device=device)
    _, expected, _ = executed(document)
    for merged in merged_shards(document, COUNT, count):
        assert merged.best.tobytes() == expected.best.tobytes()


def test_folded_counts_and_slabs_change_nothing(precision, monkeypatch):
    _, expected, _ = executed(asked(precision))
    monkeypatch.setattr(import_module("wsrender.engine.sweep_plan"), "FOLD_AFTER", 3000)
    _, folded, _ = executed(asked(precision), threads=2, chunk_size=1024)
    assert folded.best.tobytes() == expected.best.tobytes()
    monkeypatch.undo()
    plan, slabs = run.plan(asked(precision)), import_module("wsrender.engine.slabs")
    block, shape = plan.pipeline.block, SweepPlan(plan.pipeline).shape
    monkeypatch.setattr(slabs, "SHARE", 0.0)
    free = block.size * shape.bytes_per_voxel // 3 / slabs.SHARE_SLAB
    monkeypatch.setattr(slabs, "available_bytes", lambda: free)
    assert len(slabs.fitted(block, shape, devices_of("cpu"), COUNT)[1]) > 2
    assert run.run_shard(plan, 0, threads=1).sweep.best.tobytes() == expected.best.tobytes()


def test_rejected_samples_are_not_the_best(device):
    box = {"region": {"box": {"upper_m": [None, None, 0.03]}}}
    result, _, _ = executed(asked(constraints=box, device=device))
    free, _, _ = executed(asked(device=device))
    kept = np.isin(np.arange(COUNT), np.flatnonzero(free.map.position[:, 2] <= np.float32(0.03)))
    assert best_of(result.volume) == first_of_the_best(free.map, BEST, kept=kept)


def test_files_keep_it(tmp_path):
    result, _, _ = executed(asked())
    result.save(tmp_path, ["npz", "vti", "mat"])
    loaded = ws.Result.load(tmp_path)
    assert best_of(loaded.volume) == best_of(result.volume)
    with np.load(tmp_path / "volume.npz") as arrays:
        array = arrays[f"best_sample_{BEST}"]
    assert array.dtype == np.uint64
    np.testing.assert_array_equal(array, result.volume.best[BEST])
    again = import_module("wsrender.results.export.npz").read_volume_npz(tmp_path / "volume.npz")
    assert best_of(again) == best_of(result.volume)
    assert b"best_sample_inverse_condition_number" in (tmp_path / "volume.vti").read_bytes()


def test_in_larger_voxels():
    result, _, _ = executed(asked())
    found = best_of(coarser(result.volume, 3))
    by_cell = {}
    values = result.map.indices[BEST]
    for cell, number in best_of(result.volume).items():
        large = tuple(each // 3 for each in cell)
        best = by_cell.setdefault(large, number)
        if (values[number], -number) > (values[best], -best):
            by_cell[large] = number
    assert found == by_cell


def test_of_the_last_grid_of_a_converging_job():
    sampling = {"method": "converge", "index": BEST, "tolerance": 0.5, "start": 3, "step": 1}
    result, _, _ = executed(asked(sampling=sampling, keep_map=False))
    assert result.document["sampling"]["per_joint"] == [4] * 6
    last = result.document["sampling"]["samples"] - 1
    robot = ws.load_robot("phantom_omni")
    np.testing.assert_allclose(ws.configuration_of(result, last), robot.upper_limits, atol=1e-6)
    np.testing.assert_allclose(ws.configuration_of(result, 0, robot), robot.lower_limits, atol=1e-6)


def test_a_job_that_does_not_ask_says_nothing_of_it():
    plan = run.plan(job("float32"))
    assert "best_sample" not in plan.job.model_dump(mode="json")
    assert SweepPlan(plan.pipeline).shape.best is None
    assert "best" not in run.run_shard(plan, 0).packed().arrays


def test_what_is_not_allowed_is_named():
    for fields in (
        {"best_sample": "condition"},
        {"best_sample": "minimum_singular_value"},
        {"voxel_statistics": ["mean"]},
    ):
        with pytest.raises(InputError) as raised:
            run.plan(asked(**fields))
        assert raised.value.field == "best_sample"
    result, _, _ = executed(asked())
    for number in (-1, COUNT, 0.5):
        with pytest.raises(InputError) as raised:
            ws.configuration_of(result, number)
        assert raised.value.field == "number"
