"""Plans and partial results that travel between processes change no bit of a result."""

import json
from functools import reduce

import numpy as np
import pytest

from wsrender.errors import InputError
from wsrender.run import finish, merge, plan, run_shard
from wsrender.run.partial_files import load_partial, save_partial

JOB = {
    "analysis": "workspace",
    "robot": "scara",
    "sampling": {"method": "sobol", "count": 150_000},
    "voxel_size_m": 0.05,
    "voxel_statistics": ["count", "maximum", "minimum", "mean"],
    "device": "cpu",
}
KEPT = {"sampling": {"method": "sobol", "count": 3000}, "keep_map": True, "map_columns": ["configuration"]}
CONVERGE = {"sampling": {"method": "converge", "tolerance": 1e3, "start": 2, "step": 1}}
AT = {"analysis": "indices_at", "robot": "scara", "configurations": [[0.1, 0.2, 0.05, 0.3]] * 3, "device": "cpu"}


def comparable(result):
    document = {key: value for key, value in result.document.items() if key not in ("timing_s", "provenance")}
    arrays = [] if result.map is None else [result.map.position, *result.map.indices.values()]
    if result.volume is not None:
        arrays += [result.volume.count, *(a for s in result.volume.statistics.values() for a in s.values())]
    return document, [array.tobytes() for array in arrays]


@pytest.mark.parametrize("job", [JOB, JOB | KEPT, JOB | CONVERGE, AT], ids=["volume", "map", "converge", "indices_at"])
def test_shards_of_other_processes_give_the_same_result(job, tmp_path):
    here = plan(job)
    expected = comparable(finish(here, reduce(here.merge, [run_shard(here, i) for i in range(len(here.shards))])))

    resolved = json.loads(json.dumps(here.resolved()))
    if job is JOB:
        resolved["shards"] = [[0, 65536], [65536, 65536], [131072, 150_000 - 131072]]
    for shard in range(len(resolved["shards"])):
        elsewhere = plan(job, resolved=resolved)  # as each worker does
        save_partial(run_shard(elsewhere, shard), tmp_path / f"{shard}.npz")
    last = plan(job, resolved=resolved)
    partials = [load_partial(tmp_path / f"{i}.npz", last) for i in reversed(range(len(resolved["shards"])))]
    assert comparable(finish(last, reduce(lambda a, b: merge(last, a, b), partials))) == expected


def test_what_is_settled_is_not_settled_again():
    job = {name: value for name, value in JOB.items() if name != "voxel_size_m"}
    resolved = plan(job).resolved() | {"voxel_size_m": 0.125, "first_voxel": [-99, -99, -99], "shape": [200, 200, 200]}
    again = plan(job, resolved=resolved)
    assert again.resolved() == resolved


def test_a_plan_for_another_target_is_refused():
    resolved = plan(JOB).resolved() | {"target": "cpu:abacus"}
    with pytest.raises(InputError, match=r"device.*abacus"):
        plan(JOB, resolved=resolved)


def test_a_damaged_file_is_refused(tmp_path):
    planned = plan(JOB | KEPT)
    path = tmp_path / "0.npz"
    save_partial(run_shard(planned, 0), path)
    content = path.read_bytes()
    middle = len(content) // 2
    for damaged in (b"", content[:100], content[:-30], content[:middle] + b"\xff" * 64 + content[middle + 64 :]):
        path.write_bytes(damaged)
        with pytest.raises(InputError, match=r"0\.npz"):
            load_partial(path, planned)
    path.unlink()
    with pytest.raises(InputError, match=r"0\.npz"):
        load_partial(path, planned)


def test_pickles_are_not_read(tmp_path):
    path = tmp_path / "0.npz"
    np.savez(path, about=np.array([{"samples": 1}], dtype=object))
    with pytest.raises(InputError, match=r"0\.npz"):
        load_partial(path, plan(JOB))
