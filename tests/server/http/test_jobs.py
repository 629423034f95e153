"""Jobs as resources: look, wait, list, cancel, retry, delete, follow."""

import base64
import json
import threading
import time

import pytest

from tests.server.http.idle_server import DOCUMENT, problem_of


def events_of(response):
    """(id, type, data) of every event of a finished stream."""
    assert response.headers["content-type"].startswith("text/event-stream")
    blocks = [block for block in response.text.split("\n\n") if block and not block.startswith(":")]
    fields = [dict(line.split(": ", 1) for line in block.splitlines()) for block in blocks]
    return [(int(field["id"]), field["event"], json.loads(field["data"])) for field in fields]


@pytest.mark.parametrize(
    ("method", "path"),
    [
        (method, f"/v1/jobs/{id}{rest}")
        for id in ("0" * 32, "..%2f..%2fetc", "x", "%00")
        for method, rest in (
            ("GET", ""), ("DELETE", ""), ("POST", ":cancel"), ("POST", ":retry"), ("GET", "/events"),
            ("GET", "/result"), ("GET", "/artifacts"), ("GET", "/artifacts/result.json"), ("GET", "/volume/slice"),
            ("GET", "/plots/robot"),
        )
    ],
)  # fmt: skip
def test_what_is_not_there(client, method, path):
    response = client.request(method, path)
    assert response.status_code in (404, 422)
    problem_of(response, response.status_code)


def test_a_queued_job_says_what_it_waits_for(client, submit, jobs):
    jobs.waits_for = "waiting for a worker with {}".format
    job = submit(device="cuda")
    path = f"/v1/jobs/{job['id']}"
    views = [job, client.get(path).json(), client.get("/v1/jobs").json()["items"][0]]
    assert {view["progress"]["message"] for view in views} == {"waiting for a worker with cuda"}
    jobs.begin(job["id"])
    assert client.get(path).json()["progress"]["message"] == "samples"


def test_waiting_ends_with_the_job(client, submit, jobs, result_folder):
    job = submit()
    started = time.monotonic()
    threading.Timer(0.5, jobs.complete, (job["id"], result_folder)).start()
    found = client.get(f"/v1/jobs/{job['id']}", params={"wait": 60}).json()
    assert found["state"] == "succeeded" and found["progress"]["fraction"] == 1 and found["finished_at"]
    assert 0.5 <= time.monotonic() - started < 60


def test_waiting_ends_in_time(client, submit):
    job = submit()
    started = time.monotonic()
    assert client.get(f"/v1/jobs/{job['id']}", params={"wait": 0.3}).json()["state"] == "queued"
    assert 0.3 <= time.monotonic() - started < 60


def test_a_status_says_whether_what_was_waited_for_has_come(client, submit, jobs, result_folder):
    path = f"/v1/jobs/{submit()['id']}"
    assert [client.get(path, params=wait).status_code for wait in ({}, {"wait": 0}, {"wait": 0.1})] == [200, 200, 202]
    jobs.begin(path.rpartition("/")[2], 32)
    jobs.complete(path.rpartition("/")[2], result_folder)
    assert client.get(path, params={"wait": 60}).status_code == 200


def test_a_submission_waits_for_its_job(client, jobs, result_folder):
    open_yet = client.post("/v1/jobs", json=DOCUMENT, params={"wait": 0.2})
    first = open_yet.json()
    assert (open_yet.status_code, first["state"]) == (202, "queued") and "Retry-After" in open_yet.headers
    timer = threading.Timer(0.5, jobs.complete, (first["id"], result_folder))
    timer.start()
    ended = client.post("/v1/jobs", json=DOCUMENT, params={"wait": 60})  # an equal one, of the same computation
    timer.join()
    assert (ended.status_code, ended.json()["state"]) == (200, "succeeded") and "Retry-After" not in ended.headers
    assert ended.json()["id"] != first["id"] and client.get(open_yet.headers["Location"]).json()["state"] == "succeeded"
    for wrong in ("-1", "61", "nan", "soon"):
        problem_of(client.post("/v1/jobs", json=DOCUMENT, params={"wait": wrong}), 422, "invalid_request")


def test_waiting_for_news(client, submit, jobs):
    job = submit()
    threading.Timer(0.3, jobs.begin, (job["id"], 16)).start()
    found = client.get(f"/v1/jobs/{job['id']}", params={"wait": 60, "after": job["last_event"]}).json()
    assert found["state"] == "running" and found["last_event"] > job["last_event"]
    problem_of(client.get(f"/v1/jobs/{job['id']}", params={"wait": 1e9}), 422, "invalid_request")


def test_events_are_replayed(client, submit, jobs, result_folder):
    job = submit()
    jobs.begin(job["id"], 32)
    jobs.complete(job["id"], result_folder)
    path = f"/v1/jobs/{job['id']}/events"
    seen = events_of(client.get(path))
    assert [data["state"] for _, kind, data in seen if kind == "state"] == ["queued", "running", "succeeded"]
    assert [data["samples_done"] for _, kind, data in seen if kind == "progress"] == [32]
    assert [number for number, _, _ in seen] == sorted({number for number, _, _ in seen})
    assert events_of(client.get(path, headers={"Last-Event-ID": str(seen[1][0])})) == seen[2:]
    assert events_of(client.get(path, headers={"Last-Event-ID": "999"})) == []
    problem_of(client.get(path, headers={"Last-Event-ID": "x"}), 422, "invalid_request")


def test_events_arrive_as_they_happen(client, submit, jobs, result_folder):
    job = submit()

    def happen():  # in this order, however busy the machine is
        jobs.begin(job["id"], 8)
        time.sleep(0.5)
        jobs.complete(job["id"], result_folder)

    threading.Timer(0.3, happen).start()
    seen = events_of(client.get(f"/v1/jobs/{job['id']}/events"))
    assert [data["state"] for _, kind, data in seen if kind == "state"] == ["queued", "running", "succeeded"]


def test_a_failure_is_a_problem_document(client, submit, jobs):
    job = submit()
    error = {"code": "frame_not_found", "message": "tip: no such", "retryable": False, "field": "tip"}
    jobs.fail(job["id"], error)
    found = client.get(f"/v1/jobs/{job['id']}").json()
    assert found["state"] == "failed" and found["error"]["code"] == "frame_not_found"
    assert found["error"]["errors"][0]["pointer"] == "#/tip" and found["error"]["retryable"] is False
    assert events_of(client.get(f"/v1/jobs/{job['id']}/events"))[-1][2]["error"] == {
        name: value for name, value in found["error"].items() if value is not None
    }
    problem_of(client.get(f"/v1/jobs/{job['id']}/result"), 409, "no_result")


def test_cancel_retry_delete(client, submit):
    path = f"/v1/jobs/{submit()['id']}"
    problem_of(client.delete(path), 409, "invalid_transition")
    assert client.post(f"{path}:cancel").json()["state"] == "canceled"
    problem_of(client.post(f"{path}:cancel"), 409, "invalid_transition")
    retried = client.post(f"{path}:retry").json()
    assert (retried["state"], retried["attempt"]) == ("queued", 2)
    problem_of(client.post(f"{path}:retry"), 409, "invalid_transition")
    client.post(f"{path}:cancel")
    gone = client.delete(path)
    assert (gone.status_code, gone.content) == (204, b"")
    problem_of(client.get(path), 404, "job_not_found")


def test_lists_are_filtered_and_paged(client, submit):
    ids = [submit(voxel_size_m=0.1 + k, labels={"study": "a" if k else "b"})["id"] for k in range(4)]
    client.post(f"/v1/jobs/{ids[0]}:cancel")
    pages, cursor = [], None
    while True:
        page = client.get("/v1/jobs", params={"limit": 3} | ({"cursor": cursor} if cursor else {})).json()
        pages.append([job["id"] for job in page["items"]])
        cursor = page["next_cursor"]
        if cursor is None:
            break
    assert pages == [ids[:0:-1], ids[:1]]
    for query, expected in (
        ({"state": "canceled"}, ids[:1]),
        ({"label": "study=b"}, ids[:1]),
        ({"label": "study=a", "state": "queued"}, ids[:0:-1]),
        ({"analysis": "indices_at"}, []),
        ({"analysis": "workspace", "limit": 1}, ids[3:]),
        ({"robot": "CAR", "label": "study=b"}, ids[:1]),
        ({"robot": "ur5e"}, []),
    ):
        assert [job["id"] for job in client.get("/v1/jobs", params=query).json()["items"]] == expected
    assert {tuple(job["robots"]) for job in client.get("/v1/jobs").json()["items"]} == {("scara",)}
    wrong = ({"state": "x"}, {"limit": 0}, {"limit": 201}, {"label": "x"}, {"analysis": "x"}, {"cursor": "a%b"})
    for query in (*wrong, {"robot": ""}, {"robot": "a\0"}, {"robot": "x" * 101}):
        (fault,) = problem_of(client.get("/v1/jobs", params=query), 422)["errors"]
        assert fault["pointer"] in query
    for text in (b"abc", b"1.", b"1.\0", b"x." + b"0" * 32, b"9" * 40 + b"." + b"0" * 32, b"1." + b"0" * 31 + b"\n"):
        cursor = base64.urlsafe_b64encode(text).decode().rstrip("=")
        problem_of(client.get("/v1/jobs", params={"cursor": cursor}), 404, "unknown_cursor")


def test_queue_counts_jobs(client, submit, jobs):
    submit()
    jobs.begin(submit(voxel_size_m=0.2)["id"])
    queue = client.get("/v1/queue").json()
    assert (queue["jobs"]["queued"], queue["jobs"]["running"]) == (1, 1)
    assert (queue["waiting"], queue["running"]) == (1, 1) and queue["oldest_queued_at"]
