"""How Sphinx builds this site: ``sphinx-build -W docs OUT``, without a network.

Pages are Markdown. Their Python snippets are run by ``tests/test_docs.py``.
"""

import os
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_extensions"))

from gallery_shown import Shown  # noqa: E402

from wsrender.version import __version__  # noqa: E402

project = "wsrender"
author = "The wsrender developers"
copyright = f"{author}, Apache-2.0"
version = release = __version__

extensions = [
    "citations",
    "mathml",
    "myst_parser",
    "pictures",
    "reference",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
    "sphinxcontrib.bibtex",
    "tutorials",
]
exclude_patterns = [
    "_extensions",
    "_templates",
    "examples",
    "gallery",
    "generated/**/*.ipynb",
    "generated/extra",
    "**sg_execution_times.rst",
]
suppress_warnings = ["config.cache"]  # the gallery's scraper is an object
nitpicky = True
nitpick_ignore_regex = [("py:.*", ".*")]  # types of other packages: their sites are not asked

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
html_math_renderer = "mathml"
bibtex_bibfiles = ["references.bib"]

html_theme = "pydata_sphinx_theme"
html_title = "wsrender"
templates_path = ["_templates"]
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = html_show_sourcelink = False
html_favicon = "_static/icon.svg"
html_context = {"default_mode": "auto"}  # otherwise the theme reports a mode that is none
html_theme_options = {
    "logo": {"text": "wsrender"},
    "navbar_end": ["theme-switcher"],
    "secondary_sidebar_items": ["page-toc"],
    "show_toc_level": 2,
    "footer_start": ["copyright"],
    "footer_end": [],
}

# The gallery's scripts, run in alphabetical order, and the tutorials. DOCS_GALLERY: names of those to run, apart by
# commas; without it all are, and where it is empty none.
EXTRA = HERE / "generated" / "extra"  # what is copied to the site as it is
EXTRA.mkdir(parents=True, exist_ok=True)
html_extra_path = [str(EXTRA.relative_to(HERE))]
_chosen = os.environ.get("DOCS_GALLERY")
tutorials_run = None if _chosen is None else _chosen.split(",")
_names = "|".join(name for name in (_chosen or "").split(",") if name) or "(?!)"
sphinx_gallery_conf = {
    "examples_dirs": ["gallery"],
    "gallery_dirs": ["generated/gallery"],
    "subsection_order": [f"gallery/{name}" for name in ("reach", "cell", "targets", "arms", "mechanisms", "practice")],
    "within_subsection_order": "FileNameSortKey",
    "filename_pattern": "/plot_" if _chosen is None else f"/({_names})\\.py$",
    "image_scrapers": (Shown(EXTRA / "views"),),
    "reset_modules": (),
    "capture_repr": ("_repr_html_",),
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_memory": False,
    "show_signature": False,
    "min_reported_time": 1e9,
    "write_computation_times": False,  # its pages ask other hosts
    "plot_gallery": "True",
}
