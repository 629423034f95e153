"""Pictures by matplotlib, drawn without a display and without pyplot's global state.

Every function returns a ``matplotlib.figure.Figure`` that notebooks show; ``save_figure`` writes it. The functions are
loaded on first use, because matplotlib is heavy.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from wsrender.errors import MissingExtraError

if TYPE_CHECKING:
    from wsrender.results.drawing.arm_plane import planar_boundary
    from wsrender.results.drawing.comparison import side_by_side
    from wsrender.results.drawing.designs import sweep_surface, trade_off
    from wsrender.results.drawing.distribution import histogram, write_histogram_csv
    from wsrender.results.drawing.faces import Faces, faces_of
    from wsrender.results.drawing.faces_of_surface import surface_faces
    from wsrender.results.drawing.five_bar import aspect_maps, conditioning_maps
    from wsrender.results.drawing.listing import pictures_of
    from wsrender.results.drawing.master_slave import mapped_points
    from wsrender.results.drawing.method_comparison import errors_by_size
    from wsrender.results.drawing.orientation_map import orientations
    from wsrender.results.drawing.paper import png, save_figure
    from wsrender.results.drawing.planes import slice_plane, slices
    from wsrender.results.drawing.point_cloud import scatter
    from wsrender.results.drawing.posture import limits_and_ellipsoids
    from wsrender.results.drawing.result_plots import ResultPlots
    from wsrender.results.drawing.stick_figure import robot
    from wsrender.results.drawing.table_curves import curves
    from wsrender.results.drawing.targets import labelled_targets
    from wsrender.results.drawing.vector_field import vector_planes
    from wsrender.results.drawing.warned import heading

# Modules are not called like their functions: importing one would hide the function.
_MODULES = {
    "Faces": "faces",
    "ResultPlots": "result_plots",
    "aspect_maps": "five_bar",
    "conditioning_maps": "five_bar",
    "curves": "table_curves",
    "errors_by_size": "method_comparison",
    "faces_of": "faces",
    "heading": "warned",
    "histogram": "distribution",
    "labelled_targets": "targets",
    "png": "paper",
    "limits_and_ellipsoids": "posture",
    "mapped_points": "master_slave",
    "orientations": "orientation_map",
    "pictures_of": "listing",
    "planar_boundary": "arm_plane",
    "robot": "stick_figure",
    "save_figure": "paper",
    "scatter": "point_cloud",
    "side_by_side": "comparison",
    "slice_plane": "planes",
    "slices": "planes",
    "surface_faces": "faces_of_surface",
    "sweep_surface": "designs",
    "trade_off": "designs",
    "vector_planes": "vector_field",
    "write_histogram_csv": "distribution",
}

__all__ = [
    "Faces",
    "ResultPlots",
    "aspect_maps",
    "conditioning_maps",
    "curves",
    "errors_by_size",
    "faces_of",
    "heading",
    "histogram",
    "labelled_targets",
    "limits_and_ellipsoids",
    "mapped_points",
    "orientations",
    "pictures_of",
    "planar_boundary",
    "png",
    "robot",
    "save_figure",
    "scatter",
    "side_by_side",
    "slice_plane",
    "slices",
    "surface_faces",
    "sweep_surface",
    "trade_off",
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
