"""Faces of surfaces are called what they are, in their colours; self-motions are drawn as ways of the joints."""

import io

import numpy as np
import pytest
import trimesh

import wsrender as ws
from wsrender.results.drawing.faces import NUMBER
from wsrender.results.view import view_of


def parts_of(view, name):
    """Names of the nodes of a mesh of a view, with triangles and colour of each."""
    (entry,) = (each for each in view.manifest["meshes"] if each["name"] == name)
    scene = trimesh.load(io.BytesIO(view.blobs[entry["geometry"]["blob"]]), file_type="glb")
    found = {}
    for node in scene.graph.nodes_geometry:
        shape = scene.geometry[scene.graph[node][1]]
        found[node] = len(shape.faces), shape.visual.material.baseColorFactor[:3].tolist()
    return found


def test_patches_of_a_boundary():
    rows = [{"a": 1.0, "alpha": np.pi / 2}, {"a": 1.0}, {"a": 0.5}]
    limits = {"joint1": [-2.5, 2.5], "joint2": [-1.0, 1.5], "joint3": [-2.0, 1.0]}
    robot = {"dh": {"convention": "standard", "rows": rows}, "limits": limits}
    result = ws.execute({"analysis": "boundary_patches", "robot": robot, "cells": 20})
    table, mesh = result.tables["patches"], result.meshes["patches"]
    number, colors = mesh.face_attributes[NUMBER], np.asarray(mesh.visual.face_colors)
    found = parts_of(view_of(result), "patches")
    assert len(found) == len(np.unique(number)) >= 4
    for name, (triangles, color) in found.items():
        k = int(name.split()[0])
        assert name.split(" ", 1)[1].startswith(str(table["kind"][k]).replace("_", " "))
        assert name.endswith(str(table["generated_by"][k]))
        rows = np.flatnonzero(number == k)
        assert triangles == len(rows)
        assert np.abs(colors[rows[0], :3].astype(int) - color).max() <= 1


def test_arms_in_their_postures():
    job = {"analysis": "postures", "robot": {"library": "ur5e"}, "environment": {"items": [{"shape": "half_space"}]}}
    result = ws.execute(job | {"position_m": [[0.4, 0.2, 0.3]], "quat_wxyz": [[0, 1, 0, 0]]})
    found, reasons = parts_of(view_of(result), "bodies"), result.tables["postures"]["reason"]
    assert sorted(found) == sorted(
        f"posture {k}{f', blocked by {reason}' if reason else ''}" for k, reason in enumerate(reasons)
    )
    assert any("blocked" in name for name in found) and not all("blocked" in name for name in found)
    assert len({tuple(color) for _, color in found.values()}) == len(found)


@pytest.fixture(scope="module")
def moving():
    """Of an arm with a joint to spare, that does not stand at the origin; the result, and its robot."""
    placement = {"position_m": [0.1, 0.2, 0.3], "rpy_deg": [0, 0, 40]}
    rows = [{"a": 0.4}, {"a": 0.3}, {"a": 0.2}]
    spec = {"dh": {"convention": "standard", "rows": rows}, "placement": placement}
    robot = ws.load_robot(ws.DHTable(convention="standard", rows=rows)).placed(ws.Transform(**placement))
    targets = robot.forward_kinematics([[0.3, 0.8, -0.5], [0.2, 1.5, 0.9]])[:, :3, 3]
    result = ws.execute({"analysis": "postures", "robot": spec, "position_m": targets.tolist()})
    return result, robot


def test_self_motions(moving):
    """The two joints between base and tip go on circles about those; each way is closed where its curve is."""
    result, robot = moving
    table = result.tables["self_motions"]
    (curves,) = (each for each in view_of(result).manifest["curves"] if each["name"] == "self_motions")
    starts = np.flatnonzero(table["point"] == 0)
    assert len(curves["points"]) == 2 * len(starts) >= 4
    tips = robot.forward_kinematics(np.stack([table[f"q_{joint}"] for joint in robot.joint_names], axis=1))[:, :3, 3]
    for k, rows in enumerate(np.split(np.arange(len(table)), starts[1:])):
        second, third = (np.array(curves["points"][2 * k + j]) for j in (0, 1))
        closed = bool(table["closed"][rows[0]])
        assert len(second) == len(third) == len(rows) + closed
        assert np.array_equal(second[0], second[-1]) == closed
        base = np.array([0.1, 0.2, 0.3])
        np.testing.assert_allclose(np.linalg.norm(second - base, axis=1), 0.4, atol=1e-9)
        np.testing.assert_allclose(np.linalg.norm(third - second, axis=1), 0.3, atol=1e-9)
        np.testing.assert_allclose(np.linalg.norm(tips[rows[0]] - third, axis=1), 0.2, atol=1e-6)


def test_very_many_self_motions_are_not_all_drawn(moving, monkeypatch):
    result, _ = moving
    monkeypatch.setattr("wsrender.results.view.robots.MOST_MOTIONS", 1)
    manifest = view_of(result).manifest
    assert [len(each["points"]) for each in manifest["curves"]] == [2]
    count = int((result.tables["self_motions"]["point"] == 0).sum())
    assert f"{count - 1} of {count} self-motions" in manifest["omitted"]
