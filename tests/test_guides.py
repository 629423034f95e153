"""What the guides show runs, and gives the numbers that they tell."""

import importlib.util
import re
from pathlib import Path

import pytest

GUIDES = Path(__file__).parents[1] / "docs" / "guides"


def test_an_arm_on_a_table_beside_another_arm(tmp_path):
    """With few samples, and without the free volume."""
    path = GUIDES / "two_arms_on_a_table.py"
    spec = importlib.util.spec_from_file_location(path.stem, path)
    guide = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(guide)
    result = guide.analysed(samples=60_000, tolerance=None, device="cpu")
    samples, pairs = result.document["samples"], result.document["rejections"]["pairs"]["colliding"]
    (percent,) = re.findall(r"samples only (\d+) % are admitted", path.with_suffix(".md").read_text(encoding="utf-8"))
    assert 100 * samples["admitted"] / samples["drawn"] == pytest.approx(int(percent), abs=1)
    assert all(samples["rejected"][name] for name in ("environment", "self_collision"))
    shapes = {shape.partition("/")[0] for pair in pairs for shape in pair["shapes"]}
    assert {"table", "neighbour"} <= shapes
    guide.drawn(result, tmp_path / "picture.png")
    assert (tmp_path / "picture.png").read_bytes().startswith(b"\x89PNG")
