"""Interactive sessions through a real server: answers, replaced questions, limits, keys, and pages that misbehave."""

import base64
import contextlib
import json
import struct
import time
from contextlib import contextmanager

import httpx2
import numpy as np
import psutil
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect
from wsrender_server.local_server import LocalServer

import wsrender as ws
from tests.server.end_to_end.acceptance import QUICK
from tests.server.jobs.waiting import wait_until, within
from wsrender.results.view import Edited
from wsrender.results.view.interactive import Interactive

ROBOT, EDITED = "/v1/robots/puma560/view/session", "/v1/robots:view/session"
VOLUME = {"ask": "volume", "robot": 0, "index": "manipulability", "samples": 1 << 14, "voxel_size_m": 0.1}
LONG = VOLUME | {"samples": 1 << 26}
AT = {"ask": "indices_at", "robot": 0, "q": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]}


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with LocalServer(tmp_path_factory.mktemp("data")) as server:
        yield server


@pytest.fixture(scope="module")
def job(server):
    """A finished job that keeps best samples: its id, and its result."""
    with ws.Client(server.url) as client:
        submitted = client.submit(QUICK | {"best_sample": "manipulability", "refined_volume": None})
        yield submitted.id, submitted.result()


def opened(server, path=ROBOT, **options):
    return connect(server.url.replace("http", "ws") + path, compression=None, max_size=None, **options)


def parts_of(message):
    (length,) = struct.unpack("<I", message[:4])
    header, at, blobs = json.loads(message[4 : 4 + length]), 4 + length, {}
    for each in header.pop("blobs"):
        blobs[each["name"]] = message[at : at + each["bytes"]]
        at += each["bytes"]
    assert at == len(message)
    return header, blobs


@contextmanager
def session(server, path=ROBOT, **options):
    """A session that is ready."""
    with opened(server, path, **options) as socket:
        ready, _ = parts_of(socket.recv(60))
        assert ready["answer"]["robots"]
        yield socket


@contextmanager
def placed(server):
    """A session that is ready, as soon as there is a place for it."""
    end = time.monotonic() + 60
    while True:
        with opened(server) as socket:
            if "answer" in parts_of(socket.recv(60))[0]:
                yield socket
                return
        assert time.monotonic() < end, "no place"
        time.sleep(0.05)


def asked(socket, number, question, patience_s=120.0):
    socket.send(json.dumps({"id": number, **question}))
    header, blobs = parts_of(socket.recv(patience_s))
    assert header["id"] == number
    return header, blobs


def ended(socket, patience_s=60.0):
    """What a refused session is told last, and its close code."""
    header = {}
    try:
        while True:
            header, _ = parts_of(socket.recv(patience_s))
    except ConnectionClosed as closed:
        return header, closed.rcvd.code


def children(server):
    """The processes of sessions: the server's own that stand behind jobs."""
    found = set()
    for each in psutil.Process(server.process.pid).children():
        with contextlib.suppress(psutil.NoSuchProcess):  # one of a session before has just ended
            found |= {each.pid} if each.nice() == 19 else set()
    return found


def gone(pids):
    wait_until(lambda: not any(map(psutil.pid_exists, pids)), 60, "the end of the process")


def test_answers_about_a_result_are_those_of_the_library(server, job):
    number, result = job
    local = Interactive.of_result(result)
    k = int(result.volume.voxels.count.argmax())
    voxel = {"ask": "voxel", "volume": "volume", "cell": result.volume.voxels.at[:, k].tolist()}
    with session(server, f"/v1/jobs/{number}/view/session") as socket:
        for n, question in enumerate((voxel, AT, VOLUME)):
            header, blobs = asked(socket, n, question)
            expected, expected_blobs = local.answer(question)
            for answer in (header["answer"], expected):
                answer.pop("elapsed_s", None)
            assert header["answer"] == expected
            assert blobs == expected_blobs
        q = asked(socket, 9, voxel)[0]["answer"]["q"]
    corner = (result.volume.voxels.at[:, k] + result.volume.first_voxel) * 0.1
    tip = ws.load_robot("ur5e").forward_kinematics(q)[0, :3, 3]
    assert (tip > corner - 1e-6).all()
    assert (tip < corner + 0.1 + 1e-6).all()


def test_a_later_question_of_its_kind_replaces_one_that_is_computed(server):
    with session(server) as socket:
        asked(socket, 0, VOLUME)  # kernels are there
        socket.send(json.dumps({"id": 1, **LONG}))
        time.sleep(0.3)
        for number in (2, 3):
            socket.send(json.dumps({"id": number, **LONG}))
        socket.send(json.dumps({"id": "last", **VOLUME}))
        told = {}
        with within(10):  # the long one takes much longer
            while "last" not in told:
                header, _ = parts_of(socket.recv(120))
                told[header["id"]] = header.get("refused", {}).get("code", "answered")
        assert told == {1: "replaced", 2: "replaced", 3: "replaced", "last": "answered"}
        socket.send(json.dumps({"id": 5, **LONG}))
        assert asked_beside(socket) == {6: "answered", 5: "answered"}  # of another kind: both are answered


def asked_beside(socket):
    socket.send(json.dumps({"id": 6, **AT}))
    told = {}
    while len(told) < 2:
        header, _ = parts_of(socket.recv(120))
        told[header["id"]] = header.get("refused", {}).get("code", "answered")
    return told


WRONG = [
    ("no JSON", None, "document"),
    ("[]", None, "request"),
    ('{"ask": "voxel"}', None, "id"),
    ('{"id": 1, "ask": "dance"}', 1, "ask"),
    ('{"id": 2, "ask": ["voxel"]}', 2, "ask"),
    ('{"id": 3, "ask": "indices_at", "q": [0]}', 3, "q"),
    ('{"id": 4, "ask": "indices_at", "q": [1e999]}', 4, "q.0"),
    ('{"id": 5, "ask": "voxel", "volume": "volume", "cell": [0, 0, -1]}', 5, "cell"),
    (json.dumps({"id": 6, **VOLUME, "limits": {"joint1": [1, 0]}}), 6, "limits.joint1"),
    (json.dumps({"id": 7, **VOLUME, "index": "<b>"}), 7, "index"),
    (json.dumps({"id": 8, **VOLUME, "voxel_size_m": 1e-5}), 8, "voxel_size_m"),
]


def test_a_wrong_question_is_refused_and_the_session_goes_on(server):
    with session(server) as socket:
        for text, number, field in WRONG:
            socket.send(text)
            header, _ = parts_of(socket.recv(60))
            assert (header["id"], header["refused"]["field"]) == (number, field), text
            assert header["refused"]["message"] and header["refused"]["code"]
        assert asked(socket, 99, AT)[0]["answer"]["position_m"]


def test_a_flood_ends_the_session_and_frees_its_process(server):
    before = children(server)
    with session(server) as socket:
        started = children(server) - before
        assert started
        with contextlib.suppress(ConnectionClosed):  # all may be on their way before the end is seen here
            for k in range(100_000):
                socket.send(json.dumps({"id": k, **LONG}))
        assert ended(socket)[1] == 1008
        gone(started)


def test_as_many_questions_a_second_as_a_fast_screen_has_pictures_are_taken(server):
    """120 at once are, and again in the next second; of more, some end the session."""
    with session(server) as socket:
        for _ in range(2):
            for k in range(120):
                socket.send(json.dumps({"id": k, "ask": "dance"}))
            for k in range(120):
                assert parts_of(socket.recv(60))[0]["id"] == k
            time.sleep(1.1)
        with contextlib.suppress(ConnectionClosed):
            for k in range(2000):  # more than 120 in a second, however busy the machine is
                socket.send(json.dumps({"id": k, "ask": "dance"}))
        header, code = ended(socket)
        assert (header["refused"]["code"], code) == ("too_fast", 1008)


def test_too_long_a_question_ends_the_session(server):
    with session(server) as socket:
        socket.send(" " * ((1 << 16) - 100) + json.dumps({"id": 1, **AT}).ljust(100))
        assert parts_of(socket.recv(60))[0]["answer"]
        socket.send(" " * ((1 << 16) + 1))
        header, code = ended(socket)
        assert (header["refused"]["code"], code) == ("message_too_large", 1009)


def test_a_page_that_is_gone_in_the_middle_frees_its_process(server):
    before = children(server)
    with session(server) as socket:
        started = children(server) - before
        asked(socket, 0, VOLUME)
        socket.send(json.dumps({"id": 1, **LONG}))
        time.sleep(0.2)
        socket.socket.shutdown(2)  # without a word
    gone(started)


def test_a_session_whose_process_is_killed_says_so(server):
    before = children(server)
    with session(server) as socket:
        for pid in children(server) - before:
            psutil.Process(pid).kill()
        header, code = ended(socket)
    assert (header["refused"]["code"], code) == ("crashed", 1011)
    assert "SIGKILL" in header["refused"]["message"]


def test_a_page_that_takes_nothing_in_frees_its_process(server):
    before = children(server)
    with session(server, max_queue=1) as socket:
        started = children(server) - before
        fine = VOLUME | {"samples": 1 << 10, "voxel_size_m": 0.012}  # some megabytes each
        end = time.monotonic() + 60
        with contextlib.suppress(ConnectionClosed):
            while any(map(psutil.pid_exists, started)) and time.monotonic() < end:
                socket.send(json.dumps({"id": 1, **fine}))
                time.sleep(0.2)
        gone(started)


def test_sessions_run_behind_jobs_and_are_few(server):
    gone(children(server))  # sessions of other tests, whose places are given back a moment later
    before = children(server)
    with contextlib.ExitStack() as sessions:
        for _ in range(4):
            sessions.enter_context(placed(server))
        started = children(server) - before
        assert len(started) == 4
        with opened(server) as fifth:
            header, code = ended(fifth)
        assert (header["refused"]["code"], code) == ("too_many_sessions", 1008)
    gone(started)


def test_memory_is_limited(tmp_path, monkeypatch):
    """What a small question takes is allowed; a large one ends the session while it is computed."""
    monkeypatch.setenv("WSRENDER_MAX_VIEW_SESSION_MEMORY_BYTES", str(420 * 2**20))
    with LocalServer(tmp_path) as server, session(server) as socket:
        asked(socket, 0, VOLUME)
        time.sleep(1.2)  # it is looked at twice
        assert asked(socket, 1, AT)[0]["answer"]["values"]
        socket.send(json.dumps({"id": 2, **LONG, "voxel_size_m": 0.0085}))
        header, code = ended(socket)
        assert (header["refused"]["code"], code) == ("out_of_memory", 1008)


@pytest.mark.parametrize("origin", ["http://evil.example", "http://[abc", "null"])
def test_pages_of_other_sites_are_refused(server, origin):
    with opened(server, origin=origin) as socket:
        header, code = ended(socket)
    assert (header["refused"]["code"], code) == ("wrong_origin", 1008)


def test_pages_of_this_host_may_connect(server):
    with session(server, origin="http://127.0.0.1:3000"):
        pass


@pytest.mark.parametrize(
    ("path", "code"),
    [("/v1/jobs/none/view/session", "not_found"), ("/v1/robots/nobody/view/session", "robot_not_found")],
)
def test_of_what_is_not_there_nothing_is_answered(server, path, code):
    with opened(server, path) as socket:
        header, closed = ended(socket)
    assert closed == 1008
    assert header["refused"]["code"] == code or header["refused"]["code"].endswith(code)


def test_keys(tmp_path):
    keys = tmp_path / "keys"
    secret = "a/secret=of,ann-12345"
    keys.write_text(f"{secret} ann read\n")
    with LocalServer(tmp_path / "data", ["--api-key-file", str(keys)]) as server:
        as_text = base64.urlsafe_b64encode(secret.encode()).decode().rstrip("=")
        with session(server, subprotocols=["wsrender.v1", f"wsrender.key64.{as_text}"]) as socket:
            assert socket.subprotocol == "wsrender.v1"
        with session(server, additional_headers={"Authorization": f"Bearer {secret}"}):
            pass
        for protocols in (["wsrender.v1"], ["wsrender.v1", "wsrender.key.nobody"], ["wsrender.v1", "wsrender.key64.a"]):
            with opened(server, subprotocols=protocols) as socket:
                header, code = ended(socket)
            assert code == 1008
            assert header["refused"]["code"] == "unauthorized" or "key" in header["refused"]["message"]


def test_a_robot_that_is_edited_is_asked_about_under_its_constraints(server):
    """Before there is a job: the answers are the library's, the voxels' size that of a job which does not say."""
    rows = [{"a": 0.5, "limits": [-2, 2]}, {"a": 0.3, "limits": [-2, 2]}, {"joint": "prismatic", "limits": [0, 0.2]}]
    dh = {"dh": {"convention": "standard", "rows": rows}}
    edited = {"robot": dh, "constraints": {"region": {"half_space": {"normal": [1, 0, 0]}}}}
    local = Interactive.of_edited(Edited(**edited))
    questions = [AT | {"q": [0.1, 0.2, 0.1]}, {name: VOLUME[name] for name in VOLUME if name != "voxel_size_m"}]
    with opened(server, EDITED) as socket:
        socket.send(json.dumps(edited))
        assert "answer" in parts_of(socket.recv(60))[0]
        for n, question in enumerate(questions):
            header, blobs = asked(socket, n, question)
            expected, expected_blobs = local.answer(question)
            for answer in (header["answer"], expected):
                answer.pop("elapsed_s", None)
            assert header["answer"] == expected
            assert blobs == expected_blobs
    free = Interactive.of_edited(Edited(robot=dh)).answer(questions[1])[0]
    assert expected["volume_m3"] < 0.8 * free["volume_m3"]
    sampling = {"method": "sobol", "count": VOLUME["samples"], "seed": 0}
    job = ws.analyze(dh, sampling, indices=["manipulability"], refined_volume=None, device="cpu")
    assert free["volume"]["voxel_size_m"] == job.volume.voxel_size_m


@pytest.mark.parametrize(
    ("first", "code"),
    [
        ("{", "invalid_document"),
        ('{"robot": {"library": "nobody"}}', "invalid_document"),
        ('{"robot": {"path": "/etc/passwd"}}', "invalid_document"),
        ('{"robot": {"model": "' + "0" * 64 + '"}}', "model_not_found"),
        ("{}", "invalid_input"),
    ],
)
def test_a_robot_that_is_none_is_refused(server, first, code):
    before = children(server)
    with opened(server, EDITED) as socket:
        socket.send(first)
        header, closed = ended(socket)
    assert closed == 1008
    assert header["refused"]["code"] == code, header
    gone(children(server) - before)


def test_the_messages_are_described(server):
    document = httpx2.get(f"{server.url}/v1/view-session/asyncapi.json", timeout=60).json()
    assert document["channels"]["job"]["address"] == "/v1/jobs/{id}/view/session"
    assert document["channels"]["edited"]["address"] == EDITED
    assert "edited" not in document["channels"]["job"]["messages"]
    assert {"voxel", "indices_at", "inverse", "postures", "placement", "volume", "answer"} <= set(
        document["components"]["schemas"]
    )
    text = json.dumps(document)
    for name in {part.split('"')[0] for part in text.split("#/components/schemas/")[1:]}:
        assert name in document["components"]["schemas"]
    assert np.isin(["id", "ask", "index"], document["components"]["schemas"]["volume"]["required"]).all()
