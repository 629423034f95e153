"""Workspaces as points: in the document itself, or in a file of the user's own."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar

from pydantic import BeforeValidator, Field

from wsrender.documents.array_files import ArrayFile
from wsrender.documents.document import Document
from wsrender.documents.quantities import Name, Sha256, is_none, points_of

HEADERS = (("x", "y", "z"), ("x_m", "y_m", "z_m"))
"""Names that the columns of a file may have."""


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
    """A .npy, Parquet or CSV file of three columns, as they stand or named x, y, z; local runs only."""
    model: Annotated[Sha256 | None, Field(exclude_if=is_none)] = None
    """SHA-256 of such a file that was uploaded to a server, 64 hexadecimal digits."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if sum(each is not None for each in (self.points, self.path, self.model)) != 1:
            yield "points", 'must be given, or else "path" or "model": one of them'

    @property
    def given(self) -> tuple[tuple[float, float, float], ...] | ArrayFile:
        """The points, or the file that holds them."""
        return self.points or ArrayFile.model_construct(path=self.path, model=self.model)


def is_point_set(value: Any) -> bool:
    """Whether a part of a document is meant as points."""
    said = isinstance(value, Mapping) and not value.keys().isdisjoint(PointSet.model_fields)
    return said or isinstance(value, PointSet)
