"""A million poses of open arms of six hinges that forward kinematics made, anywhere, near limits and at them."""

from functools import partial

import numpy as np

from tests.engine.test_closed_form import anywhere, apart, near_limits
from tests.reference.open_arms import ARMS, open_arm
from wsrender.engine import open_wrist_postures, search_open_wrist
from wsrender.robots.closed_form import OpenWristForm

POSES, SETS = 1 << 17, 1 << 15  # of an arm: half of them near limits and at them; of those anywhere whose sets are made
SAME, NEAR = 1e-6, 1e-4  # of configurations [rad]; slack of postures that the limits may hold


def tallies(name, poses=POSES, sets=SETS):
    """How many poses, how many called unreachable, and how many lack the configuration that made them, unflagged."""
    chain = open_arm(name)
    form, unreachable = OpenWristForm.of(chain), 0
    q = anywhere(chain, poses // 2)
    for each in (q, near_limits(chain, poses // 2)):
        unreachable += int(search_open_wrist(form, chain.poses(each), device="cpu").unreachable.sum())
    q = q[:sets]
    found = open_wrist_postures(form, chain.poses(q), device="cpu")
    off = apart(chain, q[:, None], form.rest.configurations(found.rows[..., :12]))
    lacking = np.where(found.rows[..., 12] > -NEAR, off, np.inf).min(axis=1) > SAME
    return {"poses": poses, "unreachable": unreachable, "missed": int((lacking & (found.flags == 0)).sum())}


PARTS = {name: partial(tallies, name) for name in ARMS}


def violations(figures):
    """What is beyond its bound in tallies by arm."""
    return [
        f"{arm}: {tally['unreachable']} called unreachable, {tally['missed']} without the configuration that made them"
        for arm, tally in figures.items()
        if tally["unreachable"] or tally["missed"]
    ]
