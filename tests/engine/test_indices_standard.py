"""The twelve indices of the standard convention against NumPy's singular value decomposition in float64."""

from functools import cache

import numpy as np
import pytest

import wsrender as ws
from tests.engine.test_kinematics import PLACEMENT, TOOL
from tests.reference import local_indices
from tests.reference.mujoco_library import MujocoRobot
from tests.reference.postures import random_postures
from wsrender.robots import library
from wsrender.robots.model_warning import ModelWarning
from wsrender.tolerances import TOLERANCES, epsilon

LENGTH = 0.35
TASKS = ["linear", "angular", "full", ("x", "y"), ("z",), ("x", "y", "rz")]
# A task costs a kernel each for every number of joints, so the robots share few.
CASES = [("ur5e", task) for task in TASKS] + [
    (name, task) for name in ("puma560", "stanford_arm", "franka_panda", "kuka_iiwa14") for task in ("linear", "full")
]
KINEMATIC_CASES = [
    ("phantom_omni", "linear"),
    ("articulated", "linear"),
    ("cartesian", "linear"),
    ("dvrk_mtm", "linear"),
    ("scara", "full"),
    ("slave_5r", "full"),
]


@cache
def robot_and_references(name):
    robot = ws.load_robot(name, placement=PLACEMENT, tool=TOOL)
    q = random_postures(robot.chain, 1000, seed=1)
    reference = MujocoRobot(library.find(name), robot.joint_names, robot.tip_frame, PLACEMENT, TOOL)
    return robot, q, reference.at(q)


def task_matrix(name, task):
    _, _, reference = robot_and_references(name)
    return local_indices.task_matrix(reference.jacobian, task, LENGTH, PLACEMENT[:3, :3])


def accelerations(A, M):
    """J M^-1."""
    return np.linalg.solve(M, A.transpose(0, 2, 1)).transpose(0, 2, 1)


def assert_indices(found, expected, precision, A, prefix=""):
    """Values (N,) against those expected for task matrices (N, m, n); 0 will do where A counts as singular."""
    m, n = A.shape[1:]
    sigma = np.linalg.svd(A, compute_uv=False)
    # Twice the threshold of the definitions, since rounding decides at the threshold itself.
    may_count_as_0 = sigma[:, -1] <= 2 * max(m, n) * epsilon(precision) * sigma[:, 0]
    for name, exact in expected.items():
        power = local_indices.power_without_root(name, m)
        value = found[prefix + name].astype(np.float64)
        assert np.isfinite(value).all() and (value >= 0).all(), prefix + name
        error = np.abs(value**power - exact**power)
        error[may_count_as_0 & (value == 0)] = 0
        error = error.max() / max((exact**power).max(), np.finfo(float).tiny)
        assert error <= TOLERANCES[precision].index, (prefix + name, error)


@pytest.mark.parametrize(("name", "task"), CASES)
def test_twelve_indices(name, task, precision, device):
    robot, q, reference = robot_and_references(name)
    A = task_matrix(name, task)
    found = ws.evaluate_indices(
        robot, q, "all", task, characteristic_length_m=LENGTH, precision=precision, device=device
    )
    assert_indices(found, local_indices.standard(A), precision, A)
    expected = local_indices.standard(accelerations(A, reference.inertia))
    assert_indices(found, expected, precision, A, "dynamic_")


@pytest.mark.parametrize(("name", "task"), KINEMATIC_CASES)
def test_six_indices_of_robots_without_inertias(name, task, precision, device):
    robot, q, _ = robot_and_references(name)
    A = task_matrix(name, task)
    found = ws.evaluate_indices(
        robot, q, "all", task, characteristic_length_m=LENGTH, precision=precision, device=device
    )
    assert tuple(found) == local_indices.NAMES
    assert_indices(found, local_indices.standard(A), precision, A)
    if A.shape[2] < A.shape[1]:
        assert all((values == 0).all() for values in found.values())


def test_torque_scaling(precision, device):
    robot, q, reference = robot_and_references("ur5e")
    A = task_matrix("ur5e", "linear")
    scaled = accelerations(A, reference.inertia) * robot.chain.effort_limits
    found = ws.evaluate_indices(robot, q, "all", torque_scaling=True, precision=precision, device=device)
    assert_indices(found, local_indices.standard(scaled), precision, A, "dynamic_")


def test_joint_limit_penalisation(precision, device):
    robot, q, reference = robot_and_references("puma560")
    lower, upper = robot.lower_limits, robot.upper_limits
    # At the limits themselves float32's rounding of the limit decides, and a condition number of nothing.
    inside = ((q - lower > 0.02) & (upper - q > 0.02)).all(axis=1)
    q, J, M = q[inside], reference.jacobian[inside], reference.inertia[inside]
    A = local_indices.task_matrix(local_indices.penalized(J, q, lower, upper, 10.0), "linear")
    found = ws.evaluate_indices(robot, q, "all", joint_limit_penalty=True, precision=precision, device=device)
    assert_indices(found, local_indices.standard(A), precision, A)
    assert_indices(found, local_indices.standard(accelerations(A, M)), precision, A, "dynamic_")


def test_the_penalty_is_1_at_mid_range_and_0_at_a_limit():
    robot, _, _ = robot_and_references("puma560")
    middle = (robot.lower_limits + robot.upper_limits) / 2
    q = np.stack([middle, robot.lower_limits, robot.upper_limits])
    free = ws.evaluate_indices(robot, q, "all")
    held = ws.evaluate_indices(robot, q, "all", joint_limit_penalty=10.0)
    for name in free:
        assert held[name][0] == pytest.approx(free[name][0], rel=1e-9)
        assert (held[name][1:] == 0).all()


def test_inertia_evaluated_by_mujoco(device):
    robot, q, reference = robot_and_references("franka_panda")
    A = task_matrix("franka_panda", "linear")[:100]
    found = ws.evaluate_indices(robot, q[:100], "all", inertia="mujoco", precision="float64", device=device)
    assert_indices(found, local_indices.standard(A), "float64", A)
    expected = local_indices.standard(accelerations(A, reference.inertia[:100]))
    assert_indices(found, expected, "float64", A, "dynamic_")


def planar_arm(length, mass, joints=3, last_mass=None):
    """Equal links in a plane; the last may have a mass of its own, or none."""
    rows = []
    for i in range(joints):
        m = mass if i < joints - 1 or last_mass is None else last_mass
        inertia = m * length**2 / 12
        link = {"mass": m, "center_of_mass": [length / 2, 0, 0], "inertia": [inertia] * 3} if m else {}
        rows.append({"a": length if i else 0, "limits": [-2, 2], **link})
    tool = np.eye(4)
    tool[0, 3] = length
    return ws.load_robot(ws.DHTable(convention="modified", rows=rows), tool=tool)


@pytest.mark.filterwarnings("ignore::wsrender.robots.model_warning.ModelWarning")
def test_two_rows_of_a_tiny_robot(device):
    robot, q = planar_arm(3e-4, 1e-6), np.random.default_rng(0).uniform(-2, 2, (500, 3))
    A = accelerations(robot.jacobian(q)[:, :2], robot.inertia_matrix(q, method="mujoco"))
    expected = local_indices.standard(A)
    for precision in ("float32", "float64"):
        found = ws.evaluate_indices(robot, q, "dynamic", ["x", "y"], precision=precision, device=device)
        assert_indices(found, expected, precision, A, "dynamic_")


@pytest.mark.filterwarnings("ignore::wsrender.robots.model_warning.ModelWarning")
def test_six_rows_of_a_huge_robot(device):
    """The product of its six singular values underflows float32."""
    a, length, mass = np.pi / 2, 10.0, 5e4
    moment = mass * length**2 / 12
    link = {"mass": mass, "center_of_mass": [5, 0, 1], "inertia": [0.3 * moment, moment, moment], "limits": [-2, 2]}
    rows = [{"a": length if i else 0, "alpha": x, "d": 3, **link} for i, x in enumerate((0, a, 0, a, -a, a))]
    robot = ws.load_robot(ws.DHTable(convention="modified", rows=rows))
    q = np.random.default_rng(0).uniform(-2, 2, (500, 6))
    names = ["dynamic_isotropy", "dynamic_order_independent_manipulability"]
    A = accelerations(robot.jacobian(q), robot.inertia_matrix(q, method="mujoco"))
    expected = local_indices.standard(A)
    for precision in ("float32", "float64"):
        found = ws.evaluate_indices(robot, q, names, "full", precision=precision, device=device)
        for name in names:
            wanted = expected[name.removeprefix("dynamic_")]
            assert np.abs(found[name] - wanted).max() <= TOLERANCES[precision].index * wanted.max(), (precision, name)


@pytest.mark.filterwarnings("ignore::wsrender.robots.model_warning.ModelWarning")
@pytest.mark.parametrize("last_mass", [1e-2, 1e-4, 1e-6])
def test_two_rows_of_a_robot_with_a_light_last_link(last_mass, device):
    """Its last column of J M^-1 is so much larger that rounding of it drowns the others."""
    robot, q = planar_arm(0.4, 1.0, last_mass=last_mass), np.random.default_rng(0).uniform(-2, 2, (500, 3))
    A = accelerations(robot.jacobian(q)[:, :2], robot.inertia_matrix(q, method="mujoco"))
    expected = local_indices.standard(A)
    for precision in ("float32", "float64"):
        found = ws.evaluate_indices(robot, q, "dynamic", ["x", "y"], precision=precision, device=device)
        for name, value in found.items():
            wanted = expected[name.removeprefix("dynamic_")]
            assert np.abs(value - wanted).max() <= TOLERANCES[precision].index * wanted.max(), (precision, name)


def test_inertias_that_float32_cannot_hold_are_refused(device):
    robot, q = planar_arm(0.4, 1.0, last_mass=0.0), np.array([[0.3, 0.5, -0.7]])
    fields = {"task": ["x", "y"], "device": device}
    with pytest.warns(ModelWarning, match=r"differ by a factor of .* \(a link without mass\?\)"):
        found = ws.evaluate_indices(robot, q, "all", precision="float64", **fields)
    assert found["dynamic_minimum_singular_value"] > 0
    spec = robot.spec.model_dump(mode="json", exclude_none=True)
    job = {"analysis": "indices_at", "robot": spec, "configurations": q.tolist(), "indices": "all"}
    with pytest.warns(ModelWarning):
        document = ws.execute({**job, **fields}).document
    assert [warning["code"] for warning in document["warnings"]] == ["inertia_ratio"]
    assert ws.evaluate_indices(robot, q, "kinematic", precision="float32", **fields)["manipulability"] > 0
    with pytest.raises(
        ws.InputError, match=r'precision: "float32" is not allowed for dynamic indices of .*"float64" is'
    ):
        ws.evaluate_indices(robot, q, "all", precision="float32", **fields)


@pytest.mark.parametrize("penalty", [1e-17, 1e-4, 1e7, float("nan"), float("inf"), "a"])
def test_penalties_out_of_range_are_refused(penalty):
    with pytest.raises(
        ws.InputError, match=r"joint_limit_penalty: (.* is not allowed; 0\.001 … 1e|must be a .*number)"
    ):
        ws.evaluate_indices("puma560", np.zeros(6), "kinematic", joint_limit_penalty=penalty)


@pytest.mark.parametrize(
    "arguments", [{"characteristic_length_m": "a"}, {"characteristic_length_m": 0}, {"indices": 3}, {"task": 3}]
)
def test_arguments_of_the_wrong_kind_are_named(arguments):
    (name,) = arguments
    with pytest.raises(ws.InputError, match=f"^{name}: must be"):
        ws.evaluate_indices("puma560", np.zeros(6), **arguments)
