"""All postures of poses beside those of EAIK and ssik, of ten arms of closed forms each, 1,000 poses an arm."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from tests.engine.test_closed_form import anywhere
from tests.engine.test_closed_form_peers import SSIK, arms, chain_of_ssik, eaik_of, module_of_ssik
from tests.reach.test_postures import apart
from wsrender.reach.posture_sets import PostureSolver

POSES = 1000
REGULAR, SAME, NEAR = 1e-3, 1e-6, 1e-3  # sigma_min above which postures agree to SAME [rad], elsewhere to NEAR
LEAST_SETS = 0.95  # share of the poses whose sets are compared


@dataclass(frozen=True)
class Agreement:
    """Of so many ``poses``, some of which are left out as families: ``sets`` that were compared.

    ``missing`` postures that the peer alone has, ``more`` that it has not, ``windings`` that are other than the peer's.
    """

    poses: int
    sets: int
    missing: int = 0
    more: int = 0
    windings: int = 0


def agreement(chain, solutions_of, count, windings=False):
    """Of poses made by forward kinematics; ``solutions_of`` a pose: configurations (K, n) of the peer."""
    T = chain.poses(anywhere(chain, count))
    found = PostureSolver(chain, device="cpu").solve(T)
    sets = missing = more = wound = 0
    for k, pose in enumerate(T):
        own = np.flatnonzero(found.pose == k)
        if found.family[own].any():
            continue
        theirs, sets = np.reshape(solutions_of(pose), (-1, chain.n)), sets + 1
        regular = found.sigma_min[own].min(initial=1) > REGULAR
        near = SAME if regular else NEAR
        missing += [apart(chain, q, found[own]).min(initial=9) > near for q in theirs].count(True)
        more += [apart(chain, q, theirs).min(initial=9) > near for q in found[own]].count(True)
        if windings and regular:
            ours = np.array([q for i in own for q in found.wound(i)])
            same = all(np.abs(ours - q).max(axis=1).min(initial=9) < near for q in theirs)
            wound += int(len(ours) != len(theirs) or not same)
    return Agreement(count, sets, missing, more, wound)


def with_ssik(name, count=POSES):
    """Within the limits, windings apart."""
    module = module_of_ssik(name)

    def solutions_of(T):
        return np.array([found.q for found in module.solve(T, allow_rescue=False)])

    return agreement(chain_of_ssik(module), solutions_of, count, windings=True)


def with_eaik(number, count=POSES):
    """Within half a turn of every joint, as EAIK knows no limits."""
    chain = list(arms())[number]
    chain = replace(chain, lower_limits=np.full(6, -np.pi), upper_limits=np.full(6, np.pi))
    peer, T_tip = eaik_of(chain)

    def solutions_of(T):
        asked = T.copy()
        asked[:3, :3] = T[:3, :3] @ T_tip[:3, :3].T
        answer = peer.IK(asked)
        return np.array([q for q, least in zip(answer.Q, answer.is_LS, strict=True) if not least])

    return agreement(chain, solutions_of, count)


PARTS = {f"ssik, {name}": partial(with_ssik, name) for name in SSIK}
PARTS |= {f"EAIK, arm {k}": partial(with_eaik, k) for k in range(len(list(arms())))}


def violations(figures):
    """What is beyond its bound in agreements by part."""
    found = []
    for part, each in figures.items():
        counts = {"missing": each.missing, "more": each.more, "of other windings": each.windings}
        found += [f"{part}: {count} {told}" for told, count in counts.items() if count]
        if each.sets < LEAST_SETS * each.poses:
            found.append(f"{part}: {each.sets} of {each.poses} sets compared")
    return found
