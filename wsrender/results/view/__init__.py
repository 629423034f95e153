"""The view of a result or a robot in a browser: a manifest in JSON, and bulk data as blobs by name.

Names are imported when they are first used: the server's process makes no view.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from wsrender.results.view.edited import Edited
    from wsrender.results.view.view import View, edited_view, robot_view, view_of

__all__ = ["Edited", "View", "edited_view", "robot_view", "view_of"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__} has no attribute {name}")
    return getattr(import_module(f"{__name__}.{'edited' if name == 'Edited' else 'view'}"), name)
