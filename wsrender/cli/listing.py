"""``wsrender robots`` and ``wsrender schema``: what there is, and how a job is written."""

import json
import sys
from typing import Annotated

import typer
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from wsrender.cli.faults import one_line_faults

PIPED_WIDTH = 240  # columns off a terminal: one robot a line


def robots() -> None:
    """List the robots and the mechanisms of the library."""
    with one_line_faults():
        from wsrender.robots import library

        console = Console() if sys.stdout.isatty() else Console(width=PIPED_WIDTH)
        for kind, listed in (("robot", library.describe()), ("mechanism", library.mechanisms())):
            table = Table(kind, "joints", "description", "source", box=SIMPLE_HEAD, show_edge=False, pad_edge=False)
            for robot in listed:
                table.add_row(robot.name, str(robot.joints), robot.description, robot.source)
            console.print(table)


def schema(
    analysis: Annotated[str | None, typer.Option(help="Only the job documents of this analysis.")] = None,
) -> None:
    """Print the JSON Schema of job documents, with every default."""
    with one_line_faults():
        from wsrender.analyses.jobs import job_schema

        typer.echo(json.dumps(job_schema(analysis), indent=2))
