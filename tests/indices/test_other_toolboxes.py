"""Numbers that users of Corke's toolboxes and of MATLAB's know: printed there, and by a Jacobian of our own."""

from math import pi

import numpy as np
import pytest

import wsrender as ws

# The Puma 560 of Corke's Robotics Toolbox (standard Denavit–Hartenberg): a [m], α [rad], d [m].
PUMA = [
    (0.0, pi / 2, 0.6718),
    (0.4318, 0.0, 0.0),
    (0.0203, -pi / 2, 0.15005),
    (0.0, pi / 2, 0.4318),
    (0.0, -pi / 2, 0.0),
    (0.0, 0.0, 0.0),
]
QN = [0.0, pi / 4, pi, 0.0, pi / 4, 0.0]  # its nominal configuration
# What `puma.manipulability(puma.qn)`, and with axes="trans", print in the manual of its version for Python.
PRINTED = {"full": 0.07861716534599998, "linear": 0.11118146146764128}
FULL_TURN = [-2 * pi, 2 * pi]


@pytest.fixture(scope="module")
def puma():
    rows = [{"a": a, "alpha": alpha, "d": d, "limits": FULL_TURN} for a, alpha, d in PUMA]
    return ws.load_robot(ws.DHTable(convention="standard", rows=rows))


def jacobian(q):
    """Geometric Jacobian (6, 6), linear rows first, by products of Denavit–Hartenberg matrices."""
    T, frames = np.eye(4), [np.eye(4)]
    for angle, (a, alpha, d) in zip(q, PUMA, strict=True):
        c, s, ca, sa = np.cos(angle), np.sin(angle), np.cos(alpha), np.sin(alpha)
        T = T @ [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]]
        frames.append(T)
    axes = [frame[:3, 2] for frame in frames[:-1]]
    return np.array([[*np.cross(z, T[:3, 3] - frame[:3, 3]), *z] for z, frame in zip(axes, frames, strict=False)]).T


@pytest.mark.parametrize("task", PRINTED)
def test_what_the_manual_prints(puma, task):
    found = ws.evaluate_indices(puma, QN, "yoshikawa", task=task, device="cpu")
    assert found["manipulability"][0] == pytest.approx(PRINTED[task], rel=1e-9)


ROWS = {"linear": slice(0, 3), "angular": slice(3, 6), "full": slice(0, 6)}


@pytest.mark.parametrize("task", ROWS)
@pytest.mark.parametrize("length_m", [1.0, 0.4])
def test_names_of_others_mean_their_formulas(puma, task, length_m):
    """MATLAB's yoshikawa and inverse-condition, Corke's yoshikawa, invcondition and minsingular."""
    many = np.random.default_rng(0).uniform(-pi, pi, (50, 6))
    asked = ["yoshikawa", "inverse-condition", "minsingular"]
    found = ws.evaluate_indices(puma, many, asked, task=task, characteristic_length_m=length_m, device="cpu")
    for k, q in enumerate(many):
        J = jacobian(q)
        J[:3] /= length_m if task == "full" else 1
        J = J[ROWS[task]]
        assert found["manipulability"][k] == pytest.approx(np.sqrt(np.linalg.det(J @ J.T)), rel=1e-9, abs=1e-12)
        assert found["inverse_condition_number"][k] == pytest.approx(1 / np.linalg.cond(J), rel=1e-9, abs=1e-12)
        assert found["minimum_singular_value"][k] == pytest.approx(np.linalg.svd(J)[1][-1], rel=1e-9, abs=1e-12)
    same = ws.evaluate_indices(puma, many, "invcondition", task=task, characteristic_length_m=length_m, device="cpu")
    assert np.array_equal(same["inverse_condition_number"], found["inverse_condition_number"])
