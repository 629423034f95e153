"""Conditioning of a posture at the speed of a haptic loop: singular values, 1/κ, its gradient, the force along it."""

from typing import Any

import numpy as np
from scipy.linalg import lapack

from wsrender.documents.kinetostatics import ConditioningForce
from wsrender.errors import NumericalError
from wsrender.kinetostatics.kinematics import Posture, PostureKinematics

_dgesdd: Any = lapack.dgesdd  # type: ignore[attr-defined]
SMALL = 1e-2  # share of the largest singular value below which the pseudo-inverse is damped


def decomposed(A: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """U (m, k), σ (k,), Vᵀ (k, n) of A (m, n); LAPACK itself, since np.linalg.svd takes twice as long."""
    u, sigma, v, fault = _dgesdd(A, full_matrices=0)
    if fault:
        raise NumericalError("the singular values of a Jacobian did not converge")
    return u, sigma, v


def damped_factor(sigma: np.ndarray, v: np.ndarray) -> np.ndarray:
    """V Σ⁺ (n, k) of a decomposition: the pseudo-inverse is this times Uᵀ, and stays bounded at singular postures.

    Numerical filtering (Maciejewski and Klein 1988) with λ² = ε² − σ² (Nakamura and Hanafusa 1986): a singular value
    above ε = σ_1 / 100 is inverted exactly, one below counts as σ/ε², which is 0 where there is no motion at all.
    """
    least = SMALL * float(sigma[0])
    if least == 0.0:
        return np.zeros(v.shape[::-1])
    counted = np.maximum(sigma, least)
    return v.T * (sigma / (counted * counted))


def damped_inverse(A: np.ndarray) -> np.ndarray:
    """Damped pseudo-inverse (n, m) of A (m, n)."""
    u, sigma, v = decomposed(A)
    return damped_factor(sigma, v) @ u.T


class TaskConditioning:
    """i = σ_m/σ_1 of the rows of a task, linear ones divided by the characteristic length [m]."""

    def __init__(self, kinematics: PostureKinematics, rows: tuple[int, ...], length: float):
        scale = [1 / length if row < 3 and max(rows) >= 3 else 1.0 for row in rows]
        self._select = np.zeros((len(rows), 6))  # rows of the task, scaled
        self._select[range(len(rows)), rows] = scale
        self._coupling = kinematics.coupling
        before = np.tri(len(kinematics.chain.joint_source), k=-1).T  # sums over the joints before one
        self._sums = np.stack([before, 1.0 - before])  # and over it and those after it
        self._second = _SECOND @ self._select.T

    def at(self, posture: Posture) -> "Condition":
        """The conditioning of a posture."""
        A = self._select.dot(posture.J)
        u, sigma, v = decomposed(A)
        largest, least = float(sigma[0]), float(sigma[-1])
        if len(sigma) < len(A) or least <= max(A.shape) * _EPSILON * largest:
            return Condition(0.0, u, sigma, v)
        return Condition(least / largest, u, sigma, v)

    def gradient(self, posture: Posture, condition: "Condition") -> np.ndarray:
        """∇i by q, (n,); zero where i is 0 by rank, and for a task of one row.

        dσ_k = u_kᵀ dA v_k, so di = ⟨Y, dJ⟩ with columns (y_i, z_i) of Y, and dJ from the second-order kinematics of a
        chain (Hourtash, *The kinematic Hessian and higher derivatives*, 2005): joint j turns the columns (v_i, ω_i) of
        the joints i after it by ω_j, and moves the tip, v_j, that those before it turn:
        ∂i/∂q_j = ω_j·Σ_{i≥j} (v_i × y_i + ω_i × z_i) − v_j·Σ_{i<j} ω_i × y_i.
        """
        u, sigma, v = condition.parts
        if condition.inverse == 0.0 or len(sigma) == 1:
            return np.zeros(len(posture.q))
        weights, largest = np.zeros(len(sigma)), float(sigma[0])
        weights[0], weights[-1] = -condition.inverse / largest, 1.0 / largest
        by_row = (u * weights).dot(v)  # ∂i/∂A
        if self._coupling is not None:
            by_row = by_row @ self._coupling.T
        columns = posture.columns
        crossed = _CROSS.dot(_FIRST.dot(columns) * self._second.dot(by_row))
        gradient = _ONES.dot(columns * (crossed.reshape(2, 3, -1) @ self._sums).reshape(6, -1))
        return gradient if self._coupling is None else gradient @ self._coupling


class Condition:
    """``inverse`` = 1/κ of a posture, 0 where it is singular, and the decomposition that it came from, ``parts``."""

    __slots__ = ("inverse", "parts")

    def __init__(self, inverse: float, u: np.ndarray, sigma: np.ndarray, v: np.ndarray):
        self.inverse, self.parts = inverse, (u, sigma, v)


class ConditioningRamp:
    """The conditioning force of [CB]: |F| = F_max clip((i_on − i)/(i_on − i_th), 0, 1), i_th = 1/κ_threshold."""

    def __init__(self, choice: ConditioningForce, peak: float, length: float):
        self.peak = peak
        self.on = choice.inverse_condition_on
        self.width = self.on - 1 / choice.condition_threshold
        self.stiffness = choice.stiffness_n_m or peak * length / self.width

    def share(self, inverse: float) -> float:
        """Part of the full strength, 0 … 1."""
        return min(max((self.on - inverse) / self.width, 0.0), 1.0)

    def slope(self, inverse: float) -> float:
        """Minus the derivative of the energy by i [J]."""
        return self.stiffness * max(self.on - inverse, 0.0)

    def energy(self, inverse: float) -> float:
        """½ k clip(i_on − i, 0)² [J]."""
        return 0.5 * self.stiffness * max(self.on - inverse, 0.0) ** 2


def _cross_products() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """F (18, 6), S (18, 6), X (6, 18): X ((F c) ∘ (S y)) are −ω × y and v × y + ω × z of c = (v, ω), (y, z)."""
    first, second, out = np.zeros((18, 6)), np.zeros((18, 6)), np.zeros((6, 18))
    pairs = ((3, 0, 0, -1.0), (0, 0, 3, 1.0), (3, 3, 3, 1.0))  # where a, b and their cross product begin, and its sign
    terms = [(*pair, k, turn) for pair in pairs for k in range(3) for turn in (1, -1)]
    for row, (a, b, to, sign, k, turn) in enumerate(terms):  # (a × b)_k = a_{k+1} b_{k+2} − a_{k+2} b_{k+1}
        first[row, a + (k + turn) % 3] = second[row, b + (k - turn) % 3] = 1.0
        out[to + k, row] = sign * turn
    return first, second, out


_FIRST, _SECOND, _CROSS = _cross_products()
_ONES = np.ones(6)
_EPSILON = float(np.finfo(float).eps)
