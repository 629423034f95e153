"""Acceptance criteria of a ``base_placement`` job: pass, fail or undecided from the best placement."""

import json

import numpy as np
import pytest

import wsrender as ws
from tests.analyses.base_placement.test_base_placement import DOWN, RING, job, seen_from, solutions_of
from tests.reference import closed_form_inverse as closed_form
from wsrender.cli import main
from wsrender.cli.faults import NOT_PASSED
from wsrender.run import execute, plan

FAR = [9.0, 0.0, 0.0]
OVER = {"x_m": [-0.6, 0.6, 0.3], "y_m": [-0.3, 0.3, 0.3]}


@pytest.mark.parametrize(("share", "said"), [(6 / 7, "pass"), (0.9, "fail")])
def test_the_best_placement_is_judged(share, said, tmp_path, capsys):
    document = job("ur5e", [*RING, FAR], [DOWN] * 7, over=OVER, criteria=[{"least_share": share}])
    (tmp_path / "job.json").write_text(json.dumps(document))
    with pytest.raises(SystemExit) as ended:
        main(["run", str(tmp_path / "job.json"), "-o", str(tmp_path / "out")])
    assert ended.value.code == {"pass": 0, "fail": NOT_PASSED}[said]
    assert f"criterion 1: {said}: 85.71 %" in capsys.readouterr().out
    result = ws.Result.load(tmp_path / "out")
    assert result.document["verdict"] == said and result.document["criteria"][0]["reached"] == 6


@pytest.mark.parametrize("guarded", [False, True])
def test_margins_are_kept_within_the_limits(guarded):
    """As closed forms say of every target from the best placement: with room, and without."""
    robot = ws.load_robot("puma560")
    fields = {"constraints": {"region": {"box": {"lower_m": [-5, -5, -5]}}}} if guarded else {}
    asked = [{"least_share": 1.0, "joint_margin_deg": room} for room in (0.0, 20.0, 60.0)]
    result = execute(job("puma560", RING, [DOWN] * 6, over=OVER, weights=[1, 2, 3, 1, 1, 1], criteria=asked, **fields))
    base, weight = np.array(result.document["best"]["T_world_base"]), np.array([1, 2, 3, 1, 1, 1])
    solutions = solutions_of("puma560", *(part[0] for part in seen_from(base[None], RING, [DOWN] * 6)))
    shares = []
    for k, each in enumerate(asked):
        room = np.deg2rad(each["joint_margin_deg"])
        low, high = robot.lower_limits + room, robot.upper_limits - room
        inside = closed_form.within_limits(solutions, low, high, robot.chain.revolute).any(axis=1)
        entry = result.document["criteria"][k]
        shares.append(weight[inside].sum() / weight.sum())
        assert entry["share"] == pytest.approx(shares[-1], abs=1e-12)
        assert entry["verdict"] == ("pass" if inside.all() else "fail")
        if k:
            assert ((result.tables["targets"][f"criterion_{k + 1}"] == "reachable") == inside).all()
    assert shares[0] > shares[2] and result.document["verdict"] == "fail"


def test_margins_are_estimated_to_take_a_placement_each():
    document = job("ur5e", RING, over={"x_m": -0.4}, refine=False)
    room, none = {"least_share": 1.0, "joint_margin_deg": 10}, {"least_share": 1.0}
    alone, again, twice = (
        plan(document | {"criteria": each}).cost.seconds for each in ([none], [room, none], [room, room])
    )
    more = plan(document | {"over": {"x_m": [-0.4, 0, 0.2]}}).cost  # two placements, of larger tables
    assert again > alone and twice - again == pytest.approx(again - alone, rel=1e-6)
    assert again - alone == pytest.approx(more.seconds - alone, rel=0.05)


def test_where_nothing_is_served_nothing_passes():
    result = execute(job("ur5e", [FAR], over=OVER, criteria=[{"least_share": 0.01}]))
    assert result.document["best"] is None and result.document["verdict"] == "fail"


def test_where_nothing_is_decided_nothing_fails():
    """A target of one pose that the search leaves open from some placement."""
    planned = plan(job("ur5e", RING[:2], over=OVER, criteria=[{"least_share": 0.5}]))
    bits = {name: np.zeros((8, 1), np.uint8) for name in ("served", "undecided", "proven")}
    bits["undecided"][5] = 2
    from wsrender.analyses.partial_result import rows_of_shard
    from wsrender.run.steps import finish

    document = finish(planned, rows_of_shard(0, bits)).document
    assert document["verdict"] == "undecided" and document["criteria"][0]["undecided_share"] == 0.5


def test_one_arm_that_passes_is_enough():
    arms = [{"robot": "scara"}, {"robot": "ur5e"}]
    fields = {"robots": arms, "over": OVER, "criteria": [{"least_share": 1.0}]}
    document = {key: each for key, each in job("ur5e", RING, [DOWN] * 6).items() if key != "robot"} | fields
    found = execute(document).document
    assert [each["verdict"] for each in found["robots"]] == ["fail", "pass"] and found["verdict"] == "pass"
    assert execute(document | {"robots": [arms[0], arms[0]]}).document["verdict"] == "fail"


def test_a_margin_that_no_joint_has_is_refused():
    asked = {"criteria": [{"least_share": 1.0, "joint_margin_deg": 200.0}]}
    with pytest.raises(ws.InputError, match=r"criteria\.0\.joint_margin_deg: must be at most"):
        plan(job("puma560", RING, [DOWN] * 6, over=OVER, **asked))
