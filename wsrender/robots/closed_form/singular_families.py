"""Postures where a joint is free: families of one freedom, solved by their ends.

Of a closed form's branch that is singular the joints that may move while the tip stays run on a curve: joints 4 and 6
of a wrist in line; joint 1, or 2, and the wrist, where its centre stands on that axis; joints 2, 3, 4 and 6 of an arm
with three parallel axes whose axis 6 is parallel to them. Where postures on the curve are within the limits, one of
their connected sets has a joint at a limit, or is a whole loop. Of each joint at each limit the others follow in closed
form, and a loop goes through the extremes of its first joint; if none of these is within the limits, no posture is.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wsrender.robots.closed_form.closed_form import ClosedForm
from wsrender.robots.closed_form.numbers import TURN, hinge_arcs

SLIGHT = 2e-4  # reaches and sines: what is closer to a family may be of it
LEVER = 0.02  # least sine or length [reach] at which the joints that are not of a family are told apart
STEEP = 1e-3  # least product of sines of two angles between three axes that turns are told apart by
WRIST, FIRST, SECOND, PLANE = 0, 1, 2, 3  # kinds
MEMBERS = {WRIST: (3, 5), FIRST: (0, 3, 4, 5), SECOND: (1, 3, 4, 5), PLANE: (1, 2, 3, 5)}  # joints that move
ROUNDING = 1e-7  # rad: of what stands at a limit


@dataclass(frozen=True, eq=False)
class Families:
    """Of N poses: branches (N, 8) that are a family's, and what is known of them.

    ``family`` bool; ``near`` float64: how far off the branch is [sine or reaches]; ``told_apart`` bool: the joints that
    are not of the family stand off each other's folds, so that it is the whole family; ``none`` bool: no pose that is
    closer than was asked has a posture of it within the limits. ``pose`` (M,) int and ``rows`` (M, 12): postures of
    families within the limits, each of their connected sets at least once, as kernels give them.
    """

    family: np.ndarray
    near: np.ndarray
    told_apart: np.ndarray
    none: np.ndarray
    pose: np.ndarray
    rows: np.ndarray


def families(form: ClosedForm, T: np.ndarray, rows: np.ndarray, within: float) -> Families:
    """Of poses (N, 4, 4) in the world and what kernels keep of their postures (N, 8, >= 12).

    ``within``: how far poses may be off that ``none`` speaks of [rad and reaches].
    """
    kind, near, told_apart = _kinds(form, T, rows)
    none = np.zeros(kind.shape, bool)
    pose, found = [np.zeros(0, int)], [np.zeros((0, 12))]
    for which in np.unique(kind[kind >= 0]):
        at, branch = np.nonzero(kind == which)
        curves = _Curves(form, int(which), *_in_frame(form, T[at]), rows[at, branch, :12])
        more, values = curves.members(np.zeros(len(at)))
        pose, found = [*pose, at[more]], [*found, values]
        # Joints move by the root of what the pose does at a fold, by up to 1 / LEVER times as far elsewhere. A centre
        # comes to axis 2 at a fold of joint 3, where it is as high, or as near, as it can be.
        off = within + near[at, branch]
        none[at, branch] = curves.nowhere((20 if which == SECOND else 4) * np.sqrt(off) + 10 / LEVER * off)
    none &= told_apart
    numbers = np.concatenate(pose)
    order = np.argsort(numbers, kind="stable")
    return Families(kind >= 0, near, told_apart, none, numbers[order], np.concatenate(found)[order])


def _in_frame(form: ClosedForm, T: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The rotation (N, 3, 3) and the wrist's centre (N, 3) [reach] that kernels solve for."""
    asked, numbers = form.targets(T), form.numbers()
    base, tool = (np.array([numbers[f"{name}{k}"] for k in range(12)]) for name in ("base", "tool"))
    turned = base[:9].reshape(3, 3) @ asked[:, :9].reshape(-1, 3, 3)
    center = asked[:, 9:] @ base[:9].reshape(3, 3).T + base[9:] + turned @ tool[9:]
    return turned @ tool[:9].reshape(3, 3), center


def _kinds(form: ClosedForm, T: np.ndarray, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of every branch (N, 8) the kind, -1 of none or two, how far off it is, and `_Arm.told_apart`."""
    shape = rows.shape[:2]
    A, center = _in_frame(form, T)
    A, center = (np.repeat(x, shape[1], axis=0) for x in (A, center))
    arm = _Arm(form, A, center, rows[..., :12].reshape(-1, 12))
    off = np.full((4, len(center)), 1.0)
    with np.errstate(invalid="ignore"):
        off[PLANE if form.solved.arm == "parallel" else WRIST] = arm.across
        if form.solved.arm == "nested":
            if form.solved.axes.axes[0].revolute:
                off[FIRST] = np.hypot(center[:, 0], center[:, 1])
            if form.solved.axes.axes[1].revolute:
                off[SECOND] = arm.from_axis_2
        some = off <= SLIGHT
        told_apart = arm.told_apart(some)
    kind = np.where(some.sum(axis=0) == 1, np.argmax(some, axis=0), -1)
    return kind.reshape(shape), off.min(axis=0).reshape(shape), told_apart.reshape(shape)


class _Arm:
    """Branches (B,): rotations ``A`` (B, 3, 3), centres (B, 3) and kernels' ``rows`` (B, 12)."""

    def __init__(self, form: ClosedForm, A: np.ndarray, center: np.ndarray, rows: np.ndarray):
        self.form, self.A, self.center, self.rows = form, A, center, rows
        self.numbers, self.count = form.numbers(), len(rows)
        self.revolute = np.array([axis.revolute for axis in form.solved.axes.axes])
        self.middle, self.half = hinge_arcs(form.solved)
        self.angles = np.where(self.revolute, np.arctan2(rows[:, 1::2], rows[:, ::2]), 0.0)
        self.plane = form.solved.arm == "parallel"

    def tilt(self, k: int) -> np.ndarray:
        """Rx of the angle between axes k and k + 1 (3, 3)."""
        c, s = self.numbers[f"ca{k}"], self.numbers[f"sa{k}"]
        return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])

    def turn(self, k: int) -> np.ndarray:
        """Rz of joint k, 1 to 3, in the links (B, 3, 3)."""
        if self.revolute[k - 1]:
            elbow = np.arctan2(self.numbers["delta_s"], self.numbers["delta_c"]) if k == 3 else 0.0
            return turns(self.angles[:, k - 1] - elbow)
        c, s = self.numbers[f"turn_c{k}"], self.numbers[f"turn_s{k}"]
        return np.tile(np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]), (self.count, 1, 1))

    @cached_property
    def rest(self) -> np.ndarray:
        """The rotation that is left to the wrist (B, 3, 3)."""
        R = self.turn(1) @ self.tilt(1)
        if not self.plane:
            R = R @ self.turn(2) @ self.tilt(2) @ self.turn(3) @ self.tilt(3)
        return R.transpose(0, 2, 1) @ self.A

    @property
    def across(self) -> np.ndarray:
        """The sine of the angle between axes 4 and 6 (B,)."""
        return np.hypot(self.rest[:, 0, 2], self.rest[:, 1, 2])

    @property
    def elbow(self) -> np.ndarray:
        """The centre before joint 2 (B, 3) [reach]."""
        n, one = self.numbers, np.ones(self.count)
        by = np.stack([one, self.rows[:, 4], self.rows[:, 5]])
        return np.stack([np.array([n[f"f{r}{k}"] for k in "0cs"]) @ by for r in "xyz"], axis=1)

    @property
    def from_axis_2(self) -> np.ndarray:
        """Distance of the centre from axis 2 (B,) [reach]."""
        return np.hypot(self.elbow[:, 0], self.elbow[:, 1])

    @cached_property
    def off_axis_1(self) -> np.ndarray:
        """Where the equation of joint 1 wants the centre, beside what it may turn to (B,) [reach]."""
        solved, n, p = self.form.solved, self.numbers, self.center
        k = 1 if solved.first == 1 else 2
        squares = solved.equations[k - 1].squares
        right = self.rows[:, 4:6] @ [n[f"e{k}_rc"], n[f"e{k}_rs"]] + squares * ~self.revolute[2] * self.rows[:, 4] ** 2
        left = squares * (p * p).sum(axis=1) + n[f"e{k}_lz"] * p[:, 2] + n[f"e{k}_l0"]
        return (right - left) * n[f"e{k}_left_scale"]

    def told_apart(self, some: np.ndarray) -> np.ndarray:
        """Whether the joints of the arm that are not of a family (4, B) stand off each other's folds (B,)."""
        solved, n, p = self.form.solved, self.numbers, self.center
        around = np.hypot(p[:, 0], p[:, 1])
        if self.plane:
            if not self.revolute[0]:
                return np.full(self.count, abs(n["ca1"]) > LEVER)
            return around**2 - ((n["ca1"] * p[:, 2] - n["plane"]) / n["sa1"]) ** 2 > LEVER**2
        if solved.arm != "nested":
            return np.abs(np.linalg.det(self._moves())) > LEVER**2
        three, one = (1, 2) if solved.first == 3 else (2, 1)
        right = np.array([n[f"e{three}_rc"], n[f"e{three}_rs"]])
        if self.revolute[2]:
            good = np.abs(self.rows[:, 4:6] @ [right[1], -right[0]]) > LEVER * max(1.0, np.hypot(*right))
            good |= some[SECOND]
        else:
            good = np.abs(right[0] + 2 * solved.equations[three - 1].squares * self.rows[:, 4]) > LEVER
        if self.revolute[1]:
            good &= some[SECOND] | (self.from_axis_2 > LEVER)
        if self.revolute[0]:
            root = np.sqrt(np.maximum(around**2 - self.off_axis_1**2, 0))
            return good & (some[FIRST] | (root * n.get(f"e{one}_left_weight", 0.0) > LEVER))
        slope = n[f"e{one}_lz"] + 2 * solved.equations[one - 1].squares * (p[:, 2] - self.rows[:, 0])
        return good & (np.abs(slope) > LEVER)

    def _moves(self) -> np.ndarray:
        """What hinges 1 to 3 move the centre by, in columns (B, 3, 3) [reach/rad]."""
        n, p, rows, f = self.numbers, self.center, self.rows, self.elbow
        X, Y = rows[:, 0] * p[:, 0] + rows[:, 1] * p[:, 1], rows[:, 0] * p[:, 1] - rows[:, 1] * p[:, 0]
        moved = np.stack([np.array([n[f"f{r}{k}"] for k in "cs"]) @ [-rows[:, 5], rows[:, 4]] for r in "xyz"], axis=1)
        about = np.stack([-f[:, 1], f[:, 0], np.zeros(len(f))], axis=1)
        two = turns(self.angles[:, 1])
        first = np.stack([-Y, n["ca1"] * X, -n["sa1"] * X], axis=1)
        return np.stack([first, (two @ about[..., None])[..., 0], (two @ moved[..., None])[..., 0]], axis=2)


class _Curves(_Arm):
    """Families of one kind."""

    def __init__(self, form: ClosedForm, kind: int, A: np.ndarray, center: np.ndarray, rows: np.ndarray):
        super().__init__(form, A, center, rows)
        self.kind, self.joints = kind, MEMBERS[kind]
        self.sign = np.where(self.rest[:, 2, 2] < 0, -1.0, 1.0)

    def members(self, wider: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Branches (M,) and rows (M, 12) of postures within limits that are ``wider`` (B,) [rad]."""
        found = self._others(wider + ROUNDING)
        number, rows = [np.zeros(0, int)], [np.zeros((0, 12))]
        for values, there, _ in self._points(wider):
            at = np.flatnonzero(found & there & self._within(values, wider + ROUNDING))
            made = self.rows[at].copy()
            for joint, value in zip(self.joints, values, strict=True):
                made[:, 2 * joint], made[:, 2 * joint + 1] = np.cos(value[at]), np.sin(value[at])
            number, rows = [*number, at], [*rows, made]
        return np.concatenate(number), np.concatenate(rows)

    def nowhere(self, wider: np.ndarray) -> np.ndarray:
        """Whether none is within limits that are ``wider`` (B,) [rad], (B,) bool; not where that is not known."""
        possible = np.zeros(self.count, bool)
        for values, there, sure in self._points(wider):
            possible |= ~sure | (there & self._within(values, wider + ROUNDING))
        return ~(possible & self._others(wider))

    def _others(self, wider: np.ndarray) -> np.ndarray:
        """Whether the joints that stand still are within their limits, and the branch is there, (B,) bool."""
        good = np.ones(self.count, bool)
        for k in range(6):
            if k in self.joints or (k == 4 and self.kind in (FIRST, SECOND)):
                continue
            if self.revolute[k]:
                good &= self._arc(k, self.angles[:, k], wider)
            else:
                value = self.rows[:, 2 * k]
                good &= (value >= self.numbers[f"lower{k + 1}"] - wider) & (
                    value <= self.numbers[f"upper{k + 1}"] + wider
                )
        return good & (np.abs(self.off_axis_1) <= np.maximum(wider, 1e-6)) if self.kind == FIRST else good

    def _arc(self, k: int, angle: np.ndarray, wider: np.ndarray) -> np.ndarray:
        return np.abs(np.remainder(angle - self.middle[k] + np.pi, TURN) - np.pi) <= self.half[k] + wider

    def _within(self, values: tuple[np.ndarray, ...], wider: np.ndarray) -> np.ndarray:
        return np.all([self._arc(k, value, wider) for k, value in zip(self.joints, values, strict=True)], axis=0)

    def _points(self, wider: np.ndarray) -> Iterator[tuple[tuple[np.ndarray, ...], np.ndarray, np.ndarray]]:
        """Angles of the joints that move, each (B,), at ends of the curve; whether they exist, and are known (B,)."""
        points = {WRIST: self._in_line, PLANE: self._four_bar}.get(self.kind, self._about_a_point)
        yield from points(wider)

    def _ends(self, k: int, wider: np.ndarray) -> list[np.ndarray]:
        return [self.middle[k] + way * (self.half[k] + wider) for way in (-1, 1)]

    @cached_property
    def sum_of_turns(self) -> np.ndarray:
        """What joint 4, or the sum of 2 to 4, and joint 6 times the sign are together (B,), of axes in line."""
        between = self.tilt(4) @ turns(self.angles[:, 4]) @ self.tilt(5)
        whole = np.arctan2(self.rest[:, 1, 0], self.rest[:, 0, 0])
        return whole - np.arctan2(between[:, 1, 0], between[:, 0, 0])

    def _in_line(self, wider: np.ndarray):
        yes, total, sign = np.ones(self.count, bool), self.sum_of_turns, self.sign
        for end in (*self._ends(3, wider), np.full(self.count, self.middle[3])):
            yield (end, sign * (total - end)), yes, yes
        for end in self._ends(5, wider):
            yield (total - sign * end, end), yes, yes

    def _four_bar(self, wider: np.ndarray):
        """The plane's links 2 and 3, and that of joints 4 and 5, between joint 2 and the tip."""
        n, total, sign = self.numbers, self.sum_of_turns, self.sign
        a2, a3, rigid = n["a2"], n["a3"], n["a4"] + 1j * n["b4"]
        p = self.center
        if self.revolute[0]:
            c, s = np.cos(self.angles[:, 0]), np.sin(self.angles[:, 0])
            X, Y, Z = c * p[:, 0] + s * p[:, 1], c * p[:, 1] - s * p[:, 0], p[:, 2]
        else:
            X, Y, Z = p[:, 0], p[:, 1], p[:, 2] - self.rows[:, 0]
        goal = X - n["a1"] + 1j * (n["ca1"] * Y + n["sa1"] * Z)
        far, yes = np.abs(goal), np.ones(self.count, bool)
        sure = yes & (abs(rigid) > LEVER)

        def posture(two, three, four):  # angles in the plane
            return two, three - two, four - three, sign * (total - four)

        for end in self._ends(1, wider):
            for three, four, there in two_bars(a3, rigid, goal - a2 * np.exp(1j * end), wider):
                yield posture(end, three, four), there, sure
        for end in self._ends(2, wider):
            for two, four, there in two_bars(a2 + a3 * np.exp(1j * end), rigid, goal, wider):
                yield posture(two, two + end, four), there, sure
        for end in self._ends(3, wider):
            for two, three, there in two_bars(a2, a3 + rigid * np.exp(1j * end), goal, wider):
                yield posture(two, three, three + end), there, sure
        # |goal - rigid e^(i four)| is a band: loops go through its ends, or through where it is largest and least.
        turned = np.angle(goal) - np.angle(rigid)
        fours = [*self._ends(5, wider), turned, turned + np.pi]
        fours[:2] = [total - sign * end for end in fours[:2]]
        for reach in (a2 + a3, abs(abs(a2) - abs(a3))):
            with np.errstate(divide="ignore", invalid="ignore"):
                cosine = np.clip((far**2 + abs(rigid) ** 2 - reach**2) / (2 * far * abs(rigid)), -1, 1)
            fours += [turned + way * np.arccos(np.nan_to_num(cosine)) for way in (-1, 1)]
        for four in fours:
            for two, three, there in two_bars(a2, a3, goal - rigid * np.exp(1j * four), wider):
                yield posture(two, three, four), there, sure

    def _about_a_point(self, wider: np.ndarray):
        """Four axes through the centre: Rz(free) M Rz(4) Rx Rz(5) Rx Rz(6) = Q."""
        before = self.turn(1) @ self.tilt(1) if self.kind == SECOND else np.tile(np.eye(3), (self.count, 1, 1))
        M = self.tilt(1) @ self.turn(2) if self.kind == FIRST else np.eye(3)
        M = M @ self.tilt(2) @ self.turn(3) @ self.tilt(3)
        Q, X4, X5 = before.transpose(0, 2, 1) @ self.A, self.tilt(4), self.tilt(5)
        free, four, five, six = self.joints
        start, bend, end = angles_of(M)
        for at in (*self._ends(free, wider), *self._extremes(M, Q)):
            for turned, there, sure in three_turns(X4, X5, (turns(at) @ M).transpose(0, 2, 1) @ Q, wider):
                yield (at, *turned), there, sure
        for at in self._ends(four, wider):
            a, b, c = angles_of(M @ turns(at) @ X4)
            for (t1, t2, t3), there, sure in three_turns(tilts(b), X5, Q, wider):
                yield (t1 - a, at, t2 - c, t3), there, sure
        for at in self._ends(five, wider):
            a, b, c = angles_of(X4 @ turns(at) @ X5)
            for (t1, t2, t3), there, sure in three_turns(tilts(bend), tilts(b), Q, wider):
                yield (t1 - start, t2 - end - a, at, t3 - c), there, sure
        for at in self._ends(six, wider):
            for (t1, t2, t3), there, sure in three_turns(tilts(bend), X4, Q @ turns(-at) @ X5.T, wider):
                yield (t1 - start, t2 - end, t3, at), there, sure

    def _extremes(self, M: np.ndarray, Q: np.ndarray) -> list[np.ndarray]:
        """Values of the free joint where the angle between axes 4 and 6 is largest and least, or at its ends (B,)."""
        m, q, n = M[:, :, 2], Q[:, :, 2], self.numbers
        along, aside = m[:, 0] * q[:, 0] + m[:, 1] * q[:, 1], m[:, 0] * q[:, 1] - m[:, 1] * q[:, 0]
        middle, size = np.arctan2(aside, along), np.maximum(np.hypot(along, aside), 1e-300)
        found = [middle, middle + np.pi]
        for way in (-1, 1):
            cosine = (n["ca4"] * n["ca5"] + way * n["sa4"] * n["sa5"] - m[:, 2] * q[:, 2]) / size
            off = np.arccos(np.clip(cosine, -1, 1))
            found += [middle - off, middle + off]
        return found


def turns(angle: np.ndarray) -> np.ndarray:
    """Rz of angles (B,), (B, 3, 3)."""
    c, s, R = np.cos(angle), np.sin(angle), np.tile(np.eye(3), (len(angle), 1, 1))
    R[:, 0, 0], R[:, 0, 1], R[:, 1, 0], R[:, 1, 1] = c, -s, s, c
    return R


def tilts(angle: np.ndarray) -> np.ndarray:
    """Rx of angles (B,), (B, 3, 3)."""
    return np.roll(turns(angle), (1, 1), axis=(1, 2))


def angles_of(R: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angles (B,) of R = Rz Rx Rz, the second from 0 to pi."""
    bend = np.arctan2(np.hypot(R[:, 0, 2], R[:, 1, 2]), R[:, 2, 2])
    return np.arctan2(R[:, 0, 2], -R[:, 1, 2]), bend, np.arctan2(R[:, 2, 0], R[:, 2, 1])


Turned = tuple[tuple[np.ndarray, np.ndarray, np.ndarray], np.ndarray, np.ndarray]


def three_turns(first: np.ndarray, second: np.ndarray, Q: np.ndarray, wider: np.ndarray) -> Iterator[Turned]:
    """Both solutions (B,) of Rz ``first`` Rz ``second`` Rz = ``Q``, of which those two are Rx.

    With whether they exist, but for angles of ``wider`` (B,), and whether turns are told apart (B,).
    """
    c, s = first[..., 2, 2] * second[..., 2, 2], first[..., 2, 1] * second[..., 2, 1]
    v = Q[:, :, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        cosine = np.nan_to_num((c - v[:, 2]) / s)
    sure = (np.abs(s) > STEEP) & (np.hypot(v[:, 0], v[:, 1]) > STEEP)
    there = 1 - np.abs(cosine) >= -(wider**2) - ROUNDING
    for way in (-1, 1):
        middle = way * np.arccos(np.clip(cosine, -1, 1))
        inner = first @ turns(middle) @ second
        t1 = np.arctan2(v[:, 1], v[:, 0]) - np.arctan2(inner[:, 1, 2], inner[:, 0, 2])
        left = (turns(t1) @ inner).transpose(0, 2, 1) @ Q
        yield (t1, middle, np.arctan2(left[:, 1, 0], left[:, 0, 0])), there, sure


def two_bars(
    first: np.ndarray | complex, second: np.ndarray | complex, goal: np.ndarray, wider: np.ndarray
) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Both ways that two bars, complex numbers in their own frames, reach ``goal`` (B,): their angles, and whether."""
    l1, l2, far = np.abs(first), np.abs(second), np.abs(goal)
    with np.errstate(divide="ignore", invalid="ignore"):
        at1 = np.nan_to_num((far**2 + l1**2 - l2**2) / (2 * far * l1))
        at2 = np.nan_to_num((far**2 + l2**2 - l1**2) / (2 * far * l2))
    there = (1 - np.abs(at1) >= -(wider**2) - ROUNDING) & (1 - np.abs(at2) >= -(wider**2) - ROUNDING)
    one, two = (np.arccos(np.clip(at, -1, 1)) for at in (at1, at2))
    for way in (-1, 1):
        yield np.angle(goal) + way * one - np.angle(first), np.angle(goal) - way * two - np.angle(second), there
