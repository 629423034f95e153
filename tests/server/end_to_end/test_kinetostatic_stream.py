"""Live streams through a real server: forces, safety, limits, authentication, several clients."""

import json
import os
import signal
import time
from contextlib import contextmanager

import httpx2
import numpy as np
import psutil
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect
from wsrender_server.local_server import LocalServer
from wsrender_server.streams.sessions import MessageRate

import wsrender as ws
from wsrender.documents.kinetostatic_stream import Force, Opened, Statistics

ROBOT = "phantom_omni"
PATH = "/v1/kinetostatic-stream"
PATIENT = {"stale_after_s": 5.0}  # machines are shared: nothing here is about speed


@pytest.fixture(scope="module")
def arm():
    robot = ws.load_robot(ROBOT)
    q = (robot.lower_limits + robot.upper_limits) / 2
    q[0] = robot.upper_limits[0] - 0.02
    return robot, q


def settled(stream, samples=120, **sample):
    """The answer after so many samples: the force has risen."""
    for _ in range(samples):
        message = stream.exchange(**sample, timeout_s=60)
    return message


def raw(server, **options):
    return connect(server.url.replace("http", "ws") + PATH, compression=None, **options)


def received(socket, kind, patience_s=60.0):
    end = time.monotonic() + patience_s
    while time.monotonic() < end:
        message = json.loads(socket.recv(patience_s))
        if message["type"] == kind:
            return message
    raise TimeoutError(kind)


@contextmanager
def open_raw(server):
    with raw(server) as socket:
        socket.send(json.dumps({"type": "open", "robot": ROBOT, **PATIENT}))
        yield socket


def test_configurations_and_forces(client, arm):
    robot, q = arm
    expected = ws.force_field(robot)
    with client.kinetostatic_stream(ROBOT, **PATIENT) as stream:
        opened = Opened.model_validate(stream.opened)
        assert opened.joint_names == robot.joint_names
        assert opened.characteristic_length_m == pytest.approx(expected.length.length_m)
        assert opened.stiffness_bound_n_per_m == pytest.approx(1000)
        assert opened.enforced_stiffness_n_per_m < 1000
        message = settled(stream, configuration=q)
        force = Force.model_validate(message)
        assert force.state == "rendering"
        assert force.force_n == pytest.approx(expected.force(q), abs=1e-6)
        assert force.inverse_condition_number == pytest.approx(expected.evaluate(q).inverse_condition)
        assert force.position_m == pytest.approx(robot.forward_kinematics(q)[0][:3, 3])
        assert ("joint_limit", robot.joint_names[0]) in [(w.kind, w.joint) for w in force.warnings]
        assert 0 <= force.latency_s < 1
        assert 0 <= force.wait_s < 1
        assert np.linalg.norm(stream.force()) > 1
        asked = Statistics.model_validate(stream.ask_statistics(60))
        assert asked.samples == 120
    closed = Statistics.model_validate(stream.statistics)
    assert closed.type == "closed"
    assert closed.ticks >= closed.samples > 0
    assert closed.late_s["p50"] <= closed.late_s["max"]


def test_poses_are_solved_in_the_loop(client, arm):
    robot, q = arm
    place = robot.forward_kinematics(q)[0][:3, 3]
    goal = place + np.array([0.0, -0.01, 0.0])
    with client.kinetostatic_stream(ROBOT, input="pose", start=q.tolist(), **PATIENT) as stream:
        message = settled(stream, 5, position_m=goal)
        assert message["tracking_error_m"] < 1e-6
        assert message["position_m"] == pytest.approx(goal, abs=1e-6)
        clutched = settled(stream, 3, position_m=place, clutch=True)
        assert (clutched["state"], clutched["force_n"]) == ("clutched", [0, 0, 0])


def test_silence_ends_the_force_on_both_sides(client, arm):
    with client.kinetostatic_stream(ROBOT, stale_after_s=0.3) as stream:
        end = time.monotonic() + 60
        while not stream.force().any():  # on a busy machine samples may come later than that
            assert time.monotonic() < end
            stream.exchange(arm[1], timeout_s=60)
        while stream.receive(60)["state"] != "stale":
            pass
        assert stream.last["force_n"] == [0, 0, 0]
        assert not stream.force().any()


WRONG = {
    '{"type":"sample","sequence":1,"configuration":[NaN,0,0,0,0,0]}': "finite",
    '{"type":"sample","sequence":1,"configuration":[1e999,0,0,0,0,0]}': "finite",
    '{"type":"sample","sequence":1,"configuration":[0,0]}': "must have 6 values",
    '{"type":"sample","sequence":1,"position_m":[0,0,0]}': "configuration: is required",
    '{"type":"sample","sequence":-1,"configuration":[0,0,0,0,0,0]}': "sequence",
    '{"type":"dance"}': "type",
    "no JSON": "JSON",
    '{"type":"sample",\n"sequence":1,\n"configuration":[0]}': "must have 6 values",
}


def test_wrong_messages_end_the_force_and_not_the_stream(client, arm):
    with client.kinetostatic_stream(ROBOT, **PATIENT) as stream:
        for text, detail in WRONG.items():
            assert any(settled(stream, 20, configuration=arm[1])["force_n"])
            stream._socket.send(text)
            while (message := stream.receive(60))["state"] != "invalid_input":
                pass
            assert detail in message["detail"]
            assert message["force_n"] == [0, 0, 0]
        assert stream.ask_statistics(60)["refused"] == 5  # the other samples are well formed


@pytest.mark.parametrize("value", [1e307, -1e160, 1e7])
@pytest.mark.parametrize("kind", ["configuration", "pose"])
def test_values_of_no_use_end_the_force_and_not_the_stream(server, kind, value):
    with raw(server) as socket:
        socket.send(json.dumps({"type": "open", "robot": {"library": "phantom_omni"}, "input": kind}))
        received(socket, "opened")
        fields = {"configuration": [value] * 6} if kind == "configuration" else {"position_m": [value, 0, 0]}
        socket.send(json.dumps({"type": "sample", "sequence": 1, **fields}))
        while (force := received(socket, "force"))["state"] != "invalid_input":
            pass
        assert force["force_n"] == [0, 0, 0] and "1000000" in force["detail"]
        socket.send('{"type": "close"}')
        assert received(socket, "closed")["refused"] == 1


def test_several_clients_each_with_their_own_robot(client, arm):
    with (
        client.kinetostatic_stream(ROBOT, **PATIENT) as one,
        client.kinetostatic_stream("ur5e", **PATIENT, field={"form": "normalised"}) as other,
    ):
        assert any(settled(one, configuration=arm[1])["force_n"])
        assert other.exchange([0.1, -1.0, 1.0, 0.2, 0.5, 0.1], timeout_s=60)["force_n"] == [0, 0, 0]
        assert (one.opened["robot"], other.opened["robot"]) == (ROBOT, "ur5e")
        with pytest.raises(ws.QuotaError, match="you have 2 live streams"), client.kinetostatic_stream(ROBOT):
            pass
    with client.kinetostatic_stream(ROBOT, **PATIENT) as again:  # there is room again
        assert again.opened


def children(server):
    return {process.pid for process in psutil.Process(server.process.pid).children(recursive=True)}


def test_a_client_that_is_gone_takes_its_loop_along(server, arm):
    before = children(server)
    with open_raw(server) as socket:
        received(socket, "opened")
        started = children(server) - before
        assert started
        socket.socket.shutdown(2)  # without a word
    end = time.monotonic() + 60
    while any(psutil.pid_exists(pid) for pid in started):
        assert time.monotonic() < end, "the loop goes on"
        time.sleep(0.05)


def test_a_loop_that_is_killed_ends_its_stream_with_a_fault(server, client):
    before = children(server)
    with open_raw(server) as socket:
        received(socket, "opened")
        for pid in children(server) - before:
            os.kill(pid, signal.SIGKILL)
        fault = received(socket, "fault")
        assert fault["code"] == "crashed" and "SIGKILL" in fault["detail"]
        with pytest.raises(ConnectionClosed):
            socket.recv(60)
    assert client.robots()  # the server lives


def test_the_force_is_zero_where_the_server_is_gone(tmp_path, arm):
    with LocalServer(tmp_path) as server, ws.Client(server.url) as client:
        with client.kinetostatic_stream(ROBOT, **PATIENT) as stream:
            assert any(settled(stream, configuration=arm[1])["force_n"])
            server.kill_all()
            end = time.monotonic() + 60
            while stream.force().any():
                assert time.monotonic() < end
        assert stream.statistics == {}


def test_too_long_a_message_ends_the_stream(server):
    with open_raw(server) as socket:
        received(socket, "opened")
        socket.send(" " * 5000)
        assert received(socket, "fault")["code"] == "message_too_large"
        with pytest.raises(ConnectionClosed) as closed:
            socket.recv(60)
        assert closed.value.rcvd.code == 1009


def test_messages_are_counted_by_the_second():
    rate = MessageRate(3)
    assert [rate.exceeded(7.0 + 0.1 * k) for k in range(5)] == [False, False, False, True, True]
    assert not rate.exceeded(8.0)


@pytest.mark.parametrize(
    ("choices", "error", "message"),
    [
        ({"robot": "nobody"}, ws.InputError, "robot.library"),
        ({"robot": {"path": "arm.urdf"}}, ws.InputError, "arm.urdf cannot be read"),
        ({"robot": ROBOT, "field": {"form": "soft"}}, ws.DocumentError, "field.form"),
        ({"robot": ROBOT, "inputs": "pose"}, TypeError, "did you mean input"),
        ({"robot": ROBOT, "cues": {"viscosity": 2}}, ws.DocumentError, "cues.viscosity"),
        ({"robot": ROBOT, "input": "pose", "start": [0, 0]}, ws.InputError, "has shape"),
    ],
)
def test_what_cannot_be_opened_says_why(client, choices, error, message):
    with pytest.raises(error, match=message), client.kinetostatic_stream(**choices):
        pass


def test_a_path_is_not_opened_by_the_server(server):
    with raw(server) as socket:
        socket.send(json.dumps({"type": "open", "robot": {"path": "/etc/passwd"}}))
        fault = received(socket, "fault")
    assert fault["errors"] == [{"pointer": "#/robot/path", "detail": fault["errors"][0]["detail"]}]


def test_pages_of_other_sites_may_not_connect(server):
    for origin in ("http://evil.example", "http://[abc", "null"):
        with pytest.raises(InvalidStatus) as refused, raw(server, origin=origin):
            pass
        assert refused.value.response.status_code == 403
    with raw(server, origin="http://127.0.0.1:3000"):
        pass


def test_keys(tmp_path, arm):
    keys = tmp_path / "keys"
    keys.write_text("a-secret-of-ann-12345 ann\na-secret-of-bob-12345 bob read\n")
    with LocalServer(tmp_path / "data", ["--api-key-file", str(keys)]) as server:
        with ws.Client(server.url, "a-secret-of-ann-12345") as client, client.kinetostatic_stream(ROBOT) as stream:
            assert stream.opened["robot"] == ROBOT
        with (
            ws.Client(server.url, "a-secret-of-bob-12345") as client,
            pytest.raises(ws.AccessError, match="lacks the scope"),
            client.kinetostatic_stream(ROBOT),
        ):
            pass
        with (
            ws.Client(server.url) as client,
            pytest.raises(ws.AccessError, match="an API key is needed"),
            client.kinetostatic_stream(ROBOT),
        ):
            pass
        # As a browser does, which cannot set headers.
        with raw(server, subprotocols=["wsrender.v1", "wsrender.key.a-secret-of-ann-12345"]) as socket:
            assert socket.subprotocol == "wsrender.v1"
            socket.send(json.dumps({"type": "open", "robot": ROBOT}))
            assert received(socket, "opened")
        unknown = ["wsrender.v1", "wsrender.key.nobody"]
        with pytest.raises(InvalidStatus) as refused, raw(server, subprotocols=unknown):
            pass
        assert refused.value.response.status_code == 401


def test_the_messages_are_described(server):
    document = httpx2.get(f"{server.url}{PATH}/asyncapi.json", timeout=60).json()
    assert document["asyncapi"] == "3.0.0"
    assert document["channels"]["stream"]["address"] == PATH
    assert {"StreamOpen", "Sample", "Force", "Opened", "Fault"} <= set(document["components"]["messages"])
    text = json.dumps(document)
    for name in {part.split('"')[0] for part in text.split("#/components/schemas/")[1:]}:
        assert name in document["components"]["schemas"]
