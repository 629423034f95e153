"""Robots that are Python classes: the same values as the library's robot, and clear errors."""

import numpy as np
import pytest

import wsrender as ws
from tests.run.simple_robots import PLANAR, PlanarClass, PlanarClassWithMasses, planar_arm, planar_arm_with_masses
from wsrender.robot.user_robot import HostRobot, as_robot
from wsrender.robots import library

TABLE = ws.DHTable(convention="standard", rows=[ws.DHRow(a=0.3)])
Q = np.random.default_rng(4).uniform(0.1, 2.5, (50, 2))


def variant(**members):
    return type("Variant", (PlanarClassWithMasses,), members)()


@pytest.mark.parametrize("user", [PlanarClass(), PlanarClassWithMasses()], ids=["finite differences", "own Jacobian"])
def test_analysis_equals_that_of_the_library_robot(user):
    options = {**PLANAR, "voxel_size_m": 0.03, "precision": "float64"}
    # Mid-voxel offsets of the sampling keep positions away from voxel faces, where rounding decides.
    sampling = ws.Random(5000, seed=7)
    user_result, result = (ws.analyze(robot, sampling, **options) for robot in (user, planar_arm()))
    assert np.array_equal(user_result.volume.count, result.volume.count)
    assert user_result.volume.first_voxel == result.volume.first_voxel
    for name, entry in result.document["indices"].items():
        for value in ("maximum", "minimum", "joint_mean", "workspace_mean"):
            assert user_result.document["indices"][name][value] == pytest.approx(entry[value], abs=1e-8)
    assert user_result.document["volume_m3"] == result.document["volume_m3"]
    # What needs the geometry of the links is left out, not made up.
    assert user_result.document["global"]["structural_length_index"] is None


def test_all_indices_with_inertia():
    names = ["manipulability", "dynamic_manipulability", "dynamic_inverse_condition_number"]
    user = ws.evaluate_indices(PlanarClassWithMasses(), Q, names, ["x", "y"], device="cpu")
    model = ws.evaluate_indices(planar_arm_with_masses(), Q, names, ["x", "y"], device="cpu")
    for name in names:
        # Point masses: MuJoCo refuses exactly none of an inertia about the centre of mass.
        assert user[name] == pytest.approx(model[name], rel=1e-5), name
    robot = PlanarClassWithMasses()
    A = robot.jacobian(Q)[:, :2] @ np.linalg.inv(robot.inertia_matrix(Q))
    assert user["dynamic_manipulability"] == pytest.approx(np.abs(np.linalg.det(A)), rel=1e-9)


def test_finite_differences():
    found = as_robot(PlanarClass()).jacobian(Q)
    assert found == pytest.approx(PlanarClassWithMasses().jacobian(Q), abs=1e-9)


def test_the_document_says_that_no_file_describes_it():
    document = ws.analyze(PlanarClassWithMasses(), ws.Grid(10), voxel_size_m=0.05, **PLANAR).document
    assert document["job"]["robot"] == {"user_defined": "tests.run.simple_robots.PlanarClassWithMasses"}
    assert document["robot"]["user_defined"] is True
    assert document["robot"]["name"] == "planar with masses"
    assert document["robot"]["joint_names"] == ["shoulder", "elbow"]
    with pytest.raises(ws.DocumentError, match="robot"):
        ws.execute(document["job"])


def test_the_hash_follows_the_kinematics():
    longer = variant(lengths=(0.5, 0.41))
    same, other = as_robot(variant()), as_robot(longer)
    assert isinstance(same, HostRobot)
    assert same.model_hash == as_robot(variant()).model_hash != other.model_hash


@pytest.mark.parametrize(
    ("members", "message"),
    [
        ({"limits": [1.0, 2.0]}, r"limits: has shape \(2,\); \(n, 2\) is needed"),
        ({"limits": "none"}, "limits: is not an array of numbers"),
        ({"limits": [(0, 1), (1, 0)]}, r"limits: of joint 1 are inverted: \[1.0, 0.0\]"),
        ({"limits": [(-np.inf, np.inf)] * 2}, "limits: has a value that is not finite; every joint needs an interval"),
        ({"joint_names": ("a",)}, "joint_names: 1 names for 2 rows of limits"),
        ({"joint_names": ("a", "a")}, "joint_names: a, a are not distinct"),
        ({"forward_kinematics": lambda self, q: np.eye(4)}, r"returned shape \(4, 4\); \(\d+, 4, 4\) is needed"),
        (
            {"forward_kinematics": lambda self, q: np.full((len(q), 4, 4), np.nan)},
            "returned a value that is not finite",
        ),
        ({"jacobian": lambda self, q: np.zeros((6, 2))}, r"jacobian: returned shape \(6, 2\); \(\d+, 6, 2\) is needed"),
    ],
)
def test_faults_of_the_class_are_named(members, message):
    with pytest.raises(ws.ModelError, match=message):
        ws.analyze(variant(**members), ws.Grid(5), voxel_size_m=0.05, **PLANAR)


@pytest.mark.parametrize("source", ["scara", library.find("scara"), TABLE], ids=type)
def test_what_load_robot_takes_is_a_robot(source):
    robot = ws.load_robot(source)
    q = robot.lower_limits + 0.3 * (robot.upper_limits - robot.lower_limits)
    position = robot.forward_kinematics(q)[:, :3, 3]
    assert ws.reachable(source, position).labels == ["reachable"]
    options = {"indices": ["manipulability"], "task": ["y"]}
    assert ws.evaluate_indices(source, q, **options) == ws.evaluate_indices(robot, q, **options)


@pytest.mark.parametrize(
    ("robot", "options", "message"),
    [
        (PlanarClass, {}, r"PlanarClass is a class; give an object of it: PlanarClass\(\)"),
        (None, {}, "NoneType is neither a Robot"),
        ("no_such_arm", {}, 'has no robot "no_such_arm"'),
        (PlanarClass(), {"indices": "dynamic"}, "needs link inertias"),
        (PlanarClassWithMasses(), {"indices": "all", "inertia": "mujoco"}, '"mujoco" is not allowed'),
        (PlanarClassWithMasses(), {"indices": "all", "torque_scaling": True}, "lacks effort limits"),
        (PlanarClass(), {"keep_map": True, "map_columns": ["orientation"]}, "orientation is not kept"),
    ],
)
def test_what_a_user_defined_robot_cannot_do(robot, options, message):
    with pytest.raises(ws.InputError, match=message):
        ws.analyze(robot, ws.Grid(5), voxel_size_m=0.05, **{**PLANAR, **options})
