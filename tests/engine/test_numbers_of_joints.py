"""Arms of one to twelve joints, hinges and slides, with any tip, against Denavit–Hartenberg products and NumPy."""

import numpy as np
import pytest

import wsrender as ws
from tests.engine.test_indices_standard import accelerations, assert_indices
from tests.engine.test_kinematics import TOOL
from tests.reference import dh_product, local_indices

KINDS = "rrprrrprrprr"
CASES = [
    (1, "full", "kinematic"),
    (1, ("x",), "all"),
    (2, ("x", "y"), "kinematic"),
    (3, "linear", "all"),
    (4, "full", "kinematic"),
    (8, "linear", "kinematic"),
    (9, "full", "kinematic"),
    (12, "linear", "all"),
]


def table_of(n):
    generator = np.random.default_rng(n)
    rows = []
    for kind in KINDS[:n]:
        a, d, x, y, z = generator.uniform(-0.3, 0.3, 5)
        alpha, theta = generator.uniform(-np.pi, np.pi, 2)
        body = {"mass": generator.uniform(0.5, 2), "center_of_mass": (x, y, z), "inertia": (0.02, 0.03, 0.04)}
        joint = "revolute" if kind == "r" else "prismatic"
        rows.append({"joint": joint, "a": a, "alpha": alpha, "d": d, "theta": theta, "limits": (-1.0, 1.5), **body})
    return ws.DHTable(convention="modified", rows=rows, name="arm")


def jacobian(table, q):
    """(6, n) at the tip of the tool, base frame."""
    points, axes = dh_product.joint_axes(table, q)
    tip = (dh_product.frames(table, q)[-1] @ TOOL)[:3, 3]
    hinges = np.array([row.joint == "revolute" for row in table.rows])[:, None]
    return np.hstack([np.where(hinges, np.cross(axes, tip - points), axes), np.where(hinges, axes, 0)]).T


@pytest.mark.parametrize(("n", "task", "indices"), CASES)
def test_any_number_of_joints(n, task, indices, precision, device):
    table = table_of(n)
    q = np.random.default_rng(0).uniform(-1, 1.5, (300, n))
    A = local_indices.task_matrix(np.array([jacobian(table, each) for each in q]), task)
    robot = ws.load_robot(table, tool=TOOL)
    found = ws.evaluate_indices(robot, q, indices, task, precision=precision, device=device)
    assert_indices(found, local_indices.standard(A), precision, A)
    if indices == "all":
        M = np.array([dh_product.inertia_matrix(table, each) for each in q])
        assert_indices(found, local_indices.standard(accelerations(A, M)), precision, A, "dynamic_")
