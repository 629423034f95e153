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


def barely_blocked(robot, count, seed=0):
    """Configurations a little beyond the boundary of what is admitted, between an admitted one and one that is not."""
    choice = constraints_for(robot, Constraints(self_collision=True), Environment(**AROUND))
    admission, random, chain = Admission(robot.chain, choice), np.random.default_rng(seed), robot.chain
    q = chain.lower_limits + random.random((6 * count, chain.n)) * (chain.upper_limits - chain.lower_limits)
    admitted = admission.rejected(q) == 0
    inside, outside = q[admitted][:count], q[~admitted][:count]
    for _ in range(30):
        middle = (inside + outside) / 2
        free = (admission.rejected(middle) == 0)[:, None]
        inside, outside = np.where(free, middle, inside), np.where(free, outside, middle)
    way = (q[~admitted][:count] - inside) / np.linalg.norm(q[~admitted][:count] - inside, axis=1)[:, None]
    return outside + way * np.exp(random.uniform(*np.log(DEEP), (count, 1)))


def test_poses_that_one_posture_hardly_misses():
    """What tries come to from no postures is off the pose, by less than counts, where collisions are other ones."""
    robot = ws.load_robot("abb_irb120")
    T = robot.forward_kinematics(barely_blocked(robot, 400), device="cpu")
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
    np.testing.assert_array_equal(alone["label"], placed["label"])
    assert min(np.unique(alone["label"], return_counts=True)[1]) > 50
