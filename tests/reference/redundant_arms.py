"""Arms of seven hinges, of which all but one at an end have a closed form, and what they reach without a search."""

from dataclasses import replace

import numpy as np

from tests.reference.arms_by_axes import RELATIONS, across, axes_of, chain_of, direction, random_arm, reversed_chain
from wsrender.engine import closed_postures
from wsrender.robots.closed_form import ClosedForm, FreeJointForm

SURE = 1e-6  # slack of a posture that there is beyond doubt


def redundant_arm(kind, seed, backwards=False, tip=None, rail=False):
    """A chain of seven joints: any first one, then two that are related as RELATIONS say, and an orthogonal wrist.

    ``tip``: None, or "in the wrist". ``rail``: the first one is a slide.
    """
    random = np.random.default_rng(seed)
    h, o, T_tip = axes_of(random_arm(kind, seed))
    for k in (4, 5):
        aside = np.cross(h[k - 1], across(random, h[k - 1]))
        h[k] = aside / np.linalg.norm(aside)
    h, o = np.vstack([direction(random), h]), np.vstack([random.uniform(-0.3, 0.3, 3), o])
    if tip:
        T_tip[:3, 3] = o[6]
    middle, half = random.uniform(-1, 1, 7), random.choice([0.4, 1.0, 2.0, 3.0, 3.5, 6.2], 7)
    chain = chain_of(h, o, T_tip, middle - half, middle + half, [not rail, *[True] * 6])
    return reversed_chain(chain) if backwards else chain


RANDOM_ARMS = {
    f"{kind}{', backwards' if backwards else ''}": redundant_arm(kind, 5, backwards)
    for kind in RELATIONS[:2]
    for backwards in (False, True)
} | {"tip in the wrist": redundant_arm(RELATIONS[0], 6, tip="in the wrist")}
RANDOM_ARMS |= {
    f"{RELATIONS[0]}, on a rail": redundant_arm(RELATIONS[0], 7, rail=True),
    f"{RELATIONS[1]}, backwards, on a rail": redundant_arm(RELATIONS[1], 7, backwards=True, rail=True),
}


def with_limits(chain, lower, upper):
    return replace(chain, lower_limits=np.array(lower, float), upper_limits=np.array(upper, float))


def swept(chain, T, values):
    """Whether poses (N, 4, 4) have a posture where the free joint stands at one of so many values of its range, (N,).

    The joint is held there, and the chain of six that is left asked for all its postures.
    """
    free = FreeJointForm.of(chain).free.coordinate
    there = np.zeros(len(T), bool)
    for value in np.linspace(chain.lower_limits[free], chain.upper_limits[free], values):
        lower, upper = chain.lower_limits.copy(), chain.upper_limits.copy()
        lower[free] = upper[free] = value
        held = ClosedForm.of(with_limits(chain, lower, upper))
        rest = np.flatnonzero(~there)
        there[rest] = closed_postures(held, T[rest], device="cpu").slack > SURE
    return there
