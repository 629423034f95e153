"""The numbers of an arm that kernels of closed forms take, by name."""

from collections.abc import Mapping

import numpy as np

from wsrender.robots.closed_form.axes import Axis
from wsrender.robots.closed_form.classes import SolvedClass

TURN = 2 * np.pi
WHOLE = 1e-9  # rad: a range of whole turns but for rounding
ALWAYS = 4.0  # beyond any slack


def geometry_numbers(solved: SolvedClass) -> dict[str, float]:
    """Everything but the limits; lengths over the reach."""
    links, reach = solved.links, solved.axes.reach
    revolute = [axis.revolute for axis in solved.axes.axes]
    a, d, ca, sa = links.a / reach, links.d / reach, _exact(np.cos(links.alpha)), _exact(np.sin(links.alpha))
    found: dict[str, float] = {}
    for name, T in (("base", np.linalg.inv(links.base)), ("tool", np.linalg.inv(links.tool))):
        found |= {f"{name}{k}": x for k, x in enumerate([*T[:3, :3].ravel(), *T[:3, 3] / reach])}
    for k in range(1, 6):
        found |= {f"a{k}": a[k - 1], f"ca{k}": ca[k - 1], f"sa{k}": sa[k - 1]}
        found |= {f"turn_c{k}": np.cos(links.theta[k - 1]), f"turn_s{k}": np.sin(links.theta[k - 1])}
    delta = elbow_turn(solved)
    found |= {"delta_c": np.cos(delta), "delta_s": np.sin(delta)}
    if solved.arm == "parallel":
        found |= {"plane": d[1] + d[2] + d[3] + ca[3] * d[4], "b4": -sa[3] * d[4]}
        return found | {"weight3": min(1.0, abs(2 * a[1] * a[2]))}
    w = np.array([a[2], -sa[2] * d[3], ca[2] * d[3] + (d[2] if revolute[2] else 0.0)])
    if revolute[2]:
        rho = np.hypot(w[0], w[1])
        columns = np.array([[0.0, 0.0, w[2]], [rho, 0.0, 0.0], [0.0, rho, 0.0]])
    else:
        c, s = np.cos(links.theta[2]), np.sin(links.theta[2])
        columns = np.array([[c * w[0] - s * w[1], s * w[0] + c * w[1], w[2]], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])
    columns = columns @ np.array([[1.0, 0.0, 0.0], [0.0, ca[1], -sa[1]], [0.0, sa[1], ca[1]]]).T
    columns[0, 0] += a[1]
    columns[0, 2] += d[1] if revolute[1] else 0.0
    if not revolute[1]:
        c, s = np.cos(links.theta[1]), np.sin(links.theta[1])
        columns = columns @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]).T
    found |= {f"f{r}{k}": columns[i, j] for j, r in enumerate("xyz") for i, k in enumerate("0cs")}
    for k, equation in enumerate(solved.equations, 1):
        left, right = np.hypot(*equation.left[:2]), np.hypot(*equation.right)
        names = ("lx", "ly", "lz", "l0", "rc", "rs")
        found |= dict(
            zip((f"e{k}_{n}" for n in names), [*equation.left, equation.constant, *equation.right], strict=True)
        )
        found |= _unit(f"e{k}_left", equation.left[:2], left) | _unit(f"e{k}_right", equation.right, right)
    return found


def elbow_turn(solved: SolvedClass) -> float:
    """Angle of joint 3 in the equations of the first three joints, less that of the links [rad]."""
    if solved.arm == "parallel" or not solved.axes.axes[2].revolute:
        return 0.0
    links = solved.links
    return float(np.arctan2(-np.sin(links.alpha[2]) * links.d[3], links.a[2]))


def limit_numbers(solved: SolvedClass, unlimited: bool = False) -> dict[str, float]:
    """Arcs of hinges and ends of slides; ``unlimited``: those of the chain's hinges turn for ever."""
    zero, reach = zeros(solved), solved.axes.reach
    found: dict[str, float] = {}
    middles, halves = hinge_arcs(solved, unlimited)
    for k, axis in enumerate(solved.axes.axes):
        lower, upper = ends_of(axis, unlimited)
        if axis.revolute:
            found |= _arc(k + 1, middles[k], halves[k])
        else:
            found |= {f"lower{k + 1}": (lower + zero[k]) / reach, f"upper{k + 1}": (upper + zero[k]) / reach}
    for k, sign in ((7, 1.0), (8, -1.0)):
        found |= _arc(k, middles[3] + sign * middles[5], halves[3] + halves[5])
    return found


def hinge_arcs(solved: SolvedClass, unlimited: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Middles and halves of the ranges of solved hinges (6,) [rad]; of slides nothing."""
    ends = np.array([ends_of(axis, unlimited) for axis in solved.axes.axes])
    return ends.mean(axis=1) + zeros(solved), np.diff(ends)[:, 0] / 2


def zeros(solved: SolvedClass) -> np.ndarray:
    """What solved joints stand at where the axes' displacements are 0 (6,) [rad or m]."""
    links = solved.links
    zero = np.where([axis.revolute for axis in solved.axes.axes], links.theta, links.d)
    zero[2] += elbow_turn(solved)
    return zero


def elbow_band(solved: SolvedClass, unlimited: bool = False) -> dict[str, float]:
    """The least and the most that the right side of an equation of joint 3 alone is within its limits."""
    right = solved.equations[0].right
    lower, upper = (end + zeros(solved)[2] for end in ends_of(solved.axes.axes[2], unlimited))
    top = np.arctan2(right[1], right[0])
    if upper - lower >= TURN:
        at = top + np.array([0.0, np.pi])
    else:
        extremes = top + np.pi * np.arange(-8, 9)
        at = np.array([lower, upper, *extremes[(extremes > lower) & (extremes < upper)]])
    values = right[0] * np.cos(at) + right[1] * np.sin(at)
    return {"right1_low": values.min(), "right1_high": values.max()}


def packed(numbers: Mapping[str, float], fields: tuple[str, ...]) -> np.ndarray:
    """Numbers in the order of ``fields``, 0 where there is none, (F,) float64."""
    return np.array([numbers.get(name, 0.0) for name in fields])


def ends_of(axis: Axis, unlimited: bool) -> tuple[float, float]:
    """The least and the largest displacement of a joint; ``unlimited``: of the chain's hinges a turn."""
    if axis.revolute and ((unlimited and axis.coordinate is not None) or not np.isfinite(axis.upper - axis.lower)):
        return -np.pi, np.pi
    return axis.lower, axis.upper


def named_motion(name: str, T: np.ndarray, reach: float) -> dict[str, float]:
    """A motion (4, 4) [m] as kernels take it: rotation by rows, position [reach]."""
    return {f"{name}{k}": x for k, x in enumerate([*T[:3, :3].ravel(), *T[:3, 3] / reach])}


def motion_of(name: str, numbers: dict[str, float], reach: float) -> np.ndarray:
    """The motion (4, 4) [m] of such numbers."""
    T, values = np.eye(4), np.array([numbers[f"{name}{k}"] for k in range(12)])
    T[:3, :3], T[:3, 3] = values[:9].reshape(3, 3), values[9:] * reach
    return T


def _arc(joint: int, middle: float, half: float) -> dict[str, float]:
    turns = int(np.floor((2 * half + WHOLE) / TURN))
    if turns and 2 * half - turns * TURN < WHOLE:
        arc = {"least": 1.0, "turns": turns - 1.0}
    else:
        half = half - turns * np.pi  # the rest of the range, about the middle of the range or opposite it
        middle = middle + turns * np.pi
        arc = {"middle_c": np.cos(middle), "middle_s": np.sin(middle), "sine": np.sin(half), "cosine": np.cos(half)}
        arc |= {"narrow": float(half < np.pi / 2), "least": 1.0 if turns else -ALWAYS, "turns": float(turns)}
    return {f"{name}{joint}": value for name, value in arc.items()}


def _unit(name: str, vector: np.ndarray, length: float) -> dict[str, float]:
    if length == 0.0:
        return {}
    unit = {f"{name}_x": vector[0] / length, f"{name}_y": vector[1] / length, f"{name}_scale": 1 / length}
    return unit | {f"{name}_weight": min(1.0, length)}


def _exact(values: np.ndarray) -> np.ndarray:
    return np.where(np.abs(values) < 1e-12, 0.0, values)
