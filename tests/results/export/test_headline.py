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
from wsrender.results.view import view_of
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
        ({"value": 80.1, "ci95": [80.1 - 1e-14, 80.1 + 1e-14]}, "reachable volume 80.1 m³ (exact)"),
        (
            {"value": 80.1, "ci95": [80.1 - 1e-9, 80.1 + 1e-9]},
            f"reachable volume {80.1:.9f} m³ (95 %: 80.099999999 … 80.100000001)",
        ),
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


NOTHING = re.compile(r"no (volume|area|length)|measures none")


@pytest.mark.parametrize("analysis", job_classes())
def test_every_result_says_first_what_was_found(analysis):
    """Golden documents of every analysis: none starts with what it has not, unless no refined volume was asked for."""
    for path in DOCUMENTS.glob(f"{analysis}*.json"):
        document = json.loads(path.read_text())["document"] | {"timing_s": defaultdict(float)}  # goldens have no times
        first, *others = headline_lines(document)
        asked = document["headline"]["reason"] != NOT_ASKED
        assert re.search(r"\d", first) if asked else first.startswith("no refined "), path.stem
        assert not any(NOTHING.match(line) for line in (first, *others)), path.stem


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("capability", ["reached voxels: 30 of 0.1 m, in all 0.03 m³, without an interval",
                        "reachability index: 0.0375 of the directions on average; "
                        "105 pairs of voxel and direction undecided",
                        "dexterous volume: 0.009 m³ of them, from 12.5 % of the directions or more"]),
        ("collaborative_volume", ["body-elemental volume: 0.001048 m³, biased: "
                                  "refined_volume gives the true one of two robots"]),
        ("design_optimization", ["best design: forearm 0.5", "its values: volume_occupied 0.255 m³",
                                 "at a bound: forearm", "designs: 3, 3 evaluated; every combination"]),
        ("five_bar", ["working mode +-: 3.0737549 m² (exact), 3 aspects without type 2 singularities",
                      "working mode -+: 3.6542301 m² (exact), 2 aspects without type 2 singularities"]),
        ("parallel_workspace.orientation", ["orientations reached: 507 of 576, 82.8 % of their measure; "
                                            "83.01 % of the whole ranges (95 %: 82.78 … 83.24)"]),
    ],
)  # fmt: skip
def test_what_is_said_where_no_volume_is_measured(name, said):
    """In the headline's place, and not once more."""
    document = json.loads((DOCUMENTS / f"{name}.json").read_text())["document"]
    assert headline_lines(document) == said
    assert ws.Result(document).summary().splitlines()[1:] == [f"  {line}" for line in said]


@pytest.mark.parametrize("name", ["collaborative_volume", "parallel_workspace.orientation"])
def test_a_view_says_it_once(name):
    document = json.loads((DOCUMENTS / f"{name}.json").read_text())["document"]
    shown = view_of(ws.Result(document)).manifest["headline"]
    assert [f"{line['label']}: {line['value']}".lower() for line in shown] == [
        line.lower() for line in headline_lines(document)
    ]


def test_of_what_some_results_measure_those_say_it():
    """A mechanism with one exact volume, and arms whose true volume was asked for."""
    for name, said in (
        ("design_optimization.searched", "reachable volume 1.27835 m³ (exact)"),
        ("collaborative_volume.refined", "collaborative volume 0.0142 m³ (95 %: 0.0137 … 0.0143)"),
    ):
        document = json.loads((DOCUMENTS / f"{name}.json").read_text())["document"]
        assert headline_lines(document) == [said]
        assert ws.Result(document).summary().splitlines()[1] == f"  {said}"
    flat = document["headline"] | {"value": None, "ci95": None, "reason": "the tip stays on a surface"}
    assert headline_lines(document | {"headline": flat}) == ["no volume: the tip stays on a surface"]


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
