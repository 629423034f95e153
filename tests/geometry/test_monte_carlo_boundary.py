"""The Monte Carlo boundary: its parts on exact data, and its stated biases over 20 seeds."""

import re
from dataclasses import replace

import numpy as np
import pytest

import wsrender as ws
from tests.geometry.planar_arms import boundary, revolute_joints, slide_and_turn, sliding, turn_and_slide, turning
from tests.reference.planar_membership import PlanarArm
from wsrender.geometry.fits import fit_circle, fit_line
from wsrender.geometry.planar.agreement import FARTHEST_APART, INWARD, LARGEST_ERROR, disagreements, signed_area
from wsrender.geometry.planar.exact_boundary import ExactBoundary
from wsrender.geometry.planar.monte_carlo import CELLS as NUMBERS
from wsrender.geometry.planar.monte_carlo import cell_loops, monte_carlo_boundary
from wsrender.geometry.planar.segments import FARTHEST, FittedSegment, FitTolerances, fitted_segments
from wsrender.pipeline.sampling import held_chain

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


def sampled(arm, seed, count=SAMPLES, biased=False):
    rng, size = np.random.default_rng(seed), (count, len(arm.low))
    share = rng.beta(0.5, 0.5, size) if biased else rng.random(size)
    at = arm.positions(np.array(arm.low) + share * (np.array(arm.high) - np.array(arm.low)))
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


def scara(method, count):
    """The library's arm in its plane; its exact boundary, and that of so many samples."""
    robot = ws.load_robot("scara")
    exact = ExactBoundary.of(held_chain(robot.chain, {"joint4": 0.0}))
    low, high = robot.chain.lower_limits, robot.chain.upper_limits
    rng = np.random.default_rng(0)
    share = rng.random((count, 4)) if method == "random" else rng.beta(0.5, 0.5, (count, 4))
    q = low + share * (high - low)
    q[:, 3] = 0
    return exact, exact.chain.plane.coordinates(robot.forward_kinematics(q)[:, :3, 3])


def test_samples_that_seldom_reach_the_boundary_have_not_converged():
    """Of three joints two at limits draw it: samples thin out towards it, whatever the cells."""
    exact, points = scara("random", SAMPLES)
    found = monte_carlo_boundary(exact.chain, points)
    assert found.cells.whole and found.cell_width_m > 1.5 * cell_loops(points, CELLS).width_m
    because = [*disagreements(found, exact)]
    assert because[0].startswith("its area is -1") and "% off" in because[0]
    published = monte_carlo_boundary(exact.chain, points, CELLS)  # what is asked for is done
    assert published.cell_width_m == cell_loops(points, CELLS).width_m
    because = [*disagreements(published, exact)]
    assert "% of its cells hold one sample alone; at most 5 % should" in because[0] and "% off" in str(because[1:])
    exact, points = scara("random", 20_000)
    assert "holes may be cells that no sample happened to hit" in str(
        [*disagreements(monte_carlo_boundary(exact.chain, points, CELLS), exact)]
    )


def test_samples_near_joint_limits_find_the_boundary_of_three_joints():
    exact, points = scara("boundary", SAMPLES)
    found = monte_carlo_boundary(exact.chain, points)
    assert [*disagreements(found, exact)] == []
    assert (len(found.loops), len(found.critical)) == (1, 6)
    assert sum(map(signed_area, found.loops)) == pytest.approx(exact.area, rel=0.035)
    concave = [segment for segment in found.segments[0] if segment.kind == "arc" and segment.sweep < 0]
    assert len(concave) == 2 and len(found.segments[0]) == 8
    drawn = sum(segment.area for segment in found.segments[0])
    assert drawn == pytest.approx(exact.area, rel=0.01 + 0.33 * exact.perimeter * found.cell_width_m / exact.area)


def test_segments_away_from_their_cells_and_from_the_exact_boundary_are_told():
    exact, points = scara("boundary", SAMPLES)
    found = monte_carlo_boundary(exact.chain, points)
    straight = [
        FittedSegment(each.start, each.end, None, None, None, each.points) if each.kind == "arc" else each
        for each in found.segments[0]
    ]
    beside, apart, area = disagreements(replace(found, segments=[straight]), exact)
    assert re.match(r"a line or arc runs \d+\.\d+ cell widths beside cells it stands for; at most 1 should", beside)
    assert "cell widths from the exact boundary, at most 1 should be" in apart
    assert re.match(r"the area within its lines and arcs is -\d+\.\d % off", area)
    missing = replace(found, segments=[found.segments[0][:-1]])  # what is drawn is right, but not all of it
    (apart, *_) = disagreements(missing, exact)
    assert "from the exact boundary" in apart
    assert [*disagreements(replace(found, segments=[[]]), exact)] == ["it has no segments"]


def test_points_of_an_arc_that_fit_a_line_are_an_arc():
    """A sagitta of 0.9 cells scatters about its line by 0.27, which a line may."""
    angle = np.linspace(-0.4, 0.4, 25)
    arc = 10 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    scattered = arc + 0.05 * np.random.default_rng(0).normal(size=arc.shape)
    scattered[[0, -1]] = arc[[0, -1]]
    tolerances = FitTolerances.of(None, None, 0.3, 1.0, 20.0)
    (found,) = fitted_segments(scattered, tolerances)
    assert found.kind == "arc" and found.radius == pytest.approx(10, rel=0.05)
    (asked,) = fitted_segments(scattered, FitTolerances.of(0.3**2, None, 0.3, 1.0, 20.0))
    assert asked.kind == "line"  # the tolerance alone decides
    flat = np.column_stack([np.arange(25.0), 0.2 * np.random.default_rng(0).normal(size=25)])
    assert [each.kind for each in fitted_segments(flat, tolerances)] == ["line"]
    outlier = np.column_stack([flat[:, 0], 0.3 * flat[:, 1] + 1.3 * (flat[:, 0] == 12)])  # of which a line may scatter
    assert len(fitted_segments(outlier, tolerances)) > 1
    assert all(each.farthest <= FARTHEST for each in fitted_segments(outlier, tolerances))


def random_arms(count, seed):
    """Chains of two to four joints with limits."""
    rng = np.random.default_rng(seed)
    while count:
        joints, x = [], 0.0
        for turns in rng.random(rng.integers(2, 5)) < 0.7:
            if turns:
                low = rng.uniform(-180, 100)
                joints.append(turning(x, 0, low, low + rng.uniform(40, 180)))
                x += rng.uniform(0.5, 3)
            else:
                low = rng.uniform(0, 2)
                joints.append(sliding(rng.uniform(0, 180), low, low + rng.uniform(0.5, 3)))
        exact = boundary(joints, (x, 0.0))
        if exact.dimension == 2:
            count -= 1
            yield exact, PlanarArm(joints, (x, 0.0))


@pytest.mark.parametrize("biased", [False, True], ids=["random", "boundary"])
def test_random_arms_are_right_or_say_that_they_are_not(biased):
    converged = 0
    for exact, arm in random_arms(25, seed=1):
        found = monte_carlo_boundary(exact.chain, sampled(arm, 0, biased=biased))
        for loop in found.segments:  # each segment begins where the one before it ends
            ends, starts = ([getattr(s, name) for s in loop] for name in ("end", "start"))
            assert np.array_equal(ends, [*starts[1:], starts[0]])
            for arc in (s for s in loop if s.kind == "arc"):  # which it is drawn by
                drawn = arc.along(arc.radius)[[0, -1]][:: int(np.sign(arc.sweep))]
                assert drawn == pytest.approx(np.array([arc.start, arc.end]), abs=1e-9 * arc.radius)
        if [*disagreements(found, exact)]:
            continue
        converged += 1
        areas = np.array([signed_area(loop) for loop in found.loops])
        assert ((areas < 0).sum(), (areas > 0).sum()) == (sum(loop.hole for loop in exact.loops), 1)
        inward = (exact.area - areas.sum()) / (exact.perimeter * found.cell_width_m)
        assert INWARD[0] <= inward <= INWARD[1] and abs(areas.sum() / exact.area - 1) <= LARGEST_ERROR
        assert max(each.farthest for loop in found.segments for each in loop) <= FARTHEST_APART * found.cell_width_m
    assert converged >= (18 if biased else 5)


def test_the_number_of_cells_falls_until_the_samples_fill_them():
    joints, tip = ARMS["PR"]
    exact, arm = boundary(joints, tip), PlanarArm(joints, tip)
    points = sampled(arm, 0, 20_000)
    assert not cell_loops(points, NUMBERS[0]).whole and len(cell_loops(points, NUMBERS[0]).loops) > 1
    found = monte_carlo_boundary(exact.chain, points)
    assert len(found.loops) == 1 and [*disagreements(found, exact)] == []
    assert (NUMBERS[0], NUMBERS[-1]) == (2500, 110)


def test_parts_and_chance_holes_of_cells():
    square = square_with_a_hole()
    found = cell_loops(square, 100)
    assert (found.parts, found.chance, found.single) == (1, 0, 0) and found.whole
    few = np.random.default_rng(0).choice(square, 120)  # one to a cell, or none
    assert cell_loops(few, 100).chance > 0 and not cell_loops(few, 100).whole
    assert cell_loops(np.concatenate([square, square + 20]), 900).parts == 2


def test_segments_part_at_a_corner_that_is_no_critical_point():
    """The longest line that fits goes round the corner by some cells."""
    x = np.arange(41.0)
    bent = np.column_stack([x, 0.3 * np.maximum(x - 20, 0)])
    one, other = fitted_segments(bent, FitTolerances.of(None, None, 0.3, 1.0, 40.0))
    assert (one.kind, other.kind) == ("line", "line")
    assert one.end == pytest.approx([20, 0]) and other.start == pytest.approx([20, 0])
