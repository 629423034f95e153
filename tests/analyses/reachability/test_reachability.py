"""The analysis ``reachability``: a job document in, a table of labelled targets out."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.collision.robots import collides
from tests.reference import closed_form_inverse as closed_form
from tests.reference.published_robots import dh_table
from tests.run.journeys import from_a_partial_file, from_the_command_line
from wsrender.reach import reachable
from wsrender.robot.constraints import constraints_for
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


FLOOR = {"items": [{"shape": "half_space", "name": "floor", "point_m": [0, 0, -0.003]}]}
GUARDED = {"analysis": "reachability", "robot": "ur5e", "environment": FLOOR, "device": "cpu"}
GUARDED["constraints"] = {"self_collision": True}


def test_what_constraints_reject_is_blocked_by_name():
    """Below the floor, in the base, above it, and out of reach."""
    points = [[0.5, 0, -0.1], [-0.07, 0.04, 0.21], [0.4, 0.2, 0.5], [2, 0, 0.5]]
    result = execute(GUARDED | {"points_m": points})
    table, targets = result.tables["targets"], result.document["targets"]
    assert table["label"].tolist() == ["blocked", "blocked", "reachable", "unreachable"]
    assert table["reason"].tolist() == ["environment", "self_collision", "", "out of reach"]
    assert (targets["blocked"], targets["reasons"]["environment"]) == (2, 1)
    rejected = np.stack([table["rejected_environment"], table["rejected_self_collision"]], axis=1)
    assert (rejected[:2].sum(axis=1) >= 8).all() and rejected[0, 0] > 0 and not rejected[3].any()
    assert table["residual_m"][:3].max() <= 1e-5
    assert "blocked targets: 2" in result.summary()
    assert result.plot.targets() is not None


def test_poses_of_admitted_configurations_are_reachable():
    """Known to be free, of a redundant arm between a table and the floor."""
    table = {"shape": "box", "size_m": [0.6, 0.6, 0.04], "position_m": [0.6, 0, 0.3]}
    around = {"items": [{"shape": "half_space", "point_m": [0, 0, -0.08]}, table]}
    robot = ws.load_robot("franka_panda")
    q = np.random.default_rng(3).uniform(robot.lower_limits, robot.upper_limits, (1500, 7))
    kept = {"environment": around, "constraints": {"self_collision": True}}
    admitted = execute({"analysis": "indices_at", "robot": "franka_panda", "configurations": q.tolist(), **kept})
    q = q[admitted.tables["admission"]["reason"] == ""]
    poses = robot.forward_kinematics(q)
    quats = Rotation.from_matrix(poses[:, :3, :3]).as_quat(scalar_first=True)
    job = {"analysis": "reachability", "robot": "franka_panda", "device": "cpu", **kept}
    for orientations in (None, quats.tolist()):
        result = execute(job | {"points_m": poses[:, :3, 3].tolist(), "quats_wxyz": orientations})
        label = result.tables["targets"]["label"]
        assert len(q) > 400 and (label == "blocked").sum() + (label == "unreachable").sum() <= 1e-3 * len(q)
        assert (label == "undecided").sum() <= 0.01 * len(q)
        # MuJoCo's own word on the configurations that were found.
        found = np.stack([result.tables["targets"][f"q_{name}"] for name in robot.joint_names], axis=1)
        assert not collides(robot, found[label == "reachable"]).any()


def test_labels_under_constraints_do_not_depend_on_shards(tmp_path):
    points = np.random.default_rng(0).uniform([-0.9, -0.9, -0.1], [0.9, 0.9, 0.9], (60, 3))
    whole = execute(GUARDED | {"points_m": points.tolist()}).tables["targets"]
    halves = [execute(GUARDED | {"points_m": half.tolist()}).tables["targets"] for half in np.split(points, 2)]
    for name, column in whole.columns.items():
        assert np.array_equal(column, np.concatenate([half[name] for half in halves])), name
    travelled = from_a_partial_file(GUARDED | {"points_m": points.tolist()}, tmp_path).tables["targets"]
    assert np.array_equal(travelled["rejected_environment"], whole["rejected_environment"])


def test_poses_between_a_floor_and_a_box_against_all_postures():
    """A Puma of capsules along its links: every posture in closed form, and MuJoCo's distances of each."""
    table = dh_table("puma560").model_copy(update={"link_radius": 0.04})
    robot = ws.load_robot(table)
    random, directions = np.random.default_rng(5), Rotation.random(600, random_state=6)
    points = random.uniform([-0.9, -0.9, -0.6], [0.9, 0.9, 0.9], (600, 3))
    around = ws.Environment([ws.HalfSpace(point_m=(0, 0, -0.5)), ws.Box(size_m=(0.2, 2, 2), position_m=(0.6, 0, 0))])
    (apart,) = constraints_for(robot, None, around)
    with np.errstate(invalid="ignore"):
        arm = closed_form.puma560_arm(points)
        solutions = closed_form.with_spherical_wrist("puma560", arm, directions.as_matrix())
    inside = closed_form.within_limits(solutions, robot.lower_limits, robot.upper_limits, robot.chain.revolute)
    admitted = np.zeros(inside.shape, bool)
    admitted[inside] = apart.host(solutions[inside], np.zeros((0, 4, 4))) == 0
    expected = np.select([admitted.any(axis=1), inside.any(axis=1)], ["reachable", "blocked"], "unreachable")
    quats = directions.as_quat(scalar_first=True)
    found = reachable(robot, points, quats, constraints=(apart,), device="cpu")
    decided = found.labels != "undecided"
    assert min((expected == name).sum() for name in ("reachable", "blocked", "unreachable")) > 50
    assert (~decided).mean() <= 0.01 and (found.labels != expected)[decided].sum() <= 1e-3 * decided.sum()
