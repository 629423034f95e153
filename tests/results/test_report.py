"""The page holds what the document says, and nothing that runs or is fetched."""

import base64
import hashlib
import io
import json
import re
from html.parser import HTMLParser

import numpy as np
import pytest
from PIL import Image

import wsrender as ws
import wsrender.notices
from wsrender import cli
from wsrender.errors import InputError, MissingExtraError, RenderError, RenderWarning
from wsrender.results import render
from wsrender.results.report.entries import MOST_ROWS, facts_html, label, table_html
from wsrender.volume.table import Table

HOSTILE = "<script>alert(\"x\")</script> & 'arm'"


class Page(HTMLParser):
    """Elements of a page, its text by table row, and every number that it states."""

    VOID = ("meta", "img", "br")

    def __init__(self, text):
        super().__init__()
        self.elements, self.open, self.rows, self.numbers, self.text = [], [], [], [], ""
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")
        if tag == "data":
            self.numbers.append(float(dict(attributes)["value"]))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data
        if {"td", "th"} & set(self.open):
            self.rows[-1][-1] += data

    def named(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]


@pytest.fixture(scope="module")
def result():
    table = ws.DHTable(convention="standard", rows=[ws.DHRow(a=0.5), ws.DHRow(a=0.4)], name=HOSTILE)
    return ws.analyze(ws.load_robot(table), ws.Grid(20), task=["x", "y"], voxel_size_m=0.05, device="cpu")


@pytest.fixture(scope="module")
def page(result, tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "report.html"
    result.report(path, views=())
    return Page(path.read_text(encoding="utf-8"))


def floats(value):
    if isinstance(value, float):
        yield value
    elif isinstance(value, dict):
        for key in value:
            yield from floats(value[key])
    elif isinstance(value, list):
        for item in value:
            yield from floats(item)


def test_every_number_of_the_document_is_in_the_page(result, page):
    stated = set(page.numbers)
    shown = {key: value for key, value in result.document.items() if key != "job"}
    assert len(list(floats(shown))) > 40
    assert set(floats(shown)) <= stated


def test_indices_are_a_table_with_units(result, page):
    (row,) = [row for row in page.rows if row[0] == "manipulability" and len(row) == 6]
    entry = result.document["indices"]["manipulability"]
    assert row[1:] == [f"{entry[key]:.6g}" for key in ("maximum", "minimum", "joint_mean", "workspace_mean")] + ["m²"]
    assert ["", "maximum", "minimum", "joint mean", "workspace mean", "unit"] in page.rows


def test_the_job_document_can_be_copied_from_the_page(result, page):
    assert json.dumps(result.document["job"], indent=2, ensure_ascii=False) in page.text


def test_nothing_runs_but_the_viewer_and_nothing_is_fetched(page, result, tmp_path):
    tags = {tag for tag, _ in page.elements}
    assert not tags & {"link", "iframe", "object", "base", "form", "a", "svg"}
    assert all(image["src"].startswith("data:image/png;base64,") for image in page.named("img"))
    assert not any(name.startswith("on") for _, attributes in page.elements for name in attributes)
    policies = [meta["content"] for meta in page.named("meta") if meta.get("http-equiv") == "Content-Security-Policy"]
    result.report(tmp_path / "report.html", views=())
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    kinds = [script["type"] for script in page.named("script")]
    assert kinds == ["application/octet-stream", "application/octet-stream", "module"]  # data, and what reads them
    loader = text.partition('<script type="module">')[2].partition("</script>")[0]
    digest = base64.b64encode(hashlib.sha256(loader.encode()).digest()).decode()
    assert policies == [
        f"default-src 'none'; img-src data: blob:; style-src 'unsafe-inline'; script-src 'sha256-{digest}' blob:"
    ]
    assert HOSTILE in page.text


def test_pictures_are_in_the_page(page):
    pictures = [base64.b64decode(image["src"].partition(",")[2]) for image in page.named("img")]
    assert len(pictures) == 4
    assert all(Image.open(io.BytesIO(picture)).size > (300, 300) for picture in pictures)
    assert [image["alt"] for image in page.named("img")][2] == "Voxels in planes"


def test_equal_results_give_equal_pages(result, tmp_path):
    for name in ("a", "b"):
        result.report(tmp_path / name, views=())
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


@pytest.mark.parametrize("fault", [RenderError("no OpenGL & such"), MissingExtraError("pyvista", "render")])
def test_without_3d_pictures_the_page_says_so(result, tmp_path, monkeypatch, fault):
    def refuse(*arguments, **options):
        raise fault

    monkeypatch.setattr(render, "picture", refuse, raising=False)
    with pytest.warns(RenderWarning, match=re.escape(str(fault))):
        result.report(tmp_path / "report.html")
    assert f"3-D pictures are left out: {fault}" in Page((tmp_path / "report.html").read_text(encoding="utf-8")).text


def test_an_unknown_view_is_refused(result, tmp_path):
    with pytest.raises(InputError, match="'side' is not a view"):
        result.report(tmp_path / "report.html", views=["side"])
    assert not (tmp_path / "report.html").exists()


def test_long_tables_are_cut_and_say_so():
    table = Table({"offset": np.arange(100.0), "label": np.array([f"<{k}>" for k in range(100)])}, {"offset": "m"})
    page = Page(table_html(table))
    assert page.rows[0] == ["offset [m]", "label"]
    assert page.rows[-1] == [f"{MOST_ROWS - 1}", f"<{MOST_ROWS - 1}>"]
    assert "100 rows; the first 40 are shown." in page.text


@pytest.mark.parametrize(
    ("key", "shown"),
    [("voxel_size_m", "voxel size [m]"), ("volume_m3", "volume [m³]"), ("joint_names", "joint names"), ("m", "m")],
)
def test_labels_have_units(key, shown):
    assert label(key) == shown


def test_values_of_every_kind():
    page = Page(facts_html({"a": None, "b": True, "c": [[1, 2], [3, 4]], "d": {"e": {"f": 0.1}}, "g": [], "h": "<&>"}))
    assert ["a", "–"] in page.rows and ["b", "yes"] in page.rows and ["3", "4"] in page.rows
    assert page.numbers == [0.1]
    nested = Page(
        facts_html({"robots": [{"name": "left", "of": {"mass": 1.5}}, {"name": "right", "of": {"mass": 2.5}}]})
    )
    assert nested.text.index("left") < nested.text.index("1.5") < nested.text.index("right") < nested.text.index("2.5")
    assert ["g", "–"] in page.rows and ["h", "<&>"] in page.rows


def test_command(result, tmp_path, capsys):
    result.save(tmp_path / "out")
    with pytest.raises(SystemExit) as ended:
        cli.main(["report", str(tmp_path / "out"), "--flat"])
    assert (ended.value.code, capsys.readouterr().out) == (0, f"{tmp_path / 'out' / 'report.html'}\n")
    assert "Files" in Page((tmp_path / "out" / "report.html").read_text(encoding="utf-8")).text


def test_headline_and_warnings_come_first(tmp_path, capsys):
    headline = {"quantity": "volume", "value": 3.8, "ci95": [3.78, 3.83], "unit": "m3", "reason": ""}
    warnings = [ws.notices.Notice("odd", f"odd {HOSTILE}", "mend it", "robot.urdf").entry()]
    found = ws.Result({"analysis": "workspace", "voxel_size_m": 0.1, "headline": headline, "warnings": warnings})
    found.save(tmp_path / "out")
    with pytest.raises(SystemExit):
        cli.main(["report", str(tmp_path / "out"), "--flat"])
    written = capsys.readouterr()
    assert written.out == f"{tmp_path / 'out' / 'report.html'}\n"
    lines = ["reachable volume 3.80 m³ (95 %: 3.78 … 3.83)", f"warning: odd {HOSTILE}; mend it (field robot.urdf)"]
    assert written.err.splitlines() == lines
    text = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    page = Page(text)
    assert ("p", {"class": "headline"}) in page.elements and ("section", {"class": "warnings"}) in page.elements
    places = [page.text.index(line.removeprefix("warning: ")) for line in lines]
    assert sorted(places) == places and places[-1] < page.text.index("Main values")
    assert page.text.count(HOSTILE) == 1 and not page.named("script")


def test_a_comparison_names_its_robots(tmp_path):
    arms = [ws.load_robot(name) for name in ("spherical", "articulated")]
    options = {"indices": ["manipulability"], "voxel_size_m": 0.05, "device": "cpu", "names": ["left", "right"]}
    found = ws.robot_comparison(arms, ws.Sobol(5_000), **options)
    found.report(tmp_path / "report.html", views=())
    page = Page((tmp_path / "report.html").read_text(encoding="utf-8"))
    assert ["quantity", "unit", "left", "right", "difference right"] in page.rows
    (row,) = [row for row in page.rows if row[0] == "volume.occupied"]
    (entry,) = [entry for entry in found.document["comparison"] if entry["quantity"] == "volume.occupied"]
    assert row == ["volume.occupied", "m³", *(f"{v:.6g}" for v in (*entry["values"], entry["differences"][1]))]


def test_a_mechanism_comes_after_its_results(tmp_path):
    options = {"indices": ["manipulability", "isotropy"], "voxel_size_m": 0.1, "device": "cpu"}
    found = ws.parallel_workspace({"library": "stewart_gough", "length_m": [0.5, 0.8]}, **options)
    found.report(tmp_path / "report.html", views=())
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert text.index("<h2>Indices") < text.index("<h2>Pictures") < text.index("<h2>Mechanism")
    (row,) = [row for row in Page(text).rows if row and row[0] == "isotropy"]
    assert row[-1] == "x, y, z, rx, ry, rz"
