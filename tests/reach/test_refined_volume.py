"""Reachable volumes against exact ones (DEFINITIONS section 6), single robots and pairs."""

import numpy as np
import pytest

import wsrender as ws
from tests.reference.exact_volumes import CASES, articulated, spherical_pair
from wsrender.reach import Inside, refined_volume, refined_volumes
from wsrender.reach.measure_refinement import refined_measure
from wsrender.reach.reached_set import FalseNegatives, hidden_share

SPHERICAL = CASES["spherical"].volume


SLOW = {"shell of 1 mm"}  # five million points: benchmarks/volumes.py


@pytest.mark.parametrize("name", [name for name, case in CASES.items() if case.volume and name not in SLOW])
def test_exact_volumes(name):
    case = CASES[name]
    exact, rounding = case.volume, case.error * case.volume
    estimate, found = refined_volume(case.robot().chain, 0.005)
    assert estimate.met
    assert estimate.low - rounding <= exact <= estimate.high + rounding
    assert estimate.high - estimate.low <= 2 * 0.005 * estimate.value
    (tried,) = found.false_negatives
    assert tried.tested > 500
    assert tried.rate < 1e-3


def test_interval_holds_the_volume_whatever_the_seed():
    chain = ws.load_robot("spherical").chain
    estimates = [refined_volume(chain, 0.02, seed=seed)[0] for seed in range(6)]
    assert sum(e.low <= SPHERICAL <= e.high for e in estimates) >= 5
    assert len({e.value for e in estimates}) == 6


@pytest.mark.parametrize("name", ["articulated", "spherical"])
def test_pairs(name):
    """Placements of [WSR] Table V; the volume that two articulated arms share is known to three digits."""
    any_spherical, both_spherical = spherical_pair()
    placed, exact = {
        "articulated": ({"position_m": (0, 0, 0.4)}, (2 * articulated() - 0.0128, 0.0128)),
        "spherical": ({"position_m": (0, 0.4, 0), "rpy_deg": (0, 0, 90)}, (any_spherical, both_spherical)),
    }[name]
    pair = []
    for x in (0.1, -0.1):
        y, z = placed["position_m"][1:]
        placement = ws.Transform(**{**placed, "position_m": (x, y, z)})
        pair.append(ws.load_robot(name, placement=placement).chain)
    events = {"any": Inside(1, 2), "all": Inside(2, 2), "exactly_1": Inside(1, 1, precise=False)}
    volumes = refined_volumes(pair, events, 0.01).volumes
    for event, volume in zip(("any", "all"), exact, strict=True):
        assert volumes[event].low - 5e-5 <= volume <= volumes[event].high + 5e-5
        assert volumes[event].met
    assert volumes["exactly_1"].value == pytest.approx(volumes["any"].value - volumes["all"].value)


@pytest.mark.parametrize("name", ["slave_5r, on a sphere", "scara, in a plane", "three joints, on a sphere"])
def test_planes_and_surfaces_have_no_volume(name):
    estimate, found = refined_volume(CASES[name].robot().chain, 0.01)
    assert (estimate.value, estimate.low, estimate.high) == (0.0, 0.0, 0.0)
    assert found.points == 0


def test_same_seed_same_estimate_whatever_the_threads():
    chain = ws.load_robot("spherical").chain
    first, second = (refined_volume(chain, 0.02, seed=5, threads=threads)[0] for threads in (1, 2))
    assert first == second


def test_no_miss_among_so_many_targets_still_hides_something():
    """The rule of three, two-sided: 3.84 / n; misses of several solvers count together, whichever of them missed."""
    none, one = FalseNegatives(4096, 0), FalseNegatives(4096, 1)
    assert hidden_share([none]) == pytest.approx(3.84 / 4096, rel=2e-3)
    assert hidden_share([none, none, FalseNegatives(0, 0)]) == hidden_share([none])
    assert 1 / 4096 < hidden_share([one]) == hidden_share([none, one]) < hidden_share([one, one])
    assert hidden_share([FalseNegatives(8, 8)]) == np.inf and hidden_share([FalseNegatives(0, 0)]) == 0.0


def test_what_no_miss_may_hide_widens_the_upper_end_within_the_tolerance():
    """As many targets are tried as the tolerance needs, on a line too, which has no more than 64 cells."""
    for case, tolerance in (("spherical", 0.01), ("spherical", 0.003)):
        measure = refined_measure(CASES[case].robot().chain, tolerance)
        (tried,) = measure.false_negatives
        assert tried.missed == 0 and 3.84 / tried.tested <= 0.101 * tolerance
        assert measure.met and measure.value and measure.ci95
        assert measure.ci95[1] >= measure.value * (1 + 3.8 / tried.tested)
    slide = ws.DHRow(joint="prismatic", limits=(0, 1))
    line = refined_measure(ws.load_robot(ws.DHTable(convention="standard", rows=(slide, slide))).chain, 0.01)
    assert line.met and line.false_negatives[0].tested == 4096
    assert line.ci95 and line.ci95[0] <= 2.0 <= line.ci95[1]


@pytest.mark.parametrize("name", ["spherical", "articulated", "cylindrical"])
@pytest.mark.parametrize("tolerance", [0.1, 0.05])
def test_coarse_intervals_hold_the_volume(name, tolerance):
    """Of 40 seeds each, all did: where strata have had their first points alone, small-sample intervals are wide."""
    case = CASES[name]
    chain, rounding = case.robot().chain, case.error * case.volume
    found = [refined_measure(chain, tolerance, seed=seed).ci95 or (0.0, 0.0) for seed in range(40, 44)]
    assert all(low - rounding <= case.volume <= high + rounding for low, high in found)
    assert all(high - low <= 2 * tolerance * case.volume for low, high in found)
