"""The page in its other homes: a report's file, a tab of its own, a notebook."""

import json
import os
import re
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import wsrender as ws
from tests.viewer.written import decoded
from wsrender.results.result import Result
from wsrender.results.view.page import MOST_EMBEDDED
from wsrender.window import in_tab

PATIENCE_MS = 180_000  # a notebook's server and kernel start beside other tests
DRAWN = ".stage-host[data-drawn=finished]"
NOISE = "GPU stall due to ReadPixels"


@pytest.fixture(scope="module")
def result() -> Result:
    return ws.analyze("ur5e", ws.Sobol(1 << 16), indices=["manipulability"], voxel_size_m=0.1, refined_volume=None)


@pytest.fixture
def page(chromium):
    """A page that must end without errors on its console, and ask nothing but its own host."""
    page = chromium.new_page(viewport={"width": 1280, "height": 800})
    page.set_default_timeout(PATIENCE_MS)
    errors, asked = [], []
    page.on("console", lambda said: errors.append(said.text) if said.type == "error" else None)
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    yield page
    hosts = {re.split(r"[/?]", url, maxsplit=3)[2] for url in asked if url.startswith(("http", "ws"))}
    assert errors == []
    assert len(hosts) <= 1, hosts
    page.close()


def settled(page):
    page.locator(DRAWN).wait_for()
    page.wait_for_timeout(300)
    page.locator(DRAWN).wait_for()


def colors(page):
    """How many colours are seen in the view."""
    seen = decoded(page.locator(".stage-host").first.screenshot())
    return len(np.unique(seen.reshape(-1, 3), axis=0))


def click_middle(page):
    box = page.locator(".stage-host").first.bounding_box()
    page.mouse.click(box["x"] + 0.5 * box["width"], box["y"] + 0.55 * box["height"])


def test_a_report_shows_its_view_from_a_file(page, result, tmp_path):
    path = tmp_path / "report.html"
    result.report(path, views=())
    text = path.read_text()
    part = text[text.index('<div class="view">') : text.index("</section>", text.index('<div class="view">'))]
    assert len(part) <= MOST_EMBEDDED
    page.goto(path.as_uri())
    settled(page)
    assert colors(page) > 500
    page.get_by_role("button", name="Explore").click()
    page.get_by_label("Joint joint1 [°]", exact=True).wait_for()
    assert page.get_by_role("button", name="Drag the tool").count() == 0  # no engine behind it
    page.get_by_role("button", name="Explore").click()
    page.locator(".stage-host").scroll_into_view_if_needed()
    settled(page)
    click_middle(page)
    page.get_by_role("button", name="Explore").click()
    voxel = page.locator("[data-voxel]")
    cell = [int(each) for each in voxel.get_attribute("data-voxel").split()]
    at = np.searchsorted(result.volume.voxels.cells, np.ravel_multi_index(cell, result.volume.shape))
    kept = result.volume.voxels.statistics["maximum"]["manipulability"][at]
    shown = float(voxel.locator("[data-value='maximum:manipulability']").get_attribute("data-exact"))
    assert shown == float(np.float16(kept)) != kept
    page.get_by_text("These values are rounded to 16 bits.").wait_for()


def test_a_tab_opens_once_and_is_answered_by_the_engine(page, chromium, result):
    local = in_tab(result)
    try:
        page.goto(local.url)
        settled(page)
        assert colors(page) > 500
        assert "token" not in page.url
        assert page.get_by_role("button", name="Other postures").count() == 1
        page.reload()
        settled(page)
        other = chromium.new_page()
        assert other.goto(local.url).status == 403
        other.close()
    finally:
        local.close()


def test_the_command_shows_a_saved_result(page, result, tmp_path):
    result.save(tmp_path / "result")
    command = [sys.executable, "-m", "wsrender", "view", str(tmp_path / "result"), "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=os.environ) as program:
        try:
            page.goto(program.stdout.readline().strip())
            settled(page)
            assert "ur5e" in page.title()
            program.send_signal(signal.SIGINT)
            assert program.wait(20) == 0
        finally:
            program.kill()  # where it has not ended: background jobs of a shell ignore Ctrl-C


@pytest.fixture
def notebook(tmp_path):
    """Address of JupyterLab, in which a notebook lies."""
    pytest.importorskip("jupyterlab", reason="needs JupyterLab")
    pytest.importorskip("anywidget", reason="needs anywidget")
    cell = "import wsrender as ws\nws.load_robot('ur5e')"
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    content = {
        "nbformat": 4,
        "nbformat_minor": 5,
        "metadata": {"kernelspec": kernel},
        "cells": [
            {"cell_type": "code", "id": "a", "metadata": {}, "source": cell, "outputs": [], "execution_count": None}
        ],
    }
    (tmp_path / "arm.ipynb").write_text(json.dumps(content))
    port, token = 20_000 + os.getpid() % 20_000, "t" * 32
    options = [f"--ServerApp.port={port}", f"--IdentityProvider.token={token}", "--LabApp.news_url=None"]
    options += ["--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate", "--no-browser", "--allow-root"]
    command = [sys.executable, "-m", "jupyterlab", *options, f"--ServerApp.root_dir={tmp_path}"]
    home = {"HOME": tmp_path, "JUPYTER_CONFIG_DIR": tmp_path / "config", "IPYTHONDIR": tmp_path / "ipython"}
    with (tmp_path / "log").open("w") as log:
        server = subprocess.Popen(command, stderr=log, stdout=log, env={**os.environ, **home})
    try:
        yield f"http://127.0.0.1:{port}/lab/tree/arm.ipynb?token={token}", tmp_path / "arm.ipynb"
    finally:
        server.terminate()
        server.wait(30)


def test_a_notebook_shows_a_robot_and_keeps_no_data(page, notebook):
    address, path = notebook
    for _ in range(60):
        try:
            page.goto(address)
            break
        except Exception:
            time.sleep(0.5)
    page.get_by_text("| Idle").wait_for()  # what is run before the kernel is there is lost
    page.locator(".jp-Notebook .jp-Cell").first.click()
    page.locator(".jp-Notebook .jp-Cell .jp-InputArea-editor").first.click()
    page.keyboard.press("Control+Enter")
    settled(page)
    # The layout of ipywidgets, which comes before or after the view, takes the style of their element away.
    stage = page.locator(".stage-host").first
    stage.evaluate("stage => stage.getRootNode().host.closest('.lm-Widget').removeAttribute('style')")
    assert stage.bounding_box()["height"] > 300
    assert colors(page) > 100
    card = page.locator(".jp-OutputArea .wsrender-card")
    assert "6 joints" in card.inner_text()
    page.keyboard.press("Control+s")
    end = time.monotonic() + 30
    while '"output_type"' not in path.read_text():
        assert time.monotonic() < end
        time.sleep(0.2)
    assert "wsrender-card" in path.read_text()  # for who reads it without a kernel
    assert path.stat().st_size < 80_000  # the card's picture, none of the view's data
