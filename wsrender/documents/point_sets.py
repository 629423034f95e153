"""Workspaces as points: in the document itself, or in a file of the user's own."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import BeforeValidator

from wsrender.documents.document import Document
from wsrender.documents.quantities import Name, points_of
from wsrender.errors import InputError

MOST_POINTS = 10_000_000


def _points(value: Any) -> tuple[Any, ...] | None:
    if value is None:
        return None
    points = points_of(value)
    if not points:
        raise ValueError("must be a list of points [x, y, z], finite numbers")
    return points


class PointSet(Document):
    """Points that an end effector reaches [m, world frame]."""

    long_fields: ClassVar[tuple[str, ...]] = ("points",)

    points: Annotated[tuple[tuple[float, float, float], ...] | None, BeforeValidator(_points)] = None
    """The points [x, y, z]."""
    path: Name | None = None
    """A .npy or .csv file of shape (N, 3), a header line allowed in CSV; local runs only."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if (self.points is None) == (self.path is None):
            yield "points", 'must be given, or else "path": one of the two'

    def array(self) -> np.ndarray:
        """The points, (N, 3) float64; InputError where the file cannot be read or holds something else."""
        if self.path is None:
            return np.array(self.points, np.float64)
        path = Path(self.path)
        try:
            points = np.load(path, allow_pickle=False) if path.suffix == ".npy" else _read_csv(path)
            points = np.asarray(points, np.float64)
        except (OSError, ValueError, EOFError) as error:
            raise InputError("path", f"{path} cannot be read as points: {error}") from error
        if points.ndim != 2 or points.shape[1] != 3 or not len(points) or not np.isfinite(points).all():
            raise InputError("path", f"{path} must hold finite numbers of shape (N, 3), not {points.shape}")
        return points


def _read_csv(path: Path) -> np.ndarray:
    with path.open(encoding="utf-8-sig") as file:
        first = file.readline().replace(",", " ").split()
    try:
        [float(word) for word in first]
        header = 0
    except ValueError:
        header = 1
    return np.loadtxt(path, delimiter=",", skiprows=header, ndmin=2, encoding="utf-8-sig")


def is_point_set(value: Any) -> bool:
    """Whether a part of a document is meant as points."""
    return isinstance(value, PointSet) or (isinstance(value, Mapping) and bool({"points", "path"} & set(value)))
