"""Long lists of numbers that stand in a file instead of the document."""

from collections.abc import Iterator
from typing import Any

from wsrender.documents.document import Document
from wsrender.documents.quantities import Name, Sha256

TABLE_TYPES = {".csv": "text/csv", ".parquet": "application/vnd.apache.parquet", ".npy": "application/x-npy"}
"""Media types of tables by the endings of their files."""


class ArrayFile(Document):
    """Rows of numbers in a file: a .npy array, or a Parquet or CSV table of numeric columns.

    Columns are named as what they hold, or stand in its order.
    """

    path: Name | None = None
    """A .csv, .parquet or .npy file; local runs only."""
    model: Sha256 | None = None
    """SHA-256 of such a file that was uploaded to a server, 64 hexadecimal digits."""

    def __init__(self, path: Any = None, /, **values: Any):
        Document.__init__(self, **values if path is None else {"path": str(path), **values})

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if (self.path is None) == (self.model is None):
            yield "path", 'must be given, or else "model": one of the two'
        if self.path is not None and not self.path.lower().endswith((*TABLE_TYPES,)):
            yield "path", f'must end in {", ".join(TABLE_TYPES)}, not "{self.path}"'
