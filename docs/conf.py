"""How Sphinx builds this site: ``sphinx-build -W docs OUT``, without a network.

Pages are Markdown. Their Python snippets are run by ``tests/test_docs.py``.
"""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_extensions"))

from wsrender.version import __version__  # noqa: E402

project = "wsrender"
author = "The wsrender developers"
copyright = f"{author}, Apache-2.0"
version = release = __version__

extensions = [
    "mathml",
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_design",
    "sphinxcontrib.bibtex",
]
exclude_patterns = ["_extensions", "examples"]
nitpicky = True
nitpick_ignore_regex = [("py:.*", ".*")]  # types of other packages: their sites are not asked

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
html_math_renderer = "mathml"
bibtex_bibfiles = ["references.bib"]

html_theme = "pydata_sphinx_theme"
html_title = "wsrender"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = html_show_sourcelink = False
html_theme_options = {
    "logo": {"text": "wsrender"},
    "navbar_end": ["theme-switcher"],
    "secondary_sidebar_items": ["page-toc"],
    "show_toc_level": 2,
    "footer_start": ["copyright"],
    "footer_end": [],
}
