"""Targets by their labels, and warnings on the pictures that they concern."""

from itertools import combinations

import numpy as np
import pytest

import wsrender as ws
from tests.results.export.sample_data import random_map, random_volume
from wsrender.analyses.reachability.pictures import labelled_targets
from wsrender.errors import InputError
from wsrender.results import drawing
from wsrender.results.export.text import sampling_text
from wsrender.run import execute
from wsrender.volume.table import Table

POINTS = [[0.3, 0.1, 0.2], [0.25, -0.2, 0.1], [9.0, 0.0, 0.0]]
LONG = "positions differ by a thousand times: lengths may be millimetres written as metres, " * 6


@pytest.fixture(scope="module")
def reached():
    return execute({"analysis": "reachability", "robot": "articulated", "points_m": POINTS, "device": "cpu"})


def test_a_reachability_job_shows_its_targets(reached, tmp_path):
    reached.save(tmp_path)
    assert (tmp_path / "plots" / "targets.png").stat().st_size > 10_000
    labels = reached.tables["targets"]["label"]
    axes = reached.plot.targets().axes[0]
    shown = [text.get_text() for text in axes.get_legend().get_texts()]
    counts = {name: int((labels == name).sum()) for name in np.unique(labels)}
    assert {f"{name} ({count})" for name, count in counts.items()} <= set(shown)
    marks = {line.get_marker(): len(line.get_xdata()) for line in axes.lines if line.get_linestyle() == "None"}
    assert marks["x"] == counts["unreachable"]


def test_labels_have_marks_of_their_own():
    label = np.array(["reachable", "undecided", "unreachable", "reachable"])
    columns = {"position": np.eye(4, 3), "label": label, "quat_wxyz": np.eye(4)}
    axes = labelled_targets(Table(columns)).axes[0]
    marks = {line.get_marker(): len(line.get_xdata()) for line in axes.lines}
    assert (marks["o"], marks["^"], marks["x"]) == (2, 1, 1)
    with pytest.raises(InputError, match="rows of position and label are needed"):
        labelled_targets(Table({"position": np.eye(3)}))


WARNINGS = [
    {"code": "few_samples", "message": "too few samples", "remedy": "take more", "field": "sampling"},
    {"code": "units_length", "message": LONG, "remedy": "", "field": "robot"},
]


def test_pictures_carry_the_warnings_that_concern_them():
    document = {"robot": {"name": "arm"}, "warnings": WARNINGS}
    plot = ws.Result(document, sample=random_map(), volume=random_volume((4, 4, 4))).plot
    for figure in (plot.slices(), plot.scatter(), plot.histogram(), plot.slice(z=0.6)):
        figure.draw_without_rendering()
        (text,) = [text for text in figure.texts if text.get_text().startswith("Warning: ")]
        assert "Warning: too few samples\nWarning: positions differ" in text.get_text() and "…" in text.get_text()
        title, note = figure._suptitle.get_window_extent(), text.get_window_extent()
        axes = [axes.get_tightbbox() for axes in figure.axes if axes.get_visible()]
        assert not any(a.overlaps(b) for a, b in combinations([title, note], 2)) and title.y0 >= note.y1
        assert not any(note.overlaps(box) for box in axes if box is not None)
        assert figure.bbox.x0 <= note.x0 and note.x1 <= figure.bbox.x1
    assert drawing.heading("arm", WARNINGS, "surface").warnings == (LONG,)
    assert drawing.heading("arm", WARNINGS[:1], "boundary").warnings == ()
    three = drawing.heading("arm", [*WARNINGS, WARNINGS[1] | {"message": "other"}], "volume").warnings
    assert len(three) == 2 and three[1].endswith("(and 1 more in the result's warnings)")


def test_no_warning_is_said_twice_and_different_ones_come_first():
    again = [WARNINGS[0] | {"message": "b: too few samples"}, *WARNINGS]
    assert drawing.heading("arm", again[:1] + again, "volume").warnings == (
        "b: too few samples",
        f"{LONG} (and 1 more in the result's warnings)",
    )
    assert drawing.heading("arm", WARNINGS[:1] * 2, "volume").warnings == ("too few samples",)


def test_long_titles_are_not_cut():
    title = "a mechanism with quite a long name · 21,013,632 samples (grid_by_subsystem)"
    figure = drawing.histogram(random_map(names=("w",)), title=title)
    figure.draw_without_rendering()
    box = figure._suptitle.get_window_extent()
    assert figure.bbox.x0 <= box.x0 and box.x1 <= figure.bbox.x1
    assert figure.get_suptitle().replace("\n", " ") == title


def test_titles_say_in_words_how_samples_are_spread_and_how_a_voxel_is_approached():
    for method, words in (
        ("grid_by_subsystem", "grid, by subsystem"),
        ("lattices", "on lattices of positions and of joint angles"),
        ("boundary", "near the joint limits"),
        ("sobol", "sobol"),
    ):
        sampling = {"samples": 1200, "method": method}
        assert sampling_text({"robot": {"name": "arm"}, "sampling": sampling}) == f"arm · 1,200 samples ({words})"
    one = {"samples": 1, "method": "given"}
    assert sampling_text({"robot": {"name": "arm"}, "sampling": one}) == "arm · 1 sample (as given)"
    admitted = {"samples": {"drawn": 9, "admitted": 8, "rejected": {"self_collision": 1, "region": 0}}}
    assert sampling_text({"robot": {"name": "arm"}} | admitted) == "arm · admitted by self collision, region"
    capability = {"directions": 50, "approach_axis": "-x"}
    title = sampling_text({"analysis": "capability", "robot": {"name": "arm"}, "capability": capability})
    assert title == "arm · 50 directions of approach by the tip's -x axis"
