"""Sets of orientations: their rotations, and weights that follow the invariant measure."""

import numpy as np
import pytest

from wsrender.documents.orientations import EulerRanges, TiltRanges
from wsrender.documents.robot import Transform
from wsrender.mechanisms.orientations import orientation_set


def test_euler_angles_are_those_of_documents():
    spec = EulerRanges(euler_xyz_deg=((-10, 30), (20, 20), (-5, 5)), per_angle=(3, 9, 2))
    found = orientation_set(spec)
    assert found.levels == (3, 1, 2) and len(found.rotations) == 6
    for angles, rotation in zip(np.rad2deg(found.angles), found.rotations, strict=True):
        expected = Transform(euler_xyz_deg=tuple(angles)).matrix()[:3, :3]
        np.testing.assert_allclose(rotation, expected, atol=1e-15)


def test_tilts_have_their_tilt_azimuth_and_no_torsion():
    found = orientation_set(TiltRanges(tilt_deg=40, tilts=5, azimuths=8))
    azimuth, tilt, _ = found.angles.T
    expected = np.stack([np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)], axis=1)
    np.testing.assert_allclose(found.rotations[:, :, 2], expected, atol=1e-15)
    # Zero torsion: a half turn about the horizontal axis of the tilt itself, so the rotation has no z component.
    skew = found.rotations - np.swapaxes(found.rotations, 1, 2)
    np.testing.assert_allclose(skew[:, 1, 0], 0, atol=1e-15)


def test_shares_are_those_of_the_rotation_group():
    """The rotations by less than an angle: (θ - sin θ) / π of all (Miles 1965), from Euler angles of all of SO(3)."""
    spec = EulerRanges(euler_xyz_deg=((-180, 180), (-90, 90), (-180, 180)), per_angle=(61, 41, 61))
    found = orientation_set(spec)
    angle = np.arccos(np.clip((np.trace(found.rotations, axis1=1, axis2=2) - 1) / 2, -1, 1))
    for limit in np.deg2rad([60, 90, 120]):
        share = found.weights[angle < limit].sum()
        assert share == pytest.approx((limit - np.sin(limit)) / np.pi, rel=0.02)


def test_the_share_of_a_cap():
    """Tilts up to 30° of those up to 60°: (1 - cos θ) / (1 - cos 60°), θ half a step beyond the level 30°."""
    found = orientation_set(TiltRanges(tilt_deg=60, tilts=601, azimuths=4))
    share = found.weights[found.angles[:, 1] < np.deg2rad(30.05)].sum()
    assert share == pytest.approx((1 - np.cos(np.deg2rad(30.05))) / (1 - np.cos(np.pi / 3)), rel=1e-4)


@pytest.mark.parametrize("spec", [TiltRanges(tilt_deg=10), EulerRanges(euler_xyz_deg=((0, 0), (90, 90), (0, 0)))])
def test_weights_add_up(spec):
    found = orientation_set(spec)
    assert found.weights.sum() == pytest.approx(1)
    assert found.whole_weights.min() >= 1
    assert found.whole_weights.sum(dtype=np.int64) == pytest.approx(2**30, rel=1e-3)


def test_quaternions_turn_like_the_rotations():
    found = orientation_set(TiltRanges(tilt_deg=170, torsion_deg=(-90, 90), tilts=3, azimuths=3, torsions=3))
    matrices = [Transform(quat_wxyz=tuple(quat)).matrix()[:3, :3] for quat in found.quat_wxyz]
    np.testing.assert_allclose(matrices, found.rotations, atol=1e-12)
