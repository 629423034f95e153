"""Loci of a five-bar: where its distal links make a given angle, and where κ(B) = 1; exact parametrisations ([CB])."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.optimize import fminbound, root_scalar

from wsrender.mechanisms.five_bar.mechanism import FiveBar, wrapped
from wsrender.mechanisms.five_bar.region import LEGS

_START = 0.1  # not 0: there and at π elbows often stretch, and a scan should have such events inside
SCAN = np.linspace(_START, _START + 2 * np.pi, 1441)  # parameters between which one event is looked for
TOUCHING = 1e-9  # sine or angle [rad] below which a curve touches a boundary without crossing it
ON_ARC = 1e-6  # the same of postures that an event finds on an arc: roots of flat postures are found as squares
ROUNDING = 1e-13  # the same of postures of a curve that runs along a boundary
BESIDE = 1e-10  # how far beside a cut a piece begins: at cuts where an elbow meets a base, the curve has a jump
MERGED = 1e-7  # events nearer than this in the curve's parameter are one


@dataclass(frozen=True, eq=False)
class Curve:
    """A closed curve of postures: ``angles(t)`` gives θ1 … θ4 (N, 4) [rad] at t (N,) in [0, 2π], the ends being one.

    ``five_bar`` places them; nothing is said of limits or modes.
    """

    kind: str
    five_bar: FiveBar
    angles: Callable[[np.ndarray], np.ndarray]

    def positions(self, t: np.ndarray) -> np.ndarray:
        """P at parameters t, (N, 2) [m]."""
        return end_point(self.five_bar, self.angles(t))


@dataclass(frozen=True)
class BoundaryMeeting:
    """Where a curve meets the boundary of a working mode: parameter t, and the arcs that meet there.

    ``arcs`` holds (name, joint angle along it) of each; in flat postures both legs have one, not all of them bound the
    workspace.
    """

    t: float
    arcs: tuple[tuple[str, float], ...]


@dataclass(frozen=True, eq=False)
class LocusPiece:
    """A curve from ``start`` to ``stop`` within one working mode and the limits; closed if it meets no boundary."""

    curve: Curve
    working_mode: str
    low: float
    high: float
    start: BoundaryMeeting | None = None
    stop: BoundaryMeeting | None = None

    @property
    def closed(self) -> bool:
        """Whether it ends where it starts."""
        return self.start is None

    def angles(self, count: int) -> np.ndarray:
        """θ1 … θ4 at ``count`` + 1 parameters from its start to its end, evenly spaced, (count + 1, 4)."""
        return self.curve.angles(np.linspace(self.low, self.high, count + 1))


def end_point(five_bar: FiveBar, angles: np.ndarray) -> np.ndarray:
    """P of postures θ1 … θ4 (N, 4), by the left leg, (N, 2) [m]."""
    elbow = five_bar.elbows(angles)[:, 0]
    return elbow + five_bar.distal_m[0] * np.stack([np.cos(angles[:, 2]), np.sin(angles[:, 2])], axis=1)


def postures(five_bar: FiveBar, theta: np.ndarray, position: np.ndarray) -> np.ndarray:
    """θ1 … θ4 (N, 4) [rad] of actuated angles (N, 2) and the P (N, 2) [m] that belongs to them."""
    distal = position[:, None] - five_bar.elbows(theta)
    return np.concatenate([theta, np.arctan2(distal[..., 1], distal[..., 0])], axis=1)


def type_2_curves(five_bar: FiveBar) -> list[Curve]:
    """Postures in which C, P and D are in line: det A = 0."""
    return [*angle_curves(five_bar, 0.0, "type_2"), *angle_curves(five_bar, np.pi, "type_2")]


def least_kappa_a_curves(five_bar: FiveBar) -> list[Curve]:
    """Postures in which the distal links are at right angles: κ(A) is least, and 1 where they are equal."""
    quarter = np.pi / 2
    return [c for delta in (quarter, -quarter) for c in angle_curves(five_bar, delta, "least_kappa_a")]


def angle_curves(five_bar: FiveBar, delta: float, kind: str) -> list[Curve]:
    """All postures with θ3 − θ4 = δ [rad].

    C and D then are a constant distance c apart: P is a point on the coupler of the four-bar (L0, L1, c, L1'). With
    δ = 0 and equal distal links c is 0, and P runs on circles about the points that C = D may take.
    """
    a, b = five_bar.distal_m
    squared = (a - b) ** 2 + 2 * a * b * (1 - np.cos(delta))
    if squared <= (1e-12 * five_bar.size_m) ** 2:
        return [Curve(kind, five_bar, _circle_angles(theta)) for theta in _meeting_elbows(five_bar)]
    c = float(np.sqrt(squared))
    return [Curve(kind, five_bar, _coupler_angles(five_bar, delta, c, *motion)) for motion in _motions(five_bar, c)]


def _meeting_elbows(five_bar: FiveBar) -> list[np.ndarray]:
    """θ1 and θ2 with C = D: none, one or two pairs."""
    first, second = five_bar.proximal_m
    foot = (five_bar.base_m**2 + first**2 - second**2) / (2 * five_bar.base_m)
    squared = first**2 - foot**2
    if squared < 0:
        return []
    heights = [np.sqrt(squared), -np.sqrt(squared)] if squared > 0 else [0.0]
    return [np.array([np.arctan2(h, foot), np.arctan2(h, foot - five_bar.base_m)]) for h in heights]


def _circle_angles(theta: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    return lambda t: np.stack([np.full(len(t), theta[0]), np.full(len(t), theta[1]), t, t], axis=1)


def _motions(five_bar: FiveBar, coupler: float) -> Iterator[tuple[float, float, int]]:
    """Closed motions of the four-bar (L0, L1, coupler, L1'): middle and half range of θ1, side of D.

    θ1 = middle + half·cos t swings between the ends, where D changes sides (side 0); where the crank turns fully
    (half 0) θ1 = t and D stays on one side of the line C → B.
    """
    base, (first, second) = five_bar.base_m, five_bar.proximal_m
    scale = 2 * base * first
    least = (base**2 + first**2 - (coupler + second) ** 2) / scale  # cos θ1 lies between least and largest
    largest = (base**2 + first**2 - (coupler - second) ** 2) / scale
    if least >= 1 or largest <= -1:
        return
    if least <= -1 and largest >= 1:
        yield from ((0.0, 0.0, side) for side in (1, -1))
    elif largest >= 1:
        yield 0.0, float(np.arccos(least)), 0
    elif least <= -1:
        low = float(np.arccos(largest))
        yield np.pi, np.pi - low, 0
    else:
        low, high = float(np.arccos(largest)), float(np.arccos(least))
        yield from ((sign * (low + high) / 2, (high - low) / 2, 0) for sign in (1, -1))


def _coupler_angles(
    five_bar: FiveBar, delta: float, c: float, middle: float, half: float, side: int
) -> Callable[[np.ndarray], np.ndarray]:
    a, b = five_bar.distal_m
    along, across = a * (a - b * np.cos(delta)) / c, -a * b * np.sin(delta) / c  # P − C in the frame of C → D
    second, B = five_bar.proximal_m[1], np.array([five_bar.base_m, 0.0])

    def angles(t: np.ndarray) -> np.ndarray:
        theta_1 = middle + half * np.cos(t) if half else t
        sides = np.where(np.sin(t) >= 0, 1, -1) if half else np.full(len(t), side)
        C = five_bar.elbows(np.stack([theta_1, theta_1], axis=1))[:, 0]
        to_b = B - C
        distance = np.hypot(*to_b.T)
        foot = (distance**2 + c**2 - second**2) / (2 * distance)
        height = sides * np.sqrt(np.maximum(c**2 - foot**2, 0.0))
        unit = to_b / distance[:, None]
        to_d = foot[:, None] * unit + height[:, None] * _turned(unit)
        theta_2 = np.arctan2(*(C + to_d - B).T[::-1])
        to_p = (along * to_d + across * _turned(to_d)) / c
        theta_3, theta_4 = np.arctan2(*to_p.T[::-1]), np.arctan2(*(to_p - to_d).T[::-1])
        return np.stack([theta_1, theta_2, theta_3, theta_4], axis=1)

    return angles


def _turned(v: np.ndarray) -> np.ndarray:
    """Vectors (N, 2) turned by a quarter."""
    return np.stack([-v[:, 1], v[:, 0]], axis=1)


def pieces(curve: Curve) -> list[LocusPiece]:
    """The curve, cut where it meets a type-1 singularity or a limit of a base joint, less what limits exclude.

    The cuts are known within 1e-10 of the parameter.
    """
    cuts = _cuts(curve)
    if not cuts:
        mode = _mode_at(curve, 1.0)
        return [LocusPiece(curve, mode, 0.0, 2 * np.pi)] if mode else []
    found = []
    for (_, start), (stop, _) in zip(cuts, [*cuts[1:], cuts[0]], strict=True):
        low, high = start + BESIDE, (stop if stop > start else stop + 2 * np.pi) - BESIDE
        mode = _mode_at(curve, (low + high) / 2)
        if mode:
            found.append(LocusPiece(curve, mode, low, high, _event(curve, low), _event(curve, high)))
    return found


def _mode_at(curve: Curve, t: float) -> str | None:
    """The working mode at a parameter; None beyond the limits, or where an elbow is stretched or folded."""
    angles = curve.angles(np.array([t]))[0]
    sines = np.sin(angles[2:] - angles[:2])
    within = [not np.isnan(curve.five_bar.within_limits(angles[leg : leg + 1], leg)[0]) for leg in (0, 1)]
    return (
        "".join("+" if sine > 0 else "-" for sine in sines) if all(np.abs(sines) > TOUCHING) and all(within) else None
    )


def _cuts(curve: Curve) -> list[tuple[float, float]]:
    """Where an elbow is stretched or folded, or a base joint at a limit: first and last t of those that are one."""
    found = sorted(
        t for leg in (0, 1) for function in (_elbow_sine, _beyond_limit) for t in _roots(curve, leg, function)
    )
    cuts: list[tuple[float, float]] = []
    for t in found:
        if cuts and t - cuts[-1][1] <= MERGED:
            cuts[-1] = cuts[-1][0], t
        else:
            cuts.append((t, t))
    if len(cuts) > 1 and cuts[0][0] + 2 * np.pi - cuts[-1][1] <= MERGED:
        first, _ = cuts.pop()
        cuts[0] = first - 2 * np.pi, cuts[0][1]
    return cuts


def _event(curve: Curve, t: float) -> BoundaryMeeting:
    """The arcs on which a posture lies: of flat ones both legs', not only that of the leg that cuts the curve."""
    angles, arcs = curve.angles(np.array([t])), []
    for leg, side in enumerate(LEGS):
        elbow = float(wrapped(angles[:, 2 + leg] - angles[:, leg])[0])
        if abs(np.sin(elbow)) < ON_ARC:
            arcs.append((f"{side} {'outer' if np.cos(elbow) > 0 else 'inner'}", float(angles[0, leg])))
        limits = curve.five_bar.limits_rad[leg]
        if limits is not None and abs(_beyond_limit(curve.five_bar, angles, leg)[0]) < ON_ARC:
            high = wrapped(angles[:, leg] - sum(limits) / 2)[0] > 0
            arcs.append((f"{side} {'high' if high else 'low'}", abs(elbow)))
    return BoundaryMeeting(t, tuple(arcs))


def _elbow_sine(five_bar: FiveBar, angles: np.ndarray, leg: int) -> np.ndarray:
    """0 where the leg is stretched or folded; what is nothing but rounding is 0."""
    sine = np.sin(angles[:, 2 + leg] - angles[:, leg])
    return np.where(np.abs(sine) < ROUNDING, 0.0, sine)


def _beyond_limit(five_bar: FiveBar, angles: np.ndarray, leg: int) -> np.ndarray:
    """How far a base joint is beyond its limits [rad], below 0 within them; −1 where it has none."""
    limits = five_bar.limits_rad[leg]
    if limits is None:
        return np.full(len(angles), -1.0)
    beyond = np.abs(wrapped(angles[:, leg] - sum(limits) / 2)) - (limits[1] - limits[0]) / 2
    return np.where(np.abs(beyond) < ROUNDING, 0.0, beyond)


def _roots(curve: Curve, leg: int, function: Callable[[FiveBar, np.ndarray, int], np.ndarray]) -> list[float]:
    """Parameters of a turn at which a function of the posture changes its sign, or touches 0."""

    def value(t: float) -> float:
        return float(function(curve.five_bar, curve.angles(np.array([t])), leg)[0])

    t, values = SCAN[:-1], function(curve.five_bar, curve.angles(SCAN), leg)
    roots = list(t[values[:-1] == 0])
    for k in np.flatnonzero(values[:-1] * values[1:] < 0):
        roots.append(float(root_scalar(value, bracket=(SCAN[k], SCAN[k + 1]), xtol=1e-14, rtol=1e-14).root))
    size, step = np.abs(values[:-1]), t[1] - t[0]
    before, after = np.roll(values[:-1], 1), np.roll(values[:-1], -1)
    keeps_sign = (before * values[:-1] > 0) & (values[:-1] * after > 0)
    for k in np.flatnonzero(keeps_sign & (size < np.abs(before)) & (size <= np.abs(after)) & (size < 10 * step)):
        # In terms of the distance from t[k]: the search is as exact as its variable is small.
        away = fminbound(lambda x, at=t[k]: abs(value(at + x)), -step, step, xtol=1e-14)
        if abs(value(t[k] + away)) < TOUCHING:
            roots.append(float(t[k] + away))
    return roots
