"""Which pictures there are of a result."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from wsrender.results.drawing.result_plots import ResultPlots

Pictures = dict[str, Callable[[], Figure]]
CURVES = ("scan", "refinements", "scales", "convergence")  # tables that are drawn against their first column


def pictures_of(plot: ResultPlots, document: Mapping[str, Any]) -> Pictures:
    """What draws each picture that a result has data for, by its name; ``document`` is the result document."""
    pictures = _of_samples(plot)
    pictures |= {name: partial(plot.curves, name) for name in CURVES if len(plot.tables.get(name, ()))}
    if plot.volume is not None and plot.volume.vectors and plot.volume.n_occupied:
        pictures["field"] = plot.vectors
    if {"posture", "ellipsoids"} <= set(plot.tables):
        pictures["posture"] = plot.posture
    if plot.volume is not None and plot.volume.statistics.get("product"):
        pictures["product"] = partial(plot.slices, statistic="product")
    analysis = document.get("analysis")
    return pictures | (_OF_ANALYSES[analysis](plot, document) if analysis in _OF_ANALYSES else {})


def _of_samples(plot: ResultPlots) -> Pictures:
    """The arm, its samples and voxels."""
    pictures: Pictures = {}
    if plot.skeleton is not None and len(plot.skeleton):
        pictures["robot"] = plot.robot
    if plot.samples is not None and len(plot.samples):
        pictures["scatter"] = plot.scatter
    if plot.volume is not None and plot.volume.n_occupied:
        pictures["slices"] = plot.slices
    if "scatter" in pictures and plot.samples is not None and plot.samples.indices:
        pictures["histogram"] = plot.histogram
    return pictures


def _of_mapping(plot: ResultPlots, document: Mapping[str, Any]) -> Pictures:
    return {"mapping": plot.mapping} if "mapping" in plot.tables else {}


def _of_mechanism(plot: ResultPlots, document: Mapping[str, Any]) -> Pictures:
    pictures: Pictures = {"surface": partial(plot.surface, "workspace")} if "workspace" in plot.meshes else {}
    return pictures | ({"orientations": plot.orientations} if "orientations" in plot.tables else {})


def _of_five_bar(plot: ResultPlots, document: Mapping[str, Any]) -> Pictures:
    """κ(A), κ(B) and κ(J) in both spaces, and the aspects."""
    pictures: Pictures = {"aspects": plot.aspects}
    for space in ("cartesian", "joint"):
        for matrix in "abj":
            pictures[f"kappa_{matrix}_{space}"] = partial(plot.conditioning, matrix, space)
    return pictures


def _of_design(plot: ResultPlots, document: Mapping[str, Any]) -> Pictures:
    """A sweep over one or two parameters, the first two objectives of a Pareto search, the best design's surface."""
    pictures: Pictures = {"best": partial(plot.surface, "best")} if "best" in plot.meshes else {}
    if "sweep" in plot.tables and document["best"] is not None:
        parameters = document["parameters"]
        values = [array for name, array in list(plot.tables["sweep"].columns.items())[:2]]
        if len(parameters) == 1:
            pictures["sweep"] = partial(plot.curves, "sweep")
        elif len(parameters) == 2 and min(len(np.unique(array)) for array in values) > 1:
            pictures["sweep"] = plot.sweep
    if len(plot.tables.get("pareto", ())):
        names = [objective["name"] for objective in document["objectives"]]
        pictures["pareto"] = partial(plot.trade_off, *names[:2])
    return pictures


def _of_targets(plot: ResultPlots, document: Mapping[str, Any]) -> Pictures:
    return {"targets": plot.targets} if len(plot.tables.get("targets", ())) else {}


_OF_ANALYSES: dict[str, Callable[[ResultPlots, Mapping[str, Any]], Pictures]] = {
    "reachability": _of_targets,
    "planar_boundary": lambda plot, _: {"boundary": plot.boundary},
    "boundary_patches": lambda plot, _: {"patches": plot.patches} if "patches" in plot.meshes else {},
    "master_slave_mapping": _of_mapping,
    "parallel_workspace": _of_mechanism,
    "five_bar": _of_five_bar,
    "method_comparison": lambda plot, _: {"methods": plot.methods},
    "design_optimization": _of_design,
    "robot_comparison": lambda plot, _: {"comparison": plot.side_by_side},
}
