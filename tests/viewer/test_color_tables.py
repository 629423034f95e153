"""The page's colours are those of the pictures."""

import runpy
from pathlib import Path

from wsrender.results.drawing.color_scale import DIVERGING
from wsrender.results.drawing.style import COLOR_MAP

WEB = Path(__file__).parents[2] / "server" / "web"


def test_colour_tables_are_those_of_matplotlib():
    """As the script writes them; those that the pictures use are among them."""
    script = runpy.run_path(str(WEB / "color_tables.py"))
    assert (WEB / "src" / "scene" / "color_tables.ts").read_text() == script["module"]()
    assert {COLOR_MAP, DIVERGING} <= set(script["NAMES"])
