"""Of every analysis: threads, chunks, shards and their order, and a way through a file change no bit of the result."""

import json
from dataclasses import replace
from functools import reduce

import pytest
from wsrender_server.jobs import steps
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.task import Step, Task

import wsrender as ws
from tests.golden.facts import bits_of
from tests.golden.files import analyses, golden_names, job_of
from wsrender.run import finish, merge, plan, run_shard
from wsrender.run.partial_files import load_partial, save_partial

# Those whose samples, or what is refined beside them, are shards.
DIVISIBLE = {
    "workspace",
    "reachability",
    "capability",
    "shared_workspace",
    "robot_comparison",
    "collaborative_volume",
    "parallel_workspace",
    "method_comparison",
}


@pytest.mark.parametrize("analysis", analyses())
def test_threads_and_chunks_change_no_bit(analysis, local):
    result = ws.execute(job_of(analysis), threads=1, chunk_size=37)
    assert bits_of(result) == bits_of(local(analysis))


@pytest.mark.parametrize("analysis", analyses())
def test_a_partial_result_travels(analysis, local, planned, tmp_path):
    """Another process knows what planning settled, as JSON, and reads the partial result from a file."""
    here = planned(analysis)
    save_partial(run_shard(here, 0), tmp_path / "0.npz")
    there = plan(job_of(analysis), resolved=json.loads(json.dumps(here.resolved())))
    assert there.settled == here.settled and there.resolved() == here.resolved()
    assert bits_of(finish(there, load_partial(tmp_path / "0.npz", there))) == bits_of(local(analysis))


@pytest.mark.parametrize("analysis", analyses())
def test_facts_are_no_arrays(analysis, planned):
    """What is said in JSON stands beside the arrays: none is a text."""
    partial = run_shard(planned(analysis), 0).packed()
    assert json.loads(json.dumps(partial.facts)) == partial.facts
    assert all(array.ndim > 0 and array.dtype != object for array in partial.arrays.values())


def divisions(planned):
    """Plans of the golden jobs that can be divided, in about four shards, and what is refined beside them."""
    found = {}
    for name in golden_names():
        whole = planned(name)
        shards = whole.divided(whole.samples * whole.effort / 4, 256)
        if len(shards) > 1:
            found[name] = plan(job_of(name), resolved={**whole.resolved(), "shards": shards})
    return found


def test_shards_in_any_order_change_no_bit(planned, local):
    """Samples and refinements, each of which has travelled, in another order than they were planned in."""
    found = divisions(planned)
    assert {name.partition(".")[0] for name in found} == DIVISIBLE
    assert {name for name, each in found.items() if each.refinements} >= {
        "robot_comparison",
        "shared_workspace.refined",
    }
    for name, divided in found.items():
        partials = [divided.read(run_shard(divided, shard).packed()) for shard in reversed(range(len(divided.shards)))]
        merged = reduce(lambda a, b: merge(divided, a, b), partials[1::2] + partials[::2])
        assert bits_of(finish(divided, merged)) == bits_of(local(name)), name
        assert len(planned(name).shards) == 1


@pytest.mark.parametrize("wanted", [1, 1000])
def test_a_server_divides_as_the_analysis_says(wanted, planned, monkeypatch):
    """However few samples a shard shall have: all samples, each once, then what is refined."""
    monkeypatch.setattr(steps, "_state", {"shard_samples": wanted, "max_samples": 10**10, "gauges": [0, 0, 0]})
    monkeypatch.setattr(steps, "_plans", type(steps._plans)())
    several = set()
    for name in golden_names():
        whole = planned(name)
        shards = steps.run(Task(Step.PLAN, name, name, job_of(name)))["resolved"]["shards"]
        ends = [0, *(first + count for first, count in shards)]
        assert [first for first, _ in shards] == ends[:-1] and ends[-1] == whole.samples
        assert [count for _, count in shards[1:]].count(0) == whole.refinements
        for piece in whole.pieces:
            inside = {first - piece.first for first, count in shards if count and piece.within(first, count)[1]}
            assert inside == {0} if piece.unit is None else all(first % piece.unit == 0 for first in inside), name
        assert len(shards) <= 2 * steps.MOST_SHARDS
        several |= {name.partition(".")[0]} if len(shards) > 1 else set()
    assert several == DIVISIBLE


def test_a_server_merges_shards_and_refinements(planned, local, monkeypatch, tmp_path):
    """Its steps, each with what another process would have of the plan, give the bits of a local run."""
    state = {"shard_samples": 2000, "max_samples": 10**10, "gauges": [0, 0, 0], "threads": 1}
    files = DataFolder(tmp_path)
    monkeypatch.setattr(steps, "_state", {**state, "files": files})
    for own, name in {"a": "shared_workspace.refined", "b": "robot_comparison"}.items():
        task = Task(Step.PLAN, own, own, job_of(name), seconds={})
        task = replace(task, resolved=json.loads(json.dumps(steps.run(task)["resolved"])))
        for shard in reversed(range(len(task.resolved["shards"]))):
            monkeypatch.setattr(steps, "_plans", type(steps._plans)())
            steps.run(replace(task, step=Step.SHARD, shard=shard))
        record = steps.run(replace(task, step=Step.FINISH))[0]
        document = json.loads(files.artifact(own, record["sha256"]).read_text())
        assert lasting(document) == lasting(json.loads(json.dumps(local(name).document))), name


def lasting(document):
    """Without times, and what belongs to saved files."""
    return {key: value for key, value in document.items() if key not in ("timing_s", "artifacts", "provenance")}


class StoppedError(Exception):
    """Somebody has cancelled."""


def stopping(calls):
    """A progress that stops the run at its n-th call."""
    left = [calls]

    def report(done):
        left[0] -= 1
        if left[0] == 0:
            raise StoppedError

    return report


@pytest.mark.parametrize("analysis", analyses())
def test_a_run_is_stopped_from_its_progress(analysis, planned):
    with pytest.raises(StoppedError):
        run_shard(planned(analysis), 0, stopping(1))


def test_a_resuming_run_goes_on_where_it_was_stopped(planned, local, tmp_path):
    """The same bits, stopped or not, and nothing done twice."""
    resuming = [name for name in golden_names() if planned(name).resumes]
    assert {name.partition(".")[0] for name in resuming} == {"design_optimization"}
    for name in resuming:
        kept = tmp_path / f"{name}.checkpoint"
        with pytest.raises(StoppedError):
            run_shard(planned(name), 0, stopping(2), checkpoint=kept)
        before = kept.read_text().splitlines()
        assert len(before) > 1
        result = finish(planned(name), run_shard(planned(name), 0, checkpoint=kept))
        after = kept.read_text().splitlines()
        assert after[: len(before)] == before and len(set(after)) == len(after)
        assert bits_of(result) == bits_of(local(name)), name
