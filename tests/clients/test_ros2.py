"""The callback of the ROS 2 node, against a stub of rclpy and a server: ROS itself is not here."""

import importlib.util
import json
import sys
import threading
import types
from pathlib import Path

import pytest
from wsrender_server.local_server import LocalServer

NODE = Path(__file__).parent.parent.parent / "clients" / "ros2" / "wsrender_node.py"
JOB = {"analysis": "indices_at", "robot": {"library": "ur5e"}, "configurations": [[0, -1.5, 1.5, 0, 1, 0]]}
LONG = {"analysis": "workspace", "robot": {"library": "ur5e"}, "sampling": {"method": "sobol", "count": 10**10}}


class Goal:
    """What rclpy hands to a callback, as far as the node uses it."""

    def __init__(self, document, cancel_at=None):
        self.request = types.SimpleNamespace(document=document)
        self.is_cancel_requested = False
        self.ends, self.told = [], []
        self._cancel_at = cancel_at

    def publish_feedback(self, feedback):
        self.told.append(feedback)
        self.is_cancel_requested = len(self.told) == self._cancel_at or self.is_cancel_requested

    def succeed(self):
        self.ends.append("succeeded")

    def canceled(self):
        self.ends.append("canceled")

    def abort(self):
        self.ends.append("aborted")


@pytest.fixture(scope="module")
def node(tmp_path_factory):
    with LocalServer(tmp_path_factory.mktemp("data")) as server, pytest.MonkeyPatch.context() as patch:
        for name, module in stub(server.url).items():
            patch.setitem(sys.modules, name, module)
        spec = importlib.util.spec_from_file_location("wsrender_node", NODE)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        node = module.WsrenderNode()
        yield node
        node.client.close()


def stub(url):
    """Modules of rclpy with the names that the node imports, and of the action, whose fields are the file's."""

    class Node:
        def __init__(self, name):
            self.name = name

        def declare_parameter(self, name, value):
            return types.SimpleNamespace(value=url if name == "server" else value)

    class Any:
        ACCEPT = 1

        def __init__(self, *places, **names):
            self.names = names

    goal, result, feedback = (
        [line.split()[:2] for line in part.strip().splitlines()]
        for part in (NODE.parent / "action" / "RunJob.action").read_text().split("---")
    )
    assert goal == [["string", "document"]]

    def message(fields):
        kinds = {name: {"string": str, "float64": float}[kind] for kind, name in fields}

        class Message:
            __slots__ = tuple(kinds)

            def __init__(self):
                for name, kind in kinds.items():
                    super().__setattr__(name, kind())

            def __setattr__(self, name, value):
                assert type(value) is kinds[name], (name, value)
                super().__setattr__(name, value)

        return Message

    action = types.SimpleNamespace(Result=message(result), Feedback=message(feedback))
    names = {
        "rclpy": {},
        "rclpy.action": {"ActionServer": Any, "CancelResponse": Any},
        "rclpy.callback_groups": {"ReentrantCallbackGroup": Any},
        "rclpy.executors": {"MultiThreadedExecutor": Any},
        "rclpy.node": {"Node": Node},
        "wsrender_ros": {},
        "wsrender_ros.action": {"RunJob": action},
    }
    modules = {name: types.ModuleType(name) for name in names}
    for name, values in names.items():
        vars(modules[name]).update(values)
    return modules


def test_a_job(node):
    goal = Goal(json.dumps(JOB))
    result = node.execute(goal)
    assert goal.ends == ["succeeded"] and not result.problem
    assert json.loads(result.result)["analysis"] == "indices_at" and len(result.job) == 32


def test_cancel_while_it_runs(node):
    goal = Goal(json.dumps(LONG), cancel_at=1)
    result = node.execute(goal)
    assert goal.ends == ["canceled"] and not result.result
    assert goal.told and 0 <= goal.told[0].fraction < 1
    assert node.client.job(result.job).state == "canceled"


@pytest.mark.parametrize(("document", "words"), [('{"analysis": "workspace"}', "robot"), ("{", "line 1")])
def test_refused(node, document, words):
    goal = Goal(document)
    result = node.execute(goal)
    assert goal.ends == ["aborted"] and words in result.problem and not result.result


def test_canceled_by_another(node):
    goal = Goal(json.dumps(LONG))
    ended = []
    thread = threading.Thread(target=lambda: ended.append(node.execute(goal)))
    thread.start()
    while not goal.told:
        thread.join(0.1)
    (job,) = [each for each in node.client.jobs(analysis="workspace") if not each.finished]
    job.cancel()
    thread.join(100)
    assert goal.ends == ["aborted"] and json.loads(ended[0].problem)["code"] == "canceled"
