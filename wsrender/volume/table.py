"""Tables: named columns of one length, such as a curve or a list of points."""

from dataclasses import dataclass, field

import numpy as np

from wsrender.errors import InputError


@dataclass(frozen=True, eq=False)
class Table:
    """Columns of one length N, each (N,) or (N, k), of numbers, truth values or text; units by column ("1": none).

    Raises InputError, naming the column, where its shape is not that of the others.
    """

    columns: dict[str, np.ndarray]
    units: dict[str, str] = field(default_factory=dict)

    def __post_init__(self):
        for name, column in self.columns.items():
            if column.ndim not in (1, 2) or len(column) != len(self):
                raise InputError(name, f"has shape {column.shape}; the table has {len(self)} rows")

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    def __getitem__(self, name: str) -> np.ndarray:
        return self.columns[name]
