"""Values of a result document as HTML; everything is escaped, for names and labels may hold anything."""

from collections.abc import Iterator, Mapping, Sequence
from html import escape
from typing import Any

import numpy as np

from wsrender.indices.units import pretty_unit
from wsrender.volume.table import Table

MOST_ROWS = 40  # of a table; the file beside the report has all
_UNITS = ("m6", "m3", "m2", "m", "s", "rad", "deg")  # at the end of keys


def label(key: str) -> str:
    """A key as people read it: ``voxel size [m]`` for ``voxel_size_m``."""
    if key == "ci95":
        return "95 % interval"
    name, _, ending = key.rpartition("_")
    if name and ending in _UNITS:
        return f"{name.replace('_', ' ')} [{pretty_unit(ending)}]"
    return key.replace("_", " ")


def number(value: float) -> str:
    """A number with at most six digits; the element keeps all of them."""
    return f'<data value="{value!r}">{value:.6g}</data>' if isinstance(value, float) else f"{value}"


def value_html(value: Any) -> str:
    """Any value of a document: numbers, text, lists, and what is nested in them."""
    if value is None or value == {}:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int | float):
        return number(value)
    if isinstance(value, Mapping):
        return facts_html(value)
    if isinstance(value, list | tuple):
        return _list_html(value)
    return escape(str(value))


def _list_html(values: Sequence[Any]) -> str:
    if values and all(isinstance(item, Mapping) for item in values):
        nested = any(isinstance(part, Mapping) for item in values for part in item.values())
        return "".join(map(_titled, values)) if nested else records_html(values)
    if values and all(isinstance(item, list | tuple) for item in values):
        rows = "".join(f"<tr>{_cells(row)}</tr>" for row in values[:MOST_ROWS])
        return f"<table class=matrix>{rows}</table>{_rest(len(values))}"
    return ", ".join(value_html(item) for item in values) or "–"


def _titled(record: Mapping[str, Any]) -> str:
    """A record too deep for the row of a table, under its name."""
    rest = {key: value for key, value in record.items() if key != "name"}
    return f"<h3>{escape(str(record.get('name', '')))}</h3>{facts_html(rest)}"


def facts_html(facts: Mapping[str, Any]) -> str:
    """Names and values, one a line; a mapping of alike mappings becomes one table."""
    if _alike(facts.values()):
        return records_html([{"": name, **record} for name, record in facts.items()])
    rows = "".join(f"<tr><th>{escape(label(key))}</th><td>{value_html(_cell(facts, key))}</td></tr>" for key in facts)
    return f"<table class=facts>{rows}</table>"


def records_html(records: Sequence[Mapping[str, Any]]) -> str:
    """Mappings as the rows of a table whose columns are all their keys."""
    keys = list(dict.fromkeys(key for record in records for key in record))
    head = "".join(f"<th>{escape(label(key))}</th>" for key in keys)
    rows = "".join(f"<tr>{_cells([_cell(record, key) for key in keys])}</tr>" for record in records[:MOST_ROWS])
    return f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>{_rest(len(records))}"


def table_html(table: Table, most_rows: int = MOST_ROWS) -> str:
    """The first rows of a table, with units."""
    head = "".join(f"<th>{escape(_column_label(name, table.units.get(name)))}</th>" for name in table.columns)
    rows = "".join(f"<tr>{_cells(row)}</tr>" for row in _table_rows(table, most_rows))
    return f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>{_rest(len(table), most_rows)}"


def _table_rows(table: Table, most_rows: int) -> Iterator[list[Any]]:
    for row in range(min(len(table), most_rows)):
        record = {name: _plain(column[row]) for name, column in table.columns.items()}
        yield [_cell(record, name) for name in record]


def _plain(value: Any) -> Any:
    """A NumPy value as Python's; what JSON has no number for as text."""
    value = value.tolist() if isinstance(value, np.ndarray | np.generic) else value
    return str(value) if isinstance(value, float) and not np.isfinite(value) else value


def _column_label(name: str, unit: str | None) -> str:
    return label(name) if unit in (None, "", "1") else f"{name.replace('_', ' ')} [{pretty_unit(unit)}]"


def _cell(record: Mapping[str, Any], key: str) -> Any:
    value = record.get(key)
    return pretty_unit(value) if key == "unit" and isinstance(value, str) else value


def _cells(values: Sequence[Any]) -> str:
    return "".join(
        f"<td{' class=number' if isinstance(value, int | float) else ''}>{value_html(value)}</td>" for value in values
    )


def _alike(values: Any) -> bool:
    """Whether values are mappings of plain values, and lists of them, that share their first key."""
    records = list(values)
    flat = all(isinstance(record, Mapping) and record and all(map(_is_plain, record.values())) for record in records)
    return len(records) > 0 and flat and len({next(iter(record)) for record in records}) == 1


def _is_plain(value: Any) -> bool:
    parts = value if isinstance(value, list | tuple) else [value]
    return not any(isinstance(part, Mapping | list | tuple) for part in parts)


def _rest(rows: int, most_rows: int = MOST_ROWS) -> str:
    return f"<p class=note>{rows:,} rows; the first {most_rows} are shown.</p>" if rows > most_rows else ""
