"""Plan, run_shard, merge, finish; the same bits whatever the chunks, threads and shards."""

import json
from functools import reduce

import numpy as np
import pytest
import trimesh

import wsrender as ws
from tests.lasting import lasting
from tests.run.simple_robots import PLANAR, planar_arm
from wsrender.collision import store
from wsrender.run import execute, finish, merge, plan, run_shard
from wsrender.run.steps import Progress

FULL = {
    **PLANAR,
    "voxel_size_m": 0.03,
    "voxel_statistics": ("count", "maximum", "mean", "minimum"),
    "keep_map": True,
    "map_columns": ("configuration", "orientation"),
}


def analysis(**execution):
    return ws.analyze(planar_arm(), ws.Grid(90), **FULL, **execution)


def timeless(result):
    """The document without what differs from run to run."""
    return json.dumps(lasting(result.document))


def assert_same_bits(a, b):
    assert timeless(a) == timeless(b)
    assert a.volume.first_voxel == b.volume.first_voxel
    assert a.volume.count.tobytes() == b.volume.count.tobytes()
    for statistic, by_index in a.volume.statistics.items():
        for name, values in by_index.items():
            assert values.tobytes() == b.volume.statistics[statistic][name].tobytes()
    for samples, others in ((a.map, b.map), (a.sample, b.sample)):
        assert samples.position.tobytes() == others.position.tobytes()
        assert samples.configuration.tobytes() == others.configuration.tobytes()
        for name, values in samples.indices.items():
            assert values.tobytes() == others.indices[name].tobytes()


@pytest.mark.parametrize("execution", [{"chunk_size": 1000}, {"chunk_size": 37, "threads": 2}, {"threads": 1}])
def test_chunks_and_threads_change_no_bit(execution):
    assert_same_bits(analysis(), analysis(**execution))


def test_shards_merged_in_any_order_are_the_whole():
    whole = analysis()
    resolved = plan(whole.document["job"]).resolved()
    shards = [[0, 2048], [2048, 2048], [4096, 2048], [6144, 90**2 - 6144]]
    planned = plan(whole.document["job"], resolved={**resolved, "shards": shards})
    assert [first for first, _ in planned.shards] == [0, 2048, 4096, 6144]
    assert sum(count for _, count in planned.shards) == 90**2
    partials = [run_shard(planned, shard) for shard in range(4)]
    merged = reduce(lambda a, b: merge(planned, a, b), (partials[i] for i in (2, 0, 3, 1)))
    assert_same_bits(finish(planned, merged), whole)


def test_a_plan_says_what_will_run():
    planned = plan(
        {"analysis": "workspace", "robot": "scara", "sampling": {"method": "sobol", "count": 5000}, "device": "cpu"}
    )
    assert planned.estimate["samples"] == 5000
    assert planned.estimate["seconds"] > 0
    assert planned.estimate["bytes"] > 0
    assert planned.shards == [(0, 5000)]
    assert planned.target.startswith("cpu:")


def test_the_job_of_a_result_gives_it_again():
    first = analysis()
    assert_same_bits(first, execute(json.dumps(first.document["job"])))


def test_progress_ends_at_the_total():
    calls = []
    progress: Progress = lambda *call: calls.append(call)  # noqa: E731
    analysis(progress=progress, chunk_size=512)
    assert calls[0] == (0, 1, "planning")
    assert calls[-1] == (8100, 8100, "finishing")
    assert all(0 <= done <= total for done, total, _ in calls)


def test_tables_of_collisions_tell_how_far_they_are(tmp_path, monkeypatch):
    monkeypatch.setenv(store.FOLDER, str(tmp_path))
    monkeypatch.setattr(store, "_LATEST", {})
    trimesh.creation.annulus(0.1, 0.2, 0.1).export(tmp_path / "ring.stl")
    ring = {"items": [{"shape": "mesh", "path": str(tmp_path / "ring.stl"), "position_m": [0, 0, -0.5]}]}
    asked = {"analysis": "indices_at", "robot": "franka_panda", "configurations": [[0.0] * 7], "environment": ring}
    calls = []
    execute(asked | {"constraints": {"self_collision": True}}, lambda *call: calls.append(call))
    told = [call[:2] for call in calls if call[2] == "collision tables"]
    assert told[0] == (0, 1)  # the grid of the mesh, then pairs
    pairs = told[-1][1]
    assert pairs > 30 and told[1:] == [(done, pairs) for done in range(pairs)]
    calls.clear()
    execute(asked | {"constraints": {"self_collision": True}}, lambda *call: calls.append(call))
    assert all(message != "collision tables" for *_, message in calls)  # they are made


@pytest.mark.parametrize("chunk_size", [0, -1, 1.5, "many"])
def test_chunk_size_is_a_positive_whole_number(chunk_size):
    with pytest.raises(ws.InputError, match=r"chunk_size: .* is not allowed; a positive whole number is"):
        analysis(chunk_size=chunk_size)


def test_too_many_samples_name_the_remedy():
    with pytest.raises(ws.ResourceError, match=r"1e\+12 samples; .*max_samples = 1e\+10: use .*sobol"):
        ws.analyze("ur5e", ws.Grid(100), device="cpu")
    with pytest.raises(ws.ResourceError, match=r"sampling.count: 5001 samples; at most max_samples = 5000"):
        ws.analyze("ur5e", ws.Random(5001), max_samples=5000, device="cpu")


def test_the_frames_of_a_robot_are_in_its_job():
    robot = ws.load_robot("phantom_omni", tip="link4")
    document = ws.analyze(
        robot, ws.Grid(5), ["manipulability", "inverse_condition_number"], voxel_size_m=0.02, device="cpu"
    ).document
    assert document["job"]["tip"] == "link4"
    assert document["robot"]["tip_frame"] == "link4"
    again = execute(document["job"]).document
    assert again["indices"] == document["indices"]
    assert again["robot"] == document["robot"]


def test_indices_at_configurations_in_the_order_asked():
    q = [[0.3, 0.5], [0.3, 0.0], [-1.0, 2.0]]
    job = {
        "analysis": "indices_at",
        "robot": {"dh": json.loads(planar_arm().spec.dh.model_dump_json())},
        "configurations": q,
        **PLANAR,
    }
    result = execute(job)
    assert result.map.indices["manipulability"] == pytest.approx(0.2 * np.sin([0.5, 0.0, 2.0]))
    assert result.map.configuration.tolist() == q
    assert result.document["sampling"] == {"method": "given", "samples": 3}
    assert result.document["indices"]["manipulability"]["unit"] == "m^2"
    for configurations, message in (
        (None, "must be a list, not null"),
        ([], "must have at least 1 items"),
        ([[1.0]], r"has shape \(1, 1\); \(2,\) or \(N, 2\) is needed"),
    ):
        with pytest.raises(ws.InputError, match=f"configurations: {message}"):
            execute({**job, "configurations": configurations})
