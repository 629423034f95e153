"""Regions by number of inverse solutions, against closed-form inverse kinematics on a raster."""

import numpy as np
import pytest

import wsrender as ws
from tests.geometry.planar_arms import boundary, revolute_joints, slide_and_turn, sliding, turn_and_slide, turning


def within(value, low, high):
    return (value >= low) & (value <= high)


def elbow_counts(x, y, l1, l2, limits):
    """Postures of an RR arm within limits [°] at points, both elbows."""
    limits = np.radians(limits)
    cosine = (x**2 + y**2 - l1**2 - l2**2) / (2 * l1 * l2)
    count = np.zeros(x.shape, int)
    for sign in (1, -1):
        elbow = sign * np.arccos(np.clip(cosine, -1, 1))
        shoulder = np.arctan2(y, x) - np.arctan2(l2 * np.sin(elbow), l1 + l2 * np.cos(elbow))
        inside = np.abs(cosine) <= 1
        for angle, (low, high) in zip((shoulder, elbow), limits, strict=True):
            inside &= np.mod(angle - low, 2 * np.pi) <= high - low
        count += inside
    return count


def crank_counts(x, y, low_deg, high_deg):
    """Postures of the paper's PR arm: x = 2 sin θ, y = d − 2 cos θ, d in 0 … 6."""
    count = np.zeros(x.shape, int)
    for theta in (np.arcsin(np.clip(x / 2, -1, 1)), np.pi - np.arcsin(np.clip(x / 2, -1, 1))):
        turned = np.mod(theta - np.radians(low_deg), 2 * np.pi) <= np.radians(high_deg - low_deg)
        count += (np.abs(x) <= 2) & turned & within(y + 2 * np.cos(theta), 0, 6)
    return count


def areas(counts, box):
    (x0, x1), (y0, y1) = box
    cell = (x1 - x0) * (y1 - y0) / counts.size
    return {n: cell * np.count_nonzero(counts == n) for n in range(1, 3)}


def raster(box, cells=1200):
    axes = [np.linspace(low, high, 2 * cells + 1)[1::2] for low, high in box]
    return np.meshgrid(*axes)


def test_whole_turns_have_two_postures_everywhere():
    (only,) = boundary(*revolute_joints([8, 5], [(-180, 180)] * 2)).inverse_solution_regions
    assert (only.number, only.regions) == (2, 1)
    assert only.area_m2 == pytest.approx(160 * np.pi, rel=1e-9)


def test_an_elbow_that_bends_one_way_has_one():
    (only,) = boundary(*revolute_joints([8, 5], [(-180, 180), (0, 150)])).inverse_solution_regions
    assert (only.number, only.regions) == (1, 1)


@pytest.mark.parametrize("limits", [[(-60, 60), (-60, 60)], [(-30, 200), (-150, 100)], [(-180, 180), (-40, 120)]])
def test_regions_of_two_turning_joints(limits):
    found = boundary(*revolute_joints([2, 1.5], limits)).inverse_solution_regions
    box = [(-3.6, 3.6)] * 2
    expected = areas(elbow_counts(*raster(box), 2, 1.5, limits), box)
    assert {r.number: r.area_m2 for r in found} == pytest.approx({n: a for n, a in expected.items() if a}, abs=0.02)


@pytest.mark.parametrize("limits", [(30, 330), (0, 360), (10, 200)])
def test_regions_of_a_slide_and_a_turn(limits):
    exact = boundary(*slide_and_turn(*limits))
    found = exact.inverse_solution_regions
    box = [(-2.1, 2.1), (-2.1, 8.1)]
    expected = areas(crank_counts(*raster(box), *limits), box)
    assert {r.number: r.area_m2 for r in found} == pytest.approx({n: a for n, a in expected.items() if a}, abs=0.03)
    assert sum(r.area_m2 for r in found) == pytest.approx(exact.area, rel=1e-9)


def test_regions_are_counted():
    # A turn of 60° and an elbow of ±60°: the elbow bends either way in the middle, one way on each side of it.
    by_number = {r.number: r for r in boundary(*revolute_joints([2, 1.5], [(-60, 60)] * 2)).inverse_solution_regions}
    assert by_number[2].regions == 1
    assert by_number[1].regions >= 2


def test_one_slide_and_one_turn_about_the_base_have_one_posture():
    assert [(r.number, r.regions) for r in boundary(*turn_and_slide()).inverse_solution_regions] == [(1, 1)]
    slides = [sliding(0, 0, 1), sliding(90, 0, 1)]
    assert [(r.number, r.area_m2) for r in boundary(slides, (0, 0)).inverse_solution_regions] == [(1, pytest.approx(1))]


def test_other_arms_have_no_number():
    three = boundary(*revolute_joints([4, 2, 1], [(-60, 60)] * 3))
    assert three.inverse_solution_regions is None
    assert boundary([turning(0, 0, 0, 30), turning(0, 0, 0, 30)], (1, 0)).inverse_solution_regions is None
    with pytest.raises(ws.InputError, match="two joints must move the tip over an area"):
        three.inverse_solutions([[6, 0]])


@pytest.mark.parametrize("limits", [[(-60, 60), (-60, 60)], [(-30, 200), (-150, 100)]])
def test_numbers_at_points(limits):
    x, y = raster([(-3.6, 3.6)] * 2, cells=60)
    found = boundary(*revolute_joints([2, 1.5], limits)).inverse_solutions(np.column_stack([x.ravel(), y.ravel()]))
    assert (found == elbow_counts(x, y, 2, 1.5, limits).ravel()).all()
