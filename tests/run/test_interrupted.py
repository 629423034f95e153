"""Ctrl-C during a run, or while a job is waited for, says what was kept."""

import pytest

import wsrender as ws
from wsrender.client.connection import Connection
from wsrender.client.job import Job

JOB = {
    "analysis": "workspace",
    "robot": "scara",
    "sampling": {"method": "sobol", "count": 5000},
    "voxel_size_m": 0.1,
    "indices": ["manipulability"],
}


def test_a_run_says_how_far_it_was():
    def press(done, total, message):
        if message == "samples" and done:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as stopped:
        ws.execute(JOB, press)
    (note,) = stopped.value.__notes__
    assert note == "samples, 5,000 of 5,000 done; nothing of this run was kept"


def test_a_waited_job_goes_on(monkeypatch):
    job = Job(Connection("http://127.0.0.1:9", None, 1.0, 1.0), {"id": "j1", "state": "running"})

    def press(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(job, "_poll", press)
    with pytest.raises(KeyboardInterrupt) as stopped:
        job.wait()
    assert stopped.value.__notes__ == ["the job goes on at the server; Client.job('j1') finds it"]
