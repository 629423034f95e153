"""A picture that another package adds in one file: from Python, the command line and a live server."""

import json

import httpx2
import pytest

import wsrender as ws
from tests.server.end_to_end.acceptance import PATIENCE_S
from tests.server.http.idle_server import DOCUMENT, problem_of
from wsrender.results import presentation

PNG = b"\x89PNG"


def test_from_python(package, tmp_path):
    result = ws.execute(DOCUMENT)
    assert "distances" in dir(result.plot)
    (axes,) = result.plot.distances(bins=7).axes
    assert len(axes.patches) == 7 and sum(bar.get_height() for bar in axes.patches) == len(result.map)
    result.save(tmp_path / "out")
    assert "plots/distances.png" in [each["name"] for each in result.document["artifacts"]]
    result.report(tmp_path / "report.html", views=())
    assert "Distances of samples from the origin" in (tmp_path / "report.html").read_text(encoding="utf-8")
    without = ws.Result(result.document, volume=result.volume)
    assert "distances" not in [row.name for row in without.plot.pictures]
    with pytest.raises(ws.InputError, match="samples: distances shows it, which the result does not hold"):
        without.plot.distances()


def test_from_the_command_line(package, wsrender, tmp_path):
    (tmp_path / "job.json").write_text(json.dumps(DOCUMENT))
    code, out, err = wsrender("run", tmp_path / "job.json", "-o", tmp_path / "out")
    assert code == 0 and "plots/distances.png" in out, err
    assert (tmp_path / "out/plots/distances.png").read_bytes().startswith(PNG)


def test_from_a_live_server(live):
    job = live.submit(DOCUMENT).wait(timeout=PATIENCE_S)
    for path in ("artifacts/plots/distances.png", "plots/distances"):
        answer = httpx2.get(f"{live.url}/v1/jobs/{job.id}/{path}", timeout=PATIENCE_S).raise_for_status()
        assert answer.headers["content-type"] == "image/png" and answer.content.startswith(PNG)


def test_a_server_lists_it(package, client, finished):
    parameters = client.get("/openapi.json").json()["paths"]["/v1/jobs/{job_id}/plots/{plot}"]["get"]["parameters"]
    (plot,) = (each["schema"] for each in parameters if each["name"] == "plot")
    assert plot["enum"] == sorted(presentation.all_pictures()) and "distances" in plot["enum"]
    assert client.get(f"{finished}/plots/distances").content.startswith(PNG)
    problem = problem_of(client.get(f"{finished}/plots/sunset"), 422, "invalid_request")
    assert "'distances'" in problem["detail"]


def test_from_a_program(monkeypatch):
    monkeypatch.setattr(presentation, "_REGISTERED", {})
    ws.register_picture(ws.Picture("of_scans", lambda plot: None, needs=("skeleton",), analyses=("capability",)))
    assert "of_scans" in presentation.pictures_of({"analysis": "capability"})
    assert "of_scans" not in presentation.pictures_of({"analysis": "workspace"})
    with pytest.raises(ws.InputError, match="name: there is a picture 'robot' already, wsrender's own"):
        ws.register_picture(ws.Picture("robot", lambda plot: None))
