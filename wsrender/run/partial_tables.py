"""Tables ↔ arrays of a partial result."""

import json
from collections.abc import Mapping

import numpy as np

from wsrender.volume.table import Table

UNITS = "tables"  # array with the units of every table, as JSON


def arrays_of_tables(tables: Mapping[str, Table]) -> dict[str, np.ndarray]:
    """The columns of tables as arrays, ``name:column`` each; names hold no colon."""
    units = np.array(json.dumps({name: table.units for name, table in tables.items()}))
    columns = {f"{name}:{key}": values for name, table in tables.items() for key, values in table.columns.items()}
    return {UNITS: units, **columns}


def tables_of_arrays(partial: Mapping[str, np.ndarray]) -> dict[str, Table]:
    """The tables that `arrays_of_tables` has put into a partial result."""
    tables = {}
    for name, units in json.loads(str(partial[UNITS])).items():
        columns = {key.partition(":")[2]: array for key, array in partial.items() if key.partition(":")[0] == name}
        tables[name] = Table({key: array for key, array in columns.items() if key}, units)
    return tables
