"""Indices that another package adds in one file: from Python, the command line and a live server."""

import json

import numpy as np
import pytest
from wsrender_server.job_body import body_schemas

import wsrender as ws
from tests.server.end_to_end.acceptance import PATIENCE_S
from wsrender.errors import InputError
from wsrender.indices import catalogue as listed
from wsrender.indices.index_catalogue import KINEMATIC, resolve

JOB = {
    "analysis": "workspace",
    "robot": {"library": "phantom_omni"},
    "sampling": {"method": "random", "count": 2000, "seed": 3},
    "indices": ["anisotropy", "weighted"],
    "index_options": {"weighted": {"weight": 2}},
    "voxel_size_m": 0.02,
    "keep_map": True,
    "map_columns": ["configuration"],
    "refined_volume": None,
    "device": "cpu",
}


def twins(J, weight=0.5):
    """Values (N,) by index of Jacobians' task rows (N, m, n)."""
    sigma = np.linalg.svd(J, compute_uv=False)
    return {"anisotropy": 1 - sigma[:, -1] / sigma[:, 0], "weighted": sigma[:, 0] + weight * sigma[:, -1]}


def check(result, weight):
    J = ws.load_robot("phantom_omni").jacobian(result.map.configuration, device="cpu")[:, :3]
    for name, expected in twins(J, weight).items():
        assert result.map.indices[name] == pytest.approx(expected, abs=1e-5)
        assert np.nanmax(result.volume.statistics["maximum"][name]) == pytest.approx(expected.max(), abs=1e-5)


def test_from_the_command_line(package, wsrender, tmp_path):
    (tmp_path / "job.json").write_text(json.dumps(JOB | {"indices": "kinematic", "index_options": {}}))
    options = ["--indices", "anisotropy,weighted", "-o", tmp_path / "out"]
    code, out, err = wsrender("run", tmp_path / "job.json", *options)
    assert code == 0 and "anisotropy" in out and "weighted" in out, err
    check(ws.Result.load(tmp_path / "out"), 0.5)
    assert (tmp_path / "out" / "plots" / "slices.png").stat().st_size > 1000


def test_from_a_live_server(live):
    check(live.submit(JOB).wait(timeout=PATIENCE_S).result(), 2.0)
    for options, field in (({"weight": 9}, "weight"), ({"wait": 1}, "wait")):
        with pytest.raises(ws.DocumentError, match=f"index_options.weighted.{field}"):
            live.submit(JOB | {"index_options": {"weighted": options}})


def test_the_schema_of_a_server_tells_of_them(package):
    schemas = body_schemas()
    (lists,) = [choice for choice in schemas["WorkspaceJob"]["properties"]["indices"]["anyOf"] if "items" in choice]
    assert {"anisotropy", "dynamic_weighted"} < set(lists["items"]["enum"])
    options = schemas["WorkspaceJob"]["properties"]["index_options"]
    assert set(options["properties"]) > {"weighted", "dynamic_weighted"} and options["additionalProperties"] is False
    weight = options["properties"]["weighted"]["properties"]["weight"]
    assert weight.pop("description") == "share of the smallest value [1]"
    assert weight == {"type": "number", "default": 0.5, "minimum": 0.0, "maximum": 4.0}


def test_from_python(package):
    assert {"anisotropy", "weighted"} < set(listed())
    assert resolve("kinematic", True) == KINEMATIC and len(KINEMATIC) == 6
    q = ws.load_robot("scara").chain.within(0.3)[None]
    found = ws.evaluate_indices("scara", q, ["anisotropy", "weighted"], device="cpu")
    expected = twins(ws.load_robot("scara").jacobian(q, device="cpu")[:, :3])
    assert all(found[name] == pytest.approx(expected[name], abs=1e-12) for name in expected)
    with pytest.raises(InputError, match="'anisotropy' is taken by the catalogue"):
        ws.register_index("anisotropy", lambda s, m, n: s[0])
