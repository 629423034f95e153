"""What a plan says that its job will take, beside what it took: files, the growth with voxels, and the names."""

from dataclasses import fields

import pytest

from wsrender import run
from wsrender.analyses.cost import Cost, in_turn

SAMPLING = {"method": "random", "count": 4096, "seed": 1}
ARM = {"robot": "phantom_omni", "sampling": SAMPLING}
JOBS = {
    "workspace": ARM | {"refined_volume": None},
    "labelled workspace": ARM | {"refined_volume": None, "voxel_labels": True, "voxel_size_m": 0.04},
    "map": ARM | {"refined_volume": None, "keep_map": True},
    "capability": {"robot": "phantom_omni", "directions": 20, "voxel_size_m": 0.05},
    "kinetostatic_field": ARM | {"sampling": {"method": "sobol", "count": 1024}},
    "reachability": {"robot": "phantom_omni", "points_m": [[0.1, 0.001 * k, 0.1] for k in range(100)]},
    "shared_workspace": {"robots": [ARM, ARM | {"name": "other"}], "refined_volume": None},
    "robot_comparison": {"robots": [ARM, ARM | {"name": "other"}], "refined_volume": None},
}
OF_WORKSPACE = ("labelled workspace", "map")


def job(name: str, **fields) -> dict:
    """A small job."""
    analysis = "workspace" if name in OF_WORKSPACE else name
    return {"analysis": analysis, "device": "cpu"} | JOBS[name] | fields


def uncompressed(path) -> int:
    """Bytes of a file, of a compressed one its numbers'."""
    if path.suffix == ".vtkhdf":
        import h5py

        with h5py.File(path) as file:
            return sum(each.size * each.dtype.itemsize for each in file["VTKHDF/CellData"].values())
    if path.suffix == ".parquet":
        import pyarrow.parquet as pq

        found = pq.ParquetFile(path).metadata
        return sum(found.row_group(k).total_byte_size for k in range(found.num_row_groups))
    return path.stat().st_size


@pytest.mark.parametrize("name", JOBS)
def test_files_are_as_large_as_estimated(name, tmp_path):
    planned = run.plan(job(name))
    result = run.finish(planned, run.run_shard(planned, 0))
    result.save(tmp_path / "out")
    taken = sum(uncompressed(path) for path in (tmp_path / "out").rglob("*") if path.is_file())
    assert planned.cost.file_bytes == pytest.approx(taken, rel=0.3)


@pytest.mark.parametrize("name", JOBS)
def test_an_estimate_is_the_cost(name):
    planned = run.plan(job(name))
    cost = planned.cost
    assert all(getattr(cost, field.name) > 0 for field in fields(Cost))
    assert (
        planned.estimate
        == cost.estimate()
        == {
            "samples": cost.samples,
            "bytes": cost.memory_bytes,
            "memory_bytes": cost.memory_bytes,
            "file_bytes": cost.file_bytes,
            "seconds": cost.seconds,
        }
    )


@pytest.mark.parametrize("name", ["capability", "workspace"])
def test_half_the_edge_takes_eight_times_the_voxels(name):
    coarse, fine = (run.plan(job(name, voxel_size_m=size)).cost for size in (0.01, 0.005))
    assert fine.memory_bytes == pytest.approx(8 * coarse.memory_bytes, rel=0.1)
    assert fine.file_bytes > coarse.file_bytes and fine.seconds >= coarse.seconds
    samples = 8 if name == "capability" else 1
    assert fine.samples == pytest.approx(samples * coarse.samples, rel=1e-3)


def test_refined_volumes_and_labels_are_counted():
    plain, refined, finer = (run.plan(job("workspace", refined_volume=t)).cost for t in (None, 0.01, 0.002))
    assert refined.seconds >= plain.seconds + 0.5 and finer.seconds > refined.seconds
    labelled = run.plan(job("workspace", voxel_labels=True)).cost
    for field in ("seconds", "memory_bytes", "file_bytes"):
        assert getattr(labelled, field) > getattr(plain, field)


def test_of_parts_in_turn_the_largest_memory_counts():
    assert in_turn([Cost(1, 20, 3, 4), Cost(5, 6, 7, 8)]) == Cost(6, 20, 10, 12)
