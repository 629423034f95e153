"""Of every analysis: malformed documents are refused by the field at fault, and a job says what it will take."""

import itertools
import math
import re

import pytest

import wsrender as ws
from tests.golden.files import analyses, golden_names, job_of
from wsrender.analyses.jobs import parse_job
from wsrender.analyses.registry import job_classes
from wsrender.engine import devices_of, target_of
from wsrender.errors import DocumentError
from wsrender.run import plan

NOWHERE = {"no such field": [None]}  # no value of any field
ODD = (NOWHERE, {}, [], "", -1, float("nan"), None, [None], [[]], True)
IN_WORDS = re.compile(r"[\w .]+")  # a path of fields, without what pydantic calls members of a union


def fields():
    """(analysis, field) of every field of every job."""
    return [(analysis, field) for analysis in analyses() for field in job_classes()[analysis].model_fields]


def refused(document):
    """The fields that the refusal of a document names."""
    with pytest.raises(DocumentError) as refusal:
        parse_job(document)
    assert all(message for _, message in refusal.value.problems)
    return [field for field, _ in refusal.value.problems]


@pytest.mark.parametrize("analysis", analyses())
def test_unknown_fields_are_refused(analysis):
    assert refused({**job_of(analysis), "colour": 1}) == ["colour"]


@pytest.mark.parametrize(("analysis", "field"), fields())
def test_a_field_of_the_wrong_kind_is_named(analysis, field):
    first = refused({**job_of(analysis), field: NOWHERE})[0]
    assert first == field or first.startswith(f"{field}.")


@pytest.mark.parametrize("name", golden_names())
def test_what_is_wrong_is_named_by_fields_alone(name):
    job = job_of(name)
    for field, value in itertools.product(job_classes()[job["analysis"]].model_fields, ODD):
        try:
            parse_job({**job, field: value})
        except DocumentError as refusal:
            paths = [path for path, _ in refusal.problems]
            assert all(IN_WORDS.fullmatch(path) for path in paths), (value, paths)
            assert len(paths) == len(set(paths)), (value, paths)


@pytest.mark.parametrize("analysis", analyses())
def test_what_is_required_is_named(analysis):
    fields = job_classes()[analysis].model_fields
    for required in (name for name, field in fields.items() if field.is_required()):
        document = {name: value for name, value in job_of(analysis).items() if name != required}
        assert refused(document)[0] == required


@pytest.mark.parametrize("name", golden_names())
def test_a_job_is_estimated(name, planned):
    estimate = planned(name).estimate
    assert set(estimate) == {"samples", "bytes", "memory_bytes", "file_bytes", "seconds"}
    assert all(math.isfinite(value) and value > 0 for value in estimate.values()), estimate


@pytest.mark.parametrize("name", golden_names())
def test_the_estimate_knows_the_samples(name, planned, local):
    """What the result says it has sampled, where its number was known beforehand."""
    taken = local(name).document.get("sampling", {}).get("samples")
    if taken is None or planned(name).resolved().get("iterates"):
        return
    assert planned(name).estimate["samples"] >= taken


def elsewhere(value):
    """What planning settles on a machine of another target, which says so of every part of a plan."""
    if isinstance(value, dict):
        return {name: "cuda:sm_00" if name == "target" else elsewhere(each) for name, each in value.items()}
    return [elsewhere(each) for each in value] if isinstance(value, list) else value


@pytest.mark.parametrize("analysis", analyses())
def test_a_plan_for_another_target_is_refused(analysis, planned):
    """Partial results of two targets would not have the same bits."""
    resolved = planned(analysis).resolved()
    assert resolved["target"] == planned(analysis).target == target_of(devices_of("cpu"))
    with pytest.raises(ws.InputError, match="the job was planned for cuda:sm_00, this machine has cpu:"):
        plan(job_of(analysis), resolved=elsewhere(resolved))


@pytest.mark.parametrize("analysis", analyses())
def test_a_result_says_the_target_that_was_planned(analysis, planned, local):
    assert local(analysis).document["provenance"]["target"] == planned(analysis).target
