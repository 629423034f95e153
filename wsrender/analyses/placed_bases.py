"""Where bases may stand, and stand, as the analyses of placements tell it: units, cells, and lines of a summary."""

from collections.abc import Iterable, Mapping
from typing import Any

from wsrender.documents.placements import ANGLES, COORDINATES, PlacementSpace
from wsrender.volume.table import CellGrid

UNITS = {name: "deg" if name in ANGLES else "m" for name in COORDINATES}


def grid_of(over: PlacementSpace, axes: Iterable[str]) -> CellGrid:
    """The cells of some of the ranges of a space."""
    axes = tuple(axes)
    steps = tuple(over.ranges[name][2] for name in axes)
    origin = [float(over.values(name)[0] - step / 2) for name, step in zip(axes, steps, strict=True)]
    return CellGrid(axes, tuple(origin), steps, tuple(over.shape[COORDINATES.index(name)] for name in axes))


def place_of(entry: Mapping[str, Any]) -> str:
    """Where a base stands, (x, y, z) m, (roll, pitch, yaw)°, of an entry that holds its coordinates."""
    place, turn = (", ".join(f"{entry[name]:.4g}" for name in part) for part in (COORDINATES[:3], ANGLES))
    return f"({place}) m, ({turn})°"
