"""Closed-form inverse kinematics of three joints, of every kind and in special places."""

import itertools

import numpy as np
import pytest
from scipy.ndimage import binary_erosion
from scipy.spatial.transform import Rotation

from tests.geometry.spatial_arms import arm_of, box, elbow, general, scara, spherical
from wsrender.geometry.spatial.inverse import ThreeJointInverse
from wsrender.geometry.spatial.measures import joint_volume
from wsrender.geometry.spatial.spatial_arm import SpatialArm

KINDS = ["".join(kinds) for kinds in itertools.product("RP", repeat=3)]


def random_arm(kinds, special, rng):
    """Joints at random, or at right angles with axes that often meet or are parallel."""
    T = np.tile(np.eye(4), (3, 1, 1))
    for i in range(3):
        if special:
            T[i, :3, :3] = Rotation.from_euler("xyz", rng.integers(0, 4, 3) * 90, degrees=True).as_matrix()
            T[i, :3, 3] = rng.uniform(-1, 1, 3) * rng.integers(0, 2, 3)
        else:
            T[i, :3, :3] = Rotation.random(random_state=rng).as_matrix()
            T[i, :3, 3] = rng.uniform(-1, 1, 3)
    revolute = np.array([kind == "R" for kind in kinds])
    low = np.where(revolute, rng.uniform(-3, 0, 3), rng.uniform(-1, 0, 3))
    high = low + np.where(revolute, rng.uniform(1, 4, 3), 1.5)
    tip = np.array([0.7, 0.0, 0.0]) if special else rng.uniform(-1, 1, 3)
    return SpatialArm(("a", "b", "c"), revolute, low, high, np.zeros(3, bool), T, tip)


@pytest.mark.parametrize("special", [False, True])
@pytest.mark.parametrize("kinds", KINDS)
def test_every_configuration_is_found_again(kinds, special):
    rng = np.random.default_rng(KINDS.index(kinds))
    tested = 0
    for _ in range(12):
        arm = random_arm(kinds, special, rng)
        d = arm.low + (arm.high - arm.low) * rng.random((60, 3))
        points, J, _ = arm.motion(d)
        if np.abs(np.linalg.det(J)).max() < 1e-9:
            continue  # it fills no volume
        found = ThreeJointInverse(arm).solutions(points)
        apart = np.nan_to_num(np.abs(found - d[:, None]).max(axis=2), nan=np.inf).min(axis=1)
        regular = np.abs(np.linalg.det(J)) > 1e-4
        assert apart[regular].max(initial=0) < 1e-6
        again = arm.position(np.nan_to_num(found).reshape(-1, 3)).reshape(60, 8, 3)
        off = np.linalg.norm(again - points[:, None], axis=2)[np.isfinite(found[:, :, 0])]
        assert off.max() < 1e-7 * arm.size
        assert ((np.isnan(found)) | ((found >= arm.low) & (found <= arm.high))).all()
        tested += 1
    assert tested > 2


def test_an_elbow_has_four_solutions_inside_and_none_outside():
    inverse = ThreeJointInverse(arm_of(elbow()))
    rng = np.random.default_rng(1)
    direction = rng.normal(size=(200, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    radius = rng.uniform(0, 2, 200)
    count = np.isfinite(inverse.solutions(direction * radius[:, None])[:, :, 0]).sum(axis=1)
    assert (count == np.where((radius > 0.4) & (radius < 1.6), 4, 0)).all()


@pytest.mark.parametrize(
    ("subject", "volume"),
    [
        (spherical, 28 * np.pi / 3 * (1 + np.sqrt(3))),
        (box, 0.3 * 0.4 * 0.7),
        (elbow, 4 * np.pi / 3 * (1.6**3 - 0.4**3)),
        (scara, 0.2 * 0.06 * np.radians(120) * (np.cos(np.radians(20)) - np.cos(np.radians(150)))),
    ],
)
def test_volumes_of_closed_form(subject, volume):
    value, error = joint_volume(ThreeJointInverse(arm_of(subject())), lambda points: None)
    assert value == pytest.approx(volume, rel=1e-9)
    assert error < 1e-7 * volume


def test_overlapping_sweeps_count_once():
    """A circle of R 1 slid by 1 m covers a stadium less the lens that both its ends leave out."""
    value, _ = joint_volume(ThreeJointInverse(_slid_circle()), lambda points: None)
    lens = 2 * np.arccos(0.5) - 0.5 * np.sqrt(3)
    assert value == pytest.approx(0.2 * (np.pi + 2.0 - lens), rel=1e-6)


def _slid_circle():
    """A slide along x of 1 m, a whole turn about z at R 1, a slide along z of 0.2 m: a swept cylinder's surface."""
    T = np.tile(np.eye(4), (3, 1, 1))
    T[0, :3, :3] = Rotation.from_euler("y", 90, degrees=True).as_matrix()
    T[1, :3, :3] = T[0, :3, :3].T
    T[2, :3, 3] = (1.0, 0.0, 0.0)
    low, high = np.array([0.0, -np.pi, 0.0]), np.array([1.0, np.pi, 0.2])
    return SpatialArm(("x", "turn", "z"), np.array([False, True, False]), low, high, np.zeros(3, bool), T, np.zeros(3))


def test_volume_of_a_general_arm_against_its_profile():
    """Whole turns about z: V = 2π ∫∫ ρ dρ dz over the profile, here counted in cells, those of the border half."""
    arm, edge = arm_of(general()), 0.02
    value, error = joint_volume(ThreeJointInverse(arm), lambda points: None, most_lines=150)
    q = np.linspace(-np.pi, np.pi, 700, endpoint=False)
    d = np.column_stack([np.zeros(len(q) ** 2), *(axis.ravel() for axis in np.meshgrid(q, q))])
    p = arm.position(d)
    cells = np.floor(np.column_stack([np.hypot(p[:, 0], p[:, 1]), p[:, 2]]) / edge).astype(int)
    held = np.zeros((100, 200), bool)
    held[cells[:, 0], cells[:, 1] + 100] = True
    weight = (held.astype(float) + binary_erosion(held, np.ones((3, 3)))) / 2
    counted = 2 * np.pi * ((np.arange(100) + 0.5) @ weight.sum(axis=1)) * edge**3
    assert value == pytest.approx(counted, rel=5e-3)
    assert error < 1e-2 * value
