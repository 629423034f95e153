"""Jupyter notebooks: whether this process runs one, what is displayed there, and a bar of progress."""

import sys
import time
from html import escape
from importlib import import_module
from typing import Any

UPDATE_EVERY_S = 0.1
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


class NotebookBar:
    """A bar below the cell; it stays there, full where the work has ended."""

    def __init__(self):
        self._view = _BarView("starting", None, "")
        self._next = 0.0

    def start(self) -> None:
        """Show the bar."""
        self._handle = display(self._view)

    def stop(self, completed: bool) -> None:
        """Leave the bar as it is, or full."""
        share = 1.0 if completed else self._view.share
        self._handle.update(_BarView(self._view.message, share, self._view.note))

    def show(self, share: float | None, message: str, note: str) -> None:
        """Show the part that is done, None: unknown; what is going on; and how fast."""
        self._view = _BarView(message, share, note)
        if time.monotonic() >= self._next:
            self._next = time.monotonic() + UPDATE_EVERY_S
            self._handle.update(self._view)


class _BarView:
    """One state of a bar, as HTML and as text."""

    def __init__(self, message: str, share: float | None, note: str):
        self.message, self.share, self.note = message, share, note

    def _repr_html_(self) -> str:
        value = "" if self.share is None else f' value="{self.share:.4f}"'
        return f'<progress max="1"{value} style="width: 20em"></progress> {escape(repr(self))}'

    def __repr__(self) -> str:
        percent = "" if self.share is None else f"{100 * self.share:.0f} %"
        return f"{self.message}: {', '.join(filter(None, (percent, self.note)))}".removesuffix(": ")
