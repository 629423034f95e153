"""The tutorials run as notebooks, and what they tell is what their cells print."""

import importlib.util
import re
import sys

import numpy as np
import pytest

import wsrender as ws
from tests.docs.site import CLONE, TUTORIALS

NUMBER = re.compile(r"(?<![\w.])−?\d+(?:,\d{3})*(?:\.\d+)?")


@pytest.fixture(scope="module")
def executed():
    """What the site runs tutorials by."""
    for name in ("jupytext", "nbclient", "sphinx_gallery"):
        pytest.importorskip(name, reason="needs the extra docs")
    folder = CLONE / "docs" / "_extensions"
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(folder)
        spec = importlib.util.spec_from_file_location("tutorials", folder / "tutorials.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        sys.modules.pop("gallery_shown")
        yield lambda path: module.executed(path.read_text(encoding="utf-8"), CLONE / "docs" / "examples")


@pytest.fixture(scope="module", params=TUTORIALS, ids=lambda path: path.stem)
def tutorial(request, executed, tmp_path_factory):
    """Name of a tutorial, its prose, its code, and what its cells printed."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("IPYTHONDIR", str(tmp_path_factory.mktemp("ipython")))
        patch.setenv("PYTHONPATH", ":".join(str(CLONE / each) for each in ("", "kernels", "server")))
        cells = executed(request.param).cells
    kinds = {kind: [cell for cell in cells if cell.cell_type == kind] for kind in ("markdown", "code")}
    outputs = [output for cell in kinds["code"] for output in cell.outputs]
    assert len(kinds["code"]) >= 6 and any("image/png" in output.get("data", {}) for output in outputs)
    printed = "".join(output.text for output in outputs if output.output_type == "stream" and output.name == "stdout")
    prose, code = ("\n".join(cell.source for cell in kinds[kind]) for kind in ("markdown", "code"))
    assert not any(output.output_type == "stream" and output.name == "stderr" for output in outputs)
    return request.param.stem, prose, code, printed


def test_it_tells_what_it_prints(tutorial):
    """Every number of the prose with a fraction stands in the code, or is printed, to as many digits."""
    _, prose, code, printed = tutorial
    there = [float(each.replace(",", "").replace("−", "-")) for each in NUMBER.findall(code + printed)]
    for told in re.findall(r"(?<![\w.])\d+\.\d+(?![\w.])", prose):
        digits = len(told.partition(".")[2])
        assert any(abs(abs(each) - float(told)) <= 0.51 * 10**-digits for each in there), told


def test_it_prints_what_is_known(tutorial):
    """What is told is so by another way: of a URDF, the library's arm; of a hexapod, its heights and the library's."""
    name, prose, _, printed = tutorial
    if name == "from_a_urdf":
        low, high = (float(each) for each in re.search(r"95 %: ([\d.]+) … ([\d.]+) m³\n", printed).groups())
        exact = ws.analyze("ur5e", ws.Sobol(4096, seed=3), ["manipulability"], refined_volume=0.01)
        least, most = exact.document["headline"]["ci95"]
        assert low <= most and least <= high and high - low < 0.025 * low
        assert "they overlap: True" in printed and printed.endswith("True\n")
    elif name == "targets_in_a_cell":
        assert "13 of 13" in printed and "reachable targets: 10\n  blocked targets: 3\n" in printed
        assert re.findall(r"^(.{8}) blocked +environment$", printed, re.M) == ["hole 10 ", "hole 11 ", "hole 12 "]
        assert "postures: 8, 4 free" in printed and "half of them hit the table" in prose
        assert "free volume" in printed and "blocked volume" in printed
    elif name == "where_to_stand":
        served, places = (int(each) for each in re.search(r"(\d+) of (\d+) places", printed).groups())
        assert places == 17 * 12 * 4 and 0 < served < places
        cell, best = (float(re.search(rf"{words} (0\.\d+)", printed)[1]) for words in ("had", r"m, y .* m:"))
        assert best >= cell
        assert "\n10 of 10\n" in printed
        assert 0 < int(re.search(r"(\d+) places serve all ten\n", printed)[1]) < served
    else:
        assert name == "a_parallel_mechanism"
        apart = 0.5**2 + 0.3**2 - 2 * 0.5 * 0.3 * np.cos(np.radians(40))
        heights = f"{np.sqrt(0.25 - apart):.3f} … {np.sqrt(0.64 - apart):.3f} m"
        assert re.search(rf"  z +{heights}\n", printed) and f"height: {heights}\n" in printed
        known = ws.parallel_workspace({"library": "stewart_gough", "length_m": [0.5, 0.8]}, method="exact")
        low, high, exact = (float(each) for each in re.search(r"(.*) … (.*) m³ holds (.*) m³\n", printed).groups())
        assert low <= exact <= high
        assert exact == pytest.approx(known.document["volume_m3"]["exact"], abs=5e-5)
