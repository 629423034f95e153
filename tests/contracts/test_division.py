"""Of every analysis: threads, chunks, shards and their order, and a way through a file change no bit of the result."""

import json
from dataclasses import replace
from functools import reduce

import pytest
from wsrender_server.jobs import steps
from wsrender_server.jobs.documents import CanonicalDocument
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.task import Step, Task

import wsrender as ws
from tests.golden.facts import bits_of
from tests.golden.files import analyses, golden_names, job_of
from wsrender.run import finish, further, merge, plan, run_shard
from wsrender.run.partial_files import load_partial, save_partial

# Those whose samples, or what is refined beside them, are shards.
DIVISIBLE = {
    "workspace",
    "reachability",
    "postures",
    "capability",
    "shared_workspace",
    "robot_comparison",
    "base_placement",
    "inverse_reachability",
    "two_arm_placement",
    "collaborative_volume",
    "parallel_workspace",
    "method_comparison",
    "design_optimization",
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
        settled = whole.division(whole.samples * whole.effort / 4, 4)
        if settled != whole.settled:
            found[name] = plan(job_of(name), resolved=json.loads(json.dumps(settled.entry())))
    return found


def shards_of(divided, first):
    """Partial results of a plan's shards from the ``first`` on, in the reverse order; each has travelled."""
    shards = range(first, len(divided.shards))
    return [divided.read(run_shard(divided, shard).packed()) for shard in reversed(shards)]


def test_shards_in_any_order_change_no_bit(planned, local):
    """Samples and refinements, in other orders than they were planned in; further rounds too."""
    found, rounds = divisions(planned), set()
    assert {name.partition(".")[0] for name in found} == DIVISIBLE
    assert {"robot_comparison", "shared_workspace.refined"} <= {k for k, each in found.items() if each.refinements}
    for name, divided in found.items():
        partials = shards_of(divided, 0)
        while True:
            merged = reduce(lambda a, b: merge(divided, a, b), partials[1::2] + partials[::2])
            if (more := further(divided, merged)) is None:
                break
            before, divided = len(divided.shards), more
            partials += shards_of(divided, before)
            rounds.add(name)
        assert bits_of(finish(divided, merged)) == bits_of(local(name)), name
        assert len(planned(name).shards) == 1
    refined = {name for name in found if getattr(planned(name).job, "refined_volume", None)}
    assert rounds == {"design_optimization.pareto"} | {n for n in refined if n.startswith("parallel_workspace")}
    assert "parallel_workspace" in rounds


def sent(name):
    """The golden job as a task has it."""
    return CanonicalDocument("", name, "cpu", (), (), text=json.dumps(job_of(name)))


@pytest.mark.parametrize("wanted", [1, 1000])
def test_a_server_divides_as_the_analysis_says(wanted, planned, monkeypatch, tmp_path):
    """However few samples a shard shall have: all samples, each once, then what is refined."""
    state = {"shard_samples": wanted, "max_samples": 10**10, "gauges": [0, 0, 0], "files": DataFolder(tmp_path)}
    monkeypatch.setattr(steps, "_state", state)
    monkeypatch.setattr(steps, "_plans", type(steps._plans)())
    several = set()
    for number, name in enumerate(golden_names()):
        whole, own = planned(name), f"{number:x}"
        resolved = steps.run(Task(Step.PLAN, own, own, sent(name)))["resolved"]
        shards = resolved["shards"]
        ends = [0, *(first + count for first, count in shards)]
        several |= {name.partition(".")[0]} if len(shards) > 1 else set()
        assert len(shards) <= 2 * steps.MOST_SHARDS and [first for first, _ in shards] == ends[:-1]
        assert [count for _, count in shards[1:]].count(0) == whole.refinements
        if designs := resolved.get("designs"):  # of a first round
            assert ends[-1] == len(designs) <= whole.samples == resolved["most_samples"]
            continue
        assert ends[-1] == whole.samples
        for piece in whole.pieces:
            inside = {first - piece.first for first, count in shards if count and piece.within(first, count)[1]}
            assert inside == {0} if piece.unit is None else all(first % piece.unit == 0 for first in inside), name
    assert several == DIVISIBLE


def test_a_server_merges_shards_and_refinements(planned, local, monkeypatch, tmp_path):
    """Its steps, each with what another process would have of the plan, give the bits of a local run."""
    state = {"shard_samples": 2000, "max_samples": 10**10, "gauges": [0, 0, 0], "threads": 1}
    files = DataFolder(tmp_path)
    monkeypatch.setattr(steps, "_state", {**state, "files": files})
    rounds = []
    names = {"a": "shared_workspace.refined", "b": "robot_comparison", "c": "design_optimization.pareto"}
    names["d"] = "parallel_workspace"  # whose refined volume follows from its samples
    for own, name in names.items():
        task = Task(Step.PLAN, own, own, sent(name), seconds={})
        found = steps.run(task)
        while isinstance(found, dict):
            task = replace(task, resolved=json.loads(json.dumps(found["resolved"])))
            for shard in reversed(range(len(task.resolved["shards"]))):
                monkeypatch.setattr(steps, "_plans", type(steps._plans)())
                steps.run(replace(task, step=Step.SHARD, shard=shard))
            rounds.append(name)
            found = steps.run(replace(task, step=Step.FINISH))
        document = json.loads(files.artifact(own, found[0]["sha256"]).read_text())
        assert lasting(document) == lasting(json.loads(json.dumps(local(name).document))), name
    counts = [rounds.count(name) for name in names.values()]
    assert (*counts[:2], counts[3]) == (1, 1, 2) and counts[2] > 1


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
