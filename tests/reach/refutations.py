"""A search that knows no closed form, after poses that are proven to be out of reach: what it finds refutes a proof."""

from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.engine.test_closed_form import in_the_box, near_limits
from tests.reference.arms_by_axes import PARALLEL, RELATIONS, random_arm
from wsrender.reach import InverseSolver
from wsrender.reach.evidence import REACHABLE

NAMES = ("ur5e", "puma560", "gao_6r", "stanford_arm", "scara", "slave_5r", "franka_panda", "kuka_iiwa14")
ARMS = {name: lambda name=name: ws.load_robot(name).chain for name in NAMES}
ARMS |= {kind: lambda kind=kind: random_arm(kind, 2) for kind in (*RELATIONS, PARALLEL)}
POSES = 100_000
ACCURACY = {"position_m": 1e-5, "angle_rad": 1e-5}


@dataclass(frozen=True)
class Refutations:
    """Of so many ``poses`` those ``proven`` to be out of reach, and those that the search reaches nevertheless."""

    poses: int
    proven: int
    refuted: int


def refutations(arm, poses=POSES):
    """Half of the poses are anywhere, half of them 1e-4 to 0.1 reaches and radians aside of reached ones at limits."""
    chain, random = ARMS[arm](), np.random.default_rng(6)
    near = chain.poses(near_limits(chain, poses // 2, 6))
    size = 10.0 ** random.uniform(-4, -1, (2, len(near), 1))
    near[:, :3, 3] += size[0] * chain.reach * random.normal(size=(len(near), 3))
    near[:, :3, :3] = Rotation.from_rotvec(size[1] * random.normal(size=(len(near), 3))).as_matrix() @ near[:, :3, :3]
    T = np.concatenate([in_the_box(chain, poses - len(near), 6), near])
    asked = T[:, :3, 3], T[:, :3, :3]
    solver = InverseSolver(chain, kind="pose", **ACCURACY)
    proven = solver.closed.unreachable(*asked)
    solver.closed = None
    found = solver.solve(*(rows[proven] for rows in asked))
    return Refutations(poses, int(proven.sum()), int((found.label == REACHABLE).sum()))


PARTS = {arm: partial(refutations, arm) for arm in ARMS}
LEAST_PROVEN = 0.05  # share of the poses


def violations(figures):
    """What is beyond its bound in refutations by arm."""
    found = [f"{arm}: {each.refuted} proofs refuted" for arm, each in figures.items() if each.refuted]
    few = [arm for arm, each in figures.items() if each.proven < LEAST_PROVEN * each.poses]
    return found + [f"{arm}: few proofs" for arm in few]
