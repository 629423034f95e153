"""Configurations that bring the end effector to points of a boundary, from how the sweep made them."""

import numpy as np

from wsrender.geometry.planar.candidates import Source
from wsrender.geometry.planar.curves import TURN
from wsrender.geometry.planar.planar_set import PlanarSet


def postures(swept: PlanarSet, row: int, t: float) -> list[list[float]]:
    """Displacements [rad or m] of the joints, base to tip, that reach the point at ``t`` of a piece.

    One list for each way in which the piece came about: pieces of different origin may coincide.
    """
    point = swept.curves[np.array([row])].at(np.array([t]))[0]
    found = []
    for source in _span(swept, row, t):
        found += [[first, *rest] for first, rest in _through(swept, source, point)]
    return found


def _span(swept: PlanarSet, row: int, t: float) -> tuple[int, ...]:
    """The candidates that made a piece at ``t``."""
    spans = swept.spans[row]
    if swept.curves.arc[row]:
        t = spans[0].low + np.mod(t - spans[0].low, TURN)
    return next((span.made_by for span in spans if t <= span.high), spans[-1].made_by)


def _through(swept: PlanarSet, source: int, point: np.ndarray) -> list[tuple[float, list[float]]]:
    """(displacement of the first joint, displacements of the rest) of the postures by way of one candidate."""
    joint, inner, found = swept.joint, swept.inner, swept.candidates
    assert joint is not None and inner is not None and found is not None
    kind, parent = found.source[source], int(found.parent[source])
    if kind == Source.PATH:
        start = found.point[source]
        first = joint.displacement(start, point)
    else:
        first = joint.low if kind == Source.LOWER else joint.high
        start = joint.move(point, -first)
    if parent < 0:
        return [(first, rest) for rest in _of_point(inner)]
    return [(first, rest) for rest in postures(inner, parent, _parameter(inner, parent, start))]


def _of_point(point: PlanarSet) -> list[list[float]]:
    """Displacements that leave a point where it is: of joints that do not move it, the nearest to 0."""
    rest = []
    while point.joint is not None and point.inner is not None:
        rest.append(float(np.clip(0.0, point.joint.low, point.joint.high)))
        point = point.inner
    return [rest]


def _parameter(inner: PlanarSet, row: int, point: np.ndarray) -> float:
    return float(inner.curves[np.array([row])].parameter(point[None])[0])
