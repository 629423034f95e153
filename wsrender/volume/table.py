"""Tables: named columns of one length, such as a curve or a list of points."""

from dataclasses import dataclass, field

import numpy as np

from wsrender.errors import InputError
from wsrender.notebook import mime_bundle
from wsrender.short_repr import short_names


@dataclass(frozen=True)
class CellGrid:
    """Cells that the rows of a table stand for, those of the last axis first.

    ``axes``: the columns of their centres; ``origin``: the lower corner of the first, ``step``: their edges, in the
    units of these columns; ``shape``: how many along each axis; ``frame``: that of the coordinates.
    """

    axes: tuple[str, ...]
    origin: tuple[float, ...]
    step: tuple[float, ...]
    shape: tuple[int, ...]
    frame: str = "world"


@dataclass(frozen=True, eq=False)
class Table:
    """Columns of one length N, each (N,) or (N, k), of numbers, truth values or text; units by column ("1": none).

    ``grid``: what cells the rows are, if they are any; such a table is a map, and saved as arrays of the grid's shape
    too. Raises InputError, naming the column, where its shape is not that of the others.
    """

    columns: dict[str, np.ndarray]
    units: dict[str, str] = field(default_factory=dict)
    grid: CellGrid | None = None

    def __post_init__(self):
        for name, column in self.columns.items():
            if column.ndim not in (1, 2) or len(column) != len(self):
                raise InputError(name, f"has shape {column.shape}; the table has {len(self)} rows")

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    def __repr__(self) -> str:
        return f"<Table: {len(self):,} rows of {short_names(self.columns, self.units)}>"

    _repr_mimebundle_ = mime_bundle

    def __getitem__(self, name: str) -> np.ndarray:
        return self.columns[name]
