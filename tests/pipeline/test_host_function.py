"""Constraints that a Python function decides: in this process alone."""

import json

import numpy as np
import pytest

import wsrender as ws
from tests.server.http.conftest import client, jobs, settings  # noqa: F401
from tests.server.http.idle_server import problem_of
from wsrender import cli
from wsrender.errors import InputError
from wsrender.pipeline.constraints import registry

COUNT = 1 << 14
JOB = {
    "analysis": "workspace",
    "robot": {"library": "ur5e"},
    "sampling": {"method": "sobol", "count": COUNT},
    "constraints": {"striped": {"width": 0.25}},
    "indices": ["manipulability"],
    "refined_volume": None,
}


def striped(q, poses, width=0.5):
    """What no expression says: stripes, by NumPy's own functions."""
    assert q.shape[1:] == (6,) and poses.shape[1:] == (4, 4) and q.dtype == poses.dtype == np.float64
    return np.floor(poses[:, 0, 3] / width).astype(int) % 2 == 0


@pytest.fixture
def added(monkeypatch):
    """Constraints that the test adds, and forgets."""
    monkeypatch.setattr(registry, "_ADDED", {})
    ws.register_constraint("striped", striped, on_host=True)


def expected(samples, width=0.25):
    x = samples.map.position[:, 0]
    return np.floor(x / width).astype(int) % 2 == 0, np.abs(x / width - np.round(x / width)) > 1e-4


def test_samples_are_those_that_the_function_admits(precision, device, added):
    options = {"precision": precision, "device": device}
    every = ws.execute({**JOB, **options, "constraints": None, "keep_map": True})
    admitted, sure = expected(every)
    result = ws.execute({**JOB, **options, "keep_map": True})
    assert abs(result.document["samples"]["admitted"] - admitted.sum()) <= (~sure).sum() < 0.01 * COUNT
    assert set(result.document["samples"]["rejected"]) == {"striped"}
    assert expected(result)[0][expected(result)[1]].all()
    for threads in (1, 3):
        again = ws.execute({**JOB, **options}, threads=threads, chunk_size=2048)
        assert again.document["samples"]["rejected"] == result.document["samples"]["rejected"]


def test_parts_of_a_chunk_are_asked_one_after_the_other(monkeypatch, added):
    whole = ws.execute({**JOB, "keep_map": True}, chunk_size=4096, threads=1)
    monkeypatch.setattr("wsrender.engine.host_labels.AT_A_TIME", 1000)
    parts = ws.execute({**JOB, "keep_map": True}, chunk_size=4096, threads=1)
    assert np.array_equal(parts.map.position, whole.map.position)


def test_it_is_asked_after_those_before_it(device, added):
    """A sample counts under the first constraint that it violates, beside shapes and expressions too."""
    ws.register_constraint("also", lambda q, poses: q[:, 0] > -3.0, on_host=True)
    ws.register_constraint("traced", lambda q, position, axes: q[1] + 1.0)
    floor = {"half_space": {"point_m": [0, 0, 0.2]}}
    choice = {"region": floor, "striped": True, "traced": True, "also": True, "self_collision": True}
    free = {"region": floor, "self_collision": True}
    options = {"robot": "ur5e", "configurations": np.random.default_rng(0).uniform(-6, 6, (3000, 6)), "device": device}
    alone = ws.indices_at(**options, constraints=free).tables["admission"].columns["reason"]
    reasons = ws.indices_at(**options, constraints=choice).tables["admission"].columns["reason"]
    q = options["configurations"]
    poses = ws.load_robot("ur5e").forward_kinematics(q)
    names = [("also", q[:, 0] <= -3.0), ("striped", ~striped(q, poses)), ("traced", q[:, 1] < -1)]
    want = alone.astype("U20")
    for name, violated in names:
        want = np.where((want == "") & violated, name, want)
    np.testing.assert_array_equal(reasons, want)
    assert set(reasons) == {"", "region", "self_collision", "also", "striped", "traced"}


def test_a_wrong_answer_is_refused(added):
    ws.register_constraint("odd", lambda q, poses: q[:, 0], on_host=True)
    with pytest.raises(
        InputError, match=r"constraints\.odd: its function must give whether each of .* bool, not float64"
    ):
        ws.execute({**JOB, "constraints": {"odd": True}})
    with pytest.raises(InputError, match=r"constraints\.striped\.height: unknown option; allowed: width"):
        ws.execute({**JOB, "constraints": {"striped": {"height": 1}}})
    with pytest.raises(InputError, match="an identifier other than"):
        ws.register_constraint("region", striped, on_host=True)


def test_what_a_function_raises_is_told(added):
    ws.register_constraint("broken", lambda q, poses: q[:, 9] > 0, on_host=True)
    with pytest.raises(InputError, match=r"constraints\.broken: its function raised IndexError: index 9"):
        ws.execute({**JOB, "constraints": {"broken": True}})


@pytest.mark.parametrize(
    ("name", "function", "keeps", "field"),
    [
        (3, striped, frozenset(), "name"),
        (None, striped, frozenset(), "name"),
        ("", striped, frozenset(), "name"),
        ("a\n", striped, frozenset(), "name"),
        ("odd", 7, frozenset(), "function"),
        ("odd", striped, None, "keeps"),
        ("odd", striped, "base_joint", "keeps"),
        ("odd", striped, [["base_joint"]], "keeps"),
    ],
)
@pytest.mark.parametrize("on_host", [True, False])
def test_what_cannot_be_registered(name, function, keeps, field, on_host, added):
    with pytest.raises(InputError) as caught:
        ws.register_constraint(name, function, keeps=keeps, on_host=on_host)
    assert caught.value.field == field


def test_servers_and_other_processes_do_not_know_it(client, tmp_path, added, monkeypatch, capsys):  # noqa: F811
    problem = problem_of(client.post("/v1/jobs", json=JOB), 422, "invalid_document")
    detail = "is a Python function of a process, which jobs of a server cannot ask: give one that can be traced"
    assert problem["errors"] == [{"pointer": "#/constraints/striped", "detail": detail}]
    monkeypatch.setattr(registry, "_ADDED", {})  # as in the process of a command
    (tmp_path / "job.json").write_text(json.dumps(JOB))
    with pytest.raises(SystemExit) as ended:
        cli.main(["run", str(tmp_path / "job.json"), "-o", str(tmp_path / "out")])
    assert ended.value.code == 2 and "constraints.striped: unknown constraint" in capsys.readouterr().err
