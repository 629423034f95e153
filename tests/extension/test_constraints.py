"""A constraint that another package adds in one file: from Python, the command line and a live server."""

import json

import numpy as np
import pytest

import wsrender as ws
from tests.server.end_to_end.acceptance import PATIENCE_S
from tests.server.http.idle_server import problem_of
from wsrender.pipeline.constraints import registry

JOB = {
    "analysis": "workspace",
    "robot": {"library": "ur5e"},
    "sampling": {"method": "sobol", "count": 4096},
    "indices": ["manipulability"],
    "constraints": {"tool_down": {"cosine": 0.25}},
    "voxel_size_m": 0.1,
    "keep_map": True,
    "refined_volume": None,
    "device": "cpu",
}
UNKNOWN = "unknown constraint; allowed: region, orientation, self_collision, environment, torque, tool_down"


@pytest.fixture(scope="module")
def admitted():
    """How many of the samples have their tool's axis within arccos 1/4 of straight down."""
    free = ws.execute({**JOB, "constraints": None, "map_columns": ["configuration"]})
    z = ws.load_robot("ur5e").forward_kinematics(free.map.configuration)[:, 2, 2]
    assert np.abs(z + 0.25).min() > 1e-5
    return int((z < -0.25).sum())


def check(result, admitted):
    assert 0 < admitted < 4096
    rejected = {"tool_down": 4096 - admitted}
    assert result.document["samples"] == {"drawn": 4096, "admitted": admitted, "rejected": rejected}
    assert result.map.position.shape == (admitted, 3)


def test_from_python(package, admitted):
    check(ws.execute(JOB), admitted)
    options = {key: JOB[key] for key in ("voxel_size_m", "keep_map", "refined_volume", "device")}
    cosine = {"tool_down": {"cosine": 0.25}}
    check(ws.workspace("ur5e", ws.Sobol(4096), ["manipulability"], constraints=cosine, **options), admitted)
    with pytest.raises(ws.InputError, match=r"constraints\.tool_down\.angle: unknown option; allowed: cosine"):
        ws.execute({**JOB, "constraints": {"tool_down": {"angle": 1}}})


def test_one_of_the_user_replaces_it(package, monkeypatch):
    monkeypatch.setattr(registry, "_ADDED", {})
    ws.register_constraint("tool_down", lambda q, position, axes, angle=0.0: q[0] - angle)
    assert registry.added_constraints()["tool_down"].options == (("angle", 0.0),)


def test_from_the_command_line(package, wsrender, admitted, tmp_path):
    (tmp_path / "job.json").write_text(json.dumps(JOB))
    code, _, err = wsrender("run", tmp_path / "job.json", "-o", tmp_path / "out")
    assert code == 0, err
    check(ws.Result.load(tmp_path / "out"), admitted)
    (tmp_path / "job.json").write_text(json.dumps({**JOB, "constraints": {"tool_up": True}}))
    error = f"error: constraints.tool_up: {UNKNOWN}\n"
    assert wsrender("run", tmp_path / "job.json", "-o", tmp_path / "no") == (2, "", error)


def test_from_a_live_server(live, admitted):
    check(live.submit(JOB).wait(timeout=PATIENCE_S).result(), admitted)
    with pytest.raises(ws.DocumentError, match=r"constraints\.tool_down\.angle: unknown option"):
        live.submit({**JOB, "constraints": {"tool_down": {"angle": 1}}})


@pytest.mark.parametrize(
    ("constraints", "pointer", "detail"),
    [
        (
            {"tool_up": True},
            "#/constraints/tool_up",
            UNKNOWN,
        ),
        (
            {"tool_up": False},
            "#/constraints/tool_up",
            UNKNOWN,
        ),
        ({"tool_down": {"angle": 1}}, "#/constraints/tool_down/angle", "unknown option; allowed: cosine"),
    ],
)
def test_a_server_refuses_at_once_what_it_does_not_know(package, client, constraints, pointer, detail):
    problem = problem_of(client.post("/v1/jobs", json={**JOB, "constraints": constraints}), 422, "invalid_document")
    assert problem["errors"] == [{"pointer": pointer, "detail": detail}]
    wrapped = client.post("/v1/jobs", json={"job": {**JOB, "constraints": constraints}})
    assert problem_of(wrapped, 422)["errors"][0]["pointer"] == "#/job" + pointer.removeprefix("#")


def test_the_schema_of_a_server_tells_of_it(package, client):
    schema = client.get("/openapi.json").json()["components"]["schemas"]["Constraints"]
    assert schema["additionalProperties"] is False and set(schema["properties"]) == {
        "environment",
        "orientation",
        "region",
        "self_collision",
        "tool_down",
        "torque",
    }
    switch, options = schema["properties"]["tool_down"]["anyOf"]
    assert switch == {"type": "boolean"} and options["properties"] == {"cosine": {"type": "number", "default": 0.5}}
    assert client.post("/v1/jobs", json=JOB).status_code == 202
