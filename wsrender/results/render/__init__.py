"""3-D pictures by PyVista (extra ``render``), drawn without a display in a process of their own.

``Result.render`` makes them. Nothing here imports PyVista into the caller's process: a missing OpenGL library crashes
VTK, and then only that process. The names are loaded on first use.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from wsrender.errors import MissingExtraError

if TYPE_CHECKING:
    from wsrender.results.render.composition import picture
    from wsrender.results.render.environment import Floor
    from wsrender.results.render.environment import RenderedBox as Box
    from wsrender.results.render.environment import RenderedTable as Table
    from wsrender.results.render.subject import Subject, own_robot
    from wsrender.results.render.views import VIEWS

# Modules are not called like their functions: importing one would hide the function. Here a module and a name within.
_PLACES = {
    "Box": ("environment", "RenderedBox"),
    "Floor": ("environment", "Floor"),
    "Subject": ("subject", "Subject"),
    "Table": ("environment", "RenderedTable"),
    "VIEWS": ("views", "VIEWS"),
    "own_robot": ("subject", "own_robot"),
    "picture": ("composition", "picture"),
}

__all__ = ["VIEWS", "Box", "Floor", "Subject", "Table", "own_robot", "picture"]


def __getattr__(name: str):
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    try:
        module = import_module(f"{__name__}.{_PLACES[name][0]}")
    except ModuleNotFoundError as error:
        raise MissingExtraError(error.name or name, "render") from error
    return getattr(module, _PLACES[name][1])
