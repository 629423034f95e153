"""``wsrender report``: one HTML page about a saved result."""

from pathlib import Path
from typing import Annotated

import typer

from wsrender.cli.faults import one_line_faults


def report(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="Folder of a saved result.")],
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Page to write; by default report.html in FOLDER.")
    ] = None,
    view: Annotated[
        list[str] | None,
        typer.Option(help="3-D picture to show, as in `wsrender render`; repeatable. By default boundary, isosurface."),
    ] = None,
    flat: Annotated[bool, typer.Option("--flat", help="No 3-D pictures.")] = False,
    traceback: Annotated[bool, typer.Option("--traceback", help="Show where an error came from.")] = False,
) -> None:
    """Write one HTML page about a saved result: pictures, tables, provenance and job document."""
    with one_line_faults(traceback):
        from wsrender.results.export.headline import head_lines
        from wsrender.results.result import REPORT_VIEWS, Result

        path = output or folder / "report.html"
        result = Result.load(folder)
        result.report(path, () if flat else view or REPORT_VIEWS)
        for line in head_lines(result.document):
            typer.echo(line, err=True)  # the path alone is for programs
        typer.echo(path)
