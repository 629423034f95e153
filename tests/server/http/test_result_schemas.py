"""Result documents of every analysis keep to the schema that /openapi.json has of it, and to no other."""

import copy
import json

import pytest
from jsonschema import Draft202012Validator

import wsrender as ws
from tests.golden.files import analyses, golden, golden_names
from tests.server.http.other_branches import JOBS
from tests.server.http.other_branches import job_of as further
from wsrender import __version__

COMMON = {"format", "analysis", "job", "headline", "warnings", "provenance", "timing_s", "artifacts"}
# What may hold anything: job documents, and options of indices.
OPEN = {"job", "design", "index_options", "options"}


@pytest.fixture
def validator(client):
    components = client.get("/openapi.json").json()["components"]
    return Draft202012Validator({"$ref": "#/components/schemas/ResultDocument", "components": components})


@pytest.fixture
def of_a_run(client, finished):
    """What golden documents leave out, for it differs from run to run."""
    document = client.get(f"{finished}/result").json()
    return {name: document[name] for name in ("timing_s", "artifacts", "provenance")}


def whole(name, of_a_run):
    """A golden document with what every document has."""
    document = golden(name)["document"]
    return {**document, **of_a_run, "provenance": of_a_run["provenance"] | document["provenance"]}


def errors_of(validator, document):
    return [f"{error.json_path}: {error.message[:200]}" for error in validator.iter_errors(document)]


def leaves(node, path=()):
    """Paths to numbers, texts and truth values of a document, of lists to those of the first item."""
    if isinstance(node, dict):
        for name, value in node.items():
            yield from () if name in OPEN else leaves(value, (*path, name))
    elif isinstance(node, list):
        yield from leaves(node[0], (*path, 0)) if node else ()
    elif node is not None:
        yield path


def with_leaf(document, path, value):
    changed = copy.deepcopy(document)
    node = changed
    for step in path[:-1]:
        node = node[step]
    node[path[-1]] = value
    return changed


@pytest.mark.parametrize("name", golden_names())
def test_a_document_keeps_to_its_schema(validator, of_a_run, name):
    assert errors_of(validator, whole(name, of_a_run)) == []


@pytest.mark.parametrize("name", JOBS)
def test_a_document_of_another_branch_does_too(validator, name):
    result = ws.execute(further(name))
    document = json.loads(json.dumps(result.document, allow_nan=False))
    assert errors_of(validator, document) == []


@pytest.mark.parametrize("analysis", analyses())
def test_another_field_or_type_is_refused(validator, of_a_run, analysis):
    document = whole(analysis, of_a_run)
    for name in set(document) - COMMON:
        renamed = {f"{key}_" if key == name else key: value for key, value in document.items()}
        assert errors_of(validator, renamed), f"{name} may be renamed"
        assert errors_of(validator, document | {name: [["odd"]]}), f"{name} may be anything"
    found = [path for path in leaves(document) if path[0] not in ("provenance", "artifacts")]
    assert len(found) > 10
    for path in found:
        assert errors_of(validator, with_leaf(document, path, {"odd": []})), f"{path} may be anything"


@pytest.mark.parametrize("analysis", analyses())
def test_a_document_of_one_analysis_is_none_of_another(validator, of_a_run, analysis):
    other = next(name for name in analyses() if name != analysis)
    assert errors_of(validator, whole(analysis, of_a_run) | {"analysis": other})


def test_documents_of_other_versions_are_as_they_were(validator, of_a_run):
    document = whole("capability", of_a_run)
    del document["capability"]
    assert errors_of(validator, document)
    document["provenance"] = document["provenance"] | {"wsrender": "0.1.0"}
    assert errors_of(validator, document) == [] and __version__ != "0.1.0"
    assert errors_of(validator, {key: value for key, value in document.items() if key != "headline"})


def test_names_of_schemas_are_of_one_thing_each(client):
    """Parts of results take no name of a part of a job, nor of a view."""
    from wsrender_server.job_body import body_schemas
    from wsrender_server.openapi import result_schemas

    of_results, text = result_schemas(), json.dumps(client.get("/openapi.json").json())
    assert not of_results.keys() & body_schemas().keys()
    assert all(f'"{name}"' in text for name in of_results) and "WorkspaceResult" in of_results
