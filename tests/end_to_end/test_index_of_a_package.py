"""Indices of another package, installed beside wsrender, from Python, on the command line and on a live server."""

import json
import os
import subprocess
import sys
from importlib import import_module
from importlib.metadata import EntryPoint
from pathlib import Path

import numpy as np
import pytest
from wsrender_server.job_body import body_schemas
from wsrender_server.local_server import LocalServer

import wsrender as ws
from tests.indices.added import ANISOTROPY, twins
from wsrender.errors import DocumentError, InputError
from wsrender.indices import catalogue as listed
from wsrender.indices.index_catalogue import EXTENSIONS, KINEMATIC, _extensions, resolve

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


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """A folder with an installed package: one module, and what a wheel says of its entry points."""
    folder = tmp_path_factory.mktemp("site")
    module = "from tests.indices.added import ANISOTROPY, WEIGHTED\nBOTH = [ANISOTROPY, WEIGHTED]\n"
    (folder / "lab_indices.py").write_text(module)
    about = folder / "lab_indices-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: lab-indices\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text(f"[{EXTENSIONS}]\nboth = lab_indices:BOTH\n")
    return folder


@pytest.fixture
def environment(package, monkeypatch):
    """Processes started from here find the package."""
    path = os.pathsep.join(map(str, (package, Path.cwd(), *filter(None, sys.path))))
    monkeypatch.setenv("PYTHONPATH", path)


@pytest.fixture
def installed(package, monkeypatch):
    """This process finds the package."""
    monkeypatch.syspath_prepend(str(package))
    _extensions.cache_clear()
    yield
    _extensions.cache_clear()


def test_indices_of_a_package_on_the_command_line(environment, tmp_path):
    (tmp_path / "job.json").write_text(json.dumps(JOB | {"indices": "kinematic", "index_options": {}}))
    options = ["--indices", "anisotropy,weighted", "-o", str(tmp_path / "out")]
    command = [sys.executable, "-m", "wsrender", "run", str(tmp_path / "job.json"), *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    result = ws.Result.load(tmp_path / "out")
    J = ws.load_robot("phantom_omni").jacobian(result.map.configuration, device="cpu")[:, :3]
    for name, expected in twins(J).items():
        assert result.map.indices[name] == pytest.approx(expected, abs=1e-5)
        assert np.nanmax(result.volume.statistics["maximum"][name]) == pytest.approx(expected.max(), abs=1e-5)
        assert name in done.stdout
    assert (tmp_path / "out" / "plots" / "slices.png").stat().st_size > 1000


def test_indices_of_a_package_on_a_server(environment, tmp_path):
    with LocalServer(tmp_path / "data") as server, ws.Client(server.url) as client:
        result = client.submit(JOB).result()
        J = ws.load_robot("phantom_omni").jacobian(result.map.configuration, device="cpu")[:, :3]
        for name, expected in twins(J, weight=2.0).items():
            assert result.map.indices[name] == pytest.approx(expected, abs=1e-5)
        for options, field in (({"weight": 9}, "weight"), ({"wait": 1}, "wait")):
            with pytest.raises(DocumentError, match=f"index_options.weighted.{field}"):
                client.submit(JOB | {"index_options": {"weighted": options}})


def test_the_schema_of_a_server_tells_of_them(installed):
    schemas = body_schemas()
    (lists,) = [choice for choice in schemas["WorkspaceJob"]["properties"]["indices"]["anyOf"] if "items" in choice]
    assert {"anisotropy", "dynamic_weighted"} < set(lists["items"]["enum"])
    options = schemas["WorkspaceJob"]["properties"]["index_options"]
    assert set(options["properties"]) == {"weighted", "dynamic_weighted"} and options["additionalProperties"] is False
    weight = options["properties"]["weighted"]["properties"]["weight"]
    assert weight.pop("description") == "share of the smallest value [1]"
    assert weight == {"type": "number", "default": 0.5, "minimum": 0.0, "maximum": 4.0}


def test_indices_of_a_package_in_python(installed):
    assert {"anisotropy", "weighted"} < set(listed())
    assert resolve("kinematic", True) == KINEMATIC and len(KINEMATIC) == 6
    q = ws.load_robot("scara").chain.within(0.3)[None]
    found = ws.evaluate_indices("scara", q, ["anisotropy", "weighted"], device="cpu")
    expected = twins(ws.load_robot("scara").jacobian(q, device="cpu")[:, :3])
    assert all(found[name] == pytest.approx(expected[name], abs=1e-12) for name in expected)
    with pytest.raises(InputError, match="'anisotropy' is taken by the catalogue"):
        ws.register_index("anisotropy", lambda s, m, n: s[0])


@pytest.mark.parametrize(
    ("found", "message"),
    [
        (ModuleNotFoundError("No module named 'torch'"), "cannot be used: No module named 'torch'; mend or remove"),
        ([ws.Index("manipulability", "μ", lambda s, m, n: s[0], "lab")], "'manipulability' is taken; remove one of"),
        ([ANISOTROPY, ANISOTROPY], "'anisotropy' is taken; remove one of the packages"),
        ([ws.Index("heavy", "h", lambda s, m, n: s[0], "lab", needs=("gravity",))], "needs: heavy needs gravity"),
        (3, "cannot be used: 'int' object is not iterable"),
    ],
)
def test_a_package_that_cannot_be_used_is_named(found, message, monkeypatch):
    def load(self):
        if isinstance(found, Exception):
            raise found
        return found

    monkeypatch.setattr(EntryPoint, "load", load)
    module = import_module("wsrender.indices.index_catalogue")
    monkeypatch.setattr(module, "entry_points", lambda group: [EntryPoint("lab", "lab:X", group)])
    _extensions.cache_clear()
    try:
        with pytest.raises(InputError, match=f"entry point lab = lab:X of {EXTENSIONS}: .*{message}"):
            listed()
        assert resolve("kinematic", True) == KINEMATIC  # the six do without
    finally:
        _extensions.cache_clear()
