"""The collaborative volume of jobs: the outward pair of arms, points in documents and files, malformed jobs."""

import hashlib

import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet

import wsrender as ws
from tests.multi.test_body_elements import LENS, ball
from wsrender.multi import body_elements
from wsrender.run import finish, plan, run_shard
from wsrender.run.partial_files import load_partial, save_partial

OUTWARD = {
    "left": {"robot": "gao_6r"},
    "right": {"robot": {"library": "gao_6r", "placement": {"rpy_deg": [0, 0, 180]}}},
}


def job(**fields):
    return {"analysis": "collaborative_volume", "device": "cpu", **fields}


def test_the_outward_pair_of_arms(tmp_path):
    """DEFINITIONS 6: V₃ about 4.94e-3 m³ with 2e5 points and 20³ cells, against a true 6.2190e-3."""
    document = job(**OUTWARD, seeds=4)
    result = ws.execute(document)
    entries = result.document["refinements"]
    assert entries[3]["mean_m3"] == pytest.approx(4.94e-3, rel=0.03)
    volumes = result.tables["seeds"]["volume"]
    assert volumes.shape == (4, 4)
    assert entries[3]["variance_m6"] == pytest.approx(volumes[:, 3].var(ddof=1))
    volume = result.document["volume_m3"]
    assert volume["body_elemental"] == entries[3]["mean_m3"]
    assert volume["true"]["ci95"][0] <= 6.2190e-3 <= volume["true"]["ci95"][1]
    assert len(set(volumes[:, 3])) == 4
    headline = result.document["headline"]
    assert (headline["value"], headline["ci95"]) == (volume["true"]["value"], volume["true"]["ci95"])
    planned = plan(document)
    save_partial(run_shard(planned, 0), tmp_path / "0.npz")
    again = finish(planned, load_partial(tmp_path / "0.npz", planned))
    np.testing.assert_array_equal(again.tables["seeds"]["volume"], volumes)
    result.save(tmp_path / "out")
    assert "plots/refinements.png" in {record["name"] for record in result.document["artifacts"]}


def test_the_true_volume_stands_beside_it():
    result = ws.execute(job(**OUTWARD, seeds=2, samples=50_000, refined_volume=0.05))
    true = result.document["volume_m3"]["true"]
    low, high = true["ci95"]
    headline = result.document["headline"]
    assert (headline["value"], headline["ci95"], headline["reason"]) == (true["value"], [low, high], "")
    assert low < 6.2190e-3 < high
    assert high - low < 0.11 * 6.2190e-3
    (first, *_, last) = result.document["refinements"]
    assert last["bias"] == pytest.approx(last["mean_m3"] / true["value"] - 1)
    assert last["bias"] < first["bias"]
    assert "true_low" in result.tables["refinements"].columns


def test_points_in_documents_and_files(tmp_path):
    left, right = ball(0.5, 2000, 0), ball(-0.5, 2000, 1)
    expected = body_elements(left, right, (6, 6, 6)).volumes_m3
    np.save(tmp_path / "left.npy", left)
    np.savetxt(tmp_path / "right.csv", right, delimiter=",", header="x,y,z", comments="")
    np.savetxt(tmp_path / "bare.csv", right, delimiter=",")
    parquet.write_table(pa.table({"z_m": right[:, 2], "x_m": right[:, 0], "y_m": right[:, 1]}), tmp_path / "r.parquet")
    inline = [{"points": left.tolist()}, {"points": right.tolist()}]
    files = [{"path": str(tmp_path / name)} for name in ("left.npy", "right.csv", "bare.csv", "r.parquet")]
    from_python = ws.collaborative_volume(left, right, cells=(6, 6, 6), seeds=1, device="cpu")
    assert from_python.tables["seeds"]["volume"][0] == pytest.approx(expected)
    for sources in (inline, files[:2], files[::2], files[::3], [{"points": left}, files[1]]):
        found = ws.execute(job(left=sources[0], right=sources[1], cells=[6, 6, 6], seeds=1))
        assert found.document["headline"]["value"] is None and "biased" in found.document["headline"]["reason"]
        assert found.tables["seeds"]["volume"][0] == pytest.approx(expected)
        assert found.document["refinements"][0]["variance_m6"] is None
        hashes = {
            f"{side}_sha256": hashlib.sha256((tmp_path / each["path"]).read_bytes()).hexdigest()
            for side, each in zip(("left", "right"), sources, strict=True)
            if "path" in each
        }
        said = found.document["provenance"].items()
        assert {name: value for name, value in said if name.endswith("_sha256")} == hashes
    assert expected[0] == pytest.approx(LENS, rel=0.5)


def drawn_points(monkeypatch, **document):
    """The points (N, 3) of left and right, by run, that the body elements of a job are made of."""
    runs = []

    def kept(left, right, *choices):
        runs.append((left, right))
        return body_elements(left, right, *choices)

    monkeypatch.setattr("wsrender.analyses.collaborative_volume.run.body_elements", kept)
    ws.execute(job(cells=[4, 4, 4], refined_volume=None, **document))
    return runs


def test_mirrored_arms_do_not_draw_mirrored_configurations(monkeypatch):
    """The same robot twice in one place, and turned by 180°: no point of one is a point, or mirror image, of the other.

    With one seed for both, each would be, and the common volume of two equal arms all of theirs.
    """
    for right, mirror in (({"robot": "gao_6r"}, [1, 1, 1]), (OUTWARD["right"], [-1, -1, 1])):
        for left, other in drawn_points(monkeypatch, left={"robot": "gao_6r"}, right=right, samples=500, seeds=2):
            assert left.shape == other.shape == (500, 3)
            assert np.linalg.norm(left - other * mirror, axis=1).min() > 1e-6


def test_every_run_draws_its_own_configurations(monkeypatch):
    (first, _), (second, _) = drawn_points(monkeypatch, **OUTWARD, samples=500, seeds=2)
    assert np.linalg.norm(first - second, axis=1).min() > 1e-6
    ((again, _),) = drawn_points(monkeypatch, **OUTWARD, samples=500, seeds=1, seed=1)
    np.testing.assert_array_equal(again, second)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"left": {"robot": "gao_6r"}}, "right: is required"),
        ({**OUTWARD, "left": {"points": []}}, r"left.points: must be a list of points \[x, y, z\]"),
        ({**OUTWARD, "left": {"points": [[0, 1]]}}, r"left.points: must be a list of points"),
        ({**OUTWARD, "left": {"points": [[0, 1, float("nan")]]}}, "left.points: must be a list of points"),
        ({**OUTWARD, "left": {"points": [[0, 1, 2]], "path": "a.npy"}}, "left.points: must be given, or else"),
        ({**OUTWARD, "left": {"path": "/nowhere/a.npy"}}, "left.path: /nowhere/a.npy cannot be read: No such file"),
        ({**OUTWARD, "left": {"points": [[0, 0, 0]]}, "refined_volume": 0.1}, "refined_volume: must be null"),
        ({**OUTWARD, "cells": [1, 2]}, "cells: must be a list of 3 whole numbers"),
        ({**OUTWARD, "neighbours": 5}, "neighbours: must be 4 or 6"),
        ({**OUTWARD, "max_samples": 1000}, "samples: makes 4e\\+06 configurations, above max_samples"),
        ({**OUTWARD, "left": {"robot": "nobody"}}, 'left.robot.library: has no robot "nobody"'),
    ],
)
def test_malformed_jobs(fields, message):
    with pytest.raises(ws.InputError, match=message):
        ws.execute(job(**fields))


def test_the_points_of_constrained_arms_are_those_that_are_admitted(tmp_path):
    """Half of what both reach lies behind a wall; where all does, that is said."""
    sides, seen = {"left": {"robot": "phantom_omni"}, "right": {"robot": "phantom_omni"}}, {}
    for name, lower in (("all", -9.0), ("half", 0.0)):
        constraints = {"region": {"box": {"lower_m": [None, lower, None]}}}
        document = job(**sides, samples=20_000, seeds=2, cells=[10] * 3, constraints=constraints, refined_volume=None)
        result = ws.execute(document)
        seen[name] = result.document
    result.save(tmp_path)
    assert (tmp_path / "plots" / "refinements.png").stat().st_size
    assert result.plot.title.endswith("admitted by region") and "admitted of left " in result.summary()
    for side in ("left", "right"):
        half = seen["half"]["admission"][side]
        assert half["drawn"] == 2 * 20_000 == half["admitted"] + half["rejected"]["region"]
        assert 0.3 < half["admitted"] / half["drawn"] < 0.7 and not seen["all"]["admission"][side]["rejected"]["region"]
    volume = [seen[name]["refinements"][3]["mean_m3"] for name in ("half", "all")]
    assert 0.3 * volume[1] < volume[0] < 0.7 * volume[1]
    document["constraints"]["region"]["box"]["lower_m"] = [None, 9.0, None]
    with pytest.raises(ws.InputError, match="constraints: admit none of 20000 samples"):
        ws.execute(document)
