"""3-D pictures by PyVista (extra ``render``), drawn without a display in a process of their own.

``Result.render`` makes them. Nothing here imports PyVista into the caller's process: a missing OpenGL library crashes
VTK, and then only that process. The names are loaded on first use.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from wsrender.errors import MissingExtraError

if TYPE_CHECKING:
    from wsrender.results.render.composition import picture
    from wsrender.results.render.environment import Box, Floor, Table
    from wsrender.results.render.subject import Subject, own_robot
    from wsrender.results.render.views import VIEWS

# Modules are not called like their functions: importing one would hide the function.
_MODULES = {
    "Box": "environment",
    "Floor": "environment",
    "Subject": "subject",
    "Table": "environment",
    "VIEWS": "views",
    "own_robot": "subject",
    "picture": "composition",
}

__all__ = ["VIEWS", "Box", "Floor", "Subject", "Table", "own_robot", "picture"]


def __getattr__(name: str):
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    try:
        module = import_module(f"{__name__}.{_MODULES[name]}")
    except ModuleNotFoundError as error:
        raise MissingExtraError(error.name or name, "render") from error
    return getattr(module, name)
