"""Pictures by matplotlib, drawn without a display and without pyplot's global state.

Every function returns a ``matplotlib.figure.Figure`` that notebooks show; ``save_figure`` writes it. The functions are
loaded on first use, because matplotlib is heavy.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from wsrender.errors import MissingExtraError

if TYPE_CHECKING:
    from wsrender.results.drawing.distribution import histogram, write_histogram_csv
    from wsrender.results.drawing.faces import Faces, faces_of
    from wsrender.results.drawing.faces_of_surface import surface_faces
    from wsrender.results.drawing.paper import png, save_figure
    from wsrender.results.drawing.planes import slice_plane, slices
    from wsrender.results.drawing.point_cloud import scatter
    from wsrender.results.drawing.result_plots import ResultPlots
    from wsrender.results.drawing.stick_figure import robot
    from wsrender.results.drawing.table_curves import curves
    from wsrender.results.drawing.vector_field import vector_planes
    from wsrender.results.drawing.warned import heading

# Modules are not called like their functions: importing one would hide the function.
_MODULES = {
    "Faces": "faces",
    "ResultPlots": "result_plots",
    "curves": "table_curves",
    "faces_of": "faces",
    "heading": "warned",
    "histogram": "distribution",
    "png": "paper",
    "robot": "stick_figure",
    "save_figure": "paper",
    "scatter": "point_cloud",
    "slice_plane": "planes",
    "slices": "planes",
    "surface_faces": "faces_of_surface",
    "vector_planes": "vector_field",
    "write_histogram_csv": "distribution",
}

__all__ = [
    "Faces",
    "ResultPlots",
    "curves",
    "faces_of",
    "heading",
    "histogram",
    "png",
    "robot",
    "save_figure",
    "scatter",
    "slice_plane",
    "slices",
    "surface_faces",
    "vector_planes",
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
