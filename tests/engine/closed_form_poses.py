"""A million poses of arms of every class that forward kinematics made, anywhere, near limits and at them."""

from functools import partial

import numpy as np

from tests.engine.test_closed_form import SAME, apart, near_limits, postures
from tests.reference.arms_by_axes import PARALLEL, RELATIONS, random_arm, reversed_chain

ARMS, POSES = 50, 20_000  # of a class, every second arm reversed; of an arm, half of them near limits and at them


def tallies(kind, arms=ARMS, poses=POSES):
    """How many poses, how many called unreachable, and how many lack the configuration that made them.

    That must be among the postures of poses off limits; at limits and near them rounding decides.
    """
    unreachable = missed = 0
    for seed in range(arms):
        chain = random_arm(kind, seed)
        chain = reversed_chain(chain) if seed % 2 else chain
        anywhere = np.random.default_rng(seed).uniform(chain.lower_limits, chain.upper_limits, (poses // 2, chain.n))
        for q, off_limits in ((anywhere, True), (near_limits(chain, poses - poses // 2, seed), False)):
            found, solutions, there = postures(chain, chain.poses(q))
            unreachable += int((found.slack < -found.margin).sum())
            if off_limits:
                nearest = np.where(there, apart(chain, q[:, None], solutions), np.inf).min(axis=1)
                missed += int((nearest > SAME).sum())
    return {"poses": arms * poses, "unreachable": unreachable, "missed": missed}


PARTS = {kind: partial(tallies, kind) for kind in [*RELATIONS, PARALLEL]}
MOST_MISSED = 1e-5  # share: double roots, whose postures are known to the root of rounding


def violations(figures):
    """What is beyond its bound in tallies by class."""
    found = [
        f"{kind}: {tally['unreachable']} called unreachable" for kind, tally in figures.items() if tally["unreachable"]
    ]
    lacking = {
        kind: tally["missed"] for kind, tally in figures.items() if tally["missed"] > MOST_MISSED * tally["poses"]
    }
    return found + [f"{kind}: {count} without the configuration that made them" for kind, count in lacking.items()]
