"""A job over HTTP gives what a local run gives, bit for bit."""

import json

import numpy as np
import pytest

import wsrender as ws
from tests.server.end_to_end.acceptance import PATIENCE_S, QUICK, assert_same_files, assert_same_result
from wsrender.cli import main

ARM = """<mujoco><worldbody><body><joint name="a" axis="0 0 1" range="-1 1"/><geom size="0.1"/>
<body pos="0.5 0 0"><joint name="b" axis="0 1 0" range="-1 1"/><geom size="0.1"/>
<site name="tool" pos="0.4 0 0"/></body></body></worldbody><compiler angle="radian"/></mujoco>"""


def test_result_equals_the_local_run(client, quick_local, tmp_path):
    local, folder = quick_local
    job = client.submit(QUICK, labels={"kind": "quick"})
    result = job.wait(timeout=PATIENCE_S).result()
    assert isinstance(result, ws.Result)
    assert_same_result(result, local)
    assert result.map is None
    np.testing.assert_array_equal(result.volume.count, local.volume.count)
    np.testing.assert_array_equal(
        result.volume.statistics["maximum"]["manipulability"], local.volume.statistics["maximum"]["manipulability"]
    )
    np.testing.assert_array_equal(result.sample.position, local.sample.position)
    np.testing.assert_array_equal(result.skeleton, local.skeleton)
    result.save(tmp_path / "out")
    assert_same_files(tmp_path / "out", folder)
    assert ws.Result.load(tmp_path / "out").document == result.document


def test_twin_is_answered_from_the_cache_with_its_own_id(client, quick_local):
    first = client.submit(QUICK).wait(timeout=PATIENCE_S)
    second = client.submit(QUICK)
    assert second.state == "succeeded"
    assert second.id != first.id
    assert_same_result(second.result(), quick_local[0])


def test_indices_at_configurations(client, tmp_path):
    configurations = [[0.1 * (row + column) for column in range(6)] for row in range(5)]
    document = {"analysis": "indices_at", "robot": "ur5e", "configurations": configurations, "device": "cpu"}
    result = client.submit(document).result()
    local = ws.execute(document)
    for name, values in local.map.indices.items():
        np.testing.assert_array_equal(result.map.indices[name], values)


def test_uploaded_robot(client, tmp_path):
    arm = tmp_path / "arm.xml"
    arm.write_text(ARM)
    document = {
        **QUICK,
        "robot": {"path": str(arm)},
        "sampling": {"method": "grid", "per_joint": 5},
        "task": ["y", "z"],
    }
    result = client.submit(document).wait(timeout=PATIENCE_S).result()
    local = ws.execute(document)
    assert result.document["job"]["robot"]["model"] == client.upload_model(arm)
    for field in ("joint_names", "lower_limits", "upper_limits", "tip_frame"):
        assert result.document["robot"][field] == local.document["robot"][field]
    np.testing.assert_array_equal(result.volume.count, local.volume.count)


def test_progress_events_and_lists(client):
    job = client.submit({**QUICK, "sampling": {"method": "sobol", "count": 5000}}, labels={"kind": "followed"})
    events = list(job.events())
    states = [event["data"]["state"] for event in events if event["type"] == "state"]
    assert states[0] == "queued"
    assert states[-1] == "succeeded"
    ids = [int(event["id"]) for event in events]
    assert ids == sorted(set(ids))
    assert [event["id"] for event in job.events(after=str(ids[-2]))] == [str(ids[-1])]
    assert job.refresh().progress["fraction"] == 1
    assert job.progress["samples_done"] == 5000
    assert [found.id for found in client.jobs(label=("kind", "followed"))] == [job.id]


def test_wrong_documents_raise_what_a_local_run_raises(client):
    for wrong in ({**QUICK, "robot": "ur5ee"}, {**QUICK, "precision": "float16"}, {**QUICK, "indices": ["nope"]}):
        with pytest.raises(ws.InputError) as remote:
            client.submit(wrong)
        with pytest.raises(ws.InputError) as local:
            ws.execute(wrong)
        # An index registered in this process is none of the server's: the lists of what is allowed may differ.
        assert remote.value.message.partition("allowed:")[0] == local.value.message.partition("allowed:")[0]
    with pytest.raises(ws.NotFoundError):
        client.job("0" * 32)


def test_fault_found_by_a_worker_is_raised_by_result(client):
    job = client.submit({**QUICK, "tip": "no_such_site"}).wait(timeout=PATIENCE_S)
    assert job.state == "failed"
    with pytest.raises(ws.FrameNotFoundError, match="no_such_site"):
        job.result()


def test_catalogues(client):
    assert {"workspace", "indices_at"} <= {analysis["id"] for analysis in client.analyses()}
    assert "ur5e" in {robot["name"] for robot in client.robots()}
    assert client.estimate(QUICK)["samples"] == 4096


def test_command_line_submits_and_downloads(server, capfd, tmp_path, quick_local):
    def wsrender(*arguments):
        with pytest.raises(SystemExit) as ended:
            main([*arguments, "--server", server.url])
        written = capfd.readouterr()
        assert (ended.value.code, written.err) == (0, "")
        return written.out

    document = tmp_path / "job.json"
    document.write_text(json.dumps(QUICK))
    out = wsrender("submit", str(document), "--wait", "-o", str(tmp_path / "a"), "--label", "kind=typed")
    job_id = out.split()[0]
    assert str(tmp_path / "a/volume.vtkhdf") in out
    assert_same_files(tmp_path / "a", quick_local[1])
    assert job_id in wsrender("jobs", "list")
    assert json.loads(wsrender("jobs", "show", job_id))["labels"] == {"kind": "typed"}
    wsrender("jobs", "download", job_id, "-o", str(tmp_path / "b"))
    assert_same_files(tmp_path / "b", quick_local[1])
