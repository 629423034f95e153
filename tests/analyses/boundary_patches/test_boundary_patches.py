"""The analysis ``boundary_patches``: a job document in, patches, edges, corners, a coloured mesh and a picture out."""

import json

import numpy as np
import pytest

import wsrender as ws
from tests.run.journeys import from_a_partial_file, from_the_command_line, hashes_of_two_saves
from wsrender.run import execute, finish, plan, run_shard

ROWS = [
    {"limits_deg": [-90, 90]},
    {"alpha_deg": 90, "limits_deg": [60, 150]},
    {"alpha_deg": 90, "joint": "prismatic", "limits": [2, 4]},
]
JOB = {
    "analysis": "boundary_patches",
    "robot": {"dh": {"convention": "modified", "name": "spherical", "rows": ROWS}},
    "cells": 20,
}


@pytest.fixture(scope="module")
def result():
    return execute(JOB)


def test_document_and_tables(result):
    document = result.document
    assert document["volume_m3"]["integrated"] == pytest.approx(28 * np.pi / 3 * (1 + 3**0.5), rel=1e-9)
    assert document["volume_m3"]["enclosed"] == pytest.approx(80.107913632, rel=1e-6)
    sphere = document["patches"][0]
    assert (sphere["kind"], sphere["method"]) == ("sphere", "critical_set")
    assert sphere["radius_m"] == pytest.approx(4) and sphere["center_m"] == pytest.approx([0, 0, 0], abs=1e-9)
    assert sphere["generated_by"] == [{"limits": ["joint3 upper"], "free": ["joint1", "joint2"], "singular": False}]
    assert sorted(result.tables["patches"]["kind"]) == sorted(["cone", "cone", "plane", "plane", "sphere", "sphere"])
    assert result.tables["patches"]["generated_by"][0] == "joint3 upper"
    assert (len(result.tables["edges"]), len(result.tables["corners"])) == (12, 8)
    assert result.tables["edge_points"]["edge"].max() == 11
    json.dumps(document, allow_nan=False)
    headline, error = document["headline"], document["integration_error_m3"]
    assert headline["value"] == document["volume_m3"]["integrated"] and headline["quantity"] == "volume"
    assert headline["ci95"] == [headline["value"] - error, headline["value"] + error]
    assert document["warnings"] == []


def test_parts_thinner_than_a_cell_are_said_to_be_missed():
    """Turning 10° beyond a singular posture draws a lip 0.3 (1 − sin 100°) = 4.6 mm thick, a thirtieth of a cell."""
    rows = [
        {"a": 0.3, "alpha_deg": 90, "limits_deg": [-120, 120]},
        {"joint": "prismatic", "limits": [0.2, 0.6]},
        {"a": 0.3, "limits_deg": [-100, 100]},
    ]
    job = {"analysis": "boundary_patches", "cells": 12}
    document = execute({**job, "robot": {"dh": {"convention": "standard", "name": "RPR", "rows": rows}}}).document
    volumes = document["volume_m3"]
    assert volumes["integrated"] == pytest.approx(0.403129, rel=1e-5)
    assert 1e-3 < abs(volumes["enclosed"] / volumes["integrated"] - 1) < 1e-2
    (warning,) = document["warnings"]
    assert (warning["code"], warning["field"]) == ("enclosed_differs", "cells")
    assert "thinner than a cell, 0.142 m" in warning["message"]
    job["cells"] = 32
    document = execute({**job, "robot": {"dh": {"convention": "standard", "name": "RPR", "rows": rows}}}).document
    assert document["volume_m3"]["enclosed"] == pytest.approx(0.403129, rel=3e-4) and document["warnings"] == []
    job["cells"] = 24
    rows[2]["limits_deg"] = [-60, 60]  # no lip
    document = execute({**job, "robot": {"dh": {"convention": "standard", "name": "RPR", "rows": rows}}}).document
    assert document["volume_m3"]["enclosed"] == pytest.approx(document["volume_m3"]["integrated"], rel=1e-3)
    assert document["warnings"] == []


def test_mesh_has_a_colour_per_patch(result):
    mesh = result.meshes["patches"]
    patch, colors = mesh.face_attributes["surface"], mesh.visual.face_colors
    assert mesh.is_watertight and mesh.volume == pytest.approx(80.1079, rel=5e-3)
    assert [len(np.unique(colors[patch == k], axis=0)) for k in range(6)] == [1] * 6
    assert len(np.unique(colors, axis=0)) == 6
    assert np.linalg.norm(mesh.vertices[np.unique(mesh.faces[patch == 0])], axis=1) == pytest.approx(4, abs=1e-9)


def test_python_and_document_agree(result):
    robot = ws.DHTable(convention="modified", rows=[ws.DHRow(**row) for row in ROWS], name="spherical")
    again = ws.boundary_patches(robot, cells=20)
    for name in ("patches", "edges", "corners", "volume_m3"):
        assert again.document[name] == result.document[name]


def test_from_the_command_line_and_back(tmp_path, capsys):
    loaded = from_the_command_line(JOB, tmp_path)
    shown = capsys.readouterr().out
    assert "80.10791363 m³" in shown and "12 edges, 8 corners" in shown
    assert len(np.unique(loaded.meshes["patches"].face_attributes["surface"])) == 6
    assert len(np.unique(loaded.meshes["patches"].visual.face_colors, axis=0)) == 6
    assert (tmp_path / "out/plots/patches.png").stat().st_size > 10_000
    assert len(loaded.plot.patches().axes) == 2


def test_equal_jobs_have_equal_files(result, tmp_path):
    first, second = hashes_of_two_saves(result, tmp_path)
    assert first == second and "patches.glb" in first


def test_a_partial_result_travels(result, tmp_path):
    counted = []
    found = from_a_partial_file(JOB, tmp_path, counted.append)
    assert counted == sorted(counted) and 0 < counted[-1] <= plan(JOB).shards[0][1]
    assert found.document["patches"] == result.document["patches"]
    assert (found.meshes["patches"].faces == result.meshes["patches"].faces).all()


def test_locked_joints_leave_three():
    """A wrist whose hand is off its axes moves the end point with five joints; two are held."""
    held = {"joint4": 0.3, "joint5": -0.4}
    planned = plan({"analysis": "boundary_patches", "robot": "ur5e", "locked": held})
    assert planned.arm.names == ("joint1", "joint2", "joint3")
    robot = ws.load_robot("ur5e")
    d = np.random.default_rng(0).uniform(-1, 1, (20, 3))
    q = np.column_stack([d, np.tile([0.3, -0.4, 0.0], (20, 1))])
    assert planned.arm.position(d) == pytest.approx(robot.forward_kinematics(q)[:, :3, 3], abs=1e-9)


def test_more_joints_than_three_are_fitted(tmp_path):
    """The slide of the spherical arm in two parts: the volume that is enclosed beside the refined one."""
    slides = [{"alpha_deg": 90, "joint": "prismatic", "limits": [1, 2]}, {"joint": "prismatic", "limits": [1, 2]}]
    job = {**JOB, "robot": {"dh": {"convention": "modified", "name": "longer", "rows": [*ROWS[:2], *slides]}}}
    planned, counted = plan(job), []
    found = finish(planned, run_shard(planned, 0, counted.append))
    assert counted == sorted(counted) and 0 < counted[-1] <= planned.shards[0][1]
    document = found.document
    volumes = document["volume_m3"]
    low, high = volumes["refined"]["ci95"]
    assert document["headline"]["ci95"] == [low, high] and document["warnings"] == []
    assert low < 80.107913632 < high and volumes["enclosed"] == pytest.approx(80.107913632, rel=1e-5)
    assert {patch["method"] for patch in document["patches"]} == {"fitted"}
    assert all(patch["generated_by"] == [] for patch in document["patches"])
    assert max(patch["residual_m"] for patch in document["patches"]) <= document["fit_tolerance_m"]
    assert sorted(found.tables["patches"]["kind"]) == sorted(["cone", "cone", "plane", "plane", "sphere", "sphere"])
    assert found.meshes["patches"].is_watertight
    json.dumps(document, allow_nan=False)
    found.save(tmp_path / "out")
    assert (tmp_path / "out/plots/patches.png").stat().st_size > 10_000


@pytest.mark.parametrize("heights", [[[0.2, 0.201]], [[0.1, 0.1005], [0.1, 0.1005]]], ids=["three", "four joints"])
def test_what_is_thinner_than_a_cell_has_a_volume_and_no_patches(heights, tmp_path):
    rows = [{"limits_deg": [-60, 60], "a": 0.3}, {"limits_deg": [20, 150], "a": 0.2, "alpha_deg": 180}]
    rows += [{"joint": "prismatic", "limits": limits} for limits in heights]
    robot = {"dh": {"convention": "standard", "name": "thin", "rows": rows}}
    found = execute({"analysis": "boundary_patches", "robot": robot, "cells": 8})
    found.save(tmp_path / "out")
    volume = found.document["volume_m3"].get("integrated") or found.document["volume_m3"]["refined"]["value"]
    base = 0.06 * np.radians(120) * (np.cos(np.radians(20)) - np.cos(np.radians(150)))
    assert volume == pytest.approx(0.001 * base, rel=0.01)
    assert found.document["patches"] == [] and found.meshes == {}
    assert [warning["code"] for warning in found.document["warnings"]] == ["enclosed_differs"]


@pytest.mark.parametrize(
    ("fields", "error", "message"),
    [
        ({"robot": "articulated", "locked": {"elbow": 0}}, ws.InputError, "locked.elbow: unknown joint"),
        ({"robot": "articulated", "locked": {"joint1": 9}}, ws.InputError, "locked.joint1: 9.0 is outside"),
        ({"robot": "articulated", "locked": {"joint1": 1}}, ws.ModelError, "2 joints move the end point"),
    ],
)
def test_what_cannot_be_done_is_refused_before_anything_runs(fields, error, message):
    with pytest.raises(error, match=message):
        plan({"analysis": "boundary_patches", **fields})
