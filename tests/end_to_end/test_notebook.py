"""Pictures and progress in a notebook: a real Jupyter kernel executes cells."""

import base64
import sys

import pytest

from wsrender.notebook import in_notebook

ANALYZE = """
import numpy as np
import wsrender as ws

result = ws.analyze("scara", ws.Sobol(4096), indices=["manipulability"], device="cpu", progress=True)
"""
PNG = b"\x89PNG"


class Notebook:
    """A kernel, and what its cells display."""

    def __init__(self, client):
        self._client = client

    def run(self, code):
        """The displayed data of a cell by MIME type, updates in place of what they replace, streams as text."""
        outputs = {}

        def keep(message):
            content = message["content"]
            assert message["msg_type"] != "error", "\n".join(content["traceback"])
            if message["msg_type"] in ("display_data", "execute_result", "update_display_data"):
                key = content.get("transient", {}).get("display_id") or f"output {len(outputs)}"
                assert (key in outputs) == (message["msg_type"] == "update_display_data")
                outputs[key] = content["data"]
            elif message["msg_type"] == "stream":
                key = f"stream {content['name']}"
                outputs[key] = {"text/plain": outputs.get(key, {"text/plain": ""})["text/plain"] + content["text"]}

        reply = self._client.execute_interactive(code, timeout=120, output_hook=keep)
        assert reply["content"]["status"] == "ok", reply["content"]
        return list(outputs.values())


@pytest.fixture(scope="module")
def notebook():
    from jupyter_client.manager import KernelManager

    manager = KernelManager()
    manager.kernel_spec.argv[0] = sys.executable
    manager.start_kernel()
    client = manager.client()
    client.start_channels()
    try:
        client.wait_for_ready(timeout=60)
        yield Notebook(client)
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)


@pytest.fixture(scope="module")
def analyzed(notebook):
    return notebook.run(ANALYZE)


def png_of(output):
    return base64.b64decode(output["image/png"])


def test_the_bar_ends_at_100_percent(analyzed):
    (bar,) = analyzed  # nothing else: no lines on standard error
    assert "100 %" in bar["text/plain"] and "100 %" in bar["text/html"]
    assert "━" * 40 in bar["text/plain"]  # its whole length


@pytest.mark.parametrize("call", ["slices()", "scatter()", "histogram()", "robot()"])
def test_the_last_value_of_a_cell_is_a_picture(notebook, analyzed, call):
    (output,) = notebook.run(f"result.plot.{call}")
    assert png_of(output).startswith(PNG)


def test_show_shows(notebook, analyzed):
    (output,) = notebook.run("figure = result.plot.slices()\nfigure.show()\n1 + 1;")
    assert png_of(output).startswith(PNG)


def test_pictures_stay_whole_beside_pyplots(notebook, analyzed):
    (output,) = notebook.run("%matplotlib inline\nresult.plot.slices()")
    assert png_of(output).startswith(PNG)


def test_a_bar_of_work_that_ends_between_two_reports_is_full(notebook):
    (bar,) = notebook.run(
        "from wsrender.progress import RunProgress\nwith RunProgress() as progress:\n    progress(3, 4, 'computing')"
    )
    assert "computing" in bar["text/plain"] and "100 %" in bar["text/plain"] and "100 %" in bar["text/html"]


def test_a_bar_of_work_that_fails_is_not_full(notebook):
    (bar,) = notebook.run(
        "from wsrender.progress import RunProgress\n"
        "try:\n    with RunProgress() as progress:\n        progress(1, 4, 'a < [b]')\n        raise ValueError\n"
        "except ValueError:\n    pass"
    )
    assert "25 %" in bar["text/plain"] and "a &lt; [b]" in bar["text/html"]  # text, not markup of either kind


def test_this_is_no_notebook():
    assert not in_notebook()
