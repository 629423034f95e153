"""Gradients of a five-bar's conditioning by the position of its end point: where a conditioning force points ([CB])."""

from typing import Any

import numpy as np

from wsrender.mechanisms.five_bar.condition_numbers import conditioning
from wsrender.mechanisms.five_bar.mechanism import FiveBar, rows_of


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
