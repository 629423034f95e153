"""Classes of arms whose inverse kinematics has a closed form, told by their axes.

Three joints that carry a spherical wrist put its centre on the target (Pieper 1968). With axis 1 in a frame of its own
and (X, Y, Z) the centre turned, or slid, back by joint 1, what joint 2 does changes neither the height along axis 2 nor
the distance from a point of it (a slide: neither of the coordinates across it). That makes two equations

    squares (X² + Y² + Z²) + left · (X, Y, Z) + constant = right · (cos q3, sin q3), or right q3 + squares q3²

An arm is of a class where one of them holds joint 1 or joint 3 alone: the circle of that joint and a line, then the
other's; else, with three hinges, they are a quartic.
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from wsrender.robots.closed_form.axes import JOINTS, SAME, Axes, meeting_point, nearest_points, parallel
from wsrender.robots.closed_form.links import Links, links_of

WELL = 1e-3  # sine, and length over the reach, below which the quartic of a general arm loses digits that it needs
FAR = 100  # reaches: offsets along axes that are nearly parallel, with which digits are lost
HEIGHT, DISTANCE = 0, 1


@dataclass(frozen=True, eq=False)
class Equation:
    """One of the two of the first three joints; lengths over the reach."""

    squares: int
    left: np.ndarray  # (3,)
    constant: float
    right: np.ndarray  # (2,)

    def holds(self, joint: int, revolute: bool) -> bool:
        """Whether joint 1 or 3 moves what the equation is of."""
        if joint == 1:
            moved = self.left[:2] if revolute else np.append(self.left[2:], self.squares)
        else:
            moved = self.right if revolute else np.append(self.right[:1], self.squares)
        return bool(np.abs(moved).max() > SAME)

    def less(self, share: float, other: "Equation") -> "Equation":
        """The same minus a multiple of the other."""
        return Equation(
            self.squares,
            self.left - share * other.left,
            self.constant - share * other.constant,
            self.right - share * other.right,
        )


@dataclass(frozen=True, eq=False)
class SolvedClass:
    """How an arm is solved.

    ``name``: the class in words. ``arm``: "nested" (the joint ``first``, 1 or 3, by the first of the ``equations``, the
    other by the second), "general", "parallel" (axes 2, 3 and 4) or "open" (no wrist). ``axes``: as they are solved.
    """

    name: str
    arm: str
    axes: Axes
    links: Links
    equations: tuple[Equation, ...] = ()
    first: int = 1


def solved_class(axes: Axes) -> SolvedClass | None:
    """The first class that an arm is of, seen from its base or from its tip; None where it is of none."""
    orders = [order for way in (axes, axes.backwards()) for order in way.orders()]
    found = None
    for whole in (each for order in orders for each in order.completed()):
        solved = _spherical_wrist(whole, len(axes.axes)) or _parallel(whole, len(axes.axes))
        if solved and solved.arm != "general":
            return solved
        found = found or solved
    return found


def shoulder_and_wrist(axes: Axes) -> SolvedClass | None:
    """Six hinges, seen from their base, of which an equation holds joint 3 alone, before an orthogonal wrist."""
    hinges = all(axis.revolute for axis in axes.axes)
    solved = _spherical_wrist(axes, len(axes.axes)) if hinges else None
    if solved is None or solved.arm != "nested" or solved.first != 3:
        return None
    return solved if np.abs(np.cos(solved.links.alpha[3:5])).max() < SAME else None


def open_wrist(axes: Axes) -> SolvedClass | None:
    """Six hinges, of which an equation holds joint 3 of the first three alone, and axes 4 and 5 meet.

    Where the last one stands, so does that point: the class "open" is "nested" but for that joint.
    """
    if len(axes.axes) != JOINTS or not all(axis.revolute for axis in axes.axes):
        return None
    *arm, fourth, fifth, last = axes.axes
    point = meeting_point([fourth, fifth], axes.reach)
    if point is None or np.linalg.norm(np.cross(fourth.direction, fifth.direction)) < WELL:
        return None
    along = last.direction * (last.direction @ (point - last.point))
    foot = last.point + along if parallel(fifth, last) else nearest_points(fifth, last)[1]
    ends = [replace(axis, point=at) for axis, at in zip((fourth, fifth, last), (point, point, foot), strict=True)]
    placed = replace(axes, axes=(*arm, *ends))
    links = links_of(placed.axes, axes.T_tip)
    nested = _nested(links, [True] * 3, axes.reach)
    if nested is None or nested[1] != 3 or np.abs(links.d).max() > FAR * axes.reach:
        return None
    number = [axis.coordinate + 1 for axis in placed.axes if axis.coordinate is not None]
    meeting = f"axes {number[3]} and {number[4]} intersecting"
    return SolvedClass(f"{_relation(placed, links)}, {meeting}", "open", placed, links, *nested)


def _spherical_wrist(axes: Axes, moving: int) -> SolvedClass | None:
    arm, wrist = axes.axes[:3], axes.axes[3:]
    center = meeting_point(wrist, axes.reach) if all(axis.revolute for axis in wrist) else None
    if center is None or parallel(wrist[0], wrist[1]) or parallel(wrist[1], wrist[2]):
        return None
    wrist = [replace(axis, point=center) for axis in wrist]
    # A slide's axis may stand anywhere: where the hinge after it does.
    at = [next(axis.point for axis in [*arm, *wrist][i:] if axis.revolute) for i in range(3)]
    arm = [axis if axis.revolute else replace(axis, point=point) for axis, point in zip(arm, at, strict=True)]
    placed = replace(axes, axes=(*arm, *wrist))
    links = links_of(placed.axes, axes.T_tip)
    revolute = [axis.revolute for axis in arm]
    if nested := _nested(links, revolute, axes.reach):
        name = _name(placed, moving, _relation(placed, links) if all(revolute) else "")
        return SolvedClass(name, "nested", placed, links, *nested)
    if not all(revolute) or min(abs(links.a[0]) / axes.reach, abs(np.sin(links.alpha[0]))) < WELL:
        return None
    both = equations(links, revolute, axes.reach)
    if not all(each.holds(3, True) for each in both):
        return None
    return SolvedClass(_name(placed, moving, "general arm"), "general", placed, links, both, 3)


def _nested(links: Links, revolute: list[bool], reach: float) -> tuple[tuple[Equation, Equation], int] | None:
    """Equations of the first three joints, the first of which holds joint 1 or 3 alone, and that joint."""
    first, second = equations(links, revolute, reach)
    about_elbow = first.less(2 * links.d[1] / reach, second) if revolute[1] else first
    for one, other in ((first, second), (second, first), (about_elbow, second)):
        for joint, rest in ((1, 3), (3, 1)):
            alone = one.holds(joint, revolute[joint - 1]) and not one.holds(rest, revolute[rest - 1])
            if alone and other.holds(rest, revolute[rest - 1]):
                return (one, other), joint
    return None


def equations(links: Links, revolute: list[bool], reach: float) -> tuple[Equation, Equation]:
    """Distance and height, or where joint 2 is a slide the coordinates across it, one along nothing of joint 3."""
    a, d = links.a[:3] / reach, links.d[:4] / reach
    (ca1, ca2, ca3), (sa1, sa2, sa3) = _round(np.cos(links.alpha[:3])), _round(np.sin(links.alpha[:3]))
    w = np.array([a[2], -sa3 * d[3], ca3 * d[3] + (d[2] if revolute[2] else 0.0)])  # the centre, from joint 3's foot
    if revolute[2]:
        w = np.array([np.hypot(w[0], w[1]), 0.0, w[2]])
        moving = np.array([[w[0], 0.0, 0.0], [0.0, w[0], 0.0]])  # by cos and sin
        w[0] = 0.0
    else:
        c, s = np.cos(links.theta[2]), np.sin(links.theta[2])
        w = np.array([c * w[0] - s * w[1], s * w[0] + c * w[1], w[2]])
        moving = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])  # by the displacement
    tilt = np.array([[1.0, 0.0, 0.0], [0.0, ca2, -sa2], [0.0, sa2, ca2]])
    rest, moving = tilt @ w + [a[1], 0.0, 0.0], moving @ tilt.T
    left = np.array([[1.0, 0.0, 0.0], [0.0, ca1, sa1], [0.0, -sa1, ca1]])  # the frame of axis 2
    shift = np.array([-a[0], 0.0, 0.0])
    if not revolute[1]:
        c, s = np.cos(links.theta[1]), np.sin(links.theta[1])
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        rest, moving = turn @ rest, moving @ turn.T
        along = _alone(left[:2, :2] if revolute[0] else left[:2, 2:], moving[:, :2].T)
        one, other = np.array([[along[0], along[1], 0.0], [-along[1], along[0], 0.0]])
        first = Equation(0, one @ left, float(one @ (shift - rest)), _round(moving @ one))
        return first, Equation(0, other @ left, float(other @ (shift - rest)), _round(moving @ other))
    height = Equation(0, left[2], -(rest[2] + d[1]), moving[:, 2])
    from_foot = rest + np.array([0.0, 0.0, d[1]])
    distance = Equation(
        1,
        np.array([-2 * a[0], 0.0, 0.0]),
        float(a[0] ** 2 - from_foot @ from_foot - (moving[0] @ moving[0] if revolute[2] else 0.0)),
        2 * moving @ from_foot,
    )
    return distance, height


def _alone(left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """The direction (2,) across a slide 2 along which one of joints 1 and 3, columns (2, k), does not move."""
    for columns in (right, left):
        values, vectors = np.linalg.eigh(columns @ columns.T)
        if values[0] < SAME**2:
            return vectors[:, 0]
    return np.array([1.0, 0.0])


def _parallel(axes: Axes, moving: int) -> SolvedClass | None:
    """Axes 2, 3 and 4 parallel, 5 and 6 meeting (Hawkins 2013 for UR's)."""
    first, *others = axes.axes
    if not all(axis.revolute for axis in others) or not all(parallel(others[0], axis) for axis in others[1:3]):
        return None
    planar = [axis if axis.direction @ others[0].direction > 0 else axis.flipped() for axis in others[:3]]
    point = meeting_point(others[3:], axes.reach)
    if point is None or parallel(others[2], others[3]):
        return None
    across = np.linalg.norm(np.cross(first.direction, planar[0].direction))
    if (across if first.revolute else abs(first.direction @ planar[0].direction)) < SAME:
        return None
    if not first.revolute:
        first = replace(first, point=planar[0].point)
    ends = [replace(axis, point=point) for axis in others[3:]]
    placed = replace(axes, axes=(first, *planar, *ends))
    links = links_of(placed.axes, axes.T_tip)
    if min(abs(links.a[1]), abs(links.a[2])) < SAME * axes.reach:
        return None
    return SolvedClass(_name(placed, moving, "", "three parallel axes"), "parallel", placed, links)


def _name(axes: Axes, moving: int, relation: str, kind: str = "") -> str:
    """The class in words; ``moving``: the joints that the chain has."""
    hinges = [axis for axis in axes.axes if axis.coordinate is not None and axis.revolute]
    flat = all(parallel(hinges[0], axis) for axis in hinges) if hinges else False
    slides = [axis for axis in axes.axes[:3] if not axis.revolute and axis.coordinate is not None]
    if flat and moving == 4 and len(slides) == 1 and parallel(slides[0], hinges[0]):
        return "SCARA"
    if flat and moving == 3 and not any(abs(s.direction @ hinges[0].direction) > SAME for s in slides):
        return "planar arm"
    held = JOINTS - moving
    if not kind:
        place = "shoulder" if axes.reversed else "wrist"
        kind = {0: f"spherical {place}", 1: f"{place} of two axes", 2: f"{place} of one axis"}.get(held, "no wrist")
    kinds = "" if relation else "".join("R" if axis.revolute else "P" for axis in axes.axes[:3])
    told = relation or (f"{kinds} arm" if "P" in kinds else "")
    return f"{kind}, {told}" if told else kind


def _relation(axes: Axes, links: Links) -> str:
    """How the first three axes lie to each other, by the numbers that the chain's joints have from its base."""
    step, numbers = -1 if axes.reversed else 1, []
    number = next(a.coordinate + 1 - step * (i + 1) for i, a in enumerate(axes.axes) if a.coordinate is not None)
    for axis in axes.axes[:3]:  # a joint that the chain does not have is numbered after the one before
        number = number + step if axis.coordinate is None else axis.coordinate + 1
        numbers.append(number)
    names = [f"{first} and {second}" for first, second in pairwise(numbers)]
    for i in (0, 1):
        if abs(np.sin(links.alpha[i])) < SAME:
            return f"axes {names[i]} parallel"
        if abs(links.a[i]) < SAME * axes.reach:
            return f"axes {names[i]} intersecting"
    return "general arm"


def _round(values: np.ndarray) -> np.ndarray:
    return np.where(np.abs(values) < 1e-12, 0.0, values)
