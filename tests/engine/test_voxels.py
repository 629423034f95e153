"""Voxel statistics and totals against a re-accumulation of the kept rows; the world lattice."""

import numpy as np
import pytest

import wsrender as ws
from tests.reference.voxel_accumulation import accumulated, fixed_point
from wsrender import run
from wsrender.engine.sums import scales_of
from wsrender.tolerances import epsilon

INDICES = ["manipulability", "inverse_condition_number"]
ALL_STATISTICS = ["count", "maximum", "mean", "minimum"]
EDGE = 0.0213


def job(precision, count=20_000, **fields):
    """A workspace job; every test here shares its kernels."""
    return {
        "analysis": "workspace",
        "robot": {"library": "phantom_omni"},
        "sampling": {"method": "random", "count": count, "seed": 11},
        "indices": INDICES,
        "voxel_size_m": EDGE,
        "voxel_statistics": ALL_STATISTICS,
        "keep_map": True,
        "map_columns": [],
        "precision": precision,
        "device": "cpu",
    } | fields


def executed(document, **execution):
    """Result and merged partial result of a job."""
    plan = run.plan(document)
    partials = [run.run_shard(plan, i, **execution) for i in range(len(plan.shards))]
    merged = partials[0]
    for partial in partials[1:]:
        merged = run.merge(plan, merged, partial)
    return run.finish(plan, merged), merged.sweep, plan


def test_voxels_are_those_of_the_rows(precision, device):
    result, partial, _ = executed(job(precision, device=device))
    rows, volume = result.map, result.volume
    assert len(rows) == 20_000 and partial.samples == 20_000
    expected = accumulated(rows.position, [rows.indices[name] for name in INDICES], EDGE)
    assert volume.count.sum() == 20_000
    assert int(volume.occupied.sum()) == len(expected)
    for cell, values in expected.items():
        at = tuple(np.array(cell) - volume.first_voxel)
        assert volume.count[at] == values.shape[1]
        for name, of_index in zip(INDICES, values, strict=True):
            assert volume.statistics["maximum"][name][at] == of_index.max()
            assert volume.statistics["minimum"][name][at] == of_index.min()
            mean = of_index.astype(np.float64).mean()
            # Fixed point keeps 30 bits (float32) of the index's bound.
            assert volume.statistics["mean"][name][at] == pytest.approx(mean, abs=2.0**-28)
    for statistic in ("maximum", "minimum", "mean"):
        assert np.isnan(volume.statistics[statistic][INDICES[0]][~volume.occupied]).all()


def test_sums_are_exact_integers(precision, device):
    result, partial, plan = executed(job(precision, device=device))
    for k, name in enumerate(INDICES):
        values, scale = result.map.indices[name].astype(np.float64), scales_of(plan.pipeline)[k]
        assert np.log2(scale) == np.round(np.log2(scale))
        assert abs(int(partial.totals[k]) - fixed_point(values, scale)) <= ambiguous(values * scale, precision)
        assert partial.sums[:, k].sum() == partial.totals[k]
        mean = float(partial.totals[k]) / scale / len(values) / values.max()
        assert result.document["indices"][name]["joint_mean"] == pytest.approx(mean, rel=1e-14)


def ambiguous(scaled, precision):
    """Number of values whose last bit is 1/2 or 1, where float32 cannot add a half exactly; float64's halves."""
    if precision == "float32":
        return int(((np.abs(scaled) >= 2.0**22) & (np.abs(scaled) < 2.0**24)).sum())
    return int((scaled - np.floor(scaled) == 0.5).sum())


def test_extremes_and_bounds_are_those_of_the_rows(precision):
    result, _, _ = executed(job(precision))
    position = result.map.position
    assert result.document["bounds_m"]["lower"] == position.min(axis=0).tolist()
    assert result.document["bounds_m"]["upper"] == position.max(axis=0).tolist()
    for name in INDICES:
        assert result.document["indices"][name]["maximum"] == result.map.indices[name].max()
        assert result.document["indices"][name]["minimum"] == result.map.indices[name].min()


def test_the_map_is_the_samples_in_order(precision):
    result, _, plan = executed(job(precision, count=1000))
    from wsrender.engine import configurations

    q = configurations(plan.pipeline, np.arange(1000))
    robot = ws.load_robot("phantom_omni")
    position = robot.forward_kinematics(q)[:, :3, 3]
    assert np.abs(result.map.position - position).max() <= 8 * epsilon(precision)


@pytest.mark.parametrize("count", [1, 31, 255, 256, 257, 1000])
def test_awkward_sample_counts(count, precision, device):
    few, partial, _ = executed(job(precision, count=count, device=device))
    many, _, _ = executed(job(precision, count=1000, device=device))
    assert partial.samples == count == len(few.map) == few.volume.count.sum()
    for name in INDICES:
        assert (few.map.indices[name] == many.map.indices[name][:count]).all()


def test_the_lattice_is_anchored_at_the_world_origin(precision):
    """A robot moved by whole voxels occupies the same voxels, moved."""
    edge = 0.03125  # a power of two: moving by it is exact
    here, _, _ = executed(job(precision, voxel_size_m=edge))
    moved = {"library": "phantom_omni", "placement": {"position_m": [5 * edge, -3 * edge, 40 * edge]}}
    there, _, _ = executed(job(precision, voxel_size_m=edge, robot=moved))
    difference = np.subtract(there.volume.first_voxel, here.volume.first_voxel)
    assert difference.tolist() == [5, -3, 40]
    # A tip within rounding of a face may change sides.
    assert np.abs(there.volume.count - here.volume.count).sum() <= 4
