"""What two arms reach together, under constraints of each and apart from each other, against closed forms."""

import numpy as np
import pytest

import wsrender as ws
from tests.reach import two_arms as arms
from wsrender.analyses.execution import Execution
from wsrender.documents.constraints import Apart
from wsrender.errors import InputError
from wsrender.reach.admissible_search import BLOCKED, AdmissibleSearch
from wsrender.reach.admission import Admission
from wsrender.reach.evidence import REACHABLE, UNDECIDED
from wsrender.reach.inverse_solver import InverseSolver
from wsrender.reach.pair_search import PairSearch
from wsrender.robot.arms_collision import arms_apart
from wsrender.robot.constraints import constraints_for
from wsrender.run import plan


def loaded():
    return [ws.load_robot(each["mjcf"], placement=each.get("placement")) for each in arms.both()]


def test_points_of_two_arms_against_all_their_postures():
    """Of 5,000 points that both are free to reach at most .1 % are decided wrongly, at most 1 % not at all."""
    robots, random = loaded(), np.random.default_rng(0)
    points = random.uniform([-0.4, -0.9], [1.0, 0.45], (20_000, 2))
    known = arms.labels(points, wall=True)
    chosen = np.flatnonzero(known["free"] & (known["margin"] > 1e-5))[:5000]
    searches = []
    for robot in robots:
        solver = InverseSolver(robot.chain, position_m=1e-8, device="cpu")
        searches.append(AdmissibleSearch(solver, Admission(robot.chain, constraints_for(robot, None, arms.wall()))))
    search = PairSearch(searches[0], searches[1], arms_apart(robots, ("left", "right"), Apart()))
    found = search.decide(np.pad(points[chosen], ((0, 0), (0, 1))))
    expected, decided = np.where(known["apart"][chosen], REACHABLE, BLOCKED), found != UNDECIDED
    assert len(chosen) == 5000 and 0.1 < known["apart"][chosen].mean() < 0.9
    assert (decided & (found != expected)).sum() <= 1e-3 * decided.sum() and (~decided).mean() <= 0.01


def holds(measure: dict, exact: float, width: float) -> bool:
    low, high = measure["ci95"]
    return low <= exact <= high and high - low <= width


def test_areas_that_are_shared_freely_and_apart():
    robots = [{"robot": each, "sampling": {"method": "sobol", "count": 4096}} for each in arms.both()]
    asked = {"environment": True, "arms_collision": True}
    options = {"environment": arms.wall(), "constraints": asked, "refined_volume": 0.05, "voxel_size_m": 0.02}
    result = ws.shared_workspace(robots, **options, device="cpu")
    exact, area = arms.areas(wall=True), result.document["area_m2"]
    width = 0.1 * exact["reached"]
    assert holds(area["free"], exact["apart"], width)
    assert holds(area["blocked"], exact["reached"] - exact["apart"], width)
    assert list(area["blocked"]["by"]) == ["environment", "arms_collision"]
    assert holds(area["blocked"]["by"]["environment"], exact["reached"] - exact["free"], width)
    assert holds(area["blocked"]["by"]["arms_collision"], exact["free"] - exact["apart"], width)
    assert exact["free"] - exact["apart"] > width and exact["reached"] - exact["free"] > width
    assert result.document["headline"]["value"] == area["free"]["value"] == area["refined"]["shared"]["value"]
    # One arm reaches a point alone, wherever the other is: equal arms whose wall is the same.
    alone = area["refined"]["any"]["parts"]
    assert "arms_collision" not in alone["blocked"]["by"] and area["refined"]["any"]["value"] > exact["free"]


def test_values_of_a_scan_at_which_arms_never_keep_apart_are_named():
    """At x = 0 their first links turn about one axis; where the robots stand they keep apart."""
    robots = [{"robot": each, "sampling": {"method": "sobol", "count": 64}} for each in arms.both()]
    job = {"analysis": "shared_workspace", "robots": robots, "voxel_size_m": 0.1, "device": "cpu"}
    scan = {"axis": "x", "values": [arms.BESIDE, 0.0]}
    planned = plan(job | {"scan": scan, "constraints": {"arms_collision": {"margin_m": 0.01}}})
    with pytest.raises(InputError, match=r"admit nothing: .*robot_2/first collide .*\(at scan\.values\.1\)") as error:
        planned.refinement(2, None, Execution())
    assert error.value.field == "constraints.arms_collision"


def test_what_two_arms_reach_apart_without_other_constraints():
    left, right = ({"robot": each} for each in arms.both())
    options = {"samples": 1000, "seeds": 1, "cells": (2, 2, 2), "refined_volume": 0.05, "device": "cpu"}
    result = ws.collaborative_volume(left, right, constraints={"arms_collision": True}, **options)
    exact, area = arms.areas(wall=False), result.document["area_m2"]
    assert holds(area["free"], exact["apart"], 0.11 * exact["apart"]) and "admission" not in result.document
    blocked = area["blocked"]["by"]["arms_collision"]
    assert area["blocked"]["value"] == blocked["value"] and holds(blocked, exact["reached"] - exact["apart"], 0.1)
    assert result.document["headline"]["ci95"] == area["free"]["ci95"]
