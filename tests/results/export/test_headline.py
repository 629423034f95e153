"""What is read first of a result: its headline and its warnings, in words."""

import json
import re
from collections import defaultdict
from pathlib import Path

import pytest

import wsrender as ws
from wsrender.analyses.registry import job_classes
from wsrender.notices import Notice
from wsrender.results.export.headline import headline_lines, headline_text, warning_lines
from wsrender.results.report.page import report_page
from wsrender.volume.measure import NOT_ASKED

DOCUMENTS = Path(__file__).parents[2] / "golden" / "documents"
VOLUME = {"quantity": "volume", "value": 3.8012, "ci95": [3.7812, 3.8263], "unit": "m3", "reason": ""}
NONE = {"quantity": "volume", "value": None, "ci95": None, "unit": "m3", "reason": "the tip stays on a surface"}
FEW = Notice("few_samples", "too few samples", "take more", "voxel_size_m")
ODD = Notice("inertia_dropped", "the model has no inertias")


@pytest.mark.parametrize(
    ("fields", "text"),
    [
        ({}, "reachable volume 3.80 m³ (95 %: 3.78 … 3.83)"),
        ({"value": 0.0313, "ci95": [0.0311, 0.0315]}, "reachable volume 0.0313 m³ (95 %: 0.0311 … 0.0315)"),
        ({"value": 1.0, "ci95": [0.8, 1.2]}, "reachable volume 1.00 m³ (95 %: 0.80 … 1.20)"),
        ({"value": 1.23e-5, "ci95": [1.21e-5, 1.25e-5]}, "reachable volume 1.23e-05 m³ (95 %: 1.21e-05 … 1.25e-05)"),
        ({"value": 41234.0, "ci95": [41000.0, 41500.0]}, "reachable volume 41234 m³ (95 %: 41000 … 41500)"),
        ({"value": 0.0, "ci95": [0.0, 0.1]}, "reachable volume 0.00 m³ (95 %: 0.00 … 0.10)"),
        ({"value": 1 / 3, "ci95": [1 / 3, 1 / 3]}, "reachable volume 0.333333 m³ (exact)"),
        ({"quantity": "area", "unit": "m2"}, "reachable area 3.80 m² (95 %: 3.78 … 3.83)"),
        ({"quantity": "length", "unit": "m", "ci95": None}, "reachable length 3.8012 m"),
        (NONE, "no volume: the tip stays on a surface"),
        (NONE | {"reason": NOT_ASKED}, "no refined reachable volume: none was asked for by refined_volume"),
    ],
)
def test_headlines_in_words(fields, text):
    assert headline_text(VOLUME | fields) == text


def test_a_summary_starts_with_headline_and_warnings():
    document = {"robot": {"name": "arm"}, "headline": VOLUME, "warnings": [FEW.entry(), ODD.entry()]}
    assert ws.Result(document).summary().splitlines()[:4] == [
        "arm",
        "  reachable volume 3.80 m³ (95 %: 3.78 … 3.83)",
        "  warning: too few samples; take more (field voxel_size_m)",
        "  warning: the model has no inertias",
    ]


def test_facts_stand_for_the_headline_where_no_workspace_is_measured():
    counts = {"reachable": 2, "unreachable": 1, "undecided": 0}
    document = {"analysis": "reachability", "robot": {"name": "arm"}, "headline": NONE, "targets": counts}
    said = ["reachable targets: 2", "unreachable targets: 1", "undecided targets: 0"]
    assert headline_lines(document) == said
    assert ws.Result(document).summary().splitlines() == ["arm", *(f"  {line}" for line in said)]


@pytest.mark.parametrize("analysis", job_classes())
def test_every_result_that_measures_no_workspace_says_something_of_itself(analysis):
    """Golden documents of every analysis: none says of itself that it measures nothing."""
    for path in DOCUMENTS.glob(f"{analysis}*.json"):
        lines = headline_lines(json.loads(path.read_text())["document"])
        assert lines and not any("measures none" in line for line in lines)


@pytest.mark.parametrize("path", sorted(DOCUMENTS.glob("*.json")), ids=lambda path: path.stem)
def test_units_are_written_in_one_way(path):
    """As people write them, m³ and not m^3 or m3: in the summary, and in the report but for the job."""
    document = json.loads(path.read_text())["document"] | {"timing_s": defaultdict(float)}  # goldens have no times
    html = report_page("arm", {key: value for key, value in document.items() if key != "job"}, [], {})
    shown = re.sub(r"<[^>]*>", "\n", html.partition("<body>")[2])
    for text in (ws.Result(document).summary(), shown):
        assert not re.search(r"\bm\^\d|\bm[23]\b|\bdeg\b", text)


def test_a_headline_says_what_of_a_mechanism_it_measures():
    document = {"analysis": "parallel_workspace", "kind": "dexterous", "headline": VOLUME}
    assert headline_lines(document) == ["dexterous volume 3.80 m³ (95 %: 3.78 … 3.83)"]
    without = document | {"headline": NONE | {"reason": NOT_ASKED}}
    assert headline_lines(without) == ["no refined dexterous volume: none was asked for by refined_volume"]
    assert headline_lines(document | {"kind": "constant_orientation"})[0].startswith("reachable volume 3.80 m³")


def test_several_robots_have_a_headline_each():
    robots = [{"name": "left", "headline": VOLUME}, {"name": "right", "headline": NONE}]
    document = {"analysis": "shared_workspace", "headline": VOLUME, "robots": robots}
    assert headline_lines(document) == [
        "shared volume 3.80 m³ (95 %: 3.78 … 3.83)",
        "left: reachable volume 3.80 m³ (95 %: 3.78 … 3.83)",
    ]
    assert headline_lines(document | {"headline": NONE, "robots": robots[1:]}) == [
        "no volume: the tip stays on a surface"
    ]
    together = NONE | {"reason": "see each"}
    assert headline_lines(document | {"analysis": "robot_comparison", "headline": together}) == [
        "left: reachable volume 3.80 m³ (95 %: 3.78 … 3.83)",
        "right: no volume: the tip stays on a surface",
    ]


def test_results_of_the_first_version_have_neither():
    assert headline_lines({"robot": {}}) == [] == warning_lines({"robot": {}})


def test_a_real_result_has_both():
    result = ws.analyze("spherical", ws.Sobol(2000), indices=["manipulability"], voxel_size_m=0.02, device="cpu")
    first, *rest = result.summary().splitlines()[1:]
    assert first == f"  {headline_text(result.document['headline'])}" and "m³ (95 %: " in first
    assert any(line.startswith("  warning: too few samples") and "(field voxel_size_m)" in line for line in rest)


def test_a_summary_says_a_number_once():
    """The refined volume is the headline; occupied voxels of an arm in a plane are counted, for they have no area."""
    refined = {name: VOLUME[name] for name in ("value", "ci95")}
    solid = {"headline": VOLUME, "volume_m3": {"occupied": 4.0, "refined": refined}}
    text = ws.Result(solid).summary()
    assert text.count("3.80") == 1 and "refined" not in text and "occupied volume         4 m³" in text
    other = solid | {"volume_m3": {"refined": {"any": {"value": 5.0, "ci95": [4.5, 5.5]}, "shared": refined}}}
    text = ws.Result(other).summary()
    assert "refined any volume      5 m³ (95 %: 4.5 … 5.5)" in text and "shared" not in text
    exact = {"headline": VOLUME | {"ci95": [3.8012, 3.8012]}, "volume_m3": {"exact": 3.8012}}
    assert ws.Result(exact).summary() == "robot\n  reachable volume 3.8012 m³ (exact)"


def test_the_summary_of_an_arm_in_a_plane_has_no_cubic_metres():
    result = ws.analyze("scara", ws.Sobol(10_000, locked={"joint3": 0.3}), ["manipulability"], task=["x", "y"])
    occupied, size = result.document["volume_m3"]["occupied"], result.document["voxel_size_m"]
    facts = [line for line in result.summary().splitlines() if not line.startswith("  manipulability")]
    assert sum("m²" in line for line in facts) == 1 and not any("m³" in line for line in facts)
    assert f"  occupied voxels         {occupied / size**3:,.0f} of {size:g} m" in facts
