"""Self-motions of arms of seven joints beside a dense sweep of the free joint, where closed forms know all postures."""

from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.spatial import KDTree

import wsrender as ws
from tests.engine.test_closed_form import anywhere
from tests.reference.arms_by_axes import RELATIONS
from tests.reference.redundant_arms import SURE, redundant_arm, with_limits
from wsrender.engine import closed_postures
from wsrender.reach.posture_sets import PostureSolver
from wsrender.robots.closed_form import ClosedForm, FreeJointForm

ARMS = {
    "franka_panda": lambda: ws.load_robot("franka_panda").chain,
    "kuka_iiwa14": lambda: ws.load_robot("kuka_iiwa14").chain,
    "random arm": lambda: redundant_arm(RELATIONS[1], 5),
}
POSES, VALUES = 20, 4096
ON, BESIDE, PIECES = 1e-8, 0.01, 16  # of points to the pose [m, rad]; of postures to the curves' chords [rad]


@dataclass(frozen=True)
class Sweep:
    """Of so many ``poses``: ``curves``, largest residual of their points, postures ``swept``, and those on none."""

    poses: int
    curves: int
    residual: float
    swept: int
    missed: int


def embedded(q):
    """Points on circles (N, 2 n), whose distances are those of hinges (N, n), turns apart."""
    return np.hstack([np.cos(q), np.sin(q)])


def chords(curve):
    """Points (M, n) on the straight pieces of a curve."""
    q = np.concatenate([curve.configurations, curve.configurations[:1]]) if curve.closed else curve.configurations
    step = np.remainder(np.diff(q, axis=0) + np.pi, 2 * np.pi) - np.pi
    parts = [q[:-1] + share * step for share in np.linspace(0, 1, PIECES, endpoint=False)]
    return np.concatenate([*parts, q[-1:]])


def swept_postures(chain, T, values):
    """Pose (K,) and configuration (K, n) of all postures where the free joint stands at one of the values."""
    free, pose, q = FreeJointForm.of(chain).free.coordinate, [], []
    for value in np.linspace(chain.lower_limits[free], chain.upper_limits[free], values):
        lower, upper = chain.lower_limits.copy(), chain.upper_limits.copy()
        lower[free] = upper[free] = value
        held = ClosedForm.of(with_limits(chain, lower, upper))
        found = closed_postures(held, T, keep=True, device="cpu")
        at, branch = np.nonzero(found.rows[..., 12] > SURE)
        pose, q = [*pose, at], [*q, held.configurations(found.rows[at, branch, :12])]
    return np.concatenate(pose), np.concatenate(q)


def sweep(arm, poses=POSES, values=VALUES):
    """Poses made by forward kinematics."""
    chain = ARMS[arm]()
    T = chain.poses(anywhere(chain, poses, 7))
    found = PostureSolver(chain, device="cpu").solve(T)
    pose, q = swept_postures(chain, T, values)
    residual, missed = 0.0, 0
    for k in range(poses):
        curves = [curve for curve in found.curves if curve.pose == k]
        for curve in curves:
            residual = max(residual, float(np.abs(chain.poses(curve.configurations) - T[k]).max()))
        on = KDTree(embedded(np.concatenate([chords(curve) for curve in curves])))
        missed += int((on.query(embedded(q[pose == k]))[0] > BESIDE).sum())
    return Sweep(poses, len(found), residual, len(q), missed)


PARTS = {arm: partial(sweep, arm) for arm in ARMS}


def violations(figures):
    """What is beyond its bound in sweeps by arm."""
    found = [f"{arm}: {each.missed} postures on no curve" for arm, each in figures.items() if each.missed]
    return found + [
        f"{arm}: points {each.residual:.0e} off the pose" for arm, each in figures.items() if each.residual > ON
    ]
