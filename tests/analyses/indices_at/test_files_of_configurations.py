"""Configurations in a file: the result of the same numbers in the document, to the last bit."""

import hashlib

import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet

import wsrender as ws
from wsrender.run import plan

ROWS = np.random.default_rng(1).uniform(-1, 1, (40, 6))
ROWS[3, 2] = -0.0
JOINTS = [f"joint{k}" for k in range(1, 7)]
JOB = {"analysis": "indices_at", "robot": {"library": "ur5e"}, "device": "cpu"}


def files(folder):
    np.save(folder / "rows.npy", ROWS)
    shuffled = {name: ROWS[:, JOINTS.index(name)] for name in reversed(JOINTS)}
    parquet.write_table(pa.table(shuffled), folder / "rows.parquet")
    np.savetxt(folder / "rows.csv", ROWS, "%.17g", delimiter=",", header=",".join(JOINTS), comments="")
    return [folder / f"rows.{ending}" for ending in ("npy", "parquet", "csv")]


def test_values_are_those_of_the_same_numbers_in_the_document(tmp_path):
    listed = ws.execute(JOB | {"configurations": ROWS.tolist()})
    assert "configurations_sha256" not in listed.document["provenance"]
    for path in files(tmp_path):
        found = ws.execute(JOB | {"configurations": {"path": str(path)}})
        assert found.document["indices"] == listed.document["indices"]
        assert found.map.configuration.tobytes() == (listed.map.configuration + 0.0).tobytes()
        assert found.map.position.tobytes() == listed.map.position.tobytes()
        for name, values in listed.map.indices.items():
            assert found.map.indices[name].tobytes() == values.tobytes()
        sha256 = hashlib.sha256(path.read_bytes()).hexdigest()
        assert found.document["provenance"]["configurations_sha256"] == sha256
        assert found.document["job"]["configurations"] == {"path": str(path), "model": None}


@pytest.mark.parametrize("given", [str, lambda path: path, ws.ArrayFile, lambda path: {"path": str(path)}])
def test_python_takes_a_file_as_a_path_or_a_document(given, tmp_path):
    path, *_ = files(tmp_path)
    found = ws.indices_at("ur5e", given(path), indices=["manipulability"], device="cpu")
    assert np.array_equal(found.map.configuration, ROWS)


def test_what_a_file_holds_is_checked_when_a_job_is_planned(tmp_path):
    """Its width by the robot, and its rows where polytopes are asked for: as those of a document."""
    path, *_ = files(tmp_path)
    job = JOB | {"configurations": {"path": str(path)}}
    assert plan(job).cost.samples == plan(JOB | {"configurations": ROWS.tolist()}).cost.samples == len(ROWS)
    with pytest.raises(
        ws.InputError, match=r"configurations\.path: .*rows.npy has the shape \(40, 6\); rows of 4 finite"
    ):
        plan(job | {"robot": {"library": "scara"}})
    with pytest.raises(ws.InputError, match="polytopes: must not be given with 40 configurations; 20 at most"):
        plan(job | {"polytopes": ["force"]})


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ([], "configurations: must have at least 1 items, not"),
        ("rows.txt", "configurations.path: must end in .csv, .parquet, .npy"),
        ({"rows": []}, "configurations.rows: is not a known field; allowed: path, model"),
        ({"model": "ab"}, "configurations.model: must match"),
        (3, "configurations: must be a list, not 3"),
    ],
)
def test_what_names_no_file_is_refused(value, message):
    with pytest.raises(ws.DocumentError, match=message):
        plan(JOB | {"configurations": value})
