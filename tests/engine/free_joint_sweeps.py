"""Searches along a free joint beside a dense sweep of it, and of poses made at, near and away from limits."""

from dataclasses import dataclass
from functools import partial

import numpy as np

import wsrender as ws
from tests.engine.test_closed_form import anywhere, in_the_box, near_limits
from tests.reference.redundant_arms import swept
from wsrender.engine import search_free_joint
from wsrender.robots.closed_form import FreeJointForm

ARMS = ("franka_panda", "kuka_iiwa14")
VALUES, UNREACHABLE = 4096, 10_000  # of the free joint; poses that are called so
MADE, AWAY = 1 << 18, 1e-3  # poses made of either kind; from limits, and from the straight elbow [rad]
MOST_UNDECIDED = 1e-3  # share of those made away from them


@dataclass(frozen=True)
class Figures:
    """Counts of poses."""

    refuted: int = 0  # unreachable ones of which the sweep finds a posture
    unreachable: int = 0  # made ones that are called so
    undecided: float = 0.0  # share of made ones away from limits and folds


def refuted(name):
    """Poses anywhere that are called unreachable, of which the sweep finds a posture."""
    chain = ws.load_robot(name).chain
    form, T, seed = FreeJointForm.of(chain), np.zeros((0, 4, 4)), 0
    while len(T) < UNREACHABLE:
        drawn = in_the_box(chain, UNREACHABLE, seed)
        found = search_free_joint(form, drawn, device="cpu")
        # Those that the arcs of the elbow leave nothing of are most, and seen at once.
        T, seed = np.concatenate([T, drawn[found.unreachable & (found.balls > 0)]]), seed + 1
    return Figures(refuted=int(swept(chain, T[:UNREACHABLE], VALUES).sum()))


def made(name):
    """Poses made by forward kinematics, half of the coordinates of some at limits or close to them."""
    chain = ws.load_robot(name).chain
    form = FreeJointForm.of(chain)
    q = anywhere(chain, MADE)
    off = np.minimum(q - chain.lower_limits, chain.upper_limits - q).min(axis=1)
    clear = (off > AWAY) & (np.abs(np.sin(q[:, 3])) > AWAY)
    found = search_free_joint(form, chain.poses(q), device="cpu")
    close = search_free_joint(form, chain.poses(near_limits(chain, MADE // 8)), device="cpu")
    unreachable = int(found.unreachable.sum() + close.unreachable.sum())
    return Figures(unreachable=unreachable, undecided=float(1 - found.reached[clear].mean()))


PARTS = {f"{name}, {told}": partial(part, name) for name in ARMS for told, part in (("sweep", refuted), ("made", made))}


def violations(figures):
    """What is beyond its bound in figures by part."""
    found = []
    for part, each in figures.items():
        if each.refuted or each.unreachable:
            found.append(f"{part}: {each.refuted + each.unreachable} reachable poses called unreachable")
        if each.undecided > MOST_UNDECIDED:
            found.append(f"{part}: {each.undecided:.1e} of the poses made are undecided")
    return found
