"""What a script of the gallery shows: a figure as a picture, a result as the viewer in a frame.

What the last line of a block gives is shown, as in a notebook. Each needs a line ``# Picture: …`` above it, which says
what is seen to those who do not see it; without one the build fails.
"""

import ast
import re
from html import escape
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from sphinx.errors import ExtensionError
from sphinx_gallery.scrapers import figure_rst

from wsrender.results.result import Result
from wsrender.results.view import view_of
from wsrender.results.view.page import embedded

_SAID = re.compile(r"^# Picture: (.+(?:\n# .+)*)", re.MULTILINE)
_DPI = 110
_PAGE = """<!doctype html>
<html lang="en">
<head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1"><title>{title}</title>
<link rel="icon" href="data:,"><style>html, body {{ margin: 0; color-scheme: light dark; }}</style></head>
<body>{view}</body></html>
"""
_FRAME = """
.. raw:: html

    <iframe class="viewer" src="{address}" title="{title}" loading="lazy"></iframe>

"""


def described(code: str, where: str) -> str:
    """What is seen in the picture that a block of code shows, by its line ``# Picture: …``; the build fails without."""
    said = _SAID.search(code)
    if said is None:
        raise ExtensionError(f"{where}: a block shows something without a line '# Picture: …'")
    return said[1].replace("\n# ", " ")


class Shown:
    """Scraper of sphinx-gallery; views are written to ``views``, from where Sphinx copies them to ``/views``."""

    def __init__(self, views: Path):
        self.views = views

    def __repr__(self) -> str:
        """The same in every build: sphinx-gallery writes it into the environment."""
        return "Shown()"

    def __call__(self, block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
        """RST of what a block shows."""
        content = block[1]
        lines = ast.parse(content).body
        value = block_vars["example_globals"].get("___") if lines and isinstance(lines[-1], ast.Expr) else None
        if not isinstance(value, Figure | Result):
            return ""
        words = described(content, block_vars["src_file"])
        path = Path(next(block_vars["image_path_iterator"]))
        if isinstance(value, Figure):
            value.savefig(path, dpi=_DPI)
            return figure_rst([str(path)], gallery_conf["src_dir"], words)
        return self._framed(value, path, words, Path(block_vars["target_file"]), Path(gallery_conf["src_dir"]))

    def _framed(self, result: Result, image: Path, said: str, target: Path, source: Path) -> str:
        """A frame with the viewer; the image of its number is the result's own, for the index of the gallery."""
        self.views.mkdir(parents=True, exist_ok=True)
        page = self.views / f"{image.stem.removeprefix('sphx_glr_')}.html"
        page.write_text(_PAGE.format(title=escape(said), view=embedded(view_of(result))), encoding="utf-8")
        next(iter(result.plot.pictures)).drawn(result.plot).savefig(image, dpi=_DPI)
        up = "../" * len(target.parent.relative_to(source).parts)
        return _FRAME.format(address=f"{up}views/{page.name}", title=escape(said, quote=True))
