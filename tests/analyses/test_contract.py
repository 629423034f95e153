"""What is the same for all analyses."""

from dataclasses import dataclass

import numpy as np
import pytest

from wsrender.analyses.contract import Analysis, Draft, Settled
from wsrender.analyses.cost import Cost
from wsrender.analyses.execution import Execution
from wsrender.analyses.partial_result import PartialResult
from wsrender.analyses.partial_tables import tables_of, with_tables
from wsrender.documents.document import Document
from wsrender.engine import devices_of, target_of
from wsrender.errors import InputError
from wsrender.notices import Notice
from wsrender.robot import load_robot
from wsrender.run.partial_files import load_partial, save_partial
from wsrender.volume.table import Table

CPU = target_of(devices_of("cpu"))


@dataclass(frozen=True, kw_only=True)
class NestedSettled(Settled):
    edge_m: float
    shape: tuple[int, int]
    parts: tuple[dict, ...] = ()
    names: list | None = None


class NothingJob(Document):
    analysis: str = "nothing"

    def arms(self):
        return {}


class Nothing(Analysis):
    settles = NestedSettled
    measured, said = None, ()

    def prepare(self, device, target):
        return NestedSettled(device, target, ((0, 5),), edge_m=0.1, shape=(2, 3), parts=({"a": [1]},))

    @property
    def cost(self):
        return Cost(5, 2, 3, 4)

    def compute(self, shard, execution, tell):
        tell(5)
        return PartialResult({"numbers": np.arange(3)}, {"edge": (1, None)})

    def result(self, partial, execution):
        facts = {"edge": partial.facts["edge"]}
        return Draft(facts, self.measured, self.said, {"sampling_path": "none"}, {"part": 2.0})


def test_settled_values_are_json_and_come_back_as_they_were():
    settled = Nothing(NothingJob()).settled
    entry = settled.entry()
    assert entry == {
        "device": "cpu",
        "target": CPU,
        "shards": [[0, 5]],
        "shard_unit": None,
        "iterates": False,
        "edge_m": 0.1,
        "shape": [2, 3],
        "parts": [{"a": [1]}],
        "names": None,
    }
    again = NestedSettled.of(entry)
    assert again == settled and again.shards == ((0, 5),) and again.shape == (2, 3)
    assert NestedSettled.of({**entry, "of another version": 1}) == settled


def test_what_is_settled_is_not_prepared_again(monkeypatch):
    resolved = Nothing(NothingJob()).resolved() | {"edge_m": 7.0, "shards": [[0, 2], [2, 3]]}
    monkeypatch.delattr(Nothing, "prepare")
    monkeypatch.setattr(Nothing, "__abstractmethods__", frozenset())
    plan = Nothing(NothingJob(), resolved=resolved)
    assert (plan.settled.edge_m, plan.shards) == (7.0, [(0, 2), (2, 3)])
    with pytest.raises(InputError, match="was planned for cpu:abacus"):
        Nothing(NothingJob(), resolved={**resolved, "target": "cpu:abacus"})


def test_facts_are_plain_and_the_same_in_a_file(tmp_path):
    plan = Nothing(NothingJob())
    told = []
    partial = plan.run_shard(0, told.append, Execution())
    assert told == [5] and partial.facts == {"edge": [1, None]}
    save_partial(partial, tmp_path / "0.npz")
    again = load_partial(tmp_path / "0.npz", plan)
    assert again.facts == partial.facts and again.arrays.keys() == partial.arrays.keys()
    np.testing.assert_array_equal(again["numbers"], partial["numbers"])
    assert again["numbers"].dtype == partial["numbers"].dtype
    with pytest.raises(TypeError):
        PartialResult({}, {"edge": np.arange(2)})


def test_tables_travel_with_their_units(tmp_path):
    tables = {"a": Table({"x": np.arange(2.0), "y": np.array(["p", "q"])}, {"x": "m"}), "ab": Table({"x": np.ones(1)})}
    save_partial(with_tables(PartialResult({"x": np.zeros(1)}, {"n": 1}), tables), tmp_path / "0.npz")
    partial = load_partial(tmp_path / "0.npz", Nothing(NothingJob()))
    found = tables_of(partial)
    assert partial.facts["n"] == 1 and partial["x"].shape == (1,)
    assert {name: list(table.columns) for name, table in found.items()} == {"a": ["x", "y"], "ab": ["x"]}
    assert found["a"].units == {"x": "m"} and found["a"].columns["y"].tolist() == ["p", "q"]


def test_the_envelope_is_added_once(monkeypatch):
    plan = Nothing(NothingJob())
    plan.notices = (Notice("of_the_robot", "it is odd"),)
    monkeypatch.setattr(Nothing, "said", (Notice("of_numbers", "few"), Notice("of_numbers", "few")))
    document = plan.finish(plan.run_shard(0, None, Execution()), {"sweep": 1.0}, Execution()).document
    assert list(document) == ["format", "analysis", "job", "edge", "headline", "warnings", "provenance", "timing_s"]
    assert document["job"] == {"analysis": "nothing"}
    assert document["headline"]["reason"] == "the analysis nothing measures none"
    assert [each["code"] for each in document["warnings"]] == ["of_the_robot", "of_numbers"]
    assert document["provenance"]["target"] == CPU and document["provenance"]["sampling_path"] == "none"
    assert list(document["timing_s"]) == ["sweep", "part", "finish"] and document["timing_s"]["sweep"] == 1.0
    monkeypatch.setattr(Nothing, "measured", {"quantity": "area"})
    assert plan.finish(plan.run_shard(0, None, Execution()), {}, Execution()).document["headline"] == Nothing.measured


def test_robots_are_named_as_the_job_has_them():
    scara = load_robot("scara")

    class OneJob(NothingJob):
        def arms(self):
            return {(): self}

    assert Nothing(NothingJob()).about_robots() == {}
    assert Nothing(OneJob(), scara).about_robots()["robot"]["name"] == "scara"
    assert [each["name"] for each in Nothing(NothingJob(), scara, scara).about_robots()["robots"]] == ["scara"] * 2


def test_one_shard_has_nothing_to_merge():
    plan = Nothing(NothingJob())
    partial = plan.run_shard(0, None, Execution())
    assert plan.refine(partial, None, Execution()) is partial and plan.resumes is False
    assert plan.estimate == {"samples": 5, "bytes": 2, "memory_bytes": 2, "file_bytes": 3, "seconds": 4}
    with pytest.raises(ValueError, match="nothing has one shard"):
        plan.merge(partial, partial)
