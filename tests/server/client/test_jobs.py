"""Jobs: waiting through restarts, events, results and their files."""

import hashlib

import httpx2
import numpy as np
import pytest
import trimesh

import wsrender as ws
from tests.results.export.sample_data import assert_same_map, assert_same_volume, random_map, random_volume
from tests.server.client.recorded_server import Lost, refuses, says, serves
from wsrender.results import export
from wsrender.results.result import Result
from wsrender.volume.table import Table

LOST = httpx2.ReadError("connection reset by peer")
REFUSED = httpx2.ConnectError("connection refused")
VOLUME = "/v1/jobs/j1/artifacts/volume.vtkhdf"


def record(state, **members):
    return {"id": "j1", "state": state, "analysis": "workspace", "error": None, **members}


@pytest.fixture(scope="module")
def local(tmp_path_factory):
    """A saved result: the object and its folder."""
    folder = tmp_path_factory.mktemp("local") / "out"
    result = Result(
        {"analysis": "workspace", "robot": {"name": "arm"}, "sampling": {"method": "sobol", "samples": 8}},
        map=random_map(50),
        sample=random_map(20),
        volume=random_volume((4, 3, 2)),
        skeleton=np.cumsum(np.ones((2, 5, 3)), axis=1),
        meshes={"surface": trimesh.creation.box()},
        tables={"scan": Table({"offset": np.arange(3.0), "V_s": np.ones(3)}, {"offset": "m", "V_s": "m^3"})},
        volumes={"left": random_volume((2, 2, 2))},
    )
    result.save(folder)
    return result, folder


@pytest.fixture
def finished(server, local):
    """A server with the finished job j1, whose result is the local one."""
    result, folder = local
    server.answer("GET", "/v1/jobs/j1", says(record("succeeded")))
    server.answer("GET", "/v1/jobs/j1/result", says(result.document))
    for artifact in result.document["artifacts"]:
        server.answer("GET", f"/v1/jobs/j1/artifacts/{artifact['name']}", serves(folder / artifact["name"]))
    return server


def test_wait_survives_a_restart(server, client, clock):
    running = record(
        "running", progress={"samples_done": 5, "samples_total": 10, "fraction": 0.5, "message": "samples"}
    )
    server.answer(
        "GET", "/v1/jobs/j1",
        says(record("queued")), says(running), LOST, *[REFUSED] * 20, refuses(503, "starting", retryable=True),
        says(running), says(record("succeeded")),
    )  # fmt: skip
    job = client.job("j1")
    assert job.wait(progress=True) is job
    assert (job.state, job.finished) == ("succeeded", True)
    polls = [dict(request.url.params) for request in server.requests[1:]]
    assert all(float(poll["wait"]) > 0 for poll in polls)
    for request, poll in zip(server.requests[1:], polls, strict=True):  # an answer that is held is no lost one
        assert request.extensions["timeout"]["read"] == pytest.approx(float(poll["wait"]) + 30)


@pytest.mark.parametrize("progress", [False, True])
def test_the_end_of_a_job_is_known_when_it_comes(progress, server, client, clock):
    """A server answers when there is an event newer than ``after``, else when the job has ended."""
    news = [(0.0, "queued"), (0.01, "running"), (0.05, "succeeded")]  # when, what

    def watched(request):
        asked = request.url.params
        wanted = int(asked["after"]) + 1 if "after" in asked else 2
        if "wait" in asked:
            clock.now = max(clock.now, news[wanted][0])
        number = max(k for k, (at, _) in enumerate(news) if at <= clock.now)
        return says(record(news[number][1], last_event=number))

    server.answer("GET", "/v1/jobs/j1", watched)
    assert client.job("j1").wait(progress=progress).state == "succeeded"
    assert len(server.requests) == (3 if progress else 2)
    assert progress or (clock.now, clock.pauses) == (0.05, [])


def test_wait_ends_with_its_timeout(server, client, clock):
    def slow(request):
        clock.now += float(request.url.params.get("wait", 0))
        return says(record("running"))

    server.answer("GET", "/v1/jobs/j1", slow)
    with pytest.raises(TimeoutError, match="job j1 is still running after 12 s"):
        client.job("j1").wait(timeout=12)
    assert clock.now == pytest.approx(12, abs=0.5)


def test_server_that_stays_away_ends_the_wait(server, client, clock):
    server.answer("GET", "/v1/jobs/j1", says(record("running")), REFUSED)
    with pytest.raises(ws.ServerConnectionError, match="lost the server"):
        client.job("j1").wait()
    assert 500 < clock.now <= 600


def test_server_that_never_holds_an_answer_is_not_flooded(server, client, clock):
    server.answer("GET", "/v1/jobs/j1", *[says(record("running"))] * 11, says(record("succeeded")))
    client.job("j1").wait()
    assert clock.now == pytest.approx(10 * 0.2)


@pytest.mark.parametrize(
    ("state", "error", "kind", "message"),
    [
        ("failed", {"code": "invalid_model", "detail": "robot: bad"}, ws.ModelError, "bad"),
        ("failed", {"code": "numerical_fault", "detail": "a σ is not finite"}, ws.NumericalError, "not finite"),
        ("failed", {"code": "not_converged", "detail": "no", "sequence": [1]}, ws.NotConvergedError, "no"),
        ("failed", {"code": "out_of_memory", "detail": "8 GiB"}, ws.JobFailedError, "8 GiB"),
        ("timed_out", None, ws.JobFailedError, "job j1 was timed out"),
        ("canceled", None, ws.JobFailedError, "job j1 was canceled"),
    ],
)
def test_jobs_without_a_result(server, client, state, error, kind, message):
    server.answer("GET", "/v1/jobs/j1", says(record(state, error=error)))
    with pytest.raises(kind, match=message) as caught:
        client.job("j1").result()
    assert caught.value.code == (error["code"] if error else state)


def test_result_is_that_of_a_local_run(finished, client, local):
    expected, _ = local
    result = client.job("j1").result()
    assert isinstance(result, ws.Result)
    assert result.document == expected.document
    assert len(finished.requests) == 2  # nothing is downloaded before it is used
    assert_same_map(result.map, expected.map)
    assert_same_map(result.sample, expected.sample)
    assert_same_volume(result.volume, expected.volume)
    np.testing.assert_array_equal(result.skeleton, expected.skeleton)
    assert result.volume is result.volume
    assert len(finished.requests) == 6
    assert result.plot.slice(z=0.6) is not None
    np.testing.assert_allclose(result.meshes["surface"].triangles, expected.meshes["surface"].triangles)
    np.testing.assert_array_equal(result.tables["scan"]["offset"], expected.tables["scan"]["offset"])
    assert_same_volume(result.volumes["left"], expected.volumes["left"])


def test_save_writes_what_a_local_run_writes(finished, client, local, tmp_path):
    _, folder = local
    client.job("j1").result().save(tmp_path / "out")
    names = {path.relative_to(folder) for path in folder.rglob("*") if path.is_file()}
    assert {path.relative_to(tmp_path / "out") for path in (tmp_path / "out").rglob("*") if path.is_file()} == names
    assert all((tmp_path / "out" / name).read_bytes() == (folder / name).read_bytes() for name in names)
    assert Result.load(tmp_path / "out").document == local[0].document


def test_save_with_more_formats_writes_them_here(finished, client, local, tmp_path):
    result = client.job("j1").result()
    result.save(tmp_path / "out", formats=("npz",))
    assert_same_volume(export.read_volume_npz(tmp_path / "out/volume.npz"), local[0].volume)
    assert "volume.npz" in [artifact["name"] for artifact in result.document["artifacts"]]


def test_failed_save_leaves_nothing(finished, client, tmp_path):
    finished.answer("GET", "/v1/jobs/j1/artifacts/surface.ply", refuses(404, "not_found", detail="gone"))
    with pytest.raises(ws.NotFoundError, match="gone"):
        client.job("j1").result().save(tmp_path / "out")
    assert list(tmp_path.iterdir()) == []


def test_without_h5py_and_pyarrow_npz_is_asked(finished, client, local, tmp_path, monkeypatch):
    expected, _ = local
    export.write_volume_npz(expected.volume, tmp_path / "volume.npz")
    export.write_table_npz(expected.sample, tmp_path / "sample.npz")
    finished.answer("GET", "/v1/jobs/j1/artifacts/volume.vtkhdf", serves(tmp_path / "volume.npz"))
    finished.answer("GET", "/v1/jobs/j1/artifacts/sample.parquet", serves(tmp_path / "sample.npz"))
    monkeypatch.setattr("wsrender.results.export.formats.find_spec", lambda package: None)
    result = client.job("j1").result()
    assert_same_volume(result.volume, expected.volume)
    assert_same_map(result.sample, expected.sample)
    assert [request.url.params["format"] for request in finished.requests[2:]] == ["npz", "npz"]


def test_what_was_converted_is_verified_by_its_tag(finished, client, tmp_path, monkeypatch):
    monkeypatch.setattr("wsrender.results.export.formats.find_spec", lambda package: None)
    finished.answer("GET", VOLUME, (200, {"ETag": f'"{hashlib.sha256(b"whole").hexdigest()}"'}, b"other"))
    with pytest.raises(ws.ServerError, match="another SHA-256 than the server says, in 2 attempts"):
        _ = client.job("j1").result().volume


def test_downloads_go_on_where_they_were(finished, client, local):
    expected, folder = local
    name = "volume.vtkhdf"
    size = (folder / name).stat().st_size
    finished.answer("GET", f"/v1/jobs/j1/artifacts/{name}", serves(folder / name, breaks=[700, 0, 900]))
    assert_same_volume(client.job("j1").result().volume, expected.volume)
    ranges = [request.headers.get("Range") for request in finished.sent("GET", f"/v1/jobs/j1/artifacts/{name}")]
    assert ranges == [None, "bytes=700-", "bytes=700-", "bytes=1600-"]
    assert size > 1600


def test_files_are_asked_for_with_the_key_and_as_they_are(finished, client):
    """What a proxy would compress on its way has neither the size nor the SHA-256 of the file."""
    assert client.job("j1").result().volume is not None
    assert {request.headers["Authorization"] for request in finished.requests} == {"Bearer secret"}
    assert {request.headers["User-Agent"] for request in finished.requests} == {f"wsrender/{ws.__version__}"}
    (file,) = (request for request in finished.requests if "/artifacts/" in request.url.path)
    assert file.headers["Accept-Encoding"] == "identity"


def test_a_download_goes_on_for_as_long_as_something_comes(finished, client, local, clock):
    """Patience is that for a server that is silent: each piece begins it anew."""
    expected, folder = local
    finished.answer("GET", VOLUME, serves(folder / "volume.vtkhdf", breaks=[20] * 40))
    assert_same_volume(client.job("j1").result().volume, expected.volume)
    assert clock.pauses == [0.1] * 40


def test_a_download_waits_for_a_server_that_starts_again(finished, client, local, clock):
    expected, folder = local
    starting = refuses(503, "starting", retryable=True, headers={"Retry-After": "3"})
    serving = serves(folder / "volume.vtkhdf", breaks=[700])
    finished.answer("GET", VOLUME, serving, REFUSED, starting, (502, {}, b"<html>bad gateway</html>"), serving)
    assert_same_volume(client.job("j1").result().volume, expected.volume)
    assert clock.pauses == pytest.approx([0.1, 0.2, 3, 0.8])
    assert finished.requests[-1].headers["Range"] == "bytes=700-"


def test_a_download_that_lost_only_its_end_is_whole(finished, client, local):
    """Nothing is left to ask for: the range begins where the file ends."""
    expected, folder = local
    content = (folder / "volume.vtkhdf").read_bytes()
    etag = f'"{hashlib.sha256(content).hexdigest()}"'
    nothing = refuses(416, "range_not_satisfiable", headers={"Content-Range": f"bytes */{len(content)}"})
    finished.answer("GET", VOLUME, (200, {"ETag": etag}, Lost(content)), nothing)
    assert_same_volume(client.job("j1").result().volume, expected.volume)
    assert finished.requests[-1].headers["Range"] == f"bytes={len(content)}-"


def test_a_result_document_goes_on_and_is_verified_too(finished, client, local, tmp_path):
    """It may be as long as a job document."""
    path, document = "/v1/jobs/j1/result", local[1] / "result.json"
    finished.answer("GET", path, serves(document, breaks=[100, 0, 200]))
    assert client.job("j1").result().document == local[0].document
    asked = [request.headers.get("Range") for request in finished.sent("GET", path)]
    assert asked == [None, "bytes=100-", "bytes=100-", "bytes=300-"]
    damaged = document.read_bytes().replace(b"workspace", b"workspade")
    finished.answer("GET", path, (200, {"ETag": f'"{hashlib.sha256(document.read_bytes()).hexdigest()}"'}, damaged))
    with pytest.raises(ws.ServerError, match="/result: what arrived has another SHA-256 than the server says"):
        client.job("j1").result()


def test_names_of_files_may_be_odd(server, client, tmp_path):
    """What stands for something in an address is written otherwise there."""
    name, content = "maps/left #1? 100%.csv", b"x\n1\n"
    record = {"name": name, "bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}
    server.answer("GET", "/v1/jobs/j1", says({"id": "j1", "state": "succeeded"}))
    server.answer("GET", "/v1/jobs/j1/result", says({"artifacts": [record]}))
    server.answer("GET", f"/v1/jobs/j1/artifacts/{name}", (200, {}, content))
    client.job("j1").download(tmp_path / "out")
    assert (tmp_path / "out" / name).read_bytes() == content
    assert server.requests[-1].url.query == b""


def test_progress_of_downloads_is_that_of_all_files(finished, client, local, tmp_path, monkeypatch):
    told = []
    shown = lambda _, total: lambda have: told.append((have, total))  # noqa: E731
    monkeypatch.setattr("wsrender.client.job_facts.Watched.on_bytes", shown)
    client.job("j1").download(tmp_path / "out", progress=True)
    sizes = [artifact["bytes"] for artifact in local[0].document["artifacts"]]
    assert told == [(sum(sizes[: k + 1]), sum(sizes)) for k in range(len(sizes))]


def test_file_that_changed_during_a_download_starts_anew(finished, client, local, tmp_path):
    expected, folder = local
    other = tmp_path / "volume.vtkhdf"
    other.write_bytes(bytes(5000))
    path = "/v1/jobs/j1/artifacts/volume.vtkhdf"
    finished.answer("GET", path, serves(other, breaks=[700]), serves(folder / "volume.vtkhdf"))
    assert_same_volume(client.job("j1").result().volume, expected.volume)
    assert [request.headers.get("Range") for request in finished.sent("GET", path)] == [None, "bytes=700-"]


def test_damaged_files_are_refused(finished, client, local, tmp_path):
    damaged = tmp_path / "volume.vtkhdf"
    damaged.write_bytes((local[1] / "volume.vtkhdf").read_bytes()[:-1] + b"?")
    path = "/v1/jobs/j1/artifacts/volume.vtkhdf"
    finished.answer("GET", path, serves(damaged))
    with pytest.raises(ws.ServerError, match="another SHA-256 than the server says, in 2 attempts"):
        _ = client.job("j1").result().volume
    assert len(finished.sent("GET", path)) == 2
    finished.answer("GET", path, serves(damaged), serves(local[1] / "volume.vtkhdf"))
    assert_same_volume(client.job("j1").result().volume, local[0].volume)


@pytest.mark.parametrize("name", ["../evil", "/etc/passwd", "a/../../b", "c:\\x", ""])
def test_names_that_leave_the_folder_are_refused(server, client, name):
    server.answer("GET", "/v1/jobs/j1", says(record("succeeded")))
    server.answer("GET", "/v1/jobs/j1/result", says({"artifacts": [{"name": name}]}))
    with pytest.raises(ws.InputError, match="is not the name of a file in the result folder"):
        client.job("j1").result()


def test_events_go_on_after_a_lost_connection(server, client):
    def stream(*ids):
        return "".join(f'id: {i}\nevent: progress\ndata: {{"n": {i}}}\n\n' for i in ids).encode()

    headers = {"Content-Type": "text/event-stream"}
    states = ["queued", "queued", "running", "running", "running", "succeeded"]
    server.answer("GET", "/v1/jobs/j1", *[says(record(state)) for state in states])
    server.answer(
        "GET", "/v1/jobs/j1/events",
        (200, headers, Lost(stream(1, 2))), REFUSED, (200, headers, stream(3)), (200, headers, stream(4)),
        (200, headers, b""),
    )  # fmt: skip
    events = list(client.job("j1").events())
    assert [(event["id"], event["type"], event["data"]) for event in events] == [
        (str(i), "progress", {"n": i}) for i in (1, 2, 3, 4)
    ]
    seen = [request.headers.get("Last-Event-ID") for request in server.sent("GET", "/v1/jobs/j1/events")]
    assert seen == [None, "2", "2", "3", "4"]
