"""The conventions ``table_1`` and ``wsrender_code`` against their NumPy twins."""

import numpy as np
import pytest

import wsrender as ws
from tests.engine.test_indices_standard import PLACEMENT, robot_and_references
from tests.reference import local_indices
from wsrender.errors import InputError
from wsrender.tolerances import TOLERANCES

LIMIT_OF_CONDITION = 1e3  # beyond it the twin's own pinv and det have lost the digits that are compared


def assert_close(found, expected, precision, roots, prefix="", chosen=slice(None)):
    for name, exact in expected.items():
        power = roots.get(name, 1.0)
        value, exact = found[prefix + name][chosen].astype(np.float64), exact[chosen]
        assert np.isfinite(value).all(), prefix + name
        error = np.abs(value**power - exact**power).max() / (exact**power).max()
        assert error <= TOLERANCES[precision].index, (prefix + name, error)


@pytest.mark.parametrize("task", ["linear", "full"])
def test_table_1(task, precision, device):
    robot, q, reference = robot_and_references("ur5e")
    A = local_indices.task_matrix(reference.jacobian, task, 1.0, PLACEMENT[:3, :3])
    regular = np.linalg.cond(A) < LIMIT_OF_CONDITION
    assert regular.sum() > 300
    found = ws.evaluate_indices(robot, q, "all", task, convention="table_1", precision=precision, device=device)
    # n-th roots of det H: the n-th half power leaves the product of the singular values.
    roots = {"order_independent_manipulability": 3.0, "isotropy": 3.0}
    assert_close(found, local_indices.table_1(A), precision, roots, "", regular)
    assert all(np.isfinite(values).all() for values in found.values())


@pytest.mark.parametrize("name", ["ur5e", "franka_panda"])
def test_wsrender_code(name, device):
    robot, q, reference = robot_and_references(name)
    n = robot.chain.n
    found = ws.evaluate_indices(robot, q, "all", convention="wsrender_code", device=device)
    roots = {"order_independent_manipulability": float(n), "isotropy": float(n)}
    s = np.linalg.svd(reference.jacobian, compute_uv=False)
    # pinv's cut is a jump: next to it rounding decides; far below and far above it does not.
    ratio = s[:, -1] ** 2 / (6 * np.spacing(s[:, 0] ** 2))
    decided = (ratio > 1e4) | (ratio < 1e-2)
    assert decided.sum() > 500
    assert_close(found, local_indices.wsrender_code(reference.jacobian), "float64", roots, "", decided)


def test_wsrender_code_with_fewer_joints_than_rows():
    robot, q, reference = robot_and_references("slave_5r")
    found = ws.evaluate_indices(robot, q, "all", convention="wsrender_code")
    expected = local_indices.wsrender_code(reference.jacobian)
    roots = {"order_independent_manipulability": 5.0, "isotropy": 5.0}
    regular = np.linalg.cond(reference.jacobian) < 1e5
    assert_close(found, expected, "float64", roots, "", regular)


def test_wsrender_code_needs_float64():
    robot, q, _ = robot_and_references("ur5e")
    with pytest.raises(InputError, match=r'precision: .*float32.* not allowed .*wsrender_code; "float64" is'):
        ws.evaluate_indices(robot, q, convention="wsrender_code", precision="float32")


def test_an_unknown_convention():
    robot, q, _ = robot_and_references("ur5e")
    with pytest.raises(InputError, match="convention: 'corke' is not allowed; standard, table_1, wsrender_code"):
        ws.evaluate_indices(robot, q, convention="corke")
