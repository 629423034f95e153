"""What an analysis adds to the view of its results: what only it knows of its document and tables."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.results.view.manifest import Mapping, Plot, Quantity, Skeleton, ViewCurves
from wsrender.results.view.words import said, unit_said
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

if TYPE_CHECKING:
    from wsrender.results.drawing.faces import Faces


@dataclass(frozen=True, eq=False)
class Arrows:
    """Arrows from ``origins`` (N, 3) [m] along ``vectors`` (N, 3) in ``unit``, in world axes."""

    name: str
    origins: np.ndarray
    vectors: np.ndarray
    unit: str = "1"


@dataclass(frozen=True, eq=False)
class Additions:
    """Parts of a manifest, after those that any result has.

    ``faces``: those of meshes by name that no table of surfaces names.
    ``in_plane``: the frame (4, 4) in the world in whose xy plane the tables of lines and arcs lie.
    """

    skeletons: Sequence[Skeleton] = ()
    curves: Sequence[ViewCurves] = ()
    plots: Sequence[Plot] = ()
    arrows: Sequence[Arrows] = ()
    volumes: dict[str, VolumeData] = field(default_factory=dict)
    faces: "dict[str, Faces]" = field(default_factory=dict)
    mapping: Mapping | None = None
    in_plane: np.ndarray = field(default_factory=lambda: np.eye(4))


def lines(name: str, label: str, points: Sequence[np.ndarray], closed: bool = False) -> ViewCurves:
    """Lines through points (N, 2) or (N, 3) [m] each; those of a plane lie at z = 0."""
    return {"name": name, "label": label, "closed": closed, "points": [vectors(each) for each in points]}


def vectors(points: np.ndarray) -> list[Any]:
    """Points (N, 2) or (N, 3) as JSON, without those that are not finite."""
    points = np.asarray(points, float)
    points = points[np.isfinite(points).all(axis=1)]
    flat = np.zeros((len(points), 3 - points.shape[1]))
    return list(map(tuple, np.concatenate([points, flat], axis=1).tolist()))


def curve_plot(name: str, label: str, table: Table, across: str, upwards: Sequence[str]) -> Plot:
    """Columns of a table against another, in the order of that."""
    order = np.argsort(table[across], kind="stable")
    return {
        "name": name,
        "label": label,
        "kind": "curve",
        "x": quantity(across, table.units.get(across), table[across][order]),
        "y": [quantity(each, table.units.get(each), table[each][order]) for each in upwards],
    }


def quantity(name: str, unit: str | None, values: np.ndarray) -> Quantity:
    """Numbers of a plot; those that are not finite are None."""
    numbers = [value if np.isfinite(value) else None for value in np.asarray(values, float).tolist()]
    return {"label": said(name), "unit": unit_said(unit), "values": numbers}
