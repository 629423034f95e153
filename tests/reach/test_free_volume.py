"""Free and blocked volumes against closed forms, and labels of single points."""

import json
from dataclasses import asdict

import numpy as np
import pytest

import wsrender as ws
from tests.reach import guarded_arms as arms
from wsrender.documents.constraints import Constraints
from wsrender.reach.admissible_search import BLOCKED, AdmissibleSearch
from wsrender.reach.admission import Admission
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.reach.free_volume import FreeSet
from wsrender.reach.inverse_solver import InverseSolver
from wsrender.reach.measure_refinement import free_measures
from wsrender.reach.reached_set import FalseNegatives, hidden_share
from wsrender.robot.constraints import constraints_for


def measured(guarded, **options):
    return free_of(guarded.robot.chain, guarded.constraints, **{"tolerance": 0.01, "device": "cpu"} | options)


def free_of(chain, constraints, tolerance, **options):
    return free_measures([chain], [constraints], {"": 1}, tolerance, **options)[""]


def holds(measure, exact):
    low, high = measure.ci95
    return low <= exact <= high


def test_two_links_over_a_floor():
    found = measured(arms.two_links())
    exact, whole = arms.free_area_of_two_links(), np.pi * 4 * arms.LINK**2
    assert found["free"].quantity == "area" and found["free"].met and found["free"].undecided < 1e-3 * exact
    assert found["free"].value == pytest.approx(exact, rel=0.01) and holds(found["free"], exact)
    assert found["blocked"] == found["environment"] and holds(found["blocked"], whole - exact)


def test_a_fine_tolerance_cuts_cells():
    found, exact = measured(arms.two_links(), tolerance=0.002), arms.free_area_of_two_links()
    assert found["free"].met and found["free"].value == pytest.approx(exact, rel=0.002)
    assert found["free"].points > 20_000


def test_a_scara_beside_a_column():
    found, (free, blocked) = measured(arms.scara()), arms.free_and_blocked_of_scara()
    assert found["free"].met and found["free"].value == pytest.approx(free, rel=0.01) and holds(found["free"], free)
    assert blocked > 0.015 * free and holds(found["blocked"], blocked)


def test_where_no_sample_is_admitted_nothing_is_known():
    guarded = arms.two_links()
    away = constraints_for(guarded.robot, Constraints(region={"box": {"lower_m": [9, None, None]}}), None)
    found = free_of(guarded.robot.chain, away, 0.01)
    whole = np.pi * 4 * arms.LINK**2
    assert found["free"].value == 0 and not found["free"].met
    assert found["free"].ci95[0] == 0 and found["free"].ci95[1] >= whole and found["blocked"].ci95[0] == 0


def test_what_each_of_two_constraints_blocks():
    """A region that ends at x = .5 m, whatever the posture, and of the rest what is below the floor."""
    guarded, end = arms.two_links(), 0.5
    region = constraints_for(guarded.robot, Constraints(region={"box": {"upper_m": [end, None, None]}}), None)
    found = free_of(guarded.robot.chain, (*region, *guarded.constraints), 0.01)
    x, z = np.meshgrid(*[np.linspace(-2, 2, 4001) * arms.LINK] * 2, indexing="ij")
    disc, above = np.hypot(x, z) <= 2 * arms.LINK, z >= arms.FLOOR + arms.RADIUS
    cell = (arms.LINK / 1000) ** 2
    exact = {"region": disc & (x > end), "environment": disc & (x <= end) & ~above, "free": disc & (x <= end) & above}
    exact["blocked"] = disc & ~exact["free"]
    for name, where in exact.items():
        assert holds(found[name], where.sum() * cell), name
    assert found["environment"].ci95[1] < found["blocked"].ci95[0]


def test_what_the_search_misses_widens_all_intervals(monkeypatch):
    """A search that calls a tenth of what is free blocked: both trials tell, and intervals hold what is exact."""
    decide = AdmissibleSearch.decide

    def missing(self, *targets, **options):
        found = decide(self, *targets, **options)
        missed = np.flatnonzero(found.label == REACHABLE)[::10]
        found.label[missed], found.rejected[missed, 0] = BLOCKED, 1
        return found

    monkeypatch.setattr(AdmissibleSearch, "decide", missing)
    found, exact = measured(arms.two_links()), arms.free_area_of_two_links()
    assert found["free"].value == pytest.approx(0.9 * exact, rel=0.01) and holds(found["free"], exact)
    assert holds(found["blocked"], np.pi * 4 * arms.LINK**2 - exact)
    low, high = found["blocked"].ci95
    hidden = hidden_share(found["free"].false_negatives) * (found["free"].ci95[1] + found["blocked"].value)
    assert low + hidden < found["blocked"].value < high - hidden
    for trial in found["free"].false_negatives:
        assert trial.tested > 3000 and trial.rate == pytest.approx(0.1, abs=0.01)


@pytest.mark.parametrize("center", [0.5, 5.0], ids=["some", "none"])
def test_a_search_that_misses_all_has_intervals_that_documents_hold(monkeypatch, center):
    monkeypatch.setattr(FreeSet, "found_later", lambda *_: FalseNegatives(1, 1))
    robot = arms.two_links().robot
    region = {"sphere": {"position_m": [center, 0, 0], "radius_m": 0.2}}
    found = free_of(robot.chain, constraints_for(robot, Constraints(region=region), None), 0.05)
    json.dumps({name: asdict(each) for name, each in found.items()}, allow_nan=False)
    assert found["blocked"].ci95[0] == 0 and found["free"].ci95[1] >= np.pi * 4 * arms.LINK**2


FAR = ws.Transform(position_m=(5e5, 4.2e6, 10.0), rpy_deg=(20, 0, 90))


@pytest.mark.parametrize("placement", (None, FAR), ids=("here", "far away"))
def test_a_spherical_arm_beside_a_wall(placement):
    found, (free, blocked) = measured(arms.spherical(placement)), arms.free_and_blocked_of_spherical()
    assert found["free"].met and found["free"].value == pytest.approx(free, rel=0.01) and holds(found["free"], free)
    assert holds(found["blocked"], blocked)


def test_labels_of_points_around_a_column():
    """Of 20,000 points those that are decided wrongly are at most .1 %, those undecided at most 1 %."""
    guarded, random = arms.scara(), np.random.default_rng(0)
    points = random.uniform([-0.9, -0.9, -0.2], [0.9, 0.9, 0], (20_000, 3))
    points[:10_000, :2] = arms.COLUMN + random.uniform(-0.3, 0.3, (10_000, 2))
    reach, free, margin = arms.scara_labels(points)
    solver = InverseSolver(guarded.robot.chain, position_m=1e-6, device="cpu")
    found = AdmissibleSearch(solver, Admission(guarded.robot.chain, guarded.constraints)).decide(points)
    expected = np.select([free, reach], [REACHABLE, BLOCKED], UNREACHABLE)
    clear = margin > 1e-5  # the tolerance's share of what decides
    undecided = found.label == UNDECIDED
    wrong = clear & ~undecided & (found.label != expected)
    assert (reach & ~free).sum() > 1000 and clear.mean() > 0.999
    assert wrong.sum() <= 1e-3 * (~undecided).sum() and undecided.mean() <= 0.01
    assert set(found.reason[found.label == BLOCKED].tolist()) == {1}
    # Configurations are those that reach the target, and of free ones admitted.
    there = found.label != UNREACHABLE
    tip = guarded.robot.chain.poses(found.q)[:, :3, 3]
    assert np.abs(tip - points)[there & ~undecided].max() <= 1e-6
    admitted = guarded.constraints[0].host(found.q, np.zeros((0, 4, 4))) == 0
    assert admitted[found.label == REACHABLE].all() and not admitted[found.label == BLOCKED].any()
