"""Scenes, robots and meshes in files that a client uploads: the server counts what a local run counts."""

import hashlib

import numpy as np
import pytest
import trimesh

import wsrender as ws
from tests.server.end_to_end.acceptance import PATIENCE_S

CELL = """<mujoco><worldbody><geom name="floor" type="plane" size="1 1 1" pos="0 0 -.2"/>
<geom name="wall" type="box" size=".02 1 1" pos="-.5 0 0"/></worldbody></mujoco>"""
PENDULUM = """<mujoco><worldbody><body><joint name="a" axis="0 1 0" range="-90 90"/>
<geom type="capsule" size=".05" fromto="0 0 0 0 0 .4"/></body></worldbody></mujoco>"""


def test_a_table_of_targets_travels(client, tmp_path):
    """Labels, names and verdict are those of a local run, in as many shards as the server makes."""
    table = tmp_path / "holes.csv"
    table.write_text("name,x_m,y_m,z_m,weight\na,0.4,0.2,0.3,3\nb,2,0,0,1\n")
    document = {"analysis": "reachability", "robot": "ur5e", "targets": {"path": str(table)}, "device": "cpu"}
    document["criteria"] = [{"least_share": 0.75, "joint_margin_deg": 5}, {"least_share": 0.8}]
    local = ws.execute(document)
    result = client.submit(document).wait(timeout=PATIENCE_S).result()
    assert result.document["criteria"] == local.document["criteria"]
    assert result.document["verdict"] == local.document["verdict"] == "fail"
    sha256 = hashlib.sha256(table.read_bytes()).hexdigest()
    assert result.document["provenance"]["targets_sha256"] == sha256
    assert result.tables["targets"]["name"].tolist() == ["a", "b"]
    assert np.array_equal(result.tables["targets"]["q_joint1"], local.tables["targets"]["q_joint1"])


def test_a_table_travels_to_placements(client, tmp_path):
    """Free axes, names and hash too, in as many shards as the server makes."""
    table = tmp_path / "holes.csv"
    header = "name,x_m,y_m,z_m,roll_deg,pitch_deg,yaw_deg,free_axis,weight"
    table.write_text(f"{header}\na,0.4,0.2,0.3,180,0,0,z,3\nb,2,0,0.2,180,0,0,,1\n")
    document = {"analysis": "base_placement", "robot": "ur5e", "targets": {"path": str(table)}, "device": "cpu"}
    document |= {"over": {"x_m": [-1, 1, 0.1], "y_m": [-1, 1, 0.1]}, "refine": False}
    local, result = ws.execute(document), client.submit(document).wait(timeout=PATIENCE_S).result()
    assert result.document["best"] == local.document["best"] and result.document["best"]["weight"] == 3
    sha256 = hashlib.sha256(table.read_bytes()).hexdigest()
    assert result.document["provenance"]["targets_sha256"] == sha256
    assert result.tables["targets"]["name"].tolist() == ["a", "b"]
    assert np.array_equal(result.tables["placements"]["served_bits"], local.tables["placements"]["served_bits"])


def test_a_table_travels_to_postures(client, tmp_path):
    table = tmp_path / "holes.csv"
    table.write_text("name,x_m,y_m,z_m,qw,qx,qy,qz\na,0.4,0.2,0.3,0,1,0,0\nb,2,0,0,0,1,0,0\n")
    document = {"analysis": "postures", "robot": "ur5e", "targets": {"path": str(table)}, "device": "cpu"}
    local, result = ws.execute(document), client.submit(document).wait(timeout=PATIENCE_S).result()
    assert result.document["postures"] == local.document["postures"]
    assert result.document["provenance"]["targets_sha256"] == hashlib.sha256(table.read_bytes()).hexdigest()
    assert result.tables["poses"]["name"].tolist() == ["a", "b"]
    assert np.array_equal(result.tables["postures"]["q_joint1"], local.tables["postures"]["q_joint1"])


def test_arrays_travel(client, tmp_path):
    """The bits of the same numbers in the document; what a file holds wrongly is said by field, file and row."""
    rows = np.random.default_rng(2).uniform(-1, 1, (500, 6))
    np.save(tmp_path / "rows.npy", rows)
    document = {"analysis": "indices_at", "robot": "ur5e", "device": "cpu"}
    listed = client.submit(document | {"configurations": rows.tolist()}).wait(timeout=PATIENCE_S).result()
    found = client.submit(document | {"configurations": str(tmp_path / "rows.npy")}).wait(timeout=PATIENCE_S).result()
    assert found.map.configuration.tobytes() == listed.map.configuration.tobytes() == rows.tobytes()
    for name, values in listed.map.indices.items():
        assert found.map.indices[name].tobytes() == values.tobytes()
    sha256 = hashlib.sha256((tmp_path / "rows.npy").read_bytes()).hexdigest()
    assert found.document["provenance"]["configurations_sha256"] == sha256
    assert found.document["job"]["configurations"]["model"] == sha256
    points = {"analysis": "collaborative_volume", "seeds": 1, "cells": [4, 4, 4], "right": {"points": rows[:, 3:]}}
    np.save(tmp_path / "left.npy", rows[:, :3])
    left = ({"points": rows[:, :3]}, {"path": str(tmp_path / "left.npy")})
    both = [client.submit(points | {"left": each}).wait(timeout=PATIENCE_S).result() for each in left]
    assert np.array_equal(*(each.tables["seeds"]["volume"] for each in both))
    rows[7, 2] = np.nan
    np.save(tmp_path / "rows.npy", rows)
    with pytest.raises(
        ws.InputError, match=r"configurations\.model: .*, row 8, column 3: must be a finite number, not nan"
    ):
        client.submit(document | {"configurations": str(tmp_path / "rows.npy")}).wait(timeout=PATIENCE_S).result()


def test_files_of_what_stands_around_travel(client, tmp_path):
    scene, other, mesh = tmp_path / "cell.xml", tmp_path / "other.xml", tmp_path / "part.stl"
    bowl, ground = tmp_path / "bowl.obj", tmp_path / "ground.npy"
    scene.write_text(CELL)
    other.write_text(PENDULUM)
    trimesh.creation.box((0.2, 0.2, 0.2)).export(mesh)
    trimesh.creation.annulus(0.2, 0.25, 0.1).export(bowl)
    np.save(ground, [[1, 20, 1], [3, 4, 5]])
    items = [
        ws.Scene(scene, name="cell"),
        ws.OtherRobot(robot={"path": str(other), "placement": {"position_m": (0.5, 0.5, 0)}}, configuration=[0.5]),
        ws.Mesh(mesh, position_m=(0.4, -0.4, 0.3), convex=False),
        ws.Mesh(bowl, position_m=(0.5, 0.3, 0.1)),
        ws.HeightField(ground, size_m=(1, 1), position_m=(0.2, -0.6, -0.2), length_unit_m=0.01),
    ]
    tool = {"shape": "mesh", "path": str(mesh), "position_m": [0, 0, 0.1]}
    document = {
        "analysis": "workspace",
        "robot": {"library": "ur5e", "tool_shapes": [tool]},
        "environment": ws.Environment(items),
        "sampling": {"method": "sobol", "count": 4096},
        "device": "cpu",
    }
    result = client.submit(document).wait(timeout=PATIENCE_S).result()
    local = ws.execute({**document, "environment": ws.Environment(items).model_dump(mode="json")})
    assert result.document["samples"] == local.document["samples"]
    assert 0 < result.document["samples"]["rejected"]["environment"] < 4096
