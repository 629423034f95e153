"""Areas and lengths of planar and linear workspaces against closed forms (DEFINITIONS section 8), and what has none."""

import numpy as np
import pytest

import wsrender as ws
from tests.reference.exact_volumes import CASES, dh_arm, slide, tool
from wsrender.reach import Inside, refined_measure, refined_measures

TURNED = ws.Transform(position_m=(1, 2, 3), rpy_deg=(20, 30, 40))
UPRIGHT = ws.Transform(position_m=(0, 0, 1), rpy_deg=(90, 0, 0))
HINGE = (0, 0, 0, 0, {})


def hinges(*links, limits=None, **placing):
    """A planar arm of hinges with limits [deg], and its links [m]."""
    lengths = (0.0, *links[:-1])
    return dh_arm(
        *((a, 0, 0, 0, {"limits_deg": limits} if limits else {}) for a in lengths), tool=tool(x=links[-1]), **placing
    )


def slide_then_hinge(first, last, **placing):
    """PR: x = 2 sin q, y = d - 2 cos q, with q from ``first`` to ``last`` [deg]."""
    limits = {"limits_deg": (first, last)} if last - first < 360 else {}
    return dh_arm((0, 0, 0, 0, slide(0, 6)), (0, 90, 0, -90, limits), tool=tool(x=2), **placing)


def ring(outer, inner):
    """Area of a ring."""
    return np.pi * (outer**2 - inner**2)


def folded_elbow(upper, lower):
    """Area of hinges of ±45° and 180° ± 45°: circles about the first, on which the two ways to bend may overlap."""

    def along(bend):
        aside = np.angle(upper + lower * np.exp(1j * bend))
        return upper * lower * np.sin(bend) * min(np.pi / 2 + 2 * aside, np.pi / 2 + 2 * (np.pi - aside), np.pi)

    bends = np.linspace(0.75 * np.pi, np.pi, 2001)
    return np.trapezoid([along(bend) for bend in bends], bends)


AREAS = {
    "RR 8-5": (lambda: hinges(8, 5), ring(13, 3)),
    "RR 8-5, turned": (lambda: hinges(8, 5, placement=TURNED), ring(13, 3)),
    "RR .3-.27, upright": (lambda: hinges(0.3, 0.27, placement=UPRIGHT), ring(0.57, 0.03)),
    "3R 4-2-1, turned": (lambda: hinges(4, 2, 1, limits=(-60, 60), placement=TURNED), 31.497510350119),
    "3R 5-2-1": (lambda: hinges(5, 2, 1), ring(8, 2)),
    "RP, turned": (
        lambda: dh_arm((0, 0, 0, 0, {"limits_deg": (-45, 45)}), (0, 90, 0, 0, slide(5, 8)), placement=TURNED),
        39 * np.pi / 4,
    ),
    "PR": (lambda: slide_then_hinge(30, 330), 24 + 8 * np.pi / 3 - 2 * np.sqrt(3)),
    "PR, full turns, turned": (lambda: slide_then_hinge(0, 360, placement=TURNED), 24 + 4 * np.pi),
    "PP": (lambda: dh_arm((0, 0, 0, 0, slide(0, 0.3)), (0, 90, 0, 0, slide(0, 0.4)), placement=TURNED), 0.12),
}


def holds(measure, exact):
    """Whether an interval holds a value."""
    assert measure.ci95
    low, high = measure.ci95
    return low <= exact <= high


@pytest.mark.parametrize("name", AREAS)
def test_areas_of_planar_arms(name):
    robot, exact = AREAS[name]
    chain = robot().chain
    found = [refined_measure(chain, 0.01, seed=seed) for seed in range(5)]
    assert sum(holds(measure, exact) for measure in found) >= 4
    measure = found[0]
    assert (measure.quantity, measure.unit, measure.reason, measure.met) == ("area", "m2", "", True)
    assert measure.value and measure.ci95
    low, high = measure.ci95
    assert high - low <= 0.02 * measure.value
    assert measure.undecided <= 1e-3 * exact
    (tried,) = measure.false_negatives
    assert tried.tested > 500
    assert tried.rate < 1e-3


@pytest.mark.parametrize("name", ["3R 4-2-1, turned", "PR", "RR .3-.27, upright"])
def test_nine_intervals_in_ten_hold_the_area(name):
    robot, exact = AREAS[name]
    chain = robot().chain
    assert sum(holds(refined_measure(chain, 0.02, seed=seed), exact) for seed in range(30)) >= 27


def test_a_sliding_arm_has_a_length():
    rows = ((0, 0, 0, 0, slide(0.2, 0.5)), (0, 0, 0, 0, slide(0, 0.5)))
    for count, exact in ((1, 0.3), (2, 0.8)):
        measure = refined_measure(dh_arm(*rows[:count], placement=TURNED).chain, 0.01)
        assert (measure.quantity, measure.unit, measure.met) == ("length", "m", True)
        assert holds(measure, exact)


def test_a_solid_arm_has_its_refined_volume_wherever_it_stands():
    case = CASES["spherical"]
    measure = refined_measure(case.robot().chain, 0.01)
    assert (measure.quantity, measure.unit) == ("volume", "m3")
    assert holds(measure, case.volume)
    placed = refined_measure(case.robot().chain.placed(np.array(TURNED.matrix())), 0.01)
    assert placed.value == pytest.approx(measure.value, rel=1e-12)


def test_joints_that_are_held_leave_an_area_a_curve_or_a_point():
    scara = ws.load_robot("scara").chain
    exact = folded_elbow(0.2, 0.3)
    area = refined_measure(scara.held({"joint3": 0.3}), 0.01)
    assert (area.quantity, holds(area, exact)) == ("area", True)
    curve = refined_measure(scara.held({"joint1": 0.3, "joint3": 0.3}), 0.01)
    point = refined_measure(scara.held(dict.fromkeys(scara.joint_names, 0.3)), 0.01)
    for measure, quantity, reason in (
        (curve, "area", "the tip stays on a curve"),
        (point, "length", "the tip does not move"),
    ):
        assert (measure.value, measure.ci95, measure.quantity) == (None, None, quantity)
        assert (measure.reason, measure.met, measure.points) == (reason, True, 0)


@pytest.mark.parametrize(
    ("robot", "quantity", "reason"),
    [
        (CASES["slave_5r, on a sphere"].robot, "volume", "the tip stays on a surface"),
        (CASES["three joints, on a sphere"].robot, "volume", "the tip stays on a surface"),
        (
            lambda: dh_arm((0, 0, 0, 0, {}), (0, 0, 0, 0, slide(0, 1)), tool=tool(x=1)),
            "volume",
            "the tip stays on a surface",
        ),
        (lambda: hinges(2, placement=TURNED), "area", "the tip stays on a curve"),
        (lambda: dh_arm(HINGE, tool=tool(z=1)), "length", "the tip does not move"),
    ],
    ids=["slave_5r", "gimbal", "cylinder", "hinge", "point"],
)
def test_curved_surfaces_and_curves_have_no_measure(robot, quantity, reason):
    measure = refined_measure(robot().chain, 0.01)
    assert (measure.value, measure.ci95, measure.quantity, measure.reason) == (None, None, quantity, reason)


def test_right_angles_of_model_files_are_right_angles():
    """A URDF's 1.5708 tips the second axis by 3.7e-6 rad: the arm still moves in a plane."""
    robot = dh_arm(HINGE, (0.3, np.degrees(1.5708) - 90, 0, 0, {}), tool=tool(x=0.2), placement=UPRIGHT)
    measure = refined_measure(robot.chain, 0.01)
    assert measure.quantity == "area"
    assert holds(measure, ring(0.5, 0.1))


def two_rings(apart, height=0.0):
    """Two 2R arms that reach discs of .4 m, so far apart along x and z."""
    there = [ws.Transform(position_m=(x, 0, z), rpy_deg=(0, 0, 0)) for x, z in ((0, 0), (apart, height))]
    return [hinges(0.2, 0.2, placement=place).chain for place in there]


EVENTS = {"any": Inside(1, 2), "all": Inside(2, 2)}


def test_what_two_planar_arms_share_is_an_area():
    lens = 2 * 0.4**2 * np.arccos(0.5) - 0.2 * np.sqrt(4 * 0.4**2 - 0.4**2)  # of two discs, their centres .4 m apart
    found = refined_measures(two_rings(0.4), EVENTS, 0.01)
    assert {measure.quantity for measure in found.values()} == {"area"}
    assert holds(found["all"], lens)
    assert holds(found["any"], 2 * np.pi * 0.4**2 - lens)


def test_arms_in_different_planes_have_no_area_together():
    found = refined_measures(two_rings(0.4, height=0.1), EVENTS, 0.01)
    assert {measure.value for measure in found.values()} == {None}
    assert {measure.reason for measure in found.values()} == {"the tips move in different planes"}


def test_a_planar_arm_adds_nothing_to_a_volume():
    solid = CASES["spherical"].robot().chain
    (flat,) = two_rings(0.4)[:1]
    found = refined_measures([solid, flat], EVENTS, 0.02)
    assert {measure.quantity for measure in found.values()} == {"volume"}
    assert holds(found["any"], CASES["spherical"].volume)
    assert found["all"].value == 0.0 and found["all"].reason == (
        "a tip that stays in a plane, on a surface or on a curve reaches no volume"
    )
    assert found["any"].reason == ""
    assert len(found["all"].false_negatives) == 2


def test_a_budget_of_points_ends_the_work_with_an_honest_interval():
    case = CASES["shell of 1 mm"]  # would take more than a million points
    measure = refined_measure(case.robot().chain, 0.01)
    assert not measure.met
    assert 50_000 < measure.points <= 110_000
    assert holds(measure, case.volume)


@pytest.mark.parametrize("name", ["articulated", "dvrk_mtm", "gao_6r", "phantom_omni"])
def test_library_arms_need_few_points(name):
    """Border cells sorted by their neighbours, and what is proven out of reach left out: else 15,000 to 35,000."""
    measure = refined_measure(ws.load_robot(name).chain, 0.01)
    assert measure.met
    assert measure.points < 10_000
