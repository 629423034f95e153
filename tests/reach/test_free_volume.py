"""Free and blocked volumes against closed forms, and labels of single points."""

import numpy as np
import pytest

import wsrender as ws
from tests.reach import guarded_arms as arms
from wsrender.reach.admissible_search import BLOCKED, AdmissibleSearch
from wsrender.reach.admission import Admission
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.reach.inverse_solver import InverseSolver
from wsrender.reach.measure_refinement import free_measures


def measured(guarded, **options):
    return free_measures(guarded.robot.chain, guarded.constraints, **{"tolerance": 0.01, "device": "cpu"} | options)


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
