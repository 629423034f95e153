"""Dynamic indices of the conventions ``table_1`` and ``wsrender_code`` against their NumPy twins."""

import numpy as np
import pytest

import wsrender as ws
from tests.engine.test_indices_conventions import LIMIT_OF_CONDITION, assert_close
from tests.engine.test_indices_standard import PLACEMENT, robot_and_references
from tests.reference import local_indices


@pytest.mark.parametrize("task", ["linear", "full"])
def test_table_1(task, precision, device):
    robot, q, reference = robot_and_references("ur5e")
    A = local_indices.task_matrix(reference.jacobian, task, 1.0, PLACEMENT[:3, :3])
    regular = np.linalg.cond(A) < LIMIT_OF_CONDITION
    found = ws.evaluate_indices(robot, q, "all", task, convention="table_1", precision=precision, device=device)
    expected = local_indices.table_1_dynamic(A, reference.inertia)
    roots = {"order_independent_manipulability": 3.0, "isotropy": 3.0}
    assert_close(found, expected, precision, roots, "dynamic_", regular)


@pytest.mark.parametrize("name", ["ur5e", "franka_panda"])
def test_wsrender_code(name, device):
    robot, q, reference = robot_and_references(name)
    n = robot.chain.n
    found = ws.evaluate_indices(robot, q, "all", convention="wsrender_code", device=device)
    roots = {"order_independent_manipulability": float(n), "isotropy": float(n)}
    expected = local_indices.wsrender_code(reference.jacobian, reference.inertia)
    regular = np.linalg.cond(reference.jacobian @ reference.inertia) < 1e5
    assert_close(found, expected, "float64", roots, "dynamic_", regular)
