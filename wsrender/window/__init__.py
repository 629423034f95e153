"""The viewer around a result or a robot: a tab of the browser, or a notebook's widget."""

import sys
from typing import TYPE_CHECKING, Any

from wsrender.notebook import in_notebook
from wsrender.results.view import View, robot_view, view_of
from wsrender.results.view.interactive import Interactive
from wsrender.robot import Robot
from wsrender.window.local import LocalView
from wsrender.window.widget import widget_of

if TYPE_CHECKING:
    from wsrender.results.result import Result


def show(what: "Result | Robot", port: int = 0, block: bool | None = None) -> Any:
    """The viewer around ``what``: in a notebook a widget, else a tab of the browser, as a `LocalView`.

    ``block``: return when the program is told to stop (Ctrl-C); by default in a script, whose end would close the view,
    not at a prompt. Raises InputError for a port in use, MissingExtraError in a notebook without the extra
    ``notebook``.
    """
    if in_notebook():
        return in_widget(what)
    tab = in_tab(what, port)
    tab.open()
    if block if block is not None else not hasattr(sys, "ps1"):
        print(f"wsrender shows {tab.view.manifest['title']} in the browser: {tab.url}\nCtrl-C ends it.", flush=True)
        tab.wait()
    return tab


def in_tab(what: "Result | Robot", port: int = 0) -> LocalView:
    """``what``, served on a loopback port for the browser that opens its link. Raises InputError for a port in use."""
    view, answering = _shown(what)
    return LocalView(view, answering, port)


def in_widget(what: "Result | Robot") -> Any:
    """``what`` in a notebook. Raises MissingExtraError without the extra ``notebook``."""
    return widget_of(*_shown(what))


def _shown(what: "Result | Robot") -> tuple[View, Interactive]:
    if isinstance(what, Robot):
        return robot_view(what), Interactive({}, [what])
    return view_of(what), Interactive.of_result(what)
