"""``wsrender view``: a saved result in the browser."""

from pathlib import Path
from typing import Annotated

import typer

from wsrender.cli.faults import one_line_faults


def view(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="Folder of a saved result.")],
    port: Annotated[int, typer.Option(help="Port on this machine to listen at; 0: a free one.")] = 0,
    browser: Annotated[bool, typer.Option(help="Open the browser; its link is printed anyway.")] = True,
    traceback: Annotated[bool, typer.Option("--traceback", help="Show where an error came from.")] = False,
) -> None:
    """Show a saved result in the browser, until Ctrl-C: volume, slices, robot, its postures, what can be changed."""
    with one_line_faults(traceback):
        from wsrender.results.result import Result
        from wsrender.window import in_tab

        local = in_tab(Result.load(folder), port)
        typer.echo(local.url)
        typer.echo("The link opens the view once. Ctrl-C ends it.", err=True)
        if browser:
            local.open()
        local.wait()
