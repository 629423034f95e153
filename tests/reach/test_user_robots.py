"""Robots defined by a Python class, beside the same robots as models: the same labels, reasons and volumes."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.reference.class_robots import DHClass, FourBar, SphericalClass
from tests.reference.exact_volumes import CASES, spherical_pair
from wsrender.engine import evaluate_kinematics, evaluate_poses
from wsrender.reach.capability import capability, fibonacci_directions
from wsrender.robot import as_robot
from wsrender.robots.reachable_box import reachable_box

COUNT = 250
SPHERICAL = CASES["spherical"].volume
EXACT = 1e-6  # m and rad: nothing lies so near the boundary by chance


def targets(robot, count, share):
    """Positions and quaternions: a share of them by forward kinematics, the others anywhere in the box."""
    random = np.random.default_rng(0)
    T = robot.forward_kinematics(random.uniform(robot.lower_limits, robot.upper_limits, (count, robot.chain.n)))
    points, quats = T[:, :3, 3], Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    free = slice(int(share * count), None)
    low, high = reachable_box(robot.chain, robot.lower_limits, robot.upper_limits)
    points[free] = random.uniform(low, high, points[free].shape)
    return points, quats


@pytest.mark.parametrize("name", ["spherical", "articulated"])
@pytest.mark.parametrize("with_orientation", [False, True], ids=["position", "pose"])
def test_labels_and_reasons_are_those_of_the_model(name, with_orientation):
    model, user = ws.load_robot(name), DHClass(name)
    points, quats = targets(model, COUNT, 0.4)
    options = {"position_tolerance_m": EXACT, "angle_tolerance_rad": EXACT, "device": "cpu"}
    theirs = ws.reachable(model, points, quats if with_orientation else None, **options)
    ours = ws.reachable(user, points, quats if with_orientation else None, **options)
    assert 0.3 < (theirs.labels == "reachable").mean() < 0.7
    assert (ours.labels[: int(0.4 * COUNT)] == "reachable").all()
    same = theirs.labels == ours.labels
    assert same.mean() > 0.99
    assert ((theirs.labels == "undecided") | (ours.labels == "undecided"))[~same].all()
    assert (theirs.reasons == ours.reasons)[same].mean() > 0.98
    if not with_orientation:  # the distance to the workspace is one number; a pose's residual has many local least ones
        missed = same & (theirs.labels == "unreachable")
        assert ours.residual_m[missed] == pytest.approx(theirs.residual_m[missed], abs=1e-6)
    back = model.forward_kinematics(ours.configurations, device="cpu")
    assert np.linalg.norm(back[:, :3, 3] - points, axis=1) == pytest.approx(ours.residual_m, abs=1e-9)


def test_the_refined_volume_is_exact():
    options = {"refined_volume": 0.03, "voxel_labels": True, "voxel_size_m": 0.03, "device": "cpu"}
    result = ws.analyze(SphericalClass(), ws.Sobol(20_000), ["manipulability"], **options)
    refined = result.document["volume_m3"]["refined"]
    assert refined["ci95"][0] <= SPHERICAL <= refined["ci95"][1]
    assert refined["met"]
    (tried,) = refined["false_negatives"]
    assert tried["tested"] > 500
    assert tried["missed"] == 0
    labels = result.document["voxel_labels"]["labels"]
    x, y, z = (np.argwhere(np.ones((15, 28, 28), bool)).T + np.array([[0.5], [-13.5], [-13.5]])) * 0.03
    sector = (np.abs(y) <= x) & (np.abs(z) <= np.hypot(x, y)) & (np.abs(np.hypot(x, y) ** 2 + z**2 - 0.1) <= 0.06)
    edge = np.isclose(np.abs(y), x)  # centres in a face of the sector, which rounding decides
    assert (sector & ~edge).sum() <= labels["reachable"] + labels["undecided"] <= (sector | edge).sum()
    assert labels["undecided"] <= edge.sum()


def test_capability_is_that_of_the_model():
    directions = fibonacci_directions(8)
    chains = ws.load_robot("spherical").chain, as_robot(DHClass("spherical")).chain
    theirs, ours = (capability(chain, 0.1, directions) for chain in chains)
    assert (ours.cells == theirs.cells).all()
    assert (ours.reached == theirs.reached).mean() > 0.995  # directions as far off as the tolerance


def test_a_pair_of_a_class_and_a_model():
    """Placements of [WSR] Table V."""
    placements = [ws.Transform(position_m=(x, 0.4, 0), rpy_deg=(0, 0, 90)) for x in (0.1, -0.1)]
    pair = [
        as_robot(SphericalClass()).placed(placements[0]),
        ws.load_robot("spherical", placement=placements[1]),
    ]
    options = {"indices": ["manipulability"], "voxel_size_m": 0.02, "refined_volume": 0.05, "device": "cpu"}
    found = ws.shared_workspace(pair, ws.Sobol(20_000), **options).document["volume_m3"]["refined"]
    for name, exact in zip(("any", "shared"), spherical_pair(), strict=True):
        assert found[name]["ci95"][0] <= exact <= found[name]["ci95"][1], name


def test_a_pose_that_does_not_exist_beyond_the_limits_is_no_solution():
    points = [[0.2, 0.1, 0.0], [-0.2, 0.1, 0.0], [0.5, 0.0, 0.0], [0.2, 0.0, 0.1]]
    found = ws.reachable(FourBar(), points)
    assert list(found.labels) == ["reachable", "unreachable", "unreachable", "unreachable"]
    assert found.residual_m[2:] == pytest.approx([0.1, 0.1])
    assert found.reasons[2] == "joint limits"  # of its slide
    assert found.reasons[3] == "out of reach"


def test_the_class_is_the_model():
    user, model = as_robot(SphericalClass()), as_robot(DHClass("spherical", joints=3))
    q = np.random.default_rng(0).uniform(user.lower_limits, user.upper_limits, (20, 3))
    assert user.jacobian(q) == pytest.approx(model.jacobian(q), abs=1e-9)
    assert user.chain.revolute.tolist() == model.chain.revolute.tolist() == [True, True, False]


def test_poses_cost_no_jacobians():
    """Those of a class may take many times as long."""

    class WithDearJacobian(SphericalClass):
        asked = 0

        def jacobian(self, q):
            self.asked += len(q)
            return super().jacobian(q)

    robot = WithDearJacobian()
    chain = as_robot(robot).chain
    asked, q = robot.asked, np.random.default_rng(0).uniform(chain.lower_limits, chain.upper_limits, (50, 3))
    poses = evaluate_poses(chain, q)
    assert robot.asked == asked > 0
    assert (poses == evaluate_kinematics(chain, q).pose).all()
    assert robot.asked == asked + len(q)


def test_a_placed_class_and_its_tool():
    user, model = as_robot(DHClass("spherical")), ws.load_robot("spherical")
    placement = ws.Transform(position_m=(0.3, -0.2, 0.1), rpy_deg=(20, -30, 140))
    tool = np.eye(4)
    tool[:3, 3], tool[:3, :3] = (0.1, -0.05, 0.2), Rotation.from_rotvec([0.3, 0.2, 0.1]).as_matrix()
    q = np.random.default_rng(0).uniform(model.lower_limits, model.upper_limits, (20, 6))
    chains = [robot.placed(placement).chain.placed(T_tip_tool=tool) for robot in (user, model)]
    ours, theirs = (evaluate_kinematics(chain, q, device="cpu") for chain in chains)
    assert ours.pose == pytest.approx(theirs.pose, abs=1e-12)
    assert ours.jacobian == pytest.approx(theirs.jacobian, abs=1e-9)
