"""Pictures by matplotlib, drawn without a display and without pyplot's global state.

Every function returns a ``matplotlib.figure.Figure``; ``save_figure`` writes it. The functions are loaded on
first use, because matplotlib is heavy.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from wsrender.errors import MissingExtraError

if TYPE_CHECKING:
    from wsrender.plots.histogram import histogram, write_histogram_csv
    from wsrender.plots.result_plots import ResultPlots
    from wsrender.plots.robot import robot
    from wsrender.plots.scatter import scatter
    from wsrender.plots.slices import slice_plane, slices
    from wsrender.plots.style import save_figure

_MODULES = {
    "ResultPlots": "result_plots",
    "histogram": "histogram",
    "robot": "robot",
    "save_figure": "style",
    "scatter": "scatter",
    "slice_plane": "slices",
    "slices": "slices",
    "write_histogram_csv": "histogram",
}

__all__ = [
    "ResultPlots",
    "histogram",
    "robot",
    "save_figure",
    "scatter",
    "slice_plane",
    "slices",
    "write_histogram_csv",
]


def __getattr__(name: str):
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    try:
        module = import_module(f"{__name__}.{_MODULES[name]}")
    except ModuleNotFoundError as error:
        raise MissingExtraError(error.name or name, "engine") from error
    return getattr(module, name)
