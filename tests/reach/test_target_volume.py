"""Volumes to cover as targets: their points, what is refused, and shares against geometry."""

import numpy as np
import pytest

import wsrender as ws
from wsrender.analyses.jobs import parse_job
from wsrender.reach.target_list import target_list
from wsrender.run import execute

BOX = {"box": {"lower_m": [-0.5, 0.0, -0.1], "upper_m": [0.5, 0.35, 0.1]}, "step_m": 0.1}
BALL = {"sphere": {"position_m": [0.2, 0.1, 0.0], "radius_m": 0.5}, "step_m": 0.02}
TWO_LINKS = {"dh": {"convention": "standard", "rows": [{"a": 0.4, "limits_deg": [-180, 180]},
                                                      {"a": 0.3, "limits_deg": [-180, 180]}]}}  # fmt: skip


def job(targets, analysis="reachability", robot="spherical", **fields):
    return {"analysis": analysis, "robot": robot, "targets": targets, "device": "cpu"} | fields


def test_cells_fill_the_box():
    """Every point of it is within half a cell of a centre; none is outside."""
    found = target_list(parse_job(job(BOX)).targets).position
    assert found.shape == (10 * 4 * 2, 3) and len(np.unique(found, axis=0)) == len(found)
    random = np.random.default_rng(0).uniform(BOX["box"]["lower_m"], BOX["box"]["upper_m"], (2000, 3))
    apart = np.abs(random[:, None] - found).max(axis=2).min(axis=1)
    assert apart.max() <= 0.05 + 1e-12
    assert (found > BOX["box"]["lower_m"]).all() and (found < BOX["box"]["upper_m"]).all()


def test_points_fill_the_ball():
    volume = parse_job(job(BALL)).targets
    points = volume.points
    assert np.linalg.norm(points - [0.2, 0.1, 0], axis=1).max() <= 0.5
    assert len(points) * volume.cell_m3 == pytest.approx(4 / 3 * np.pi * 0.5**3, rel=1e-2)


@pytest.mark.parametrize("analysis", ["reachability", "base_placement"])
def test_the_share_covered_is_that_of_the_area_within_reach(analysis):
    """A plane of two links: between .1 and .7 of the base."""
    plane = {"box": {"lower_m": [0, -0.5, -1e-6], "upper_m": [1, 0.5, 1e-6]}, "step_m": 0.02}
    placed = {} if analysis == "reachability" else {"over": {"x_m": 0.1}, "refine": False}
    asked = {"criteria": [{"least_share": 0.6}]}
    result = execute(job(plane, analysis, TWO_LINKS, **placed, **asked))
    points = parse_job(job(plane)).targets.points
    far = np.linalg.norm(points - [0.1 * bool(placed), 0, 0], axis=1)
    entry = (result.document["best"] if placed else result.document)["covered"]
    assert entry["points"] == 2500 and entry["volume_m3"] == pytest.approx(2e-6) and entry["step_m"] == 0.02
    assert entry["share"] == pytest.approx(((far > 0.1) & (far < 0.7)).mean(), abs=1e-12)
    assert "between them nothing is proven" in entry["evidence"] and entry["undecided_share"] == 0
    assert result.document["verdict"] == ("pass" if entry["share"] >= 0.6 else "fail")
    assert f"{np.floor(entry['share'] * 1e4) / 100:g} % of 2e-06 m³, sampled" in result.summary()


def test_the_tip_stands_as_asked():
    volume = BOX | {"quat_wxyz": [0, 1, 0, 0], "free_axis": "x", "step_m": 0.5}
    found = target_list(parse_job(job(volume)).targets)
    assert (found.quat_wxyz == [0, 1, 0, 0]).all() and (found.free_axis == "x").all() and (found.weight == 1).all()
    result = ws.reachability("ur5e", targets=ws.TargetVolume(**volume), device="cpu")
    assert result.document["job"]["targets"]["free_axis"] == "x" and "quat_wxyz" in result.tables["targets"].columns


REFUSED = {
    "box": ({"step_m": 0.1}, 'must be given, or else "sphere": one of the two'),
    "box of no end": ({"box": {"lower_m": [0, 0, None], "upper_m": [1, 1, 1]}, "step_m": 0.1}, "must have all sides"),
    "step_m": (BOX | {"step_m": 1e-4}, "must be larger: there would be 70,000,000,000 cells, allowed are 1,000,000"),
    "quat_wxyz": (BOX | {"quat_wxyz": [0, 2, 0, 0]}, "must have unit length, not 2"),
    "free_axis": (BOX | {"free_axis": "z"}, "must not be given without an orientation"),
}


@pytest.mark.parametrize("field", REFUSED)
def test_what_cannot_be_asked_is_refused(field):
    volume, message = REFUSED[field]
    with pytest.raises(ws.DocumentError) as refusal:
        parse_job(job(volume))
    ((where, said),) = refusal.value.problems
    assert where == f"targets.{field.partition(' ')[0]}" and message in said


@pytest.mark.parametrize(
    ("key", "of"), [("foo", "none of them"), ("position_m", "a target, which must stand in a list")]
)
def test_a_mapping_that_is_neither_table_nor_volume_is_refused_by_its_key(key, of):
    with pytest.raises(ws.DocumentError, match=f'targets: must be a list .*"{key}" is a field of {of}'):
        parse_job({"analysis": "base_placement", "robot": "ur5e", "targets": {key: [0, 0, 0]}, "over": {"x_m": 0}})
