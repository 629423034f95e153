"""Index functions: the device code traced from them computes what the same function computes with NumPy."""

import math as python_math
from importlib import import_module

import numpy as np
import pytest

import wsrender as ws
from tests.engine.test_indices_standard import robot_and_references, task_matrix
from tests.reference import local_indices
from wsrender.errors import InputError, NumericalError
from wsrender.indices import math
from wsrender.indices.index_catalogue import find, is_dynamic, resolve, unit
from wsrender.indices.units import task_matrix as task_matrix_units

USER_INDICES = {
    "of_sqrt": lambda s, m, n: math.sqrt(s[0] + s[-1]),
    "of_absolute": lambda s, m, n: math.absolute(s[1] - 0.5) + abs(s[0] - 1.0),
    "of_floor": lambda s, m, n: math.floor(3.0 * s[0] + 0.123),
    "of_exp": lambda s, m, n: math.exp(-s[0]) + math.exp2(-s[1]),
    "of_log": lambda s, m, n: math.log(1.0 + s[0]) * math.log2(2.0 + s[1]),
    "of_sin": lambda s, m, n: math.sin(s[0]) + math.cos(3.0 * s[1]),
    "of_power": lambda s, m, n: math.power(s[0], 0.3) + s[1] ** 3 + s[0] ** 0.5,
    "of_minimum": lambda s, m, n: math.minimum(s[0], 0.8) + math.maximum(s[1], 0.4),
    "of_where": lambda s, m, n: math.where(math.less(s[0], 1.0), s[0] * 0.0, s[0]) - math.where(s[1] > 0.5, 1.0, s[1]),
    "of_greater": lambda s, m, n: math.where(math.greater(s[0], 1e9), 1.0, -s[0]),
    "of_divide": lambda s, m, n: math.divide(s[-1], s[0]) + 1.0 / (1.0 + s[0]),
    "of_prod": lambda s, m, n: math.prod(s) - sum(s) / (m + n),
    "of_a_constant": lambda s, m, n: m * 10.0 + n,
    "of_difference": lambda s, m, n: 2.0 - s[0],
}


@pytest.fixture
def empty_catalogue(monkeypatch):
    """The catalogue without what a test registers."""
    module = import_module("wsrender.indices.index_catalogue")
    monkeypatch.setattr(module, "_ADDED", {})


def test_user_indices_compute_what_numpy_computes(precision, device, empty_catalogue):
    robot, q, _ = robot_and_references("ur5e")
    for name, function in USER_INDICES.items():
        ws.register_index(name, function, unit="u")
    found = ws.evaluate_indices(robot, q, list(USER_INDICES), precision=precision, device=device)
    sigma = local_indices.singular_values(task_matrix("ur5e", "linear"))
    for name, function in USER_INDICES.items():
        expected = np.broadcast_to(function(list(sigma.T), 3, 6), len(q))
        value = found[name].astype(np.float64)
        if name == "of_floor":  # a jump: rounding decides next to it
            assert (value == expected).mean() > 0.999
            continue
        if name == "of_where":
            away = (np.abs(sigma[:, 0] - 1) > 1e-5) & (np.abs(sigma[:, 1] - 0.5) > 1e-5)
            value, expected = value[away], expected[away]
        limit = {"float32": 1e-5, "float64": 1e-13}[precision]
        if name == "of_power":
            limit *= 10
        assert np.abs(value - expected).max() <= limit * max(np.abs(expected).max(), 1.0), name


def test_user_indices_have_dynamic_variants(empty_catalogue):
    ws.register_index("of_prod", USER_INDICES["of_prod"])
    assert resolve(["dynamic_of_prod", "of_prod"], has_inertia=True) == ("dynamic_of_prod", "of_prod")
    with pytest.raises(InputError, match="dynamic_of_prod needs link inertias"):
        resolve("dynamic_of_prod", has_inertia=False)


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda s, m, n: s[0] if s[0] > 1 else s[-1], "cannot branch on a value: use wsrender.math.where"),
        (lambda s, m, n: max(s), "cannot branch on a value"),
        (lambda s, m, n: python_math.sqrt(s[0]), "not the math module"),
        (lambda s, m, n: np.sqrt(s[0]), ""),
        (lambda s, m, n: s[7], "more than the 3 values"),
        (lambda s, m, n: float("inf"), "finite numbers"),
        (lambda s, m, n: "manipulability", "finite numbers"),
        (lambda s, m, n: None, "finite numbers"),
        (lambda s, m: s[0], "positional argument"),
        (lambda s, m, n: math.where(s[0] == 1.0, 0.0, 1.0), "compare by < or >"),
        (lambda s, m, n: s[0] != s[1], "compare by < or >"),
        (lambda s, m, n: s[0] <= 1.0, "compare by < or >"),
        (lambda s, m, n: s[0] < 1.0, "use wsrender.math.where"),
        (lambda s, m, n: (s[0] > 1.0) * s[0], "use wsrender.math.where"),
        (lambda s, m, n: math.where(s[0], 1.0, 0.0), "condition of where"),
    ],
)
def test_functions_that_cannot_be_traced(function, message, empty_catalogue):
    with pytest.raises(InputError, match=f"function: mine cannot be compiled: .*{message}"):
        ws.register_index("mine", function)


def test_a_condition_that_is_known_chooses(empty_catalogue):
    by_rows = ws.register_index("by_rows", lambda s, m, n: math.where(m > 2, s[0], s[-1])).function
    assert by_rows([3.0, 2.0, 1.0], 3, 6) == 3.0
    robot, q, _ = robot_and_references("ur5e")
    found = ws.evaluate_indices(robot, q[:10], ["by_rows", "manipulability"])
    sigma = local_indices.singular_values(task_matrix("ur5e", "linear")[:10])
    assert found["by_rows"] == pytest.approx(sigma[:, 0], rel=1e-12)


def test_a_task_with_too_few_values_for_a_function(empty_catalogue):
    ws.register_index("second", lambda s, m, n: s[1])
    robot, q, _ = robot_and_references("ur5e")
    with pytest.raises(InputError, match="indices: an index function takes more than the 1 values of this task"):
        ws.evaluate_indices(robot, q[:1], ["second"], ["z"])


@pytest.mark.parametrize("name", ["", "2nd", "a-b", "dynamic_mine", "yoshikawa", "manipulability", "x" * 65])
def test_names_that_are_taken_or_no_identifiers(name, empty_catalogue):
    with pytest.raises(InputError, match="name: "):
        ws.register_index(name, USER_INDICES["of_sqrt"])


def test_a_user_index_can_be_registered_again(empty_catalogue):
    ws.register_index("mine", lambda s, m, n: s[0])
    ws.register_index("mine", lambda s, m, n: s[-1], unit="m")
    assert find("mine").function([3.0, 1.0], 2, 6) == 1.0 and find("mine").unit == "m"


@pytest.mark.parametrize(
    ("alias", "name"),
    [
        ("yoshikawa", "manipulability"),
        ("inverse-condition", "inverse_condition_number"),
        ("invcondition", "inverse_condition_number"),
        ("minsingular", "minimum_singular_value"),
        ("dynamic_yoshikawa", "dynamic_manipulability"),
    ],
)
def test_aliases_of_other_toolboxes(alias, name):
    assert resolve(alias, has_inertia=True) == (name,)


def test_requests():
    assert resolve("kinematic", True) == local_indices.NAMES
    assert resolve("all", False) == local_indices.NAMES
    assert resolve("all", True) == local_indices.NAMES + tuple("dynamic_" + name for name in local_indices.NAMES)
    assert resolve(["yoshikawa", "manipulability"], True) == ("manipulability",)
    with pytest.raises(InputError, match=r"unknown index 'manipulabilty' \(did you mean 'manipulability'\?\)"):
        resolve("manipulabilty", True)


@pytest.mark.parametrize(
    ("name", "rows", "expected"),
    [
        ("manipulability", (0, 1, 2), "m^3"),
        ("manipulability", (0, 1), "m^2"),
        ("manipulability", (2,), "m"),
        ("manipulability", (3, 4, 5), "1"),
        ("inverse_condition_number", (0, 1, 2), "1"),
        ("minimum_singular_value", (0, 1, 2), "m"),
        ("order_independent_manipulability", (0, 1, 2), "m^2"),
        ("harmonic_mean_manipulability", (0, 1, 2), "m"),
        ("isotropy", (0, 1, 2, 3, 4, 5), "1"),
        ("dynamic_minimum_singular_value", (0, 1, 2), "1/(kg m)"),
        ("dynamic_minimum_singular_value", (3, 4, 5), "1/(kg m^2)"),
        ("dynamic_manipulability", (0, 1), "1/(kg^2 m^2)"),
    ],
)
def test_units(name, rows, expected):
    assert unit(name, task_matrix_units(rows, [True] * 6, dynamic=is_dynamic(name))) == expected


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda s, m, n: 1.0 / (s[0] - s[0]), r"index faulty has a value that is not finite"),
        (lambda s, m, n: math.sqrt(s[0] - 100.0), r"index faulty has a value that is not finite"),
    ],
)
def test_values_that_are_not_finite_fail_the_job(function, message, empty_catalogue):
    ws.register_index("faulty", function)
    with pytest.raises(NumericalError, match=message):
        ws.analyze("phantom_omni", ws.Random(2000, seed=1), indices=["faulty"], voxel_size_m=0.02, device="cpu")
