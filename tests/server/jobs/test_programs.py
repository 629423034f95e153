"""Programs of collisions are made once, by the planner: workers compute with its bytes."""

from dataclasses import fields

import numpy as np
import pytest
from wsrender_server.jobs import steps
from wsrender_server.jobs.documents import CanonicalDocument
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.task import Step, Task

from tests.server.jobs.documents import canonical
from wsrender import run
from wsrender.collision import store

JOB = {
    "robot": "franka_panda",
    "sampling": {"method": "sobol", "count": 4096},
    "voxel_size_m": 0.1,
    "refined_volume": None,
    "device": "cpu",
    "constraints": {"self_collision": True},
    "environment": {"items": [{"shape": "box", "size_m": [0.4, 0.4, 0.2], "position_m": [0.4, 0.2, 0.2]}]},
}


class Gauges(list):
    """Numbers that remember what was written to them."""

    def __init__(self):
        super().__init__([0, 0, 0])
        self.seen = []

    def __setitem__(self, at, value):
        super().__setitem__(at, value)
        self.seen.append(tuple(self[1:]))


@pytest.fixture
def process(tmp_path, monkeypatch):
    """What a kernel process has, without the process."""
    state = {"files": DataFolder(tmp_path / "data"), "threads": 1, "gauges": Gauges()}
    monkeypatch.setattr(steps, "_state", state | {"shard_samples": 1024, "max_samples": 1e9})
    monkeypatch.setattr(store, "_given", None)

    def begin(cache):
        monkeypatch.setattr(store, "_LATEST", {})
        steps._plans.clear()
        monkeypatch.setenv(store.FOLDER, str(tmp_path / cache))

    yield begin
    steps._plans.clear()


def test_workers_compute_with_what_the_planner_has_made(process, tmp_path, monkeypatch):
    process("planner")
    job, gauges = canonical(**JOB), steps._state["gauges"]
    document = CanonicalDocument.of(job)
    planned = steps.run(Task(Step.PLAN, "c0ffee", "c0ffee-1", document))
    made = dict(store._LATEST)
    pairs = sum(len(each.solid_pairs) for each in made.values())
    assert made and {(done, pairs) for done in range(pairs)} <= set(gauges.seen)  # progress while they are made
    resolved = planned["resolved"]
    assert len(resolved["shards"]) == 4

    process("worker")
    monkeypatch.setattr(store, "program", None)  # a worker makes none
    for shard in range(len(resolved["shards"])):
        steps.run(Task(Step.SHARD, "c0ffee", "c0ffee-1", document, resolved, shard))
    assert not (tmp_path / "worker").exists()
    assert set(store._LATEST) == set(made)
    for key, found in store._LATEST.items():
        for field in fields(found):
            own, other = getattr(found, field.name), getattr(made[key], field.name)
            assert np.asarray(own).tobytes() == np.asarray(other).tobytes()
    steps.run(Task(Step.FINISH, "c0ffee", "c0ffee-1", document, resolved, seconds={}))
    plan = steps._planned(Task(Step.SHARD, "c0ffee", "c0ffee-1", document, resolved))
    shards = [steps._load(Task(Step.SHARD, "c0ffee", "c0ffee-1", document), k, plan) for k in range(4)]

    monkeypatch.undo()
    alone = run.plan(job)
    whole, merged = run.run_shard(alone, 0), shards[0]
    for other in shards[1:]:
        merged = run.merge(plan, merged, other)
    one, many = whole.packed(), merged.packed()
    assert (many.arrays["rejected"] > 0).all()
    assert set(one.arrays) == set(many.arrays)
    for name, value in one.arrays.items():
        assert value.tobytes() == many.arrays[name].tobytes(), name
