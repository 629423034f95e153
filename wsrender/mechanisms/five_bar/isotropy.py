"""Where a five-bar is isotropic: the curves κ(B) = 1, and the points κ(J) = 1."""

from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np
from scipy.optimize import root_scalar

from wsrender.mechanisms.five_bar.condition_numbers import conditioning
from wsrender.mechanisms.five_bar.loci import least_kappa_a_curves, pieces
from wsrender.mechanisms.five_bar.mechanism import FiveBar

SAMPLES = np.linspace(0.0, 2 * np.pi, 721)  # parameters of a curve
ON_LOCUS = 1e-9  # of κ(B)
HALVINGS = 60  # of the step in which a curve leaves the workspace

PlaneCurve = Callable[[np.ndarray], np.ndarray]
"""Points (N, 2) [m] at parameters (N,) in [0, 2π]."""


def isotropic_b(five_bar: FiveBar, working_mode: str) -> list[np.ndarray]:
    """Postures with κ(B) = 1 in a working mode: runs of θ1 … θ4 (N, 4) [rad] along plane curves.

    The triangles A C P and B D P then have equal areas. With ρ, ρ' the squared distances of P from A and B,
    a = L1 L2 and s = L1² + L2² (a', s' of the right leg): 4a² − (ρ − s)² = 4a'² − (ρ' − s')².
    """
    return [run for curve in _equal_areas(five_bar) for run in _runs_within(five_bar, working_mode, curve)]


def isotropic_points(five_bar: FiveBar, working_mode: str) -> np.ndarray:
    """Postures with κ(J) = 1 in a working mode, θ1 … θ4 (N, 4) [rad].

    The distal links are at right angles, and L1 |sin(θ3 − θ1)| = L1' |sin(θ4 − θ2)|.
    """
    found = []
    for piece in (piece for curve in least_kappa_a_curves(five_bar) for piece in pieces(curve)):
        if piece.working_mode != working_mode:
            continue

        def unlike(t: np.ndarray, angles: PlaneCurve = piece.curve.angles) -> np.ndarray:
            at = angles(np.atleast_1d(t))
            left, right = (np.array(five_bar.proximal_m) * np.abs(np.sin(at[:, 2:] - at[:, :2]))).T
            return left - right

        t = np.linspace(piece.low, piece.high, len(SAMPLES))
        values = unlike(t)
        steps = np.flatnonzero(values[:-1] * values[1:] < 0)
        roots = [root_scalar(lambda x: unlike(x)[0], bracket=(t[k], t[k + 1]), xtol=1e-14).root for k in steps]
        found.append(piece.curve.angles(np.array(roots)) if roots else np.empty((0, 4)))
    return np.concatenate([np.empty((0, 4)), *found])


def _equal_areas(five_bar: FiveBar) -> Iterator[PlaneCurve]:
    """The curves, not clipped to the workspace.

    With X = ρ + ρ' − s − s' and Y = ρ − ρ' − s + s' the equation is X Y = 4(a² − a'²); Y is linear in x. Legs with
    a = a' give the line Y = 0 and the circle X = 0, others a cubic, y² = g(x).
    """
    base = five_bar.base_m
    (first, second), (third, fourth) = zip(five_bar.proximal_m, five_bar.distal_m, strict=True)
    total = first**2 + second**2 + third**2 + fourth**2
    offset = first**2 + second**2 - third**2 - fourth**2 + base**2  # Y = 2 L0 x − offset
    product = 4 * ((first * second) ** 2 - (third * fourth) ** 2)
    reach = max(five_bar.reach_m(0)[1], five_bar.reach_m(1)[1])
    if abs(product) <= 1e-13 * five_bar.size_m**4:
        yield lambda t: np.stack([np.full(len(t), offset / (2 * base)), -reach * np.cos(t / 2)], axis=1)
        squared = total / 2 - base**2 / 4
        if squared > 0:
            yield lambda t: np.array([base / 2, 0]) + np.sqrt(squared) * np.stack([np.cos(t), np.sin(t)], axis=1)
        return

    def squared_y(x: np.ndarray) -> np.ndarray:
        with np.errstate(divide="ignore"):
            return (product / (2 * base * x - offset) + total - base**2 + 2 * base * x) / 2 - x**2

    # g(x) is at least 0 between some of its roots, its pole, and the ends of what is looked at.
    cubic = np.polyadd(np.polymul([2 * base, -offset], [-1.0, base, (total - base**2) / 2]), [product / 2])
    roots = np.roots(cubic)
    real = roots[np.abs(roots.imag) < 1e-9 * five_bar.size_m].real
    ends = sorted({*real, offset / (2 * base), -2 * reach, base + 2 * reach})
    for low, high in pairwise(ends):
        if squared_y(np.array([(low + high) / 2]))[0] > 0:
            yield _both_halves(squared_y, low, high, 4 * reach)


def _both_halves(squared_y: Callable[[np.ndarray], np.ndarray], low: float, high: float, farthest: float) -> PlaneCurve:
    """The branches y = ±√g(x) over an interval of x, there and back; y stops at ``farthest``, out of all reach."""

    def points(t: np.ndarray) -> np.ndarray:
        x = (low + high) / 2 - (high - low) / 2 * np.cos(t)
        y = np.sqrt(np.clip(squared_y(x), 0.0, farthest**2))
        return np.stack([x, np.where(np.sin(t) >= 0, y, -y)], axis=1)

    return points


def _runs_within(five_bar: FiveBar, working_mode: str, curve: PlaneCurve) -> Iterator[np.ndarray]:
    """The stretches of a curve that the mode reaches, up to where it leaves the workspace.

    At a corner of the workspace both legs are stretched or folded: B is 0 there, and κ(B) has no value.
    """

    def reached(t: np.ndarray) -> np.ndarray:
        found = conditioning(five_bar, five_bar.inverse_kinematics(curve(t), working_mode))
        return np.abs(found.inverse_kappa_b - 1.0) <= ON_LOCUS

    inside = reached(SAMPLES)
    starts = np.flatnonzero(inside & ~np.concatenate([[False], inside[:-1]]))
    stops = np.flatnonzero(inside & ~np.concatenate([inside[1:], [False]]))
    for start, stop in zip(starts, stops, strict=True):
        before = [_last_inside(reached, SAMPLES[start], SAMPLES[start - 1])] if start > 0 else []
        after = [_last_inside(reached, SAMPLES[stop], SAMPLES[stop + 1])] if stop + 1 < len(SAMPLES) else []
        t = np.concatenate([before, SAMPLES[start : stop + 1], after])
        yield five_bar.inverse_kinematics(curve(t), working_mode)


def _last_inside(reached: Callable[[np.ndarray], np.ndarray], inside: float, outside: float) -> float:
    for _ in range(HALVINGS):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if reached(np.array([middle]))[0] else (inside, middle)
    return inside
