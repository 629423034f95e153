"""An analysis that another package adds in one folder: from Python, the command line and a live server."""

import json

import numpy as np
import pytest

import wsrender as ws
from tests.server.end_to_end.acceptance import PATIENCE_S
from wsrender.run import finish, plan, run_shard
from wsrender.run.partial_files import load_partial, save_partial

JOB = {"analysis": "middle_tip", "robot": {"library": "scara"}}


def expected():
    robot = ws.load_robot("scara")
    return robot.forward_kinematics((robot.lower_limits + robot.upper_limits) / 2)[0, :3, 3]


def test_from_python(package):
    document = ws.execute(JOB).document
    assert document["middle_tip"]["position_m"] == pytest.approx(expected())
    assert document["analysis"] == document["job"]["analysis"] == "middle_tip"
    assert document["robot"]["name"] == "scara" and document["provenance"]["precision"] == "float64"
    assert document["headline"]["reason"] == "the analysis middle_tip measures none"
    assert document["warnings"] == [] and {"plan", "sweep", "finish"} <= document["timing_s"].keys()
    with pytest.raises(ws.DocumentError, match="upwards"):
        ws.execute({**JOB, "upwards": "yes please"})


def test_partial_results_travel(package, tmp_path):
    """Arrays and facts, beside what was settled."""
    here = plan(JOB)
    save_partial(run_shard(here, 0), tmp_path / "0.npz")
    there = plan(JOB, resolved=json.loads(json.dumps(here.resolved())))
    assert there.settled == here.settled
    partial = load_partial(tmp_path / "0.npz", there)
    assert set(partial.arrays) == {"tip"} and partial.facts == {"joints": list(here.robot.joint_names)}
    assert finish(there, partial).document["middle_tip"] == ws.execute(JOB).document["middle_tip"]


def test_it_is_the_design_of_an_optimization(package):
    """Which runs whatever the registry has."""
    rows = [{"a": 0.4, "limits_deg": [-90, 90]}, {"a": 0.3, "limits_deg": [-90, 90]}]
    robot = {"dh": {"convention": "standard", "rows": rows}}
    length = [{"name": "a", "pointers": ["/robot/dh/rows/0/a"], "bounds": [0.2, 0.5]}]
    goal = [{"value": "/middle_tip/position_m/0"}]
    search = {"method": "sweep", "steps": 2}
    best = ws.design_optimization({"analysis": "middle_tip", "robot": robot}, length, goal, search=search)
    assert best.document["best"]["parameters"]["a"] == 0.5
    assert list(best.document["best"]["values"].values()) == pytest.approx([0.8])


def test_from_the_command_line(package, wsrender, tmp_path):
    (tmp_path / "job.json").write_text(json.dumps(JOB))
    assert wsrender("run", tmp_path / "job.json", "-o", tmp_path / "out")[0] == 0
    saved = ws.Result.load(tmp_path / "out")
    assert saved.document["middle_tip"]["position_m"] == pytest.approx(expected())
    np.testing.assert_allclose(saved.tables["tip"].columns["tip"], [expected()])
    assert json.loads(wsrender("schema", "--analysis", "middle_tip")[1])["title"] == "MiddleTipJob"


def test_from_a_live_server(package, live):
    """The same bits; its catalogue and its refusals name it."""
    job = live.submit(JOB)
    with pytest.raises(ws.DocumentError, match="upwards"):
        live.submit({**JOB, "upwards": "yes please"})
    found = job.wait(timeout=PATIENCE_S).result().document
    assert job.record["analysis"] == "middle_tip"
    assert found["middle_tip"] == ws.execute(JOB).document["middle_tip"]


def test_a_server_lists_it(package, client):
    assert "middle_tip" in [each["id"] for each in client.get("/v1/analyses").json()["items"]]
    assert client.get("/v1/analyses/middle_tip").json()["schema"]["title"] == "MiddleTipJob"
    assert "MiddleTip" in client.get("/openapi.json").text
