"""Gradients of a five-bar's conditioning against finite differences over positions."""

import numpy as np
import pytest

from wsrender.mechanisms.five_bar import FiveBar, conditioning, conditioning_gradients

MECHANISMS = [FiveBar.symmetric(6, 8, 5), FiveBar(6.0, (8.0, 7.0), (5.0, 6.5))]


@pytest.mark.parametrize("mode", ["++", "+-", "-+", "--"])
@pytest.mark.parametrize("five_bar", MECHANISMS, ids=["symmetric", "unequal legs"])
def test_finite_differences(five_bar, mode):
    points = np.random.default_rng(0).uniform([-6, -10], [12, 10], (300, 2))

    def inverse_kappas(at):
        found = conditioning(five_bar, five_bar.inverse_kinematics(at, mode))
        return np.stack([found.inverse_kappa_a, found.inverse_kappa_b])

    steps, sizes = 1e-6 * np.eye(2), inverse_kappas(points)
    differences = np.stack([(inverse_kappas(points + d) - inverse_kappas(points - d)) / 2e-6 for d in steps], axis=2)
    gradients = conditioning_gradients(five_bar, five_bar.inverse_kinematics(points, mode))
    smooth = np.isfinite(differences).all(axis=(0, 2)) & ((sizes > 1e-2) & (sizes < 0.99)).all(axis=0)
    assert np.count_nonzero(smooth) > 60
    for found, expected in zip(gradients, differences, strict=True):
        np.testing.assert_allclose(found[smooth], expected[smooth], rtol=1e-5, atol=1e-6)


def test_singular_and_isotropic_postures_have_none():
    five_bar = MECHANISMS[0]
    a, b = conditioning_gradients(five_bar, np.array([[0.3, 0.7, 0.3, 1.2], [1.0, 2.0, 1.5, 2.5]]))
    assert np.isnan(a[0]).all() and np.isnan(b[0]).all()  # the left leg is stretched
    assert np.isfinite(a[1]).all() and np.isnan(b[1]).all()  # κ(B) = 1
