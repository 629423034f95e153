"""A data folder that another version of wsrender has filled."""

import os
from pathlib import Path

import pytest
import wsrender_kernels
import wsrender_server
from wsrender_server.local_server import LocalServer

import wsrender as ws
from tests.server.end_to_end.acceptance import LONG, PATIENCE_S, QUICK

OLD = "0.0.9"


@pytest.fixture
def old_version(tmp_path, monkeypatch):
    """A file: as long as it is there, every process that is started is of version 0.0.9."""
    site = tmp_path / "old/sitecustomize.py"
    site.parent.mkdir()
    site.write_text(f"import wsrender\nwsrender.__version__ = {OLD!r}\n")
    found = [str(Path(package.__file__).parents[1]) for package in (ws, wsrender_kernels, wsrender_server)]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(site.parent), *found]))
    monkeypatch.setenv("WSRENDER_SHARD_SAMPLES", str(2**18))
    return site


def test_results_of_another_version_stay_and_are_no_hits(tmp_path, old_version):
    with LocalServer(tmp_path / "data") as server, ws.Client(server.url) as client:
        job = client.submit(QUICK).wait(timeout=PATIENCE_S)
        assert job.record["version"] == OLD and job.record["warnings"] == []
        first = job.result()
        assert first.document["provenance"]["wsrender"] == OLD and len(first.sample.position) == 4096
        begun = client.submit(LONG)
        for event in begun.events():
            if event["type"] == "progress" and event["data"]["fraction"] > 0.2:
                break
    assert list((tmp_path / "data/partials").rglob("*.npz"))
    old_version.unlink()
    with LocalServer(tmp_path / "data") as server, ws.Client(server.url) as client:
        assert {each.id for each in client.jobs()} == {job.id, begun.id}
        old = client.job(job.id)
        (warning,) = old.record["warnings"]
        assert warning["code"] == "other_version" and OLD in warning["message"] and ws.__version__ in warning["message"]
        result = old.result()
        result.save(tmp_path / "out")
        assert result.document["warnings"][-1] == warning
        assert ws.Result.load(tmp_path / "out").document["artifacts"] == first.document["artifacts"]

        again = client.submit(QUICK)
        assert again.record["state"] == "queued" and again.record["version"] == ws.__version__
        document = again.wait(timeout=PATIENCE_S).result().document
        assert document["provenance"]["wsrender"] == ws.__version__
        assert "other_version" not in [each["code"] for each in document["warnings"]]
        assert client.submit(QUICK).record["state"] == "succeeded"  # a hit of this version

        provenance = client.job(begun.id).wait(timeout=PATIENCE_S).result().document["provenance"]
        assert provenance["wsrender"] == ws.__version__
