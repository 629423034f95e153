"""Jupyter notebooks: whether this process runs one, and what is displayed there."""

import sys
from importlib import import_module
from typing import Any

_CARDS = "wsrender.results.cards"  # of a layer above, which is read by name alone


def in_notebook() -> bool:
    """Whether the code runs in a kernel whose front end shows rich output; a terminal's IPython does not."""
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    return getattr(shell, "kernel", None) is not None


def mime_bundle(what: Any, include: Any = None, exclude: Any = None) -> dict[str, Any]:
    """A notebook's display of ``what``, as a method ``_repr_mimebundle_``; elsewhere, as in a terminal, its text."""
    return import_module(_CARDS).mime_bundle(what) if in_notebook() else {"text/plain": repr(what)}


def display(what: Any) -> Any:
    """Show an object below the cell; the handle whose ``update`` puts another in its place."""
    from IPython.display import display

    return display(what, display_id=True)
