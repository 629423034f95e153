"""The reproductions by name."""

from collections.abc import Callable

from wsrender.errors import InputError
from wsrender.reproduce.alciatore import alciatore
from wsrender.reproduce.five_bar import five_bar
from wsrender.reproduce.gao import gao
from wsrender.reproduce.row import Row
from wsrender.reproduce.shah import shah
from wsrender.reproduce.zhang import mapping, table_3, table_6
from wsrender.run.steps import Progress

CASES: dict[str, Callable[[Progress | None], list[Row]]] = {
    "wsrender-table-3": table_3,
    "wsrender-table-6": table_6,
    "wsrender-mapping": mapping,
    "gao": gao,
    "five-bar": five_bar,
    "shah": shah,
    "alciatore": alciatore,
}


def reproduce(name: str, progress: Progress | None = None) -> list[Row]:
    """Run the published cases of a name; InputError lists the names."""
    if name not in CASES:
        raise InputError("NAME", f"{name!r} is not a reproduction; allowed: {', '.join(CASES)}")
    return CASES[name](progress)
