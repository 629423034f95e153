"""``wsrender reproduce``: published cases, run again."""

import json
import sys
from dataclasses import asdict
from typing import Annotated, Any

import typer
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from wsrender.cli.completion import one_of
from wsrender.cli.faults import one_line_faults
from wsrender.progress import RunProgress

# Of wsrender.reproduce.CASES, which are slow to import.
NAMES = ("wsrender-table-3", "wsrender-table-6", "wsrender-mapping", "gao", "five-bar", "shah", "alciatore")
PIPED_WIDTH = 260  # columns off a terminal: one value a line


def reproduce(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help=f"One of {', '.join(NAMES)}.", autocompletion=one_of(*NAMES))
    ],
    as_json: Annotated[bool, typer.Option("--json", help="Print the rows as JSON.")] = False,
    traceback: Annotated[bool, typer.Option("--traceback", help="Show where an error came from.")] = False,
) -> None:
    """Run published cases again; print what was published, what comes out here, what is exact, and why they differ."""
    with one_line_faults(traceback):
        from wsrender.reproduce import reproduce as run_again

        with RunProgress() as progress:
            rows = run_again(name, progress)
        if as_json:
            found = [asdict(r) | {"from_published": r.from_published, "from_exact": r.from_exact} for r in rows]
            typer.echo(json.dumps(found, indent=2, ensure_ascii=False))
        else:
            console = Console() if sys.stdout.isatty() else Console(width=PIPED_WIDTH)
            console.print(_table(rows))


def _table(rows: list[Any]) -> Table:
    table = Table(box=SIMPLE_HEAD, show_edge=False, pad_edge=False)
    for column in ("case", "quantity"):
        table.add_column(column, no_wrap=True)
    for column in ("published", "reproduced", "exact", "− published", "− exact"):
        table.add_column(column, justify="right", no_wrap=True)
    for column in ("unit", "note"):
        table.add_column(column)
    for row in rows:
        interval = "" if row.low is None else f"95 %: {row.low:.5g} … {row.high:.5g}"
        table.add_row(
            row.case,
            row.quantity,
            _number(row.published),
            _number(row.reproduced),
            _number(row.exact),
            _difference(row.from_published, row.published),
            _difference(row.from_exact, row.exact),
            "" if row.unit == "1" else row.unit,
            "; ".join(filter(None, (interval, row.note))),
        )
    return table


def _number(value: float | None) -> str:
    return "–" if value is None else f"{value:.6g}"


def _difference(value: float | None, reference: float | None) -> str:
    return "–" if value is None or not reference else f"{value:+.2g} ({100 * value / reference:+.3g} %)"
