"""The Pareto set of a ``base_placement`` job, weight served against an index, by closed forms and by all pairs."""

from functools import reduce

import numpy as np
import pytest

import wsrender as ws
from tests.analyses.base_placement.test_base_placement import (
    DOWN,
    bases_of,
    best_values,
    job,
    manipulability_of,
    margin_of,
)
from wsrender.analyses.base_placement.result import PlacementMap, pareto_set
from wsrender.analyses.jobs import canonical_json, parse_job
from wsrender.run import execute, finish, plan, run_shard

WIDE = [[0.1 + 0.45 * np.cos(k), 0.45 * np.sin(k), 0.3] for k in range(6)]
NEAR = [[0.1, 0.05, 0.3], [0.35, 0.15, 0.3], [0.3, -0.1, 0.4]]
OVER = {"x_m": [-1.25, 1.25, 0.25], "y_m": [-1.2, 1.2, 0.3], "yaw_deg": [0, 360, 120]}
WEIGHTS = [1, 2, 1, 3, 1, 0.5]
STIFF = {"tip_compliance": {"joint_stiffness": [1e4] * 6}}


def asked(**fields):
    return job("ur5e", WIDE, [DOWN] * 6, **{"over": OVER, "pareto": True} | fields)


def beaten_by_none(*objectives, places=9):
    """Numbers of those that none is as good as in both objectives (N,) and better in one, of all pairs."""
    first, second = (np.round(np.nan_to_num(each, nan=-np.inf), places) for each in objectives)
    no_worse = (first[:, None] >= first) & (second[:, None] >= second)
    better = (first[:, None] > first) | (second[:, None] > second)
    return np.flatnonzero(~(no_worse & better).any(axis=0)).tolist()


@pytest.mark.parametrize("weights", [None, WEIGHTS])
@pytest.mark.parametrize(("index", "value"), [("joint_limit_margin", margin_of), ("manipulability", manipulability_of)])
def test_the_set_is_that_of_closed_forms(index, value, weights):
    document, robot = asked(index=index, weights=weights), ws.load_robot("ur5e")
    result = execute(document)
    values = best_values("ur5e", bases_of(document), WIDE, [DOWN] * 6, value(robot), robot)
    served = ~np.isnan(values)
    least = np.where(served.any(axis=1), np.nan_to_num(values, nan=np.inf).min(axis=1), np.nan)
    weight = served @ np.array(weights or [1] * 6)
    table, placements = result.tables["pareto"], result.tables["placements"]
    expected = beaten_by_none(weight, least, places=7)
    assert sorted(table["placement"]) == expected and 3 < len(expected) < 0.2 * len(weight)
    names = ["x_m", "y_m", "yaw_deg", "served", *(["weight"] if weights else []), index]
    assert list(table.columns) == ["placement", *names]
    assert all(np.array_equal(table[name], placements[name][table["placement"]]) for name in names)
    assert table.units["x_m"] == "m" and table.units[index] == placements.units[index]
    of = weight[table["placement"]]
    assert sorted(zip(-of, table["placement"], strict=True)) == [*zip(-of, table["placement"], strict=True)]
    objectives = ["weight" if weights else "served", index]
    counts = {"placements": len(expected), "values": len(set(of.tolist()))}
    assert result.document["pareto"] == {"objectives": objectives} | counts and counts["values"] > 2
    assert result.document["best"]["cell"]["placement"] in table["placement"][of == weight.max()]


def test_two_indices_are_the_objectives_of_what_serves_the_most():
    names, robot = ["manipulability", "joint_limit_margin"], ws.load_robot("ur5e")
    document = asked(index=names, weights=[1, 2, 3]) | {"points_m": NEAR, "quats_wxyz": [DOWN] * 3}
    document["over"] = {"x_m": [-1, 1, 0.1], "y_m": [-0.95, 1, 0.13]}
    result = execute(document)
    table, placements = result.tables["pareto"], result.tables["placements"]
    least, served = [], np.zeros((0, 3))
    for name, value in zip(names, (manipulability_of, margin_of), strict=True):
        values = best_values("ur5e", bases_of(document), NEAR, [DOWN] * 3, value(robot), robot)
        served = ~np.isnan(values)
        least.append(np.where(served.any(axis=1), np.nan_to_num(values, nan=np.inf).min(axis=1), np.nan))
        np.testing.assert_allclose(placements[name], least[-1], atol=1e-9)
    most = np.flatnonzero((weight := served @ np.array([1, 2, 3])) == weight.max())
    expected = most[beaten_by_none(*(each[most] for each in least), places=7)]
    assert sorted(table["placement"]) == expected.tolist() and len(expected) > 1 and len(most) > 20
    assert list(table.columns) == ["placement", "x_m", "y_m", "served", "weight", *names]
    assert (np.diff(table[names[0]]) < 1e-9).all() and table.units[names[0]] == "m^3"
    assert result.document["pareto"]["objectives"] == names
    best, targets = result.document["best"], result.tables["targets"]
    at = least[0][most].argmax()
    assert best["cell"][names[0]] == pytest.approx(least[0][most][at])
    assert [best[name] for name in names] == pytest.approx([np.nanmin(targets[name]) for name in names])
    (axes,) = result.plot.pareto().axes
    lines = {each.get_label(): each.get_xydata() for each in axes.lines}
    assert np.array_equal(lines["Pareto set"], np.stack([table[name] for name in names], axis=1))
    assert len(lines["all placements"]) <= len(most) and "m³" in axes.get_xlabel()


def test_two_indices_of_several_robots_and_shards_and_one_of_them_alone():
    names = ["tip_compliance", "manipulability"]
    raised = {"library": "ur5e", "placement": {"position_m": [0, 0, 0.95]}}  # serves fewer
    document = asked(index=names, index_options=STIFF)
    alone = [execute(document | {"robot": each, "index": name, "index_options": STIFF if name in STIFF else {}})
             for each in ("ur5e", raised) for name in names]  # fmt: skip
    del document["robot"]
    document |= {"robots": [{"robot": "ur5e"}, {"robot": raised, "name": "raised"}]}
    whole = plan(document)
    divided = whole.settled_as(whole.division(whole.samples / 7, 7))
    result = finish(divided, reduce(divided.merge, [run_shard(divided, k) for k in range(len(divided.shards))]))
    for k, robot in enumerate(("ur5e", "raised")):
        for name, single in zip(names, alone[2 * k : 2 * k + 2], strict=True):
            found = result.tables[f"placements_{robot}"][name]
            np.testing.assert_allclose(found, single.tables["placements"][name], rtol=1e-9)
    tables = [result.tables[f"placements_{robot}"] for robot in ("ur5e", "raised")]
    served, *values = (np.concatenate([each[column] for each in tables]) for column in ("served", *names))
    most = np.flatnonzero(served == served.max())
    assert 0 < tables[1]["served"].max() < served.max()
    table = result.tables["pareto"]
    found = table["placement"] + (table["robot"] == "raised") * len(tables[0])
    assert sorted(found) == most[beaten_by_none(-values[0][most], values[1][most])].tolist()
    assert result.tables["arms"].units["tip_compliance"] == "m/N"
    assert whole.cost.memory_bytes > plan(document | {"index": names[1], "index_options": {}}).cost.memory_bytes


BAD = [
    ({"index": ["manipulability", "manipulability"]}, "index: must be two different names"),
    ({"index": ["manipulability", "joint_limit_margin"], "pareto": False}, 'index: must be one name without "pareto"'),
    ({"index": ["manipulability"]}, "index: must be the name of an index, or a list of two"),
    ({"index": {"manipulability": 1}}, "index: must be the name of an index, or a list of two"),
]


@pytest.mark.parametrize(("fields", "message"), BAD)
def test_two_indices_are_refused_by_name(fields, message):
    with pytest.raises(ws.DocumentError, match=message):
        parse_job(asked(**fields))


def test_smaller_compliance_is_better():
    result = execute(asked(index="tip_compliance", index_options=STIFF, weights=WEIGHTS))
    placements, found = result.tables["placements"], result.tables["pareto"]["placement"]
    expected = beaten_by_none(placements["weight"], -placements["tip_compliance"], places=12)
    assert sorted(found) == expected and len(expected) > 3


def test_yaws_that_are_alike_are_all_in_it():
    result, apart = (execute(asked(index="manipulability", use_symmetry=use)) for use in (True, False))
    assert [each.document["placements"]["alike"] for each in (result, apart)] == [3, 1]
    found = result.tables["pareto"]["placement"]
    assert np.array_equal(found, apart.tables["pareto"]["placement"])
    assert {n // 3 * 3 + k for n in found for k in range(3)} == {*found}


def test_any_two_objectives():
    random = np.random.default_rng(2)
    for _ in range(200):
        weight, scores = random.integers(0, 5, (2, 12)).astype(float)
        scores[random.random(12) < 0.2] = np.nan
        numbers = pareto_set(weight, scores)
        assert sorted(numbers) == beaten_by_none(weight, scores)
        assert sorted(numbers, key=lambda n: (-weight[n], n)) == numbers.tolist()


def test_what_only_rounding_tells_apart_is_equal():
    """0.1 + 0.2 is more than 0.3 in floating point."""
    served = [[1, 1, 0], [0, 0, 1], [1, 0, 0]]
    bits = {"served": np.packbits(served, axis=1, bitorder="little"), "undecided": np.zeros((3, 1), np.uint8)}
    over = {"x_m": [0, 3, 1]}
    parsed = parse_job(job("ur5e", WIDE[:3], over=over, weights=[0.1, 0.2, 0.3], index="manipulability", pareto=True))
    for scores, expected in (([1, 1, 1], [0, 1]), ([1, 1 - 1e-13, 1 + 1e-13], [0, 1]), ([1, 2, 3], [1, 2])):
        found = PlacementMap(parsed, np.array(parsed.weights), bits, plan(parsed).score, np.array(scores, float))
        assert found.pareto["placement"].tolist() == expected


def test_shards_give_the_same_bits():
    document = asked(index="manipulability", weights=WEIGHTS)
    whole = plan(document)
    divided = whole.settled_as(whole.division(whole.samples / 7, 7))
    assert len(divided.shards) > 3
    merged = reduce(divided.merge, [run_shard(divided, k) for k in reversed(range(len(divided.shards)))])
    found, expected = finish(divided, merged), finish(whole, run_shard(whole, 0))
    assert found.document["pareto"] == expected.document["pareto"]
    for name, column in expected.tables["pareto"].columns.items():
        assert column.tobytes() == found.tables["pareto"][name].tobytes()


@pytest.mark.parametrize(("name", "sign"), [("manipulability", 1), ("tip_compliance", -1)])
def test_of_several_robots_none_of_the_others_beats_one(name, sign):
    raised = {"library": "ur5e", "placement": {"position_m": [0, 0, 0.35]}}
    options = STIFF if name in STIFF else {}
    document = asked(index=name, index_options=options)
    del document["robot"]
    result = execute(document | {"robots": [{"robot": "ur5e"}, {"robot": raised, "name": "raised"}]})
    tables = [result.tables[f"placements_{robot}"] for robot in ("ur5e", "raised")]
    served, index = (np.concatenate([each[column] for each in tables]) for column in ("served", name))
    table = result.tables["pareto"]
    found = table["placement"] + (table["robot"] == "raised") * len(tables[0])
    assert sorted(found) == beaten_by_none(served, sign * index) and next(iter(table.columns)) == "robot"
    assert np.array_equal(table["served"], served[found]) and np.array_equal(table[name], index[found])
    assert result.document["pareto"]["placements"] == len(table)
    assert set(table["robot"]) == ({"ur5e", "raised"} if sign > 0 else {"ur5e"})
    (axes,) = result.plot.pareto().axes
    labels = axes.get_legend_handles_labels()[1]
    assert labels == ["ur5e, all placements", "raised, all placements", "Pareto set", "best placement"]


def test_the_picture_shows_the_set_among_all_placements():
    result = execute(asked(index="tip_compliance", index_options=STIFF, weights=WEIGHTS))
    (axes,) = result.plot.pareto().axes
    lines, table = {each.get_label(): each.get_xydata() for each in axes.lines}, result.tables["pareto"]
    assert np.array_equal(lines["Pareto set"], np.stack([table["weight"], table["tip_compliance"]], axis=1))
    best = result.document["best"]
    assert lines["best placement"].tolist() == [[best["weight"], best["tip_compliance"]]]
    placements, drawn = result.tables["placements"], lines["all placements"]
    points = np.stack([placements["weight"], placements["tip_compliance"]], axis=1)[placements["served"] > 0]
    assert {*map(tuple, drawn)} <= {*map(tuple, points)} and len(drawn) < len(points)
    off = np.abs(points[:, None] - drawn) / np.ptp(points, axis=0)
    assert off.max(axis=2).min(axis=1).max() <= 1 / 200 * (1 + 1e-9)
    assert "pareto" in [picture.name for picture in result.plot.pictures]
    assert "beaten by none" in result.summary()


def test_where_no_target_is_served_there_is_no_set():
    result = execute(job("ur5e", [[9, 9, 9]], [DOWN], over={"x_m": [0, 1, 0.5]}, index="manipulability", pareto=True))
    assert "pareto" not in result.document and "pareto" not in result.tables


def test_it_needs_an_index_and_earlier_documents_do_not_say_it():
    with pytest.raises(ws.DocumentError, match='pareto: must not be true without "index"'):
        parse_job(asked())
    with pytest.raises(ws.DocumentError, match="pareto: "):
        parse_job(asked(index="manipulability", pareto="weight"))
    assert '"pareto"' not in canonical_json(parse_job(asked(pareto=False)))
    assert '"pareto":true' in canonical_json(parse_job(asked(index="manipulability"))).replace(" ", "")
    assert "pareto" not in execute(asked(index="manipulability", pareto=False)).tables
