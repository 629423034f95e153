"""Voxels that are too small or too large are refused when a job is planned, at the field that holds their size."""

import importlib

import numpy as np
import pytest

from wsrender import run
from wsrender.errors import DocumentError, InputError, ResourceError
from wsrender.volume.lattice import (
    LatticeBlock,
    block_of_all,
    check_voxels,
    expected_voxels,
    measured,
    voxel_size_of,
)
from wsrender.volume.voxels import Voxels

SAMPLING = {"method": "sobol", "count": 256}
ARM = {"robot": "phantom_omni", "sampling": SAMPLING}
PAIR = {"robots": [ARM, ARM | {"name": "other"}], "refined_volume": None}
MAPPED = {
    "master": ARM,
    "slave": ARM,
}


def at_size(analysis: str, size: float) -> dict:
    """A job of an analysis with voxels."""
    own = {
        "workspace": ARM | {"voxel_size_m": size},
        "capability": {"robot": "phantom_omni", "voxel_size_m": size},
        "kinetostatic_field": ARM | {"voxel_size_m": size},
        "shared_workspace": PAIR | {"voxel_size_m": size},
        "robot_comparison": PAIR | {"voxel_size_m": size},
        "master_slave_mapping": MAPPED | {"containment": {"kind": "voxels", "voxel_size_m": size}},
    }
    return {"analysis": analysis} | own[analysis]


ANALYSES = ["workspace", "capability", "kinetostatic_field", "shared_workspace", "robot_comparison"]
MAPPING = "master_slave_mapping"


@pytest.mark.parametrize("analysis", [*ANALYSES, MAPPING])
@pytest.mark.parametrize(("size", "allowed"), [(1e300, "at most 1000000"), (1e-12, "at least 1e-10")])
def test_sizes_of_no_robot_are_refused_by_the_document(analysis, size, allowed):
    with pytest.raises(DocumentError, match=rf"voxel_size_m: must be {allowed}.*, not 1e"):
        run.plan(at_size(analysis, size))


@pytest.mark.parametrize("analysis", [*ANALYSES, MAPPING])
@pytest.mark.parametrize("size", [1e-10, 1e-8, 1e-5])
def test_sizes_too_small_for_the_robot_are_refused_at_their_field(analysis, size):
    """Before anything is taken, and with what would fit."""
    with pytest.raises(InputError, match=r"or more|fits|is allowed") as caught:
        run.plan(at_size(analysis, size))
    assert caught.value.field == ("containment.voxel_size_m" if analysis == MAPPING else "voxel_size_m")


@pytest.mark.parametrize("analysis", [*ANALYSES, MAPPING])
def test_sensible_sizes_are_planned(analysis):
    assert run.plan(at_size(analysis, 0.05)).shards


def test_refused_voxels_name_bytes_and_the_smallest_that_fits(monkeypatch):
    block = LatticeBlock(0.001, (0, 0, 0), (1000, 1000, 1000))
    monkeypatch.setattr(importlib.import_module("wsrender.volume.lattice"), "available_bytes", lambda: 5 * 2**30)
    check_voxels(block, 4)  # 4e9 of .8 × 5.37e9 bytes
    message = r"voxel_size_m: 0.001 gives 1000 x 1000 x 1000 voxels, which need 29.8 GiB; 5.0 GiB are free: choose "
    with pytest.raises(ResourceError, match=message + r"0.002 or more"):
        check_voxels(block, 32)
    check_voxels(LatticeBlock(0.002, (0, 0, 0), (500, 500, 500)), 32)


def test_labels_of_voxels_are_counted(monkeypatch):
    """The job without them fits."""
    module = importlib.import_module("wsrender.analyses.cost")
    monkeypatch.setattr(module, "available_bytes", lambda: 28_000_000)
    job = at_size("workspace", 0.006) | {"refined_volume": None}
    assert run.plan(job).shards
    with pytest.raises(ResourceError, match=r"voxel_size_m: makes a job of .* GiB of memory; 0.0 GiB are free: choose"):
        run.plan(job | {"voxel_labels": True})


def test_robots_far_apart_share_a_volume_too_large():
    apart = {"robot": {"library": "phantom_omni", "placement": {"position_m": [5000.0, 5000.0, 5000.0]}}}
    robots = [ARM, ARM | apart]
    with pytest.raises(ResourceError, match=r"voxel_size_m: makes a job of .* choose") as caught:
        run.plan({"analysis": "shared_workspace", "robots": robots, "refined_volume": None, "voxel_size_m": 0.01})
    assert caught.value.field == "voxel_size_m"


def test_collaborative_cells_and_points_are_checked(monkeypatch):
    monkeypatch.setattr(importlib.import_module("wsrender.analyses.cost"), "available_bytes", lambda: 50_000_000)
    job = {"analysis": "collaborative_volume", "left": ARM["robot"], "right": ARM["robot"], "refined_volume": None}
    sides = {name: {"robot": "phantom_omni"} for name in ("left", "right")}
    for fields, field in (({"samples": 10**7}, "samples"), ({"cells": [200, 200, 200]}, "refinements")):
        with pytest.raises(ResourceError, match=r"0.0 GiB are free: take fewer") as caught:
            run.plan(job | sides | {"samples": 1000} | fields)
        assert caught.value.field == field


def test_voxels_at_places_are_those_of_dense_arrays():
    places = np.array([[3, -2, 5], [1, 0, 4], [3, -2, 4]])
    count, values = np.array([2, 3, 1]), np.array([0.5, np.nan, 1.5], np.float32)
    vectors = np.arange(9, dtype=np.float32).reshape(3, 3)
    first, voxels = Voxels.at_places(places, count, {"mean": {"a": values}}, {"v": vectors})
    assert first == (1, -2, 4) and voxels.shape == (3, 3, 2)
    dense = np.zeros((3, 3, 2), np.int64)
    dense[tuple((places - first).T)] = count
    np.testing.assert_array_equal(voxels.dense(voxels.count), dense)
    at = tuple(places[0] - first)
    assert voxels.dense(voxels.statistics["mean"]["a"])[at] == 0.5
    np.testing.assert_array_equal(voxels.dense(voxels.vectors["v"])[at], vectors[0])


def test_the_block_of_all_holds_each():
    blocks = [LatticeBlock(0.1, (0, -4, 2), (2, 3, 4)), LatticeBlock(0.1, (-5, 0, 3), (1, 1, 9))]
    assert block_of_all(blocks) == LatticeBlock(0.1, (-5, -4, 2), (7, 5, 10))


def test_expected_voxels_are_those_of_the_volume_at_every_size():
    """Of a ball of radius .5: 4/3 π r³ over the voxel's volume, though there are 65,536 samples only."""
    rng = np.random.default_rng(1)
    points = rng.normal(size=(1 << 16, 3))
    points *= (0.5 * rng.random(1 << 16) ** (1 / 3) / np.linalg.norm(points, axis=1))[:, None]
    volume = 4 / 3 * np.pi * 0.5**3
    for size in (0.05, 0.01, 0.001):
        assert expected_voxels(points, size) == pytest.approx(volume / size**3, rel=0.1)
    assert expected_voxels(points, 0.005) == pytest.approx(8 * expected_voxels(points, 0.01))
    flat = points * [1.0, 1.0, 0.0]
    assert expected_voxels(flat, 0.001) == pytest.approx(np.pi * 0.25 / 1e-6, rel=0.1)


@pytest.mark.parametrize("dimension", range(4))
def test_expected_voxels_are_counted_with_half_of_those_at_the_boundary(dimension):
    """As a walk over all voxels and their neighbours counts them, of sets that lie anywhere, turned in any way."""
    rng = np.random.default_rng(dimension)
    for count in (1, 7, 300, 5000):
        shape = rng.normal(size=(3, 3)) * (np.arange(3) < dimension)[:, None]
        points = rng.normal(size=(count, 3)) @ shape + 100 * rng.normal(size=3)
        spans, *_ = hull = measured(points)
        size = voxel_size_of(hull, count)
        voxels = {tuple(cell) for cell in np.floor(points / size).astype(int).tolist()}
        steps = [sign * step for step in np.eye(3, dtype=int) for sign in (1, -1)]
        inside = sum(sum(tuple(voxel + step) in voxels for step in steps) >= 2 * spans for voxel in voxels)
        expected = max((inside + len(voxels)) / 2 * (size / 0.01) ** spans, 1.0)
        assert expected_voxels(points, 0.01) == expected_voxels(points, 0.01, hull) == pytest.approx(expected)


def test_capability_counts_voxels_times_directions_however_many():
    """The first samples were counted once: at most 65,536 voxels, whatever their size."""
    pairs = [run.plan(at_size("capability", size) | {"directions": 4}).shards[0][1] for size in (0.02, 0.01, 0.005)]
    assert pairs[1] == pytest.approx(8 * pairs[0], rel=1e-3) and pairs[2] == pytest.approx(8 * pairs[1], rel=1e-3)
    assert pairs[2] > 4 * 65_536
