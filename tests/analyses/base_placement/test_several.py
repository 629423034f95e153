"""Several arms of a ``base_placement`` job: each as by itself, and where which of them does best."""

from functools import reduce

import numpy as np
import pytest

import wsrender as ws
from wsrender.analyses.base_placement.several import SeveralPlacements
from wsrender.analyses.jobs import canonical_json, parse_job
from wsrender.run import execute, plan, run_shard

RING = [[0.1 + 0.15 * np.cos(k), 0.15 * np.sin(k), 0.3] for k in range(6)]
SPACE = {"x_m": [-0.9, 0.9, 0.2], "y_m": [-0.6, 0.6, 0.3], "yaw_deg": [0, 360, 120]}
ASIDE = {"library": "puma560", "placement": {"position_m": [-0.7, 0, 0.1]}}
ARMS = [{"robot": {"library": "ur5e"}}, {"robot": ASIDE, "name": "puma"}]
STIFF = {"tip_compliance": {"joint_stiffness": [1e4] * 6}}


def job(**fields):
    asked = {"analysis": "base_placement", "points_m": RING, "quats_wxyz": [[0, 1, 0, 0]] * 6, "over": SPACE}
    return asked | {"robots": ARMS, "device": "cpu", "refine": False} | fields


@pytest.mark.parametrize("index", [None, "manipulability", "tip_compliance"])
def test_each_arm_is_placed_as_by_itself_and_wins_where_no_other_does_better(index):
    fields = {"index": index, "weights": [1, 2, 1, 3, 1, 0.5]}
    fields |= {"index_options": STIFF} if index == "tip_compliance" else {}
    result = execute(job(**fields))
    alone = [execute({name: each for name, each in job(**fields).items() if name != "robots"} | arm)
             for arm in ({"robot": "ur5e"}, {"robot": ASIDE})]  # fmt: skip
    cells = result.tables["arms_map"]
    for entry, own in zip(result.document["robots"], alone, strict=True):
        name = entry["name"]
        assert {key: entry[key] for key in ("robot", "placements", "best")}.items() <= own.document.items()
        for table in ("placements", "targets"):
            found, expected = (each.columns for each in (result.tables[f"{table}_{name}"], own.tables[table]))
            assert found.keys() == expected.keys()
            assert all(np.array_equal(found[key], expected[key], equal_nan=key == index) for key in found)
        expected = own.tables["placement_map"]
        assert expected.grid == cells.grid
        for column in expected.columns.keys() - {"x_m", "y_m"}:
            assert np.array_equal(cells[f"{column}_{name}"], expected[column], equal_nan=column == index)
    counted = {"ur5e": 0, "puma": 0, "equal": 0, "none": 0}
    for k in range(len(cells)):
        best = []
        for name in ("ur5e", "puma"):
            value = cells[f"{index}_{name}"][k] * (-1 if index == "tip_compliance" else 1) if index else 0
            best.append((cells[f"weight_{name}"][k], value))
        wins = [best[own][0] > 0 and (best[own][0] > best[1 - own][0] or best[own] >= best[1 - own]) for own in (0, 1)]
        assert wins == [cells["wins_ur5e"][k], cells["wins_puma"][k]]
        counted[["none", "ur5e", "puma", "equal"][wins[0] + 2 * wins[1]]] += 1
    about = result.document["arms"]
    assert about == {"cells": 36, "alone": {name: counted[name] for name in ("ur5e", "puma")}} | {
        name: counted[name] for name in ("equal", "none")
    }
    assert min(about["alone"].values()) > 2
    bests = [own.document["best"] for own in alone]
    ranks = [(each["weight"], each.get(index, 0) * (-1 if index == "tip_compliance" else 1)) for each in bests]
    assert (
        result.document["best"]
        == {"robot": ("ur5e", "puma")[int(ranks[1] > ranks[0])]}
        | max(zip(ranks, bests, strict=True), key=lambda each: each[0])[1]
    )


def test_equal_arms_win_together_and_the_first_is_best():
    result = execute(job(robots=[ARMS[0] | {"name": "a"}, ARMS[0] | {"name": "b"}], refine=True, over={"x_m": -0.4}))
    assert result.document["best"]["robot"] == "a" and "arms_map" not in result.tables
    table = result.tables["arms"]
    assert table["served"].tolist() == [6, 6] and table["translation_m"][0] == table["translation_m"][1] > 0
    assert result.skeleton.shape[0] == 2 and np.array_equal(*result.skeleton)
    shown = execute(job(robots=[ARMS[0] | {"name": "a"}, ARMS[0] | {"name": "b"}], over={"x_m": [-2, 2, 0.5]}))
    about = shown.document["arms"]
    assert about["alone"] == {"a": 0, "b": 0} and about["equal"] > 0 < about["none"]


def test_arms_that_serve_nothing_win_nowhere():
    result = execute(job(points_m=[[9, 9, 9]], quats_wxyz=None, over={"x_m": [-1, 1, 0.5]}))
    assert result.document["best"] is None and result.document["arms"]["none"] == 4 and result.skeleton is None
    assert np.isnan(result.tables["arms"]["x_m"]).all() and result.tables["arms"]["served"].tolist() == [0, 0]


def test_the_pairs_of_all_arms_are_shards():
    whole = plan(job())
    divided = whole.settled_as(whole.division(whole.samples * whole.effort / 9, 9))
    assert isinstance(divided, SeveralPlacements) and len(divided.shards) > 4
    parts = [run_shard(divided, shard) for shard in range(len(divided.shards))]
    found, expected = reduce(divided.merge, reversed(parts)), run_shard(whole, 0)
    assert all(np.array_equal(found.parts[k]["served"], expected.parts[k]["served"]) for k in (0, 1))


def test_from_python_arms_are_named_and_loaded():
    asked = {"points_m": RING[:2], "over": {"x_m": [-0.8, 0, 0.4]}, "device": "cpu", "refine": False}
    result = ws.base_placement(robots=["ur5e", ws.load_robot("puma560")], names=["a", None], **asked)
    assert [each["name"] for each in result.document["robots"]] == ["a", "puma560"]
    assert "robot" not in result.document["job"] and len(result.document["job"]["robots"]) == 2
    with pytest.raises(ws.DocumentError, match='robot: must be given, or else "robots": one of the two'):
        ws.base_placement(**asked)


REFUSED = {
    "robot": ({"robot": "ur5e"}, 'must be given, or else "robots": one of the two'),
    "tip": ({"tip": "tool"}, 'must not be given beside "robots", of which each has its own'),
    "robots": ({"robots": ARMS[:1]}, "must have at least 2"),
    "robots.1.robot.library": ({"robots": [*ARMS[:1], {"robot": "no_such"}]}, "no_such"),
    "robots.0.sampling": ({"robots": [ARMS[0] | {"sampling": None}, ARMS[1]]}, "sampling"),
}


@pytest.mark.parametrize("field", REFUSED)
def test_what_cannot_be_asked_is_refused(field):
    fields, message = REFUSED[field]
    with pytest.raises(ws.InputError) as refusal:
        plan(job(**fields))
    assert refusal.value.field == field and message in str(refusal.value)
    with pytest.raises(ws.DocumentError, match="robots: must not give two robots the same name: a, a"):
        parse_job(job(robots=[ARMS[0] | {"name": "a"}] * 2))


def test_errors_say_which_arm_they_are_of():
    with pytest.raises(ws.InputError, match=r"index_options\.tip_compliance.* \(of robots\.1\)"):
        plan(job(robots=[ARMS[0], {"robot": "scara"}], index="tip_compliance", index_options=STIFF))
    moving = {"robot": {"library": "ur5e", "velocity_limits": {f"joint{k}": 3 for k in range(1, 7)}}}
    still = {"robot": {"library": "puma560", "velocity_limits": {}}}
    with pytest.raises(ws.InputError, match=r"puma560 lacks .*velocity_limits.* \(of robots\.1\)"):
        plan(job(robots=[moving, still], index="velocity_radius"))


def test_jobs_of_one_robot_are_written_as_before():
    assert '"robots"' not in canonical_json(parse_job(job(robots=None, robot="ur5e")))
