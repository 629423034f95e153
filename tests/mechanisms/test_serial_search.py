"""What serial joints carry, at any of their values, against solids of revolution."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.mechanisms.mechanisms import SPEC, mechanism, poses_of, ups
from tests.mechanisms.serial_legs import ups as serial_ups
from wsrender.mechanisms.inverse_kinematics import inverse_kinematics
from wsrender.mechanisms.leg_bounds import surely_unreached
from wsrender.mechanisms.serial_search import serial_search
from wsrender.run import execute

BALL = ups([[1.0, 0.0, 0.0]] * 6, [[0.0, 0.0, 0.0]] * 6, [0.0, 0.3])  # of radius 0.3 m at x = 1
SWING = {"limits_deg": [-60.0, 60.0], "levels": 3}
JOB = {"analysis": "parallel_workspace", "voxel_size_m": 0.04, "device": "cpu", "refined_volume": 0.02}


def swept_ball(points, before):
    """Whether points lie in a ball of 0.3 m at x = 1 m, swept ±60° about z (and lifted by 0 … 0.4 m)."""
    angle = np.clip(np.arctan2(points[:, 1], points[:, 0]), -np.pi / 3, np.pi / 3)
    lift = np.clip(points[:, 2], 0, 0.4) if len(before) > 1 else np.zeros(len(points))
    return np.linalg.norm(points - np.stack([np.cos(angle), np.sin(angle), lift], axis=1), axis=1) <= 0.3


@pytest.mark.parametrize("levels", [2, 3, 121])
def test_a_ball_on_a_turntable_has_the_volume_of_pappus(levels):
    """2π/3 · 1 m · π r² + 4π/3 r³ whatever the levels: with 2 the voxels hold two balls, and a warning says so."""
    exact = 2 * np.pi / 3 * np.pi * 0.09 + 4 * np.pi / 3 * 0.027
    result = execute({**JOB, "mechanism": {**BALL, "before": [{**SWING, "levels": levels}]}})
    refined = result.document["volume_m3"]["refined"]
    low, high = refined["ci95"]
    assert low < exact < high and refined["met"] and (high - low) / 2 < 0.02 * exact
    assert result.document["headline"] == {
        "quantity": "volume", "value": refined["value"], "ci95": [low, high], "unit": "m3", "reason": ""
    }  # fmt: skip
    codes = {each["code"]: each for each in result.document["warnings"]}
    assert ("serial_levels" in codes) == (levels < 121)
    if levels == 2:
        assert result.document["volume_m3"]["occupied"] == pytest.approx(8 * np.pi / 3 * 0.027, rel=0.02)
        assert f"{result.document['volume_m3']['occupied']:.4g} m³" in codes["serial_levels"]["message"]
        assert codes["serial_levels"]["field"] == "mechanism"


@pytest.mark.parametrize("count", [1, 2])
def test_points_of_a_swept_ball(count):
    before = [{**SWING, "levels": 2}, {"type": "prismatic", "limits_m": [0.0, 0.4], "levels": 2}][:count]
    search = serial_search(SPEC.validate_python({**BALL, "before": before}))
    points = np.random.default_rng(3).uniform([-0.2, -1.4, -0.4], [1.4, 1.4, 0.8], (4000, 3))
    labels = search.labels(points, np.eye(3), device="cpu")
    expected = swept_ball(points, before)
    np.testing.assert_array_equal(labels[labels >= 0], expected[labels >= 0])
    assert 0.1 < expected.mean() < 0.5 and (labels < 0).sum() <= 2


@pytest.mark.parametrize(
    ("document", "rotation"),
    [
        ({"library": "delta", "before": [{"axis": [1, 0, 0], "limits_deg": [-60, 60], "levels": 2}]}, None),
        ({"library": "delta", "after": [{"axis": [0, 1, 0], "position_m": [0.1, 0, 0], "limits_deg": [-40, 40]},
                                        {"type": "prismatic", "axis": [1, 0, 0], "limits_m": [0.1, 0.2]}]}, None),
        ({"library": "stewart_gough", "before": [{"limits_deg": [-40, 40], "position_m": [0.1, 0.2, 0]}],
          "after": [{"type": "prismatic", "axis": [1, 0, 0], "limits_m": [-0.05, 0.05]}]}, [0, 0.1, 0.2]),
        ({"library": "six_pus", "after": [{"axis": [0, 1, 0], "position_m": [0.3, 0, 0], "limits_deg": [-30, 30]}]},
         [0.05, 0, 0]),
        ({"legs": [{"type": "RUS", "base_m": [0, 0, 0], "platform_m": [0, 0, 0], "axis": [0, 1, 0], "zero": [1, 0, 0],
                    "crank_m": 0.5, "link_m": 0.6, "angle_deg": [20, 100], "branch": "plus"}],
          "before": [{"limits_deg": [-50, 50]}]}, None),
    ],
)  # fmt: skip
def test_nothing_that_some_value_reaches_is_called_unreached(document, rotation):
    """Random values of the joints and platform poses of the workspace: the tool's pose they give is reached."""
    search = serial_search(SPEC.validate_python(document))
    random = np.random.default_rng(5)
    limits = np.array([joint.limits for joint in search.joints])
    q = limits[:, 0] + random.random((40_000, len(limits))) * np.ptp(limits, axis=1)
    R = np.eye(3) if rotation is None else Rotation.from_rotvec(rotation).as_matrix()
    points = random.uniform(-search.reach_m, search.reach_m, (40_000, 3)) * [0.7, 0.7, 1.0]
    tool, platform = search.composed(points, np.broadcast_to(R, (40_000, 3, 3)), q)
    mech = search.mechanism
    in_region = np.all((tool >= mech.region_lower) & (tool <= mech.region_upper), axis=1)
    free = mechanism({key: value for key, value in document.items() if key not in ("before", "after")}
                     | {"region": {}})  # fmt: skip
    reached = inverse_kinematics(free, platform).feasible & in_region
    assert reached.sum() > 10
    labels = search.labels(points[reached], R, device="cpu")
    assert (labels == 1).all()
    # Nor does a bound exclude what is reached, however small the motion; what it excludes is not reached.
    assert not surely_unreached(mech, platform[reached], np.zeros(reached.sum())).any()
    out = surely_unreached(mech, platform, np.full(40_000, 0.02))
    moved = platform.copy()
    moved[:, :3, 3] += 0.02 / np.sqrt(3) * random.uniform(-1, 1, (40_000, 3))
    assert out.any() and not inverse_kinematics(free, moved).feasible[out].any()


def test_serial_legs_on_a_joint_are_tried_and_said_to_be():
    legs = [serial_ups(leg) for leg in BALL["legs"][:1]]
    mech = {"legs": legs, "before": [{**SWING, "levels": 5}]}
    result = execute({**JOB, "mechanism": mech, "voxel_size_m": 0.1, "refined_volume": 0.2})
    exact = 2 * np.pi / 3 * np.pi * 0.09 + 4 * np.pi / 3 * 0.027
    low, high = result.document["headline"]["ci95"]
    assert low < exact < high
    assert "serial_joints_sampled" in [each["code"] for each in result.document["warnings"]]


def test_a_turned_pose_is_reached_by_turning_the_joint():
    """A hexapod on a turntable: its platform stays level in the carried base where the joint turns as far."""
    search = serial_search(SPEC.validate_python({"library": "stewart_gough", "before": [SWING]}))
    turned = Rotation.from_rotvec([0, 0, np.deg2rad(33.3)]).as_matrix()
    points = np.array([[0.0, 0.0, 0.55], [0.0, 0.0, 0.9]])
    both = search.labels(points, np.stack([turned, turned]), device="cpu")
    assert both.tolist() == [1, 0]
    assert inverse_kinematics(search.mechanism, poses_of(points)).feasible.tolist() == [True, False]
