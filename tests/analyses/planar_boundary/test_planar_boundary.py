"""The analysis ``planar_boundary``: a job document in, tables, drawings and a picture out."""

import numpy as np
import pytest

import wsrender as ws
from tests.run.journeys import from_a_partial_file, from_the_command_line, hashes_of_two_saves
from wsrender.run import execute, plan

ROWS = [{"a": a, "limits_deg": [-60, 60]} for a in (4, 2, 1)]
JOB = {
    "analysis": "planar_boundary",
    "robot": {"dh": {"convention": "standard", "name": "three", "rows": ROWS}},
    "sampling": {"method": "random", "count": 20_000},
    "points_m": [[0, 0], [6, 0]],
    "device": "cpu",
}


@pytest.fixture(scope="module")
def result():
    return execute(JOB)


def test_exact_values(result):
    exact = result.document["exact"]
    assert exact["area_m2"] == pytest.approx(31.497510350119, rel=1e-9)
    assert [loop["hole"] for loop in exact["loops"]] == [False]
    assert [segment["kind"] for segment in exact["loops"][0]["segments"]] == ["arc"] * 6
    assert len(exact["vertices_m"]) == 6
    assert result.document["plane"]["normal"] == [0, 0, 1]


def test_table_is_the_document(result):
    table, segments = result.tables["boundary"], result.document["exact"]["loops"][0]["segments"]
    assert table["R"].tolist() == [segment["radius_m"] for segment in segments]
    assert np.column_stack([table["x_s"], table["y_s"]]).tolist() == [segment["start_m"] for segment in segments]
    assert table["limits"].tolist()[1] == "joint1 lower, joint2 lower"
    assert (table.units["x_o"], table.units["sweep"]) == ("m", "rad")


def test_monte_carlo_lies_inside(result):
    estimated = result.document["monte_carlo"]
    assert 0.2 < estimated["mean_distance_to_exact_cells"] < 2  # three joints seldom reach the boundary
    assert 20 < estimated["area_m2"] < 31.5
    assert len(result.tables["monte_carlo"]) > 2


def test_a_monte_carlo_boundary_that_has_not_converged_says_so_and_is_drawn_so(result):
    """20,000 samples of three joints: in the document, its warnings, the summary, the table and the picture."""
    estimated = result.document["monte_carlo"]
    assert not estimated["converged"] and "% off" in estimated["not_converged_because"][0]
    (warning,) = result.document["warnings"]
    assert (warning["code"], warning["field"]) == ("monte_carlo_not_converged", "sampling")
    assert estimated["not_converged_because"][-1] in warning["message"] and '"boundary"' in warning["remedy"]
    assert "m², not converged)" in result.summary()
    assert not result.tables["monte_carlo"]["converged"].any()
    lines, labels = drawn_lines(result)
    assert labels == ["samples", "Monte Carlo,\nnot converged", "exact", "inside", "outside"]
    assert lines[0].get_alpha() < 0.5 and lines[0].get_linestyle()[0][1] is not None
    converged = execute({name: value for name, value in JOB.items() if name != "sampling"})  # as by default
    assert converged.document["monte_carlo"]["converged"] and converged.document["warnings"] == []
    lines, labels = drawn_lines(converged)
    assert labels[1] == "Monte Carlo" and lines[0].get_alpha() is None and lines[0].get_linestyle()[0][1] is None


def drawn_lines(result):
    axes = result.plot.boundary().axes[0]
    return axes.collections, [text.get_text() for text in axes.get_legend().get_texts()]


def test_the_headline_is_the_exact_area(result):
    area = result.document["exact"]["area_m2"]
    expected = {"quantity": "area", "value": area, "ci95": [area, area], "unit": "m2", "reason": ""}
    assert result.document["headline"] == expected


def test_points_are_answered(result):
    table = result.tables["points"]
    assert table["inside"].tolist() == [False, True]
    assert table["distance"] == pytest.approx([27**0.5, 6 - 27**0.5])
    assert table["nearest"][1] == pytest.approx([27**0.5, 0])


def test_python_and_document_agree(result):
    rows = [ws.DHRow(**row) for row in ROWS]
    robot = ws.DHTable(convention="standard", rows=rows, name="three")
    again = ws.planar_boundary(robot, ws.Random(20_000), points_m=[[0, 0], [6, 0]], device="cpu")
    for name in ("exact", "monte_carlo"):
        assert again.document[name] == result.document[name]


def test_from_the_command_line_and_back(tmp_path, capsys):
    loaded = from_the_command_line(JOB, tmp_path)
    assert "31.4975104 m²" in capsys.readouterr().out
    assert len(loaded.tables["boundary"]) == 6
    assert (tmp_path / "out/plots/boundary.png").stat().st_size > 10_000
    assert (tmp_path / "out/boundary.dxf").is_file() and (tmp_path / "out/boundary.svg").is_file()


def test_equal_jobs_have_equal_files(result, tmp_path):
    first, second = hashes_of_two_saves(result, tmp_path)
    assert first == second and "boundary.dxf" in first


def test_a_partial_result_travels(result, tmp_path):
    found = from_a_partial_file(JOB, tmp_path)
    assert found.document["exact"] == result.document["exact"]
    assert (found.tables["samples"]["position"] == result.tables["samples"]["position"]).all()


def test_two_joints_have_regions_by_number_of_solutions(result):
    rows = [{"a": a, "limits_deg": [-180, 180]} for a in (8, 5)]
    few = {"robot": {"dh": {"convention": "standard", "rows": rows}}, "sampling": {"method": "random", "count": 500}}
    regions = execute(JOB | few).document["exact"]["inverse_solutions"]
    assert regions == [{"solutions": 2, "area_m2": pytest.approx(160 * np.pi, rel=1e-9), "regions": 1}]
    assert result.document["exact"]["inverse_solutions"] is None


def test_three_joints_have_regions_by_number_of_self_motions(result):
    regions = result.document["exact"]["self_motions"]
    assert [region["components"] for region in regions] == [1, 2, 3, 4, 5]
    assert sum(region["area_m2"] for region in regions) == pytest.approx(31.497510350119, rel=1e-9)
    assert result.tables["points"]["self_motions"].tolist() == [0, 2]


@pytest.mark.parametrize("rows", [ROWS[:1], [{"a": 0.0, "limits_deg": [-60, 60]}]], ids=["curve", "point"])
def test_sets_without_area_are_results(rows, tmp_path):
    robot = {"dh": {"convention": "standard", "rows": rows}}
    found = execute(JOB | {"robot": robot, "sampling": {"method": "random", "count": 500}})
    assert found.document["exact"]["area_m2"] == 0 and found.document["warnings"] == []
    length = 8 * np.pi / 3 if rows[0]["a"] else 0.0  # of 4 m over 120°
    headline = found.document["headline"]
    assert headline["value"] == (pytest.approx(length) if length else None) and bool(headline["reason"]) != bool(length)
    assert headline["quantity"] == ("length" if length else "area")
    found.save(tmp_path / "out")
    assert (tmp_path / "out/plots/boundary.png").is_file()


def test_arms_in_space_are_refused_before_anything_runs():
    with pytest.raises(ws.ModelError, match="joint 'joint2' turns about"):
        plan(JOB | {"robot": "puma560"})
    with pytest.raises(ws.DocumentError, match="sampling"):
        plan(JOB | {"sampling": {"method": "converge"}})
