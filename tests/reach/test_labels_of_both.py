"""A pose has the same label from a base that stands there, by ``base_placement``, as in ``reachability``."""

import numpy as np
from scipy.spatial.transform import Rotation

import wsrender as ws
from wsrender.documents.constraints import Constraints
from wsrender.documents.environment import Environment
from wsrender.reach.admission import Admission
from wsrender.robot.constraints import constraints_for

AROUND = {
    "items": [
        {"shape": "half_space", "name": "floor"},
        {"shape": "box", "name": "post", "size_m": [0.15, 0.15, 0.6], "position_m": [0.35, 0.2, 0.3]},
    ]
}
CELL = {"x_m": [-0.05, 0.05, 0.1], "y_m": [-0.05, 0.05, 0.1]}  # one placement, at the origin
DEEP = 1e-6, 1e-5  # rad: more than configurations are off their pose, and within what counts as reached


def barely_blocked(robot, count, seed=0, bent=None):
    """Configurations a little beyond the boundary of what is admitted, between an admitted one and one that is not.

    ``bent``: least and largest size of the wrist's bend, joint 5 [rad].
    """
    choice = constraints_for(robot, Constraints(self_collision=True), Environment(**AROUND))
    admission, random, chain = Admission(robot.chain, choice), np.random.default_rng(seed), robot.chain
    q = chain.lower_limits + random.random((6 * count, chain.n)) * (chain.upper_limits - chain.lower_limits)
    if bent:
        q[:, 4] = np.exp(random.uniform(*np.log(bent), len(q))) * random.choice([-1, 1], len(q))
    admitted = admission.rejected(q) == 0
    inside, outside = q[admitted][:count], q[~admitted][:count]
    for _ in range(30):
        middle = (inside + outside) / 2
        free = (admission.rejected(middle) == 0)[:, None]
        inside, outside = np.where(free, middle, inside), np.where(free, outside, middle)
    way = (q[~admitted][:count] - inside) / np.linalg.norm(q[~admitted][:count] - inside, axis=1)[:, None]
    return outside + way * np.exp(random.uniform(*np.log(DEEP), (count, 1)))


def labels_of_both(q):
    """Of the poses at configurations of an IRB 120 (N, 6): labels of ``reachability``, and of ``base_placement``."""
    robot = ws.load_robot("abb_irb120")
    T = robot.forward_kinematics(q, device="cpu")
    quat = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    job = {
        "points_m": T[:, :3, 3],
        "quats_wxyz": quat,
        "constraints": {"self_collision": True},
        "environment": AROUND,
        "device": "cpu",
    }
    alone = ws.reachability("abb_irb120", **job).tables["targets"]
    placed = ws.base_placement("abb_irb120", over=CELL, refine=False, **job).tables["targets"]
    return alone["label"], placed["label"]


def test_poses_that_one_posture_hardly_misses():
    """What tries come to from no postures is off the pose, by less than counts, where collisions are other ones."""
    alone, placed = labels_of_both(barely_blocked(ws.load_robot("abb_irb120"), 400))
    np.testing.assert_array_equal(alone, placed)
    assert min(np.unique(alone, return_counts=True)[1]) > 50


def test_poses_near_the_wrist_singularity():
    """There tries end within the tolerances with joint 4 far from every posture, and where depends on rounding."""
    q = barely_blocked(ws.load_robot("abb_irb120"), 400, bent=(1e-6, 1e-3))
    alone, placed = labels_of_both(q)
    np.testing.assert_array_equal(alone, placed)
    labels, counts = np.unique(alone, return_counts=True)
    assert labels.tolist() == ["blocked", "reachable"]
    assert min(counts) > 100
