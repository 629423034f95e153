"""Deleting a job while its files are read: what has begun to arrive arrives whole, anything else is not found."""

import hashlib
import socket
import threading

import pytest
import uvicorn
from wsrender_server.app import create_app

from tests.server.http.idle_server import problem_of
from tests.server.jobs.documents import canonical

LARGE = 64 * 2**20  # bytes: more than sockets hold
NAME = "surface.ply"


@pytest.fixture
def large_result(tmp_path):
    """A result folder with a large file, and the SHA-256 of that."""
    folder = tmp_path / "large"
    folder.mkdir()
    (folder / "result.json").write_text("{}")
    content = hashlib.shake_256(b"wsrender").digest(LARGE)
    (folder / NAME).write_bytes(content)
    return folder, hashlib.sha256(content).hexdigest()


@pytest.fixture
def port(settings, jobs):
    """Port of a server with real sockets."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        server = uvicorn.Server(uvicorn.Config(create_app(settings, jobs), log_config=None))
        thread = threading.Thread(target=server.run, args=([listener],))
        thread.start()
        yield listener.getsockname()[1]
        server.should_exit = True
        thread.join()


def test_a_slow_download_survives_the_deletion(port, jobs, large_result):
    folder, sha256 = large_result
    job = jobs.store.submit("local", canonical()).job.id
    jobs.complete(job, folder)
    with socket.create_connection(("127.0.0.1", port), timeout=60) as slow:
        request = f"GET /v1/jobs/{job}/artifacts/{NAME} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n"
        slow.sendall(request.encode())
        received = slow.recv(1024)
        assert received.startswith(b"HTTP/1.1 200")
        jobs.store.delete("local", job)
        assert not list((jobs.store.files.root / "results").iterdir())
        while piece := slow.recv(1 << 20):
            received += piece
    assert hashlib.sha256(received.partition(b"\r\n\r\n")[2]).hexdigest() == sha256


@pytest.mark.parametrize(
    "rest", ["/result", "/artifacts/map.parquet", "/artifacts/map.parquet?format=npz", "/volume/slice"]
)
def test_a_file_that_is_deleted_before_it_is_opened_is_not_found(client, jobs, finished, rest):
    """The moment between looking into the table and opening the file."""
    for path in (jobs.store.files.root / "results").rglob("*"):
        if path.is_file():
            path.unlink()
    problem_of(client.get(finished + rest), 404, "artifact_not_found")


def test_plots_of_a_file_that_is_deleted_are_not_found(client, jobs, finished, monkeypatch):
    document = jobs.store.result_document("local", finished.rpartition("/")[2])
    monkeypatch.setattr(jobs.store, "result_document", lambda *_: document)
    test_a_file_that_is_deleted_before_it_is_opened_is_not_found(client, jobs, finished, "/plots/histogram")


def test_a_result_whose_files_are_lost_is_expired_and_computed_again(client, jobs, finished, submit, result_folder):
    """From the first look at a lost file on, the job says so; a retry makes it whole."""
    for path in (jobs.store.files.root / "results").rglob("*"):
        if path.is_file():
            path.write_bytes(path.read_bytes()[::-1])
    problem_of(client.get(f"{finished}/artifacts/map.parquet"), 404, "artifact_not_found")
    job = client.get(finished).json()
    assert job["state"] == "expired" and job["error"]["code"] == "result_expired" and job["error"]["retryable"]
    assert [each["id"] for each in client.get("/v1/jobs?state=expired").json()["items"]] == [job["id"]]
    for rest in ("/result", "/artifacts", "/artifacts/map.parquet", "/view", "/plots/histogram"):
        problem = problem_of(client.get(finished + rest), 409, "result_expired")
        assert "map.parquet" in problem["detail"] and "retry the job" in problem["detail"]
    assert submit()["state"] == "queued"
    assert client.post(f"{finished}:retry").json()["state"] == "queued"
    jobs.complete(job["id"], result_folder)
    assert client.get(finished).json()["error"] is None
    assert client.get(f"{finished}/artifacts/map.parquet").content == (result_folder / "map.parquet").read_bytes()
