"""Tables in a partial result."""

from collections.abc import Mapping

from wsrender.analyses.partial_result import PartialResult
from wsrender.volume.table import Table

TABLES = "tables"  # the fact that holds the units of every table


def with_tables(partial: PartialResult, tables: Mapping[str, Table]) -> PartialResult:
    """A partial result with the columns of tables as arrays, ``name:column`` each; names hold no colon."""
    columns = {f"{name}:{key}": values for name, table in tables.items() for key, values in table.columns.items()}
    units = {name: table.units for name, table in tables.items()}
    return PartialResult({**partial.arrays, **columns}, {**partial.facts, TABLES: units})


def tables_of(partial: PartialResult) -> dict[str, Table]:
    """The tables that `with_tables` has put into a partial result."""
    tables = {}
    for name, units in partial.facts[TABLES].items():
        columns = {key.partition(":")[2]: array for key, array in partial.arrays.items() if key.startswith(f"{name}:")}
        tables[name] = Table(columns, units)
    return tables
