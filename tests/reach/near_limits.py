"""Targets made by forward kinematics from configurations near limits, and what the solver says of them."""

from dataclasses import dataclass
from functools import partial

import numpy as np

import wsrender as ws
from wsrender.reach import InverseSolver
from wsrender.reach.evidence import UNDECIDED, UNREACHABLE

MARGINS = (0.0, 0.001, 0.01, 0.05, 0.15)  # largest distance of every joint from one of its limits, of its range
KINDS = ("pose", "axis")
ACCURACY = {"position_m": 1e-5, "angle_rad": 1e-5}


def desktop_arm():
    """Five hinges: waist, three that are parallel, and a roll with the tool beside its axis."""
    rows = [
        ws.DHRow(a=0.03, d=0.12, alpha_deg=90, limits_deg=(-110, 110)),
        ws.DHRow(a=0.116, limits_deg=(0, 190)),
        ws.DHRow(a=0.135, limits_deg=(-170, 10)),
        ws.DHRow(alpha_deg=90, theta_deg=90, limits_deg=(-95, 95)),
        ws.DHRow(d=0.16, a=0.02, alpha_deg=20, limits_deg=(-157, 163)),
    ]
    return ws.load_robot(ws.DHTable(convention="standard", rows=rows, name="desktop_arm"))


def offset_wrist():
    """Six hinges: shoulder and elbow that bend one way only, three axes of the wrist that do not meet."""
    rows = [
        ws.DHRow(d=0.1, alpha_deg=90, limits_deg=(-150, 150)),
        ws.DHRow(a=0.35, limits_deg=(0, 170)),
        ws.DHRow(a=0.22, limits_deg=(-165, 0)),
        ws.DHRow(a=0.07, alpha_deg=-90, limits_deg=(-87, 87)),
        ws.DHRow(a=0.05, alpha_deg=90, theta_deg=0, limits_deg=(-76, 76)),
        ws.DHRow(d=0.05, a=0.03, limits_deg=(-160, 160)),
    ]
    return ws.load_robot(ws.DHTable(convention="standard", rows=rows, name="offset_wrist"))


def offset_chain(n, seed):
    """Hinges with offsets in every direction and narrow limits, their middle anywhere."""
    random = np.random.default_rng(seed)
    rows = []
    for _ in range(n):
        middle, width = random.uniform(-60, 60), random.uniform(50, 160)
        a, d = random.uniform(-0.1, 0.3, 2)
        alpha = random.choice([-90, 0, 90, random.uniform(-180, 180)])
        limits = (middle - width / 2, middle + width / 2)
        rows.append(ws.DHRow(a=a, d=d, alpha_deg=alpha, limits_deg=limits))
    return ws.load_robot(ws.DHTable(convention="standard", rows=rows, name=f"offset_chain_{n}"))


ARMS = {
    "desktop arm, 5": desktop_arm,
    "offset wrist, 6": offset_wrist,
    "franka_panda, 7": lambda: ws.load_robot("franka_panda"),
    "offset chain, 8": lambda: offset_chain(8, 1),
    "offset chain, 9": lambda: offset_chain(9, 1),
    "another offset chain, 9": lambda: offset_chain(9, 2),
}
COUNT = 2000  # targets for each arm, margin and kind: 120,000 in all
MOST_UNREACHABLE, MOST_OF_AN_ARM = 12, 2
MOST_UNDECIDED = {margin: 0.005 if margin else 0.02 for margin in MARGINS}  # share


@dataclass(frozen=True)
class Tally:
    """How many targets were decided, and how many of them called unreachable, and undecided."""

    targets: int = 0
    unreachable: int = 0
    undecided: int = 0

    def __add__(self, other: "Tally") -> "Tally":
        return Tally(
            self.targets + other.targets, self.unreachable + other.unreachable, self.undecided + other.undecided
        )


def near_limits(chain, margin, count):
    """Configurations (N, n) with every coordinate within a share of its range from one of its limits."""
    random = np.random.default_rng(int(1000 * margin))
    width = chain.upper_limits - chain.lower_limits
    off = margin * width * random.random((count, chain.n))
    return np.where(random.random((count, chain.n)) < 0.5, chain.lower_limits + off, chain.upper_limits - off)


def targets_at(robot, q, kind):
    """Positions (N, 3) and orientations of a kind of target, of configurations (N, n)."""
    T = robot.forward_kinematics(q, device="cpu")
    return T[:, :3, 3], {"position": None, "axis": T[:, :3, 2], "pose": T[:, :3, :3]}[kind]


def tally(robot, margin, kind, count, threads=None):
    """What the solver says of so many reachable targets."""
    solver = InverseSolver(robot.chain, kind=kind, threads=threads, **ACCURACY)
    labels = solver.solve(*targets_at(robot, near_limits(robot.chain, margin, count), kind)).label
    return Tally(count, int((labels == UNREACHABLE).sum()), int((labels == UNDECIDED).sum()))


def tallies(arm, count=COUNT):
    """What is said of the targets of an arm, by margin."""
    robot = ARMS[arm]()
    return {margin: sum((tally(robot, margin, kind, count) for kind in KINDS), Tally()) for margin in MARGINS}


PARTS = {arm: partial(tallies, arm) for arm in ARMS}


def violations(figures):
    """What is beyond its bound in tallies by margin, by arm."""
    unreachable = {arm: sum(tally.unreachable for tally in by_margin.values()) for arm, by_margin in figures.items()}
    found = [f"{arm}: {count} called unreachable" for arm, count in unreachable.items() if count > MOST_OF_AN_ARM]
    if sum(unreachable.values()) > MOST_UNREACHABLE:
        found.append(f"{sum(unreachable.values())} called unreachable in all")
    for margin, most in MOST_UNDECIDED.items():
        total = sum((by_margin[margin] for by_margin in figures.values()), Tally())
        if total.undecided > most * total.targets:
            found.append(f"{total.undecided} of {total.targets} undecided at a margin of {margin}")
    return found
