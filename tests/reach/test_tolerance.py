"""The largest ball in which nothing fails, of sets whose ball is known."""

import numpy as np
import pytest

from wsrender.reach.tolerance import SAFE, largest_ball


@pytest.mark.parametrize("seed", range(3))
def test_beside_a_plane_and_a_small_hole(seed):
    """The hole is nearer than the plane, and takes a thousandth of the largest ball."""
    hole = np.array([0.24, 0.24, 0.12])

    def holds(points):
        return (points[:, 0] > -0.5) & (np.linalg.norm(points - hole, axis=1) > 0.06)

    assert largest_ball(holds, 0.8, 1024, seed) == pytest.approx(SAFE * 0.3, rel=5e-3)


def test_a_plane_is_found_closely_in_few_calls():
    """A call may be a search by inverse kinematics, which costs about as much for fifty placements as for eight."""
    calls = []

    def holds(points):
        calls.append(len(points))
        return points[:, 0] > -0.3

    assert largest_ball(holds, 0.8, 1024) == pytest.approx(SAFE * 0.3, rel=1e-4)
    assert len(calls) < 50


def test_nothing_fails():
    assert largest_ball(lambda points: np.ones(len(points), bool), 0.7, 64) == pytest.approx(SAFE * 0.7)


def test_all_fails():
    assert largest_ball(lambda points: np.zeros(len(points), bool), 0.7, 64) < 1e-4
