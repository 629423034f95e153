"""The exact sweep against closed forms, and against least squares from many starts on random arms."""

import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.geometry.planar_arms import boundary, revolute_joints, slide_and_turn, sliding, turn_and_slide, turning
from tests.reference.planar_membership import PlanarArm

EXACT = 1e-9  # relative, what the project promises
ROOT3, PI = np.sqrt(3), np.pi
FULL = (-180, 180)
ROWS = {  # DEFINITIONS section 8: joints and tip, area, perimeter, radii of arcs, number of lines, holes
    "RP": (turn_and_slide(), 39 * PI / 4, 6 + 13 * PI / 2, [5, 8], 2, 0),
    "RR 8-5": (revolute_joints([8, 5], [FULL] * 2), 160 * PI, 32 * PI, [3, 13], 0, 1),
    "PR": (slide_and_turn(), 24 + 8 * PI / 3 - 2 * ROOT3, 12 + 4 * ROOT3 + 4 * PI, [2, 2, 2, 2], 4, 0),
    "PR, whole turn": (slide_and_turn(0, 360), 24 + 4 * PI, 12 + 4 * PI, [2, 2], 2, 0),
    "3R 4-2-1": (revolute_joints([4, 2, 1], [(-60, 60)] * 3), 31.497510350119, None, [1, 1, 3, 3, 27**0.5, 7], 0, 0),
    "3R 5-2-1": (revolute_joints([5, 2, 1], [FULL] * 3), 60 * PI, 20 * PI, [2, 8], 0, 1),
}


@pytest.mark.parametrize("row", ROWS)
def test_known_boundaries(row):
    (joints, tip), area, perimeter, radii, lines, holes = ROWS[row]
    found = boundary(joints, tip)
    segments = [segment for loop in found.segments for segment in loop]
    assert found.dimension == 2
    assert found.area == pytest.approx(area, rel=EXACT)
    assert perimeter is None or found.perimeter == pytest.approx(perimeter, rel=EXACT)
    assert sorted(s.radius for s in segments if s.kind == "arc") == pytest.approx(radii, rel=EXACT)
    assert sum(s.kind == "line" for s in segments) == lines
    assert sum(loop.hole for loop in found.loops) == holes
    assert not found.loops[0].hole


def test_vertices_of_the_third_example():
    found = boundary(*slide_and_turn())
    expected = {(sx, sy * ROOT3) for sx in (-1, 1) for sy in (-1, 1)} | {(sx * 2, y) for sx in (-1, 1) for y in (0, 6)}
    distance = np.linalg.norm(found.vertices[:, None] - np.array(sorted(expected)), axis=-1)
    assert len(found.vertices) == 8
    assert distance.min(axis=0).max() < EXACT and distance.min(axis=1).max() < EXACT


def chained(found):
    """Whether each loop's segments follow each other, arcs included, and enclose the area."""
    for loop in found.segments:
        for before, after in zip(loop, loop[1:] + loop[:1], strict=True):
            assert np.allclose(before.end, after.start, atol=EXACT)
        for segment in loop:
            if segment.kind == "arc":
                ends = (segment.start - segment.center, segment.end - segment.center)
                c, s = np.cos(segment.sweep), np.sin(segment.sweep)
                turned = np.array([[c, -s], [s, c]]) @ ends[0]
                assert np.allclose(np.linalg.norm(ends, axis=1), segment.radius, atol=EXACT)
                assert np.allclose(turned, ends[1], atol=EXACT)


@pytest.mark.parametrize("row", ROWS)
def test_segments_follow_each_other(row):
    chained(boundary(*ROWS[row][0]))


@pytest.mark.parametrize("row", ROWS)
def test_postures_reach_the_middle_of_their_segment(row):
    """`generated_by` and `postures` are of the arm, not of the sweep: the forward kinematics say so."""
    (joints, tip), *_ = ROWS[row]
    arm, found = PlanarArm(joints, tip), boundary(joints, tip)
    for segment in (segment for loop in found.segments for segment in loop):
        if segment.kind == "line":
            middle = (segment.start + segment.end) / 2
        else:
            offset = segment.start - segment.center
            middle = segment.center + (
                offset * np.cos(segment.sweep / 2) + np.array([-offset[1], offset[0]]) * np.sin(segment.sweep / 2)
            )
        reached = arm.positions(np.array(segment.postures))
        assert np.abs(reached - complex(*middle)).max() < EXACT


def test_joints_at_limits_generate_segments():
    found = boundary(*turn_and_slide())
    arcs = {round(s.radius): s.generated_by for loop in found.segments for s in loop if s.kind == "arc"}
    assert arcs == {8: ({"d": "upper"},), 5: ({"d": "lower"},)}
    lines = [s.generated_by for loop in found.segments for s in loop if s.kind == "line"]
    assert sorted(lines, key=str) == [({"theta": "lower"},), ({"theta": "upper"},)]
    # The outer arc of an arm stretched out: no joint is at a limit.
    stretched = boundary(*revolute_joints([4, 2, 1], [(-60, 60)] * 3))
    assert [s.generated_by for loop in stretched.segments for s in loop if s.radius == pytest.approx(7)] == [({},)]


joint_kinds = st.one_of(
    st.tuples(st.just("turn"), st.floats(-180, 180), st.floats(1, 360)),
    st.tuples(st.just("whole turn"), st.just(-180.0), st.just(360.0)),
    st.tuples(st.just("slide"), st.floats(-180, 180), st.floats(0.05, 2)),
    st.tuples(st.just("turn"), st.sampled_from([-90.0, -60.0, 0.0, 30.0]), st.sampled_from([60.0, 90.0, 120.0])),
    st.tuples(st.just("slide"), st.sampled_from([0.0, 45.0, 90.0]), st.sampled_from([0.5, 1.0])),
)
links = st.one_of(st.floats(0.2, 2), st.sampled_from([0.0, 1.0, 1.0]))


@st.composite
def arms(draw, most=6):
    joints, x = [], 0.0
    for kind, first, width in draw(st.lists(joint_kinds, min_size=2, max_size=most)):
        if kind == "slide":
            joints.append(sliding(first, 0.0, width))
        else:
            joints.append(turning(x, 0, first, first + width))
        x += draw(links)
    return joints, (x + draw(st.sampled_from([0.0, 0.5])), 0.0)


def beside(found):
    """Points on both sides of every segment, 1e-3 off or nearer where another segment is near, and whether inside."""
    from wsrender.geometry.planar.distances import point_distances

    curves, points, inside, step = found.reached.curves, [], [], []
    for row in range(len(curves)):
        own = curves[np.array([row])]
        best = (0.0, None, None)
        for place in (0.5, 0.3, 0.75):
            t = own.low + place * own.span
            others = np.delete(point_distances(own.at(t), curves)[0], row)
            reach = min(1e-3, others.min(initial=1.0) / 3, *(own.radius[own.arc] / 3))
            best = max(best, (reach, tuple(own.at(t)[0]), tuple(own.normal(t)[0])))
        reach, point, normal = best
        if reach < 1e-5:
            continue  # a band that the oracle cannot resolve
        for side in (1, -1):
            points.append(complex(*point) + side * reach * complex(*normal))
            inside.append(side == found.reached.sign[row])
            step.append(reach)
    return np.array(points), np.array(inside, bool), np.array(step)


@settings(max_examples=25, deadline=None, derandomize=True)
@given(arms())
def test_both_sides_of_every_segment(arm):
    joints, tip = arm
    found = boundary(joints, tip)
    if found.dimension < 2:
        return
    chained(found)
    points, inside, step = beside(found)
    residual = PlanarArm(joints, tip).residuals(points)
    assert (residual[~inside] > 0.9 * step[~inside]).all()
    assert (residual[inside] < 0.01 * step[inside]).all()
    assert (found.contains(np.column_stack([points.real, points.imag])) == inside).all()


@settings(max_examples=5, deadline=None, derandomize=True)
@given(arms())
def test_raster(arm):
    """Every point of a raster away from the boundary is inside iff least squares reach it."""
    joints, tip = arm
    found = boundary(joints, tip)
    arms_samples = PlanarArm(joints, tip)
    size = np.abs(found.vertices).max(initial=1.0) + found.reached.curves.radius.max(initial=0.0)
    axis = np.linspace(-size, size, 24)
    grid = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    nearest = found.nearest(grid)
    clear = nearest.distance > 1e-3 * size
    residual = arms_samples.residuals(grid[clear] @ np.array([1, 1j]), starts=12)
    assert ((residual < 1e-6) == nearest.inside[clear]).all()
    # The least residual of a point outside is its distance from the boundary: an upper bound that the search attains.
    outside = ~nearest.inside[clear]
    assert (residual[outside] > nearest.distance[clear][outside] - 1e-9).all()


@settings(max_examples=60, deadline=None, derandomize=True)
@given(arms(most=8), st.integers(0, 2**32 - 1))
def test_no_configuration_leaves_the_boundary(arm, seed):
    joints, tip = arm
    found, reference = boundary(joints, tip), PlanarArm(joints, tip)
    rng = np.random.default_rng(seed)
    q = reference.low + (reference.high - reference.low) * rng.random((2000, len(joints)))
    q = np.where(rng.random(q.shape) < 0.4, np.where(rng.random(q.shape) < 0.5, reference.low, reference.high), q)
    at = reference.positions(q)
    nearest = found.nearest(np.column_stack([at.real, at.imag]))
    assert (nearest.inside | (nearest.distance < 1e-9)).all()


@pytest.mark.parametrize("width", [1e-2, 1e-3, 1e-4])
def test_thin_bands(width):
    """A whole turn of a short slide: an annulus that samples of a coarse grid would miss."""
    found = boundary([turning(0, 0, *FULL), sliding(0, 0, width)], (5, 0))
    assert found.area == pytest.approx(np.pi * ((5 + width) ** 2 - 25), rel=EXACT)
    assert found.contains([[5 + width / 2, 0], [5 - width / 2, 0], [0, 0], [5 + 1.5 * width, 0]]).tolist() == [
        1,
        0,
        0,
        0,
    ]


def test_small_ranges():
    """A parallelogram of slides, as thin as 1e-6 of its length."""
    found = boundary([sliding(0, 0, 2), sliding(90, 0, 2e-6)], (0, 0))
    assert found.area == pytest.approx(4e-6, rel=1e-6)
    assert len(found.segments[0]) == 4


DEGENERATE = {
    "one joint that turns": ([turning(0, 0, -30, 60)], (2, 0), 1, 2 * np.pi / 2),
    "a whole circle": ([turning(0, 0, *FULL)], (2, 0), 1, 4 * np.pi),
    "one joint that slides": ([sliding(0, -1, 2)], (0, 0), 1, 3),
    "two slides along one line": ([sliding(0, 0, 1), sliding(180, 0, 2)], (0, 0), 1, 3),
    "two joints about one axis": ([turning(0, 0, 0, 30), turning(0, 0, -30, 10)], (1, 0), 1, np.radians(70)),
    "two that make more than a turn": ([turning(0, 0, 0, 300), turning(0, 0, 0, 90)], (1, 0), 1, 2 * np.pi),
    "the tip on the axis": ([turning(1, 0, -30, 30), turning(1, 0, 0, 90)], (1, 0), 0, 0),
}


@pytest.mark.parametrize("name", DEGENERATE)
def test_sets_without_area(name):
    joints, tip, dimension, length = DEGENERATE[name]
    found = boundary(joints, tip)
    assert (found.dimension, found.area, found.loops) == (dimension, 0, [])
    assert found.perimeter == pytest.approx(length, rel=EXACT, abs=EXACT)
    assert sum(len(loop) for loop in found.segments) == dimension
    on = np.array([found.segments[0][0].start if dimension else tip])
    assert found.contains(on).all() and not found.contains(on + 1e-3).any()


def test_a_line_through_the_centre_fills_a_disc():
    found = boundary([turning(0, 0, *FULL), sliding(0, 0, 3)], (0, 0))
    assert (found.dimension, found.area) == (2, pytest.approx(9 * np.pi, rel=EXACT))


def test_links_of_no_length_change_nothing():
    joints, tip = revolute_joints([4, 0, 2, 1], [(-60, 60), (-20, 30), (-40, 30), (-60, 60)])
    assert boundary(joints, tip).area == pytest.approx(
        boundary(*revolute_joints([4, 2, 1], [(-60, 60), (-60, 60), (-60, 60)])).area, rel=EXACT
    )


def test_nearest_points():
    found = boundary(*turn_and_slide())
    nearest = found.nearest([[6, 0], [9, 0], [0, 1], [6.5, 0.0]])
    assert nearest.inside.tolist() == [True, False, False, True]
    assert nearest.distance == pytest.approx([1, 1, np.hypot(3.5355339059327378, 2.5355339059327378), 1.5])
    assert nearest.point[:2] == pytest.approx(np.array([[5, 0], [8, 0]]))
    assert [found.segments[0][k].radius for k in nearest.segment[:2]] == pytest.approx([5, 8])


def test_six_joints_take_less_than_a_second():
    limits = [(-100, 60), (-30, 90), (-120, 40), (0, 70), (-50, 50), (-90, 10)]
    started = time.process_time()
    boundary(*revolute_joints([3, 2, 2, 1, 1, 0.5], limits))
    assert time.process_time() - started < 1.0
