"""Jacobians of a five-bar, A ṗ = B θ̇, their condition numbers with gradients, and the manipulability ([CB])."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.mechanisms.five_bar.mechanism import FiveBar, rows_of


def parallel_jacobian(five_bar: FiveBar, angles: Any) -> np.ndarray:
    """A [m] at angles θ1 … θ4 (N, 4) or (4,) [rad], (N, 2, 2): rows P − C and P − D."""
    distal = rows_of(angles, 4, "angles")[:, 2:]
    return np.array(five_bar.distal_m)[:, None] * np.stack([np.cos(distal), np.sin(distal)], axis=2)


def serial_jacobian(five_bar: FiveBar, angles: Any) -> np.ndarray:
    """B [m²] at angles (N, 4) or (4,) [rad], (N, 2, 2): diagonal L1 L2 sin(θ3 − θ1), L1' L2' sin(θ4 − θ2)."""
    angles = rows_of(angles, 4, "angles")
    diagonal = np.multiply(five_bar.proximal_m, five_bar.distal_m) * np.sin(angles[:, 2:] - angles[:, :2])
    return diagonal[:, :, None] * np.eye(2)


def jacobian(five_bar: FiveBar, angles: Any) -> np.ndarray:
    """J = A⁻¹ B [m/rad], ṗ = J θ̇, at angles (N, 4) or (4,) [rad], (N, 2, 2); NaN where A is singular."""
    A, B = parallel_jacobian(five_bar, angles), serial_jacobian(five_bar, angles)
    (a, b), (c, d) = A[:, 0].T, A[:, 1].T
    adjugate = np.stack([np.stack([d, -b], axis=1), np.stack([-c, a], axis=1)], axis=1)
    determinant = a * d - b * c
    determinant[determinant == 0] = np.nan
    return adjugate @ B / determinant[:, None, None]


@dataclass(frozen=True, eq=False)
class Conditioning:
    """Indices of N postures, each (N,): 1/κ of A, B and J [1], det A and det B, manipulability |det J|.

    1/κ is 0 where the matrix is singular (for J: where A or B is), and 1 where it is isotropic; the manipulability is
    infinite where A alone is singular. Postures with NaN angles have NaN.
    """

    inverse_kappa_a: np.ndarray
    inverse_kappa_b: np.ndarray
    inverse_kappa_j: np.ndarray
    det_a: np.ndarray
    det_b: np.ndarray
    manipulability: np.ndarray


def conditioning(five_bar: FiveBar, angles: Any) -> Conditioning:
    """The indices at angles θ1 … θ4 (N, 4) or (4,) [rad]."""
    angles = rows_of(angles, 4, "angles")
    delta = angles[:, 2] - angles[:, 3]
    sines = np.sin(angles[:, 2:] - angles[:, :2])
    beta = np.multiply(five_bar.proximal_m, five_bar.distal_m) * sines
    left, right = np.array(five_bar.proximal_m)[:, None] * np.abs(sines.T)
    distal = np.array(five_bar.distal_m)[:, None] * np.ones(len(angles))
    det_a, det_b = -np.prod(five_bar.distal_m) * np.sin(delta), beta.prod(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return Conditioning(
            _inverse_condition(distal[0], distal[1], delta),
            _ratio(np.abs(beta).min(axis=1), np.abs(beta).max(axis=1)),
            # J⁻¹ has rows u(θ3)/(L1 sin(θ3 − θ1)) and u(θ4)/(L1' sin(θ4 − θ2)): times both sines, those of A's kind.
            _inverse_condition(right, left, delta),
            det_a,
            det_b,
            np.abs(det_b) / np.abs(det_a),
        )


def _inverse_condition(first: np.ndarray, second: np.ndarray, delta: np.ndarray) -> np.ndarray:
    """1/κ of the 2×2 matrices with rows of lengths ``first`` and ``second`` at the angle δ.

    σ1 ± σ2 are known exactly, (σ1 ± σ2)² = a² + b² ± 2ab|sin δ|; with a = b their quotient gives
    κ = max(|tan δ/2|, |cot δ/2|). The difference is written as a sum of squares: nothing cancels near isotropy.
    """
    quarter = np.pi / 4 - delta / 2
    least = np.minimum(np.sin(quarter) ** 2, np.cos(quarter) ** 2)  # (1 − |sin δ|)/2
    product = first * second
    difference = np.sqrt((first - second) ** 2 + 4 * product * least)
    total = np.sqrt((first - second) ** 2 + 4 * product * (1 - least))
    largest = (total + difference) / 2
    return _ratio(product * np.abs(np.sin(delta)), largest**2)


def _ratio(small: np.ndarray, large: np.ndarray) -> np.ndarray:
    """Quotient of two numbers that are at least 0; 0 where both are 0."""
    return np.where(large == 0, 0.0, small / np.where(large == 0, 1.0, large))


def conditioning_gradients(five_bar: FiveBar, angles: Any) -> tuple[np.ndarray, np.ndarray]:
    """∂(1/κ(A))/∂P and ∂(1/κ(B))/∂P [1/m] at angles θ1 … θ4 (N, 4) or (4,) [rad], (N, 2) each.

    A force towards better conditioning points along them. NaN at type-1 singular postures, where the angles have no
    derivative by P, and where 1/κ has a kink: at isotropy, and κ(A) where the distal links are aligned.
    """
    angles = rows_of(angles, 4, "angles")
    found = conditioning(five_bar, angles)
    proximal, distal = angle_gradients(five_bar, angles)
    delta = angles[:, 2] - angles[:, 3]
    with np.errstate(invalid="ignore", divide="ignore"):
        # σ1 ± σ2 = √(a² + b² ± 2ab |sin δ|) of A, whose rows have the lengths a and b and the angle δ between them.
        (a, b), sine = five_bar.distal_m, np.abs(np.sin(delta))
        total, difference = (np.sqrt(a * a + b * b + sign * 2 * a * b * sine) for sign in (1, -1))
        by_sine = 2 * a * b * (total**2 + difference**2) / (total * difference * (total + difference) ** 2)
        slope = np.where(np.isfinite(by_sine), by_sine, np.nan) * np.cos(delta) * _sign(np.sin(delta))
        by_position_a = slope[:, None] * (distal[:, 0] - distal[:, 1])
        # d ln|β| of each leg, β = L1 L2 sin of the elbow's angle: 1/κ(B) is the lesser over the greater.
        elbow = angles[:, 2:] - angles[:, :2]
        logarithms = (distal - proximal) / np.tan(elbow)[:, :, None]
        beta = np.multiply(five_bar.proximal_m, five_bar.distal_m) * np.abs(np.sin(elbow))
        lesser = _sign(beta[:, 1] - beta[:, 0])  # 1 where the left leg's is
        by_position_b = (found.inverse_kappa_b * lesser)[:, None] * (logarithms[:, 0] - logarithms[:, 1])
    return by_position_a, by_position_b


def angle_gradients(five_bar: FiveBar, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """∂θ1, ∂θ2 and ∂θ3, ∂θ4 by P [rad/m] at angles (N, 4), (N, 2, 2) each: row, leg, coordinate; NaN if singular.

    Along u(θ3) the point moves by L1 sin(θ3 − θ1) θ̇1, along u(θ1) by −L2 sin(θ3 − θ1) θ̇3.
    """
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=2)
    sines = np.sin(angles[:, 2:] - angles[:, :2])
    sines = np.where(sines == 0, np.nan, sines)[:, :, None]
    first, second = (np.array(lengths)[:, None] for lengths in (five_bar.proximal_m, five_bar.distal_m))
    return directions[:, 2:] / (first * sines), -directions[:, :2] / (second * sines)


def _sign(values: np.ndarray) -> np.ndarray:
    """Signs; NaN at 0, a kink."""
    return np.where(values == 0, np.nan, np.sign(values))
