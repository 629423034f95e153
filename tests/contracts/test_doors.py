"""Of every analysis: Python, the command line and a live server give the same result."""

import json

import pytest
from wsrender_server.app import artifacts
from wsrender_server.local_server import LocalServer

import wsrender as ws
from tests.golden.facts import bits_of
from tests.golden.files import analyses, job_of
from tests.run.journeys import from_the_command_line
from tests.server.end_to_end.acceptance import PATIENCE_S
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.export.headline import headline_lines

ANALYSES = pytest.mark.parametrize("analysis", analyses())
STANDARD = (".parquet", ".vtkhdf", ".glb", ".ply", ".png", ".npy", ".dxf", ".json")


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with LocalServer(tmp_path_factory.mktemp("data")) as server:
        yield server


@pytest.fixture(scope="module")
def client(server):
    with ws.Client(server.url) as client:
        yield client


@pytest.fixture(scope="module")
def jobs(client):
    """The golden job of every analysis, submitted at once."""
    return {analysis: client.submit(job_of(analysis)) for analysis in analyses()}


def untimed(document):
    """A result document without seconds and the host's name."""
    copy = json.loads(json.dumps(document))
    del copy["timing_s"], copy["provenance"]["host"], copy["provenance"]["run"]
    return copy


@ANALYSES
def test_the_server_gives_what_a_local_run_gives(analysis, jobs, saved, client):
    """Document, data and every file, by its hash."""
    job = jobs[analysis].wait(timeout=PATIENCE_S)
    assert job.record["analysis"] == analysis
    result, local = job.result(), ws.Result.load(saved(analysis))
    ours, theirs = untimed(result.document), untimed(local.document)
    found, expected = ours.pop("artifacts"), theirs.pop("artifacts")
    assert ours == theirs
    by_name = {record["name"]: record for record in expected}
    assert found == [by_name[record["name"]] for record in found]
    assert {record["name"] for record in found} >= {name for name in by_name if name.endswith(STANDARD)}
    assert bits_of(result) == bits_of(local)
    stated = artifacts.ResultDocument.model_validate(local.document)
    assert headline_lines(local.document) and (stated.headline.value is not None or stated.headline.reason)
    assert [each.id for each in client.jobs(analysis=analysis)] == [job.id]


@ANALYSES
def test_the_command_line_gives_what_python_gives(analysis, saved, tmp_path, monkeypatch, capsys):
    """Every file but the pictures, which another test draws."""
    monkeypatch.setattr(ResultPlots, "pictures", [])
    result, local = from_the_command_line(job_of(analysis), tmp_path), ws.Result.load(saved(analysis))
    assert bits_of(result) == bits_of(local)
    found, by_name = result.document["artifacts"], {each["name"]: each for each in local.document["artifacts"]}
    assert found == [by_name[record["name"]] for record in found]
    plain = {name for name in by_name if name.endswith(STANDARD) and not name.startswith("plots/")}
    assert {record["name"] for record in found} >= plain
    assert all(line.strip() in capsys.readouterr().out for line in headline_lines(local.document)[:1])


@ANALYSES
def test_the_server_estimates_and_refuses(analysis, client, planned):
    """As a local plan does."""
    estimate = client.estimate(job_of(analysis))
    assert estimate["samples"] == planned(analysis).estimate["samples"]
    assert estimate["seconds"] > 0 and estimate["bytes"] > 0
    with pytest.raises(ws.InputError) as refusal:
        client.submit({**job_of(analysis), "colour": 1})
    assert refusal.value.field == "colour"
