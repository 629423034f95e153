"""The Monte Carlo boundary: its parts on exact data, and its stated biases over 20 seeds."""

import numpy as np
import pytest

from tests.boundary.planar_arms import boundary, revolute_joints, slide_and_turn, turn_and_slide
from tests.reference.planar_membership import PlanarArm
from wsrender.boundary.fits import fit_circle, fit_line
from wsrender.boundary.planar.cell_loops import cell_loops
from wsrender.boundary.planar.monte_carlo import monte_carlo_boundary

SAMPLES, CELLS = 100_000, 2500  # as published
ARMS = {
    "RP": turn_and_slide(),
    "RR": revolute_joints([8, 5], [(-180, 180)] * 2),
    "PR": slide_and_turn(),
}


def test_fits_of_exact_points():
    angle = np.linspace(0.3, 1.1, 9)
    circle = fit_circle(np.array([2.0, -1.0]) + 5 * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    assert circle.center == pytest.approx([2, -1]) and circle.radius == pytest.approx(5)
    assert circle.error == pytest.approx(0, abs=1e-20)
    assert fit_line(np.array([[0, 0], [1, 2], [3, 6.0]])) == pytest.approx(0, abs=1e-30)
    # Distances of ±1 from the x axis: mean square 1.
    assert fit_line(np.array([[0, 1], [0, -1], [9, 1], [9, -1.0]])) == pytest.approx(1)


def signed_area(loop):
    x, y = loop.T
    return (x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2


def square_with_a_hole(step=0.02):
    at = np.arange(step / 2, 10, step)
    points = np.stack(np.meshgrid(at, at), axis=-1).reshape(-1, 2)
    return points[(np.abs(points - 5) > 2).any(axis=1)]


def test_loops_of_a_square_with_a_square_hole():
    found = cell_loops(square_with_a_hole(), 100)
    outer, hole = sorted(found.loops, key=len, reverse=True)
    assert found.width_m == pytest.approx(1, rel=0.01)
    assert (len(outer), len(hole)) == (36, 20)  # cells with an empty 8-neighbour
    assert signed_area(outer) > 0 > signed_area(hole)
    steps = np.abs(np.diff(np.concatenate([outer, outer[:1]]), axis=0)).max(axis=1)
    assert steps.max() < 1.01 * found.width_m


def test_cells_of_a_line_and_of_a_point():
    line = cell_loops(np.stack([np.linspace(0, 3, 500), np.zeros(500)], axis=1), 30)
    assert len(line.loops) == 1 and line.width_m == pytest.approx(0.1)
    assert cell_loops(np.zeros((5, 2)), 30).loops == []


def sampled(arm, seed):
    q = np.random.default_rng(seed).uniform(arm.low, arm.high, (SAMPLES, len(arm.low)))
    at = arm.positions(q)
    return np.column_stack([at.real, at.imag])


@pytest.fixture(scope="module")
def runs():
    """Exact boundary, and Monte Carlo boundaries over 20 seeds, of each arm."""
    out = {}
    for name, (joints, tip) in ARMS.items():
        exact, arm = boundary(joints, tip), PlanarArm(joints, tip)
        out[name] = exact, [monte_carlo_boundary(exact.chain, sampled(arm, s), CELLS) for s in range(20)]
    return out


# Mean distance of the centroids from the exact boundary, loop by loop [cell widths], over 20 seeds. DEFINITIONS 8 says
# 0.24–0.33, which holds for outer loops: 0.33 where samples are as dense as anywhere, down to 0.24 where they crowd at
# the boundary, as they do at both circles of RR, its singular positions. Around its hole, six cells in radius, the
# boundary curves away from the region, which lowers it further.
BIAS = {"RP": [0.311], "RR": [0.238, 0.153], "PR": [0.286]}


@pytest.mark.parametrize("name", ARMS)
def test_centroids_lie_inside_by_the_stated_bias(runs, name):
    exact, found = runs[name]
    means = []
    for run in found:
        inward = []
        for loop in run.loops:
            nearest = exact.nearest(loop)
            signed = np.where(nearest.inside, nearest.distance, -nearest.distance) / run.cell_width_m
            assert signed.min() > -0.05  # where the boundary is concave, a centroid may lie a little beyond it
            inward.append(signed.mean())
        means.append(inward)
    assert np.std(means, axis=0).max() < 0.012
    assert np.mean(means, axis=0) == pytest.approx(BIAS[name], abs=0.006)  # twice the error of a mean of 20
    assert 0.235 < np.mean(means, axis=0)[0] < 0.335


def test_first_example_is_two_arcs_and_two_lines(runs):
    kinds = [sorted(segment.kind for segment in run.segments[0]) for run in runs["RP"][1]]
    assert kinds.count(["arc", "arc", "line", "line"]) >= 17  # else a line has its end at a corner split off
    for run in runs["RP"][1]:
        (loop,) = run.segments
        inner, outer = sorted(segment.radius for segment in loop if segment.kind == "arc" and abs(segment.sweep) > 1)
        width = run.cell_width_m
        # The outer arc comes out too small, the inner one is held by its exact ends.
        assert 0.2 * width < 8 - outer < 0.8 * width
        assert abs(inner - 5) < 0.5 * width
        expected = [[x * r, y * r] for r in (5, 8) for x in (0.5**0.5,) for y in (0.5**0.5, -(0.5**0.5))]
        assert np.sort(run.critical, axis=0) == pytest.approx(np.sort(expected, axis=0))


def test_second_example_is_two_circles(runs):
    for run in runs["RR"][1]:
        (outer,), (inner,) = run.segments
        assert outer.sweep == pytest.approx(2 * np.pi) and inner.sweep == pytest.approx(-2 * np.pi)
        width = run.cell_width_m
        assert 0.15 * width < 13 - outer.radius < 0.35 * width
        assert 0.05 * width < inner.radius - 3 < 0.35 * width


def test_tolerances_decide_how_many_segments():
    joints, tip = ARMS["PR"]
    exact = boundary(joints, tip)
    points = sampled(PlanarArm(joints, tip), 0)
    counts = [len(monte_carlo_boundary(exact.chain, points, CELLS, t**2, t**2).segments[0]) for t in (0.02, 0.1, 2)]
    assert counts[0] > counts[1] > counts[2]
