"""Singular values of one small matrix, and the damped pseudo-inverse, at the speed of a haptic loop."""

from typing import Any

import numpy as np
from scipy.linalg import lapack

from wsrender.errors import NumericalError

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
