"""The end of a run: its files written and reported."""

from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from wsrender.cli.faults import NOT_PASSED
from wsrender.errors import InputError
from wsrender.results.export.formats import asked, check_asked, one_of

# Formats of other packages are not listed here: that would load them for every command.
Formats = Annotated[
    list[str] | None, typer.Option("--format", help=f"Also write {one_of(asked(own=True))}; repeatable.")
]


def check_output(output: Path, formats: list[str] | None) -> None:
    """Refuse before a long run what saving would refuse after it; raises InputError."""
    if output.exists() and not output.is_dir():
        raise InputError("--output", f"must be a folder, not the file {output}")
    check_asked(formats or (), "--format")


def save_and_report(result: Any, output: Path, formats: list[str] | None) -> None:
    """Save a result; print its summary and the files written.

    Ends the command with exit code NOT_PASSED where the result has criteria that are not all fulfilled.
    """
    from wsrender.results.export.artifacts import DOCUMENT

    result.save(output, formats=tuple(formats or ()))
    console = Console(soft_wrap=True, highlight=False, markup=False)
    console.print(result.summary())
    sizes = {each["name"]: each["bytes"] for each in result.document["artifacts"]}
    for name, size in ({DOCUMENT: (output / DOCUMENT).stat().st_size} | sizes).items():
        console.print(f"{output / name}  {_size(size)}")
    if result.document.get("verdict", "pass") != "pass":
        raise typer.Exit(NOT_PASSED)


def _size(count: float) -> str:
    """Bytes in decimal units, three digits."""
    for unit in ("B", "kB", "MB"):
        if count < 1000:
            return f"{count:.3g} {unit}"
        count /= 1000
    return f"{count:.3g} GB"
