"""The walk of a newcomer, a notebook: it runs, and whoever reads it later without a kernel sees every result."""

import re
from pathlib import Path

import pytest

NOTEBOOK = Path(__file__).parent.parent.parent / "docs" / "examples" / "newcomer.ipynb"
RUN_S = 240
SHOWN = ("text/html", "image/png")
# First words of what each cell shows as its value, in the order of the cells.
DISPLAYS = ("my_arm · 6 joints", "Table of 6 rows", "my_arm · 65,536", "Volume", "", "", "", "Job", "my_arm · 65,536")


@pytest.fixture(scope="module")
def walked(tmp_path_factory, server):
    """The notebook after its run."""
    nbformat = pytest.importorskip("nbformat", reason="needs JupyterLab")
    nbclient = pytest.importorskip("nbclient", reason="needs JupyterLab")
    folder = tmp_path_factory.mktemp("newcomer")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("WSRENDER_SERVER", server.url)
        patch.setenv("IPYTHONDIR", str(folder / "ipython"))
        notebook = nbformat.read(NOTEBOOK, as_version=4)
        settings = {"timeout": RUN_S, "resources": {"metadata": {"path": str(folder)}}, "store_widget_state": False}
        yield nbclient.NotebookClient(notebook, **settings).execute(), folder


def displays(notebook):
    """What cells show: data by type, the value of a cell alone and all."""
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", ())]
    values = [output.data for output in outputs if output.output_type == "execute_result"]
    return values, values + [output.data for output in outputs if output.output_type == "display_data"]


def test_every_display_is_a_picture_or_html(walked):
    notebook, folder = walked
    values, shown = displays(notebook)
    texts = [re.sub(r"<[^>]+>", "", data.get("text/html", "")) for data in values[1:]]  # the first is the version
    assert len(texts) == len(DISPLAYS)
    assert all(text.startswith(words) for text, words in zip(texts, DISPLAYS, strict=True)), texts
    assert all(data.keys() & set(SHOWN) for data in values[1:] + shown[len(values) :])
    assert "(95 %" in texts[2] and "free volume" in texts[2]
    assert (folder / "figure.png").read_bytes().startswith(b"\x89PNG")


def test_a_browser_shows_it_without_a_kernel(walked, chromium, tmp_path):
    exporters = pytest.importorskip("nbconvert.exporters", reason="needs JupyterLab")
    exporter = exporters.HTMLExporter(template_name="basic")
    kinds = (*SHOWN, "text/markdown", "text/plain")  # an answer without a kernel and a network
    exporter.register_preprocessor(lambda notebook, resources: (_kept(notebook, kinds), resources), enabled=True)
    body, _ = exporter.from_notebook_node(walked[0])
    (tmp_path / "newcomer.html").write_text(f"<!doctype html><meta charset=utf-8><body>{body}")
    page = chromium.new_page(viewport={"width": 1000, "height": 900})
    faults, asked = [], []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    page.goto((tmp_path / "newcomer.html").as_uri())
    assert page.locator(".wsrender-card").count() == 6
    widths = page.evaluate("[...document.images].map(each => each.complete ? each.naturalWidth : 0)")
    assert len(widths) >= 7 and min(widths) > 100
    assert page.get_by_text("free volume").first.is_visible()
    outside = page.evaluate("[...document.querySelectorAll('.wsrender-card')].map(e => e.scrollWidth - e.clientWidth)")
    assert max(outside) <= 0  # wide tables scroll by themselves
    assert faults == [] and all(url.startswith(("file:", "data:")) for url in asked)
    page.close()


def _kept(notebook, kinds):
    for cell in notebook.cells:
        for output in cell.get("outputs", ()):
            if "data" in output:
                output.data = {kind: data for kind, data in output.data.items() if kind in kinds}
    return notebook
