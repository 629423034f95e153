"""Numbers of self-motions of three-joint arms: known ones, and against tracing them on random arms."""

import numpy as np
import pytest

import wsrender as ws
from tests.geometry.planar_arms import boundary, revolute_joints, sliding, turning
from tests.reference.planar_membership import PlanarArm
from tests.reference.self_motion_tracing import SelfMotionTracing

FULL = (-180, 180)


def test_whole_turns():
    """3R 4-2-1: singular at radii 7, 5, 3, 1; two self-motions between 3 and 5, one beside (Burdick 1989)."""
    found = boundary(*revolute_joints([4, 2, 1], [FULL] * 3))
    assert [(r.number, r.regions) for r in found.self_motion_regions] == [(1, 2), (2, 1)]
    assert [r.area_m2 for r in found.self_motion_regions] == pytest.approx([32 * np.pi, 16 * np.pi], rel=1e-9)
    points = np.array([[0.5, 0], [0, 2], [-4, 0], [2.9, 2.9], [5.5, 0], [7.5, 0]])
    assert found.self_motions(points).tolist() == [0, 1, 2, 2, 1, 0]


def test_at_the_base_the_first_joint_is_idle():
    """The base of 1-1-1 is reached by an equilateral triangle: two postures, each at every angle of the first joint."""
    found = boundary(*revolute_joints([1, 1, 1], [FULL] * 3))
    assert found.self_motions([[0, 0]]).tolist() == [2]
    cut = boundary(*revolute_joints([1, 1, 1], [(-100, 100), FULL, (0, 150)]))
    assert cut.self_motions([[0, 0]]).tolist() == [1]


def test_a_limit_cuts_a_self_motion():
    """4-2-1 at (5.5, 0): the first joint swings by ±θ, where 2-1 are stretched, with either elbow."""
    swing = np.degrees(np.arccos((5.5**2 + 16 - 9) / (2 * 5.5 * 4)))
    whole, right, middle = ((-90, 90), (0, 90), (-swing / 2, swing / 2))
    for first, number in ((whole, 1), (right, 1), (middle, 2)):
        assert boundary(*revolute_joints([4, 2, 1], [first, FULL, FULL])).self_motions([[5.5, 0]]).tolist() == [number]
    one_way = boundary(*revolute_joints([4, 2, 1], [middle, FULL, (0, 180)]))
    assert one_way.self_motions([[5.5, 0]]).tolist() == [1]


def random_arm(rng):
    joints, x = [], 0.0
    for _ in range(3):
        kind, low = rng.random(), rng.choice([-90, -60, rng.uniform(-180, 180)])
        if kind < 0.3:
            joints.append(sliding(rng.choice([0, 45, 90, low]), 0, rng.choice([1, rng.uniform(0.3, 2)])))
        elif kind < 0.5:
            joints.append(turning(x, 0, *FULL))
        else:
            joints.append(turning(x, 0, low, low + rng.choice([90, 120, rng.uniform(20, 350)])))
        x += rng.choice([1, 1, rng.uniform(0.2, 2)])
    return joints, (x, 0)


@pytest.mark.parametrize("seed", range(10))
def test_random_arms(seed):
    rng = np.random.default_rng(seed)
    joints, tip = random_arm(rng)
    found, arm = boundary(joints, tip), PlanarArm(joints, tip)
    total = sum(region.area_m2 for region in found.self_motion_regions)
    assert total == pytest.approx(found.area, rel=1e-9)
    at = arm.positions(arm.low + (arm.high - arm.low) * rng.random((5, 3)))
    at = at[found.self_motions(np.column_stack([at.real, at.imag]) + 1e-3) == found.self_motions(
        np.column_stack([at.real, at.imag]) - 1e-3)]  # fmt: skip
    assert len(at) >= 4  # of 5: one may lie beside a curve where the number changes
    counted = found.self_motions(np.column_stack([at.real, at.imag]))
    assert counted.tolist() == SelfMotionTracing(arm, [joint.full for joint in joints]).count(at).tolist()


@pytest.mark.parametrize("limits", [[(-60, 60)] * 3, [(-100, 60), (-30, 90), (-120, 40)]])
def test_regions_are_where_points_say(limits):
    found = boundary(*revolute_joints([4, 2, 1], limits))
    axis = np.linspace(-7, 7, 300, endpoint=False) + 7 / 300
    numbers = found.self_motions(np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2))
    cell = (14 / 300) ** 2
    for region in found.self_motion_regions:
        assert cell * np.count_nonzero(numbers == region.number) == pytest.approx(region.area_m2, abs=0.15)


def test_other_arms_have_none():
    two = boundary(*revolute_joints([2, 1], [FULL] * 2))
    assert two.self_motion_regions is None
    with pytest.raises(ws.InputError, match="three joints must move the tip"):
        two.self_motions([[1, 1]])
    # The last two joints turn about one axis.
    coaxial = boundary([turning(0, 0, *FULL), turning(1, 0, 0, 30), turning(1, 0, 0, 30)], (2, 0))
    assert coaxial.self_motion_regions is None
