"""What notebooks show: cards that say what was found, safely, with pictures; and nothing heavy elsewhere."""

import base64
import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from wsrender import notebook
from wsrender.client.connection import Connection
from wsrender.client.job import Job
from wsrender.errors import MissingExtraError
from wsrender.results import cards
from wsrender.results.cards import Card, card_of
from wsrender.results.export.headline import headline_lines, warning_lines
from wsrender.volume.table import Table

EVIL = '<script>alert("1")</script>&'


@pytest.fixture(scope="module")
def result() -> ws.Result:
    return ws.analyze("scara", ws.Sobol(1 << 12), indices=["manipulability"], voxel_size_m=0.05, keep_map=True)


@pytest.fixture(scope="module")
def planar() -> ws.Robot:
    return ws.load_robot(ws.DHTable(convention="standard", rows=[ws.DHRow(a=0.3, limits_deg=(-90, 90))] * 3))


class Read(HTMLParser):
    """Tags and text of a page, every tag closed by its own."""

    def __init__(self, html: str):
        super().__init__()
        self.tags: list[str] = []
        self.open: list[str] = []
        self.text = ""
        self.feed(html)
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        if tag != "img":
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


def pictures(html: str) -> list[bytes]:
    found = [base64.b64decode(data) for data in re.findall(r'src="data:image/png;base64,([^"]+)"', html)]
    assert all(data.startswith(b"\x89PNG") for data in found)
    return found


def test_a_result_tells_its_headline_with_interval_warnings_and_pictures(result):
    read = Read(html := card_of(result).html())
    (headline,) = headline_lines(result.document)
    assert "(95 %" in headline and headline in read.text
    assert warning_lines(result.document)[0] in read.text
    assert "manipulability" in read.text and "occupied voxels" in read.text
    assert len(pictures(html)) == 2


def test_every_part_has_a_card(result, planar):
    shown = {
        "3 joints": planar,
        f"{result.volume.n_occupied:,} of 0.05 m": result.volume,
        f"{len(result.map):,} samples": result.map,
        "m² (exact)": ws.exact_boundary(planar),
    }
    for text, what in shown.items():
        assert text in Read(html := card_of(what).html()).text
        assert len(pictures(html)) == 1
    table = Table({"x": np.arange(1000.0), "name": np.array([EVIL] * 1000)}, {"x": "m"})
    read = Read(card_of(table).html())
    assert "x [m]" in read.text and "1,000 rows" in read.text and EVIL in read.text and "script" not in read.tags


def test_what_functions_find_has_a_card():
    arm = ws.load_robot("ur5e")
    q = [0.3, -1.4, 1.6, -0.4, 1.1, 0.2]
    T = arm.forward_kinematics(q)[0]
    w, x, y, z = (Rotation.from_matrix(T[:3, :3]).as_quat()[[3, 0, 1, 2]]).tolist()
    postures = ws.postures(arm, T[:3, 3], [w, x, y, z])
    read = Read(card_of(postures).html())
    assert f"{len(postures)} postures of 1 pose" in read.text and f"{postures.count:,}, whole turns" in read.text
    assert postures.evidence in read.text and f"{postures.sigma_min[0]:.3g}"[:4] in read.text
    assert read.tags.count("tr") >= 1 + min(len(postures), 8)
    none = Read(card_of(ws.postures(arm, [[9.0, 0, 0]], [[1.0, 0, 0, 0]])).html())
    assert "0 postures of 1 pose" in none.text
    found = ws.reachable(arm, [T[:3, 3], [9, 0, 0], [0, 0, 9]])
    read = Read(card_of(found).html())
    assert "3 targets" in read.text and "2 unreachable, 1 reachable" in read.text and "2 out of reach" in read.text
    assert "distance [m]" in read.text and "angle [rad]" in read.text
    turning = dict.fromkeys(arm.joint_names, 2.0)
    arm = ws.load_robot("ur5e", velocity_limits=turning)
    shape = ws.polytope(arm, q, "velocity")
    read = Read(html := card_of(shape).html())
    assert f"{shape.radius:.4g} m/s" in read.text and f"{len(shape.vertices)} vertices" in read.text
    assert f"{shape.vertices[:, 0].max():.4g} m/s" in read.text and len(pictures(html)) == 1
    line = replace(shape, vertices=shape.vertices[:1], triangles=np.empty((0, 3), int), dimension=1)
    assert "radius" in Read(html := card_of(line).html()).text and pictures(html) == []  # nothing with an area
    nothing = replace(line, vertices=np.empty((0, 3)), dimension=0)
    assert "nothing is allowed" in Read(card_of(nothing).html()).text


def test_in_a_notebook_they_are_shown(monkeypatch):
    found = ws.reachable("scara", [[9, 0, 0]])
    assert found._repr_mimebundle_() == {"text/plain": repr(found)}
    monkeypatch.setattr(notebook, "in_notebook", lambda: True)
    assert found._repr_mimebundle_().keys() == {"text/plain", "text/html"}


def test_nothing_that_a_name_holds_becomes_a_tag():
    card = Card(EVIL, [EVIL], [EVIL], {EVIL: EVIL})
    read = Read(card.html())
    assert read.text.count(EVIL) == 5 and "script" not in read.tags


def test_what_cannot_be_drawn_is_said():
    def draw():
        raise MissingExtraError("matplotlib", "engine")

    assert "Pictures are left out: matplotlib is not installed" in Read(Card("arm", pictures=[draw]).html()).text


def test_a_job_tells_its_state_and_its_error():
    record = {
        "id": "j1",
        "analysis": "workspace",
        "state": "running",
        "created_at": "2026-01-02T03:04:05Z",
        "labels": {"of": "me"},
        "progress": {"fraction": 0.25, "message": "samples"},
    }
    job = Job(Connection("http://127.0.0.1:9", None, 1.0, 1.0), record)
    bundle = job._repr_mimebundle_()
    read = Read(bundle["text/html"])
    assert bundle["text/plain"] == "Job('j1', running)"
    assert all(text in read.text for text in ("j1", "running", "2026-01-02T03:04:05Z", "of=me", "samples"))
    assert 'value="0.2500"' in bundle["text/html"]
    job.record |= {"state": "failed", "error": {"detail": EVIL}}
    failed = Read(job._repr_mimebundle_()["text/html"])
    assert EVIL in failed.text and "progress" not in failed.tags


def test_outside_a_notebook_there_is_text_alone(result, monkeypatch):
    monkeypatch.setattr(cards, "card_of", lambda what: pytest.fail("a card was made"))
    for what in (result, result.volume, result.map):
        assert what._repr_mimebundle_(include=None, exclude=None) == {"text/plain": repr(what)}


def test_in_a_notebook_there_are_card_and_viewer(result, monkeypatch):
    pytest.importorskip("anywidget", reason="needs anywidget")
    monkeypatch.setattr(notebook, "in_notebook", lambda: True)
    bundle = result._repr_mimebundle_()
    assert bundle.keys() == {"text/plain", "text/html", "application/vnd.jupyter.widget-view+json"}
    assert result.volume._repr_mimebundle_().keys() == {"text/plain", "text/html"}


def test_without_widgets_there_is_the_card_alone(result, monkeypatch):
    monkeypatch.setattr(notebook, "in_notebook", lambda: True)
    monkeypatch.setattr(cards, "in_widget", lambda what: (_ for _ in ()).throw(MissingExtraError("anywidget", "x")))
    assert result._repr_mimebundle_().keys() == {"text/plain", "text/html"}
