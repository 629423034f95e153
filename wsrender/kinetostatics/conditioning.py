"""The inverse condition number of a posture, its gradient, and the force along it."""

import numpy as np

from wsrender.kinetostatics.kinematics import Kinematics, Posture
from wsrender.kinetostatics.singular_values import decomposed
from wsrender.spec.kinetostatics import ConditioningForce


class Conditioning:
    """i = σ_m/σ_1 of the rows of a task, linear ones divided by the characteristic length [m]."""

    def __init__(self, kinematics: Kinematics, rows: tuple[int, ...], length: float):
        chain = kinematics.chain
        scale = [1 / length if row < 3 and max(rows) >= 3 else 1.0 for row in rows]
        self._select = np.zeros((len(rows), 6))  # rows of the task, scaled
        self._select[range(len(rows)), rows] = scale
        self._coupling = np.zeros((len(chain.joint_source), chain.n))
        self._coupling[range(len(self._coupling)), chain.joint_source] = chain.joint_scale
        self._until = np.tri(len(self._coupling), k=-1)  # sums over the joints before one
        self._from = 1.0 - self._until  # and over it and those after it

    def at(self, posture: Posture) -> "Condition":
        """The conditioning of a posture."""
        A = self._select @ posture.J
        u, sigma, v = decomposed(A)
        if len(sigma) < len(A) or sigma[-1] <= max(A.shape) * np.finfo(float).eps * sigma[0]:
            return Condition(0.0, u, sigma, v)
        return Condition(float(sigma[-1] / sigma[0]), u, sigma, v)

    def gradient(self, posture: Posture, condition: "Condition") -> np.ndarray:
        """∇i by q, (n,); zero where i is 0 by rank, and for a task of one row.

        dσ_k = u_kᵀ dA v_k, and dA from the second-order kinematics of a chain (Hourtash, *The kinematic Hessian and
        higher derivatives*, 2005): joint j turns the columns (v_i, ω_i) of the joints i after it by ω_j, and moves the
        tip, v_j, that those before it turn. Both singular values, σ_m and σ_1, are treated at once: six columns.
        """
        m = len(condition.sigma)
        if condition.inverse == 0.0 or m == 1:
            return np.zeros(len(posture.q))
        left = self._select.T @ condition.u[:, :: m - 1]  # (6, 2): of σ_1 and σ_m
        right = self._coupling @ (condition.v[:: m - 1].T * (np.array([-condition.inverse, 1.0]) / condition.sigma[0]))
        turn, swing = (_CROSS @ left.ravel()).reshape(2, 6, 6)
        columns, weights = posture.columns.T, right @ _SPREAD  # (L, 6)
        v, w = columns @ _LINEAR, columns @ _ANGULAR  # (L, 6): once for each singular value
        after = self._from @ (weights * (columns @ turn))
        before = (self._until @ (weights * w)) @ swing
        return (w * after - v * before) @ _ONES @ self._coupling


class Condition:
    """``inverse`` = 1/κ of a posture, 0 where it is singular, and the decomposition that it came from."""

    __slots__ = ("inverse", "sigma", "u", "v")

    def __init__(self, inverse: float, u: np.ndarray, sigma: np.ndarray, v: np.ndarray):
        self.inverse, self.u, self.sigma, self.v = inverse, u, sigma, v


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


def _cross_products() -> np.ndarray:
    """(72, 12): from (u_1, u_2) as (6, 2) to two matrices (6, 6), of columns (3 to a singular value).

    The first takes (v, ω) to v × u_lin + ω × u_ang, the second (a_1, a_2) to a × u_lin.
    """
    levi_civita = np.zeros((3, 3, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        levi_civita[i, j, k], levi_civita[j, i, k] = 1.0, -1.0
    turn, swing = np.zeros((6, 6, 6, 2)), np.zeros((6, 6, 6, 2))
    for sigma in range(2):
        columns = slice(3 * sigma, 3 * sigma + 3)
        by_vector = levi_civita.transpose(0, 2, 1)  # (a × u)_c = ε_aub: [a, c, u]
        turn[:3, columns, :3, sigma] = turn[3:, columns, 3:, sigma] = by_vector
        swing[columns, columns, :3, sigma] = by_vector
    return np.stack([turn, swing]).reshape(72, 12)


_CROSS = _cross_products()
_SPREAD = np.kron(np.eye(2), np.ones((1, 3)))  # a value of each singular value to its three columns
_LINEAR = np.vstack([np.hstack([np.eye(3)] * 2), np.zeros((3, 6))])
_ANGULAR = np.roll(_LINEAR, 3, axis=0)
_ONES = np.ones(6)
