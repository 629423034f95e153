"""Of every analysis: threads, chunks, shards and their order, and a way through a file change no bit of the result."""

import json
from functools import reduce

import pytest
from wsrender_server.jobs import steps
from wsrender_server.jobs.task import Step, Task

import wsrender as ws
from tests.golden.facts import bits_of
from tests.golden.files import analyses, golden_names, job_of
from wsrender.run import finish, merge, plan, run_shard
from wsrender.run.partial_files import load_partial, save_partial


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


def divisible(planned):
    """Names and resolved plans of the golden jobs whose samples may be divided."""
    resolved = {name: planned(name).resolved() for name in golden_names()}
    return {name: each for name, each in resolved.items() if each.get("shard_unit")}


def test_shards_in_any_order_change_no_bit(planned, local):
    found = divisible(planned)
    assert {name.partition(".")[0] for name in found} == {"workspace", "parallel_workspace"}
    for name, resolved in found.items():
        total, unit = sum(count for _, count in resolved["shards"]), resolved["shard_unit"]
        size = max(-(-total // 4 // unit), 1) * unit
        shards = [[first, min(size, total - first)] for first in range(0, total, size)]
        divided = plan(job_of(name), resolved={**resolved, "shards": shards})
        partials = [run_shard(divided, shard) for shard in reversed(range(len(shards)))]
        merged = reduce(lambda a, b: merge(divided, a, b), partials[1::2] + partials[::2])
        assert bits_of(finish(divided, merged)) == bits_of(local(name)), name
    assert sum(len(planned(name).shards) for name in found) == len(found)


@pytest.mark.parametrize("wanted", [1, 1000])
def test_a_server_divides_at_multiples_of_the_unit(wanted, planned, monkeypatch):
    """However few samples a shard shall have: all samples, each once, in ranges that start at multiples."""
    monkeypatch.setattr(steps, "_state", {"shard_samples": wanted, "max_samples": 10**10, "gauges": [0, 0, 0]})
    monkeypatch.setattr(steps, "_plans", type(steps._plans)())
    several = 0
    for name in golden_names():
        settled = planned(name).resolved()
        shards = steps.run(Task(Step.PLAN, name, name, job_of(name)))["resolved"]["shards"]
        ends = [0, *(first + count for first, count in shards)]
        assert [first for first, _ in shards] == ends[:-1]
        assert ends[-1] == sum(count for _, count in settled["shards"])
        unit = settled.get("shard_unit")
        assert len(shards) == 1 if unit is None else all(first % unit == 0 for first, _ in shards), name
        several += len(shards) > 1
    assert several >= 4


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
