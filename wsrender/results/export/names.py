"""Names of columns and arrays, made from the names that robots and users give."""

import re
from collections.abc import Iterable


def unique_names(names: Iterable[str], kind: str, taken: set[str]) -> dict[str, str]:
    """Name in a file for each name: the name itself where it is free, else with ``kind.`` before it.

    A prismatic joint is often called ``x``, which is also the column of the position. Control characters
    and ``/``, which separates folders in HDF5 and zip files, become ``_``. ``taken`` is extended by the names
    given away.
    """
    result = {}
    for name in names:
        free = re.sub(r"[\x00-\x1f\x7f/]", "_", name)
        while free in taken or not free:
            free = f"{kind}.{free}"
        taken.add(free)
        result[name] = free
    return result
