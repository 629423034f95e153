"""``wsrender robots`` and ``wsrender schema``: what there is, and how a job is written."""

import json
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from wsrender.cli.faults import one_line_faults


def robots() -> None:
    """List the robots of the library."""
    with one_line_faults():
        from wsrender.robots import library

        table = Table("name", "joints", "description", "source")
        for robot in library.describe():
            table.add_row(robot.name, str(robot.joints), robot.description, robot.source)
        Console().print(table)


def schema(
    analysis: Annotated[str | None, typer.Option(help="Only the job documents of this analysis.")] = None,
) -> None:
    """Print the JSON Schema of job documents, with every default."""
    with one_line_faults():
        from wsrender.spec import job_schema

        typer.echo(json.dumps(job_schema(analysis), indent=2))
