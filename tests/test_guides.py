"""What the guides show runs, and gives the numbers that they tell."""

import importlib.util
import re
from pathlib import Path

import numpy as np
import pytest

from wsrender.analyses.jobs import parse_job

GUIDES = Path(__file__).parents[1] / "docs" / "guides"


def guide_of(name):
    """The guide's script as a module, and what the guide says."""
    path = GUIDES / f"{name}.py"
    spec = importlib.util.spec_from_file_location(name, path)
    guide = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(guide)
    return guide, path.with_suffix(".md").read_text(encoding="utf-8")


def test_an_arm_on_a_table_beside_another_arm(tmp_path):
    """With few samples, and without the free volume."""
    guide, text = guide_of("two_arms_on_a_table")
    result = guide.analysed(samples=60_000, tolerance=None, device="cpu")
    samples, pairs = result.document["samples"], result.document["rejections"]["pairs"]["colliding"]
    (percent,) = re.findall(r"samples only (\d+) % are admitted", text)
    assert 100 * samples["admitted"] / samples["drawn"] == pytest.approx(int(percent), abs=1)
    assert all(samples["rejected"][name] for name in ("environment", "self_collision"))
    shapes = {shape.partition("/")[0] for pair in pairs for shape in pair["shapes"]}
    assert {"table", "neighbour"} <= shapes
    guide.drawn(result, tmp_path / "picture.png")
    assert (tmp_path / "picture.png").read_bytes().startswith(b"\x89PNG")


def test_where_to_put_an_arm(tmp_path):
    """Without looking between the cells; the place that is told is at least as good as the best cell."""
    guide, text = guide_of("where_to_put_an_arm")
    result = guide.placed(refine=False, device="cpu")
    found, best = result.document["placements"], result.document["best"]
    (percent,) = re.findall(r"(\d+) % of the cells", text)
    assert f"Of {found['count']:,} placements {found['serving_all']:,} serve all ten" in text
    assert 100 * found["serving_all"] / found["count"] == pytest.approx(int(percent), abs=0.5)
    assert found["alike"] == 12 and best["served"] == found["most_served"] == 10
    x, y = (float(number.replace("−", "-")) for number in re.findall(r"[xy] = (−?[\d.]+) m", text))
    value, of_cell = (float(number) for number in re.findall(r"(0\.3\d+)", text))
    assert best["minimum_singular_value"] == pytest.approx(of_cell, abs=5e-4)
    there = guide.placed(refine=False, device="cpu", over={"x_m": x, "y_m": y}).document["best"]
    assert there["served"] == 10 and there["minimum_singular_value"] == pytest.approx(value, abs=1e-3)
    guide.drawn(result, tmp_path / "picture.png")
    assert (tmp_path / "picture.png").read_bytes().startswith(b"\x89PNG")


def test_the_viewer(tmp_path):
    """Its pictures are there in both themes, small; the jobs behind them are valid, and a picture can be made again."""
    pytest.importorskip("playwright", reason="needs Playwright for Python and a Chromium")
    image = pytest.importorskip("PIL.Image")
    guide, text = guide_of("viewer")
    folder, names = GUIDES / "viewer", [each.name for each in guide.SHOWN]
    found = {path.name: path for path in folder.iterdir()}
    assert found.keys() == {f"{name}_{theme}.png" for name in names for theme in guide.THEMES}
    for path in found.values():
        assert path.stat().st_size <= guide.MOST_BYTES
        with image.open(path) as picture:
            assert picture.size == ((1280, 640) if path.name.startswith("cell_") else (1280, 720))
    told = re.findall(r"\(viewer/(\w+)_(?:light|dark)\.png\)", text)
    assert sorted(told) == sorted(names) and len(names) == 11
    for job in guide.JOBS.values():
        parse_job(job)
    guide.draw(tmp_path, ["form"])
    for theme in guide.THEMES:
        with image.open(tmp_path / f"form_{theme}.png") as picture:
            seen = np.asarray(picture.convert("L"))
        assert (np.median(seen) > 128) == (theme == "light") and seen.std() > 5
