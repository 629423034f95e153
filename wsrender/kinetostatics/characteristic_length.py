"""Homogeneous Jacobians, and the characteristic length that makes a Jacobian homogeneous ([CB]).

Angular rows stay as they are, linear rows are divided by the length L. With s = 1/L and singular values σ_k(s):

- ``rms``: the squares of linear and of angular rows are balanced, as they are in an isotropic matrix. With all joints
  revolute, L = √(Σ‖e×r‖²/n) in space and √(Σ‖r‖²/2n) in a plane.
- ``conditioning`` (Angeles and Chablat, *On isotropic sets of points in the plane*, 2000): L of least Frobenius
  distance to the isotropic matrices, the multiples of matrices with orthonormal rows: d² = Σσ² − (Σσ)²/m.
- ``least_condition``: L of the least condition number σ_1/σ_m.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from wsrender.documents.kinetostatics import CharacteristicLengthChoice
from wsrender.errors import InputError
from wsrender.kinetostatics.kinematics import PostureKinematics

ALL_ROWS = (0, 1, 2, 3, 4, 5)
_DECADES, _STEPS = 4.0, 161  # of lengths searched around the root mean square


@dataclass(frozen=True)
class CharacteristicLength:
    """A length [m], the method that gave it, its posture (n,), and the condition number there (None: no bound)."""

    length_m: float
    method: str
    posture: np.ndarray | None
    condition_number: float | None


def homogeneous(J: np.ndarray, length_m: float) -> np.ndarray:
    """The Jacobian (6, n) with its linear rows divided by the characteristic length [m]."""
    return J / np.array([length_m] * 3 + [1.0] * 3)[:, None]


def condition_number(J: np.ndarray, length_m: float, rows: tuple[int, ...] = ALL_ROWS) -> float:
    """κ = σ_1/σ_m of the homogeneous rows of J (6, n); infinite at a singular posture."""
    sigma = np.linalg.svd(homogeneous(J, length_m)[list(rows)], compute_uv=False)
    if len(sigma) < len(rows) or sigma[-1] <= max(J.shape) * np.finfo(float).eps * sigma[0]:
        return float("inf")
    return float(sigma[0] / sigma[-1])


def rms_length(J: np.ndarray, rows: tuple[int, ...] = ALL_ROWS) -> float:
    """L that balances the squares of linear and angular rows, over the columns of revolute joints."""
    linear, angular, turning = _blocks(J, rows)
    squares = (linear[:, turning] ** 2).sum() / len(linear), (angular[:, turning] ** 2).sum() / len(angular)
    if min(squares) <= 0:
        raise InputError(
            "characteristic_length",
            'has no answer: no joint turns the end effector at a distance; give it with the method "given"',
        )
    return float(np.sqrt(squares[0] / squares[1]))


def conditioning_length(J: np.ndarray, rows: tuple[int, ...] = ALL_ROWS) -> float:
    """L of least distance between J(L) and the set of isotropic matrices."""
    start = rms_length(J, rows)
    linear, angular, _ = _blocks(J, rows)
    m = _regular_rows(linear, angular)

    def distance(exponent: float) -> float:
        sigma = np.linalg.svd(np.vstack([linear / (start * np.exp(exponent)), angular]), compute_uv=False)
        return float((sigma**2).sum() - sigma.sum() ** 2 / m)

    def slope(exponent: float) -> float:
        """Derivative of the squared distance by s = 1/L, over 2."""
        s = np.exp(-exponent) / start
        u, sigma, v = np.linalg.svd(np.vstack([s * linear, angular]), full_matrices=False)
        nuclear = float(((u @ v)[: len(linear)] * linear).sum())  # of Σσ
        return float(s * (linear**2).sum() - sigma.sum() * nuclear / m)

    low, high = _bracket(distance)
    root: Any = brentq(slope, low, high, xtol=1e-14)
    return float(start * np.exp(root))


def least_condition_length(J: np.ndarray, rows: tuple[int, ...] = ALL_ROWS) -> float:
    """L of the least condition number of J(L)."""
    start = rms_length(J, rows)
    linear, angular, _ = _blocks(J, rows)
    _regular_rows(linear, angular)

    def logarithm(exponent: float) -> float:
        sigma = np.linalg.svd(np.vstack([linear / (start * np.exp(exponent)), angular]), compute_uv=False)
        return float(np.log(sigma[0] / sigma[-1]))

    found: Any = minimize_scalar(logarithm, bounds=_bracket(logarithm), method="bounded", options={"xatol": 1e-12})
    return float(start * np.exp(found.x))


METHODS = {"rms": rms_length, "conditioning": conditioning_length, "least_condition": least_condition_length}


def characteristic_length(
    kinematics: PostureKinematics, choice: CharacteristicLengthChoice, rows: tuple[int, ...]
) -> CharacteristicLength:
    """The length that a document chooses, for the rows of its task (all six where the task does not mix kinds).

    An arm without a revolute joint needs none: 1 m, method "none". Raises InputError for a posture of the wrong length,
    and one at which the length is not defined.
    """
    chain = kinematics.chain
    if choice.length_m is not None:
        return CharacteristicLength(choice.length_m, "given", None, None)
    if not chain.joint_is_revolute.any():
        return CharacteristicLength(1.0, "none", None, None)
    q = (chain.lower_limits + chain.upper_limits) / 2 if choice.posture is None else np.array(choice.posture)
    if len(q) != chain.n:
        raise InputError("characteristic_length.posture", f"has {len(q)} values; the robot has {chain.n} joints")
    mixed = min(rows) < 3 <= max(rows)
    J, rows = kinematics.at(q).J, rows if mixed else ALL_ROWS
    length = METHODS[choice.method](J, rows)
    kappa = condition_number(J, length, rows)
    return CharacteristicLength(length, choice.method, q, kappa if np.isfinite(kappa) else None)


def _blocks(J: np.ndarray, rows: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Linear and angular rows of the task, and which columns (n,) turn."""
    linear, angular = J[[row for row in rows if row < 3]], J[[row for row in rows if row >= 3]]
    if not len(linear) or not len(angular):
        raise InputError("task", "must mix linear and angular rows: without both there is no characteristic length")
    return linear, angular, np.linalg.norm(J[3:], axis=0) > 1e-12


def _regular_rows(linear: np.ndarray, angular: np.ndarray) -> int:
    """Number of rows; InputError where no length makes them isotropic, since they depend on each other."""
    rows = np.vstack([linear / np.abs(linear).max(), angular])
    if np.linalg.matrix_rank(rows, tol=1e-9) < len(rows):
        raise InputError(
            "characteristic_length.posture", f"is singular: the {len(rows)} rows of the task depend on each other there"
        )
    return len(rows)


def _bracket(function) -> tuple[float, float]:
    """Two logarithms of the length around the least of a scan of many decades."""
    exponents = np.linspace(-1, 1, _STEPS) * _DECADES * np.log(10)
    best = int(np.argmin([function(x) for x in exponents]))
    if best in (0, _STEPS - 1):
        raise InputError("characteristic_length.posture", "has its best length at zero or infinity")
    return float(exponents[best - 1]), float(exponents[best + 1])
