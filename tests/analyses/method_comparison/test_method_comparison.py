import re

import numpy as np
import pytest

import wsrender as ws
from wsrender.analyses.method_comparison.presentation import method_rows
from wsrender.errors import InputError


def test_the_four_methods_agree_on_the_published_six_pus(tmp_path):
    """DEFINITIONS section 9: A and B in identical voxels, to .5 % at .05 m; D to .1 %; C to 1e-6."""
    result = ws.method_comparison("six_pus", voxel_sizes_m=[0.2, 0.1, 0.05], ball_subdivisions=[2, 5], device="cpu")
    table = result.tables["methods"]
    assert result.document["headline"]["value"] == pytest.approx(0.717344315, abs=1e-6)
    volumes = {
        (str(method), round(float(size), 3)): volume
        for method, size, volume in zip(table["method"], np.nan_to_num(table["size"]), table["volume"], strict=True)
    }
    assert volumes["exact", 0.0] == pytest.approx(0.717344315, abs=1e-6)
    for size in (0.2, 0.1, 0.05):
        assert volumes["grid", size] == volumes["grid_by_subsystem", size]
    assert volumes["grid", 0.05] == pytest.approx(0.717344315, rel=5e-3)
    solids = table["relative_error"][table["method"] == "solids"]
    assert abs(solids[1]) < 1e-3 < 1 and abs(solids[1]) < abs(solids[0])
    assert len(table) == 1 + 2 * 3 + 2
    steps = ("plan", "sweep", "finish")
    times = {name: seconds for name, seconds in result.document["timing_s"].items() if name not in steps}
    assert len(times) == len(table) and min(times.values()) > 0
    assert "grid_by_subsystem 0.05 m" in times and "error" in result.summary()
    rows = method_rows(result.document)
    assert [row["method"][0] for row in rows] == ["C", *"AAA", *"BBB", *"DD"]
    assert [row["time_s"] for row in rows] == list(times.values())
    assert [row["volume_m3"] for row in rows] == table["volume"].tolist()
    result.report(tmp_path / "report.html", views=())
    page = (tmp_path / "report.html").read_text()
    head, body = page[page.index("<h2>Methods") :].split("<tbody>")[:2]
    assert re.findall("<th>(.*?)</th>", head) == ["method", "size [m]", "volume [m³]", "relative error", "time [s]"]
    assert body.count("<tr>", 0, body.index("</tbody>")) == len(table) and "B grid by subsystem" in body
    result.save(tmp_path)
    assert (tmp_path / "plots" / "methods.png").stat().st_size > 10_000


def test_sizes_follow_the_volume_and_empty_workspaces_have_no_error():
    empty = {"library": "six_pus", "region": {"lower_m": [None, None, 90]}}
    result = ws.method_comparison(empty, ball_subdivisions=[1], device="cpu")
    document = result.document
    assert result.plot.methods().axes
    assert {row["volume_m3"] for row in document["methods"]} == {0.0}
    assert {row["relative_error"] for row in document["methods"]} == {None}
    sizes = sorted({row["size_m"] for row in document["methods"] if row["method"] == "grid"})
    assert len(sizes) == 4


def test_other_mechanisms_are_refused():
    with pytest.raises(InputError, match=r"^mechanism.legs.0: is a delta leg; .* pairs of PUS legs$"):
        ws.method_comparison("delta")
