"""The format of job documents: every analysis has it, and no other is read."""

import json

import pytest

from wsrender.analyses.jobs import canonical_json, job_schema, parse_job
from wsrender.analyses.registry import job_classes
from wsrender.documents.format import FORMAT
from wsrender.errors import DocumentError

UR5E = {"analysis": "workspace", "robot": "ur5e"}


def test_this_version_writes_format_2():
    assert FORMAT == 2
    assert json.loads(canonical_json(parse_job(UR5E)))["format"] == 2


@pytest.mark.parametrize("analysis", job_classes())
@pytest.mark.parametrize("found", [1, 3, 2.5, "2", None, True, [2]])
def test_another_format_is_all_that_is_told(analysis, found):
    """Fields of another format mean something else: what else is wrong would mislead."""
    with pytest.raises(DocumentError) as caught:
        parse_job({"analysis": analysis, "format": found, "nonsense": 1})
    ((field, message),) = caught.value.problems
    assert field == "format"
    assert message.startswith(f"must be 2 or left out, not {json.dumps(found)}")
    assert message.endswith("a newer wsrender has written it") == (found == 3)


@pytest.mark.parametrize("analysis", job_classes())
def test_the_schema_of_every_analysis_says_it(analysis):
    format = job_schema(analysis)["properties"]["format"]
    assert (format["const"], format["default"]) == (2, 2)


@pytest.mark.parametrize("found", [2, 2.0])
def test_a_job_without_format_is_the_same_job(found):
    assert parse_job({**UR5E, "format": found}) == parse_job(UR5E)
    assert canonical_json(parse_job({**UR5E, "format": found})) == canonical_json(parse_job(UR5E))


def test_a_job_inside_of_a_job_has_a_format_too():
    designs = {"parameters": [], "objectives": [], "design": {**UR5E, "format": 3}}
    with pytest.raises(DocumentError) as caught:
        parse_job({"analysis": "design_optimization", **designs})
    assert ("design.format", "must be 2 or left out, not 3: a newer wsrender has written it") in caught.value.problems
