"""``wsrender run``: a job executed here and saved."""

from pathlib import Path
from typing import Annotated, Any

import typer

from wsrender.cli.job_command import job_command
from wsrender.cli.saving import Formats, check_output, save_and_report
from wsrender.progress import RunProgress


@job_command
def run(
    document: dict[str, Any],
    output: Annotated[Path, typer.Option("--output", "-o", help="Folder for the results.")] = Path("out"),
    formats: Formats = None,
) -> None:
    """Analyse a robot; write the result document, volume, surface and pictures to a folder.

    Options override the fields of a job document.
    """
    check_output(output, formats)
    from wsrender.run import execute

    with RunProgress() as progress:
        result = execute(document, progress=progress)
    save_and_report(result, output, formats)
