"""Workspaces as points: in the document itself, or in a file of the user's own."""

from collections.abc import Iterator, Mapping
from os import PathLike, fspath
from typing import Annotated, Any, ClassVar

from pydantic import BeforeValidator, Field

from wsrender.documents.array_files import ArrayFile
from wsrender.documents.document import Document
from wsrender.documents.quantities import Name, Sha256, is_none, numbers_of, points_of, rows_of

HEADERS = (("x", "y", "z"), ("x_m", "y_m", "z_m"))
"""Names that the columns of a file may have."""
PLANE_HEADERS = (("x", "y"), ("x_m", "y_m"))
"""Of points in a plane."""
_POINT = tuple[float, float, float]
_PAIRS = rows_of(2)


def _rows_or_file(value: Any) -> Any:
    if isinstance(value, str | PathLike):
        value = {"path": fspath(value)}
    return ArrayFile.model_validate(value) if isinstance(value, Mapping | ArrayFile) else _PAIRS.func(value)  # type: ignore[call-arg]


PairsOrFile = Annotated[
    tuple[tuple[float, float], ...] | ArrayFile,
    Field(union_mode="left_to_right"),
    BeforeValidator(_rows_or_file, json_schema_input_type=_PAIRS.json_schema_input_type | ArrayFile),
]
"""Rows of two numbers, a single one as it is, or a file of them."""


def _points(value: Any) -> tuple[Any, ...] | None:
    if value is None:
        return None
    points = points_of([value] if numbers_of(value) else value)  # a single point as it is
    if not points:
        raise ValueError("must be a list of points [x, y, z], finite numbers")
    return points


class PointSet(Document):
    """Points that an end effector reaches [m, world frame]."""

    long_fields: ClassVar[tuple[str, ...]] = ("points",)

    points: Annotated[
        tuple[_POINT, ...] | None, BeforeValidator(_points, json_schema_input_type=tuple[_POINT, ...] | _POINT | None)
    ] = None
    """The points [x, y, z], or a single one."""
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
