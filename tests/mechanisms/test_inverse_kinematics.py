"""Inverse kinematics of legs: solutions close the loop, limits and conditions are told apart."""

import numpy as np
import pytest

from tests.mechanisms.mechanisms import known_ups, mechanism, poses_of, random_rotations
from wsrender.mechanisms.inverse_kinematics import FAULTS, fault_text, inverse_kinematics
from wsrender.pipeline.constraints.leg_distance import segment_distance

POSITIONS = {
    "stewart_gough": ([-0.2, -0.2, 0.4], [0.2, 0.2, 0.7]),
    "six_pus": ([-0.5, -0.5, 1.5], [0.5, 0.5, 2.2]),
    "delta": ([-0.4, -0.4, -0.9], [0.4, 0.4, -0.5]),
}
RUS = {
    "type": "RUS", "base_m": [1, 0, 0], "platform_m": [0.2, 0, 0], "axis": [0, 2, 0], "zero": [3, 0, 0],
    "crank_m": 0.5, "link_m": 1.5, "angle_deg": [-180, 180],
}  # fmt: skip


@pytest.mark.parametrize("name", POSITIONS)
def test_solutions_close_the_loop(name):
    """With the actuated values put into the leg, its link has its length."""
    mech, random = mechanism(name), np.random.default_rng(1)
    positions = random.uniform(*POSITIONS[name], (500, 3))
    rotation = np.eye(3) if mech.translational else random_rotations(random, 1)[0]
    legs = inverse_kinematics(mech, poses_of(positions, rotation))
    solved = ~np.isnan(legs.values)
    assert solved.mean() > 0.3
    for k, kind in enumerate(mech.kinds):
        value = legs.values[solved[:, k], k]
        joint = positions[solved[:, k]] + rotation @ mech.platform[k]
        if kind == "UPS":
            elbow, length = mech.base[k], value
        elif kind == "PUS":
            elbow, length = mech.base[k] + np.outer(value, mech.axis[k]), mech.link[k]
        else:
            level, down = np.outer(np.cos(value), mech.zero[k]), np.outer(np.sin(value), [0, 0, -1])
            elbow, length = mech.base[k] + mech.crank[k] * (level + down), mech.link[k]
        np.testing.assert_allclose(np.linalg.norm(joint - elbow, axis=1), length, rtol=1e-12)
        np.testing.assert_allclose(legs.elbows[solved[:, k], k], np.broadcast_to(elbow, joint.shape), atol=1e-12)


def test_six_pus_of_the_paper():
    """[SNK]: left slider c - h, right c + h, c = (C - A)·u, h² = R² - (|C - A|² - c²)."""
    mech = mechanism("six_pus")
    P = np.array([0.1, -0.2, 1.9])
    values = inverse_kinematics(mech, poses_of([P])).values[0]
    for i, (azimuth, R) in enumerate(zip(np.deg2rad([-90, 30, 150]), (2.5, 2.7, 2.6), strict=True)):
        n = np.array([np.cos(azimuth), np.sin(azimuth), 0])
        u = np.cross([0, 0, 1], n)
        reach = P + n * 1.5 / np.sqrt(3) - n * 5 / (2 * np.sqrt(3))
        c = reach @ u
        h = np.sqrt(R**2 - (reach @ reach - c**2))
        np.testing.assert_allclose(values[2 * i : 2 * i + 2], [c - h, c + h], rtol=1e-12)


@pytest.mark.parametrize(("branch", "expected"), [("plus", 1), ("minus", -1)])
def test_both_crank_angles(branch, expected):
    """A crank in its plane: the two solutions lie symmetrically to the direction of the platform joint."""
    mech = mechanism({"legs": [{**RUS, "branch": branch}]})
    legs = inverse_kinematics(mech, poses_of([[1.8, 0, 0.0]]))  # the platform joint is 1 m away along zero
    # Law of cosines: 1.5² = 1² + 0.5² - 2 · 1 · 0.5 cos θ, so cos θ = -1.
    np.testing.assert_allclose(np.cos(legs.values), -1, atol=1e-9)
    legs = inverse_kinematics(mech, poses_of([[2.3, 0, 0.0]]))  # 1.5 m away
    np.testing.assert_allclose(legs.values, expected * np.arccos((1.5**2 + 0.5**2 - 1.5**2) / (2 * 1.5 * 0.5)))


@pytest.mark.parametrize(
    ("limits", "fault"), [([0, 90], "above its upper limit"), ([-90, -85], "above its upper limit"), ([-90, 0], "")]
)
def test_angles_are_compared_beyond_a_full_turn(limits, fault):
    """-80.4° is 279.6°, above a range that begins at 0 and one that ends at -85°."""
    mech = mechanism({"legs": [{**RUS, "branch": "minus", "angle_deg": limits}]})
    legs = inverse_kinematics(mech, poses_of([[2.3, 0, 0.0]]))  # θ = -80.4°
    assert FAULTS[legs.faults[0, 0]] == fault


def test_either_branch_that_fits_counts():
    both = {**RUS, "branch": "either"}
    for limits, fits in ([[0, 90], True], [[-90, 0], True], [[-30, 30], False]):
        mech = mechanism({"legs": [{**both, "angle_deg": limits}]})
        assert inverse_kinematics(mech, poses_of([[2.3, 0, 0.0]])).feasible.tolist() == [fits]


@pytest.mark.parametrize(
    ("position", "text"),
    [
        ([0, 0, 0.55], ""),
        ([0, 0, -0.55], "the platform is outside its region"),
        ([0, 0, 2.0], "leg 1 (UPS) at 2.02"),
        ([0, 0, 0.01], "leg 1 (UPS) at 0.3"),
    ],
)
def test_faults_in_words(position, text):
    mech = mechanism("stewart_gough")
    found = fault_text(mech, inverse_kinematics(mech, poses_of([position])), 0)
    assert found.startswith(text) and (text or not found)


def test_a_delta_does_not_turn():
    mech = mechanism("delta")
    turned = poses_of([[0, 0, -0.7]], random_rotations(np.random.default_rng(0), 1)[0])
    assert not inverse_kinematics(mech, turned).feasible[0]
    assert inverse_kinematics(mech, poses_of([[0, 0, -0.7]])).feasible[0]
    assert "parallelograms" in fault_text(mech, inverse_kinematics(mech, turned), 0)


def test_cones_at_both_joints():
    """A single leg upright at its base, platform tilted: the angle at the base is that of the position, at the platform
    that of its tilt."""
    leg = {"type": "UPS", "base_m": [0, 0, 0], "platform_m": [0, 0, 0], "length_m": [0.5, 2]}
    cone = {"axis": [0, 0, 5], "half_angle_deg": 30}
    at_base = mechanism({"legs": [{**leg, "base_cone": cone}]})
    at_platform = mechanism({"legs": [{**leg, "platform_cone": cone}]})
    for degrees, allowed in ((29.9, True), (30.1, False)):
        s, c = np.sin(np.deg2rad(degrees)), np.cos(np.deg2rad(degrees))
        tilted = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
        assert inverse_kinematics(at_base, poses_of([[s, 0, c]])).feasible[0] == allowed
        assert inverse_kinematics(at_platform, poses_of([[0, 0, 1]], tilted)).feasible[0] == allowed


def test_the_cone_of_a_crank_turns_with_it():
    """The link stands along the crank's own zero direction turned by its angle: within any cone about it."""
    cone = {"axis": [1, 0, 0], "half_angle_deg": 1}
    mech = mechanism({"legs": [{**RUS, "base_cone": cone}]})
    for angle in (0.3, -2.0):
        stretched = np.array([1, 0, 0]) + 2.0 * np.array([np.cos(angle), 0, -np.sin(angle)]) * (1 - 1e-9)
        assert inverse_kinematics(mech, poses_of([stretched - [0.2, 0, 0]])).feasible[0]
    assert not inverse_kinematics(mech, poses_of([[2.3, 0, 0]])).feasible[0]


def test_segment_distance_against_dense_points():
    """Random, parallel, crossing and degenerate segments against the least distance of points on both."""
    random = np.random.default_rng(3)
    ends = random.uniform(-1, 1, (4, 60, 3))
    ends[3, :10] = ends[2, :10] + (ends[1, :10] - ends[0, :10])  # parallel
    ends[1, 10:15] = ends[0, 10:15]  # a point
    ends[3, 15:20] = ends[2, 15:20]
    t = np.linspace(0, 1, 401)[:, None, None]
    on_p, on_q = ends[0] + t * (ends[1] - ends[0]), ends[2] + t * (ends[3] - ends[2])
    dense = np.min([np.linalg.norm(on_p - point, axis=2).min(axis=0) for point in on_q], axis=0)
    found = segment_distance(*ends)
    assert (found <= dense + 1e-12).all()
    np.testing.assert_allclose(found, dense, atol=5e-3)


def test_leg_interference_cuts_the_workspace():
    """Legs farther apart than asked: the poses that remain are those whose least distance is."""
    document = known_ups()
    random = np.random.default_rng(2)
    poses = poses_of(random.uniform(-1, 1, (3000, 3)))
    free, kept = mechanism(document), mechanism({**document, "minimum_leg_distance_m": 0.45})
    legs = inverse_kinematics(free, poses)
    pairs = [(a, b) for a in range(6) for b in range(a + 1, 6)]
    least = np.min(
        [
            segment_distance(legs.elbows[:, a], legs.joints[:, a], legs.elbows[:, b], legs.joints[:, b])
            for a, b in pairs
        ],
        axis=0,
    )
    expected = legs.feasible & (least >= 0.45)
    np.testing.assert_array_equal(inverse_kinematics(kept, poses).feasible, expected)
    assert 0 < expected.sum() < legs.feasible.sum()
