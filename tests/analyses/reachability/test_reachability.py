"""The analysis ``reachability``: a job document in, a table of labelled targets out."""

import numpy as np
import pytest

import wsrender as ws
from tests.run.journeys import from_a_partial_file, from_the_command_line
from wsrender.run import execute, plan

POINTS = [[-0.3, 0.0, 0.0], [-0.1, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.3, 0.0]]
JOB = {"analysis": "reachability", "robot": "spherical", "points_m": POINTS, "device": "cpu"}
QUATS = [[1, 0, 0, 0], [0, 2, 0, 0], [0.5, 0.5, 0.5, 0.5], [1, 1, 0, 0]]


def test_table_says_what_python_says():
    result = execute(JOB | {"quats_wxyz": QUATS})
    found = ws.reachable(ws.load_robot("spherical"), POINTS, QUATS, device="cpu")
    table = result.tables["targets"]
    assert (table["label"] == found.labels).all()
    assert (table["reason"] == found.reasons).all()
    assert (table["residual_rad"] == found.residual_rad).all()
    assert (table["q_joint3"] == found.configurations[:, 2]).all()
    assert (table.units["q_joint3"], table.units["q_joint1"], table.units["position"]) == ("m", "rad", "m")
    assert table["quat_wxyz"].tolist() == QUATS


def test_document_counts_the_labels():
    document = execute(JOB).document
    targets = document["targets"]
    assert (targets["count"], targets["reachable"], targets["unreachable"]) == (4, 1, 3)
    assert targets["reasons"] == {"joint limits": 3}
    assert targets["largest_residual_of_reachable_m"] <= 1e-5
    assert document["job"]["seed"] == 0
    assert execute(document["job"]).document["targets"] == targets


def test_from_the_command_line_and_back(tmp_path, capsys):
    table = from_the_command_line(JOB, tmp_path).tables["targets"]
    assert table["label"].tolist() == ["reachable", "unreachable", "unreachable", "unreachable"]
    assert "reachable targets" in capsys.readouterr().out


def test_a_partial_result_travels(tmp_path):
    result = from_a_partial_file(JOB, tmp_path)
    assert np.array_equal(result.tables["targets"]["q_joint1"], execute(JOB).tables["targets"]["q_joint1"])


def test_wrong_tolerances_are_refused_before_anything_runs():
    with pytest.raises(ws.InputError, match="position_tolerance_m"):
        plan(JOB | {"precision": "float32", "position_tolerance_m": 1e-9})
