"""``wsrender robots`` and ``wsrender schema``: what there is, and how a job is written."""

import json
import sys
from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from wsrender.cli import completion
from wsrender.cli.faults import one_line_faults
from wsrender.errors import InputError

if TYPE_CHECKING:
    from wsrender.robots.library import LibraryRobot

PIPED_WIDTH = 240  # columns off a terminal: one robot a line


def robots(
    search: Annotated[str, typer.Argument(help="Only those of whose name, maker or description this is a part.")] = "",
    joints: Annotated[int | None, typer.Option(help="Only robots of so many joints.", min=1)] = None,
    payload: Annotated[float | None, typer.Option(help="Only robots rated for so many kg at least.")] = None,
    reach: Annotated[float | None, typer.Option(help="Only robots with a reach of so many m at least.")] = None,
    closed_form: Annotated[str | None, typer.Option(help="Only classes of arms with this in their name.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON: all that the library says of each.")] = False,
) -> None:
    """List the robots and the mechanisms of the library."""
    with one_line_faults():
        from wsrender.robots import library

        def wanted(robot: "library.LibraryRobot") -> bool:
            texts = [robot.name, *robot.aliases, robot.full_name, robot.maker, robot.description]
            return (
                any(search.lower() in text.lower() for text in texts if text)
                and joints in (None, robot.joints)
                and (payload is None or (robot.payload_kg or 0.0) >= payload)
                and (reach is None or (robot.reach_m or 0.0) >= reach)
                and (closed_form is None or closed_form.lower() in (robot.closed_form or "").lower())
            )

        found = [robot for robot in library.describe() if wanted(robot)]
        mechanisms = [robot for robot in library.mechanisms() if closed_form is None and wanted(robot)]
        if as_json:
            typer.echo(json.dumps({"robots": _plain(found), "mechanisms": _plain(mechanisms)}, indent=2))
        else:
            _print(found, mechanisms)


def _print(robots: "list[LibraryRobot]", mechanisms: "list[LibraryRobot]") -> None:
    console = Console() if sys.stdout.isatty() else Console(width=PIPED_WIDTH)
    look = {"box": SIMPLE_HEAD, "show_edge": False, "pad_edge": False}
    table = Table("robot", "joints", "maker", r"payload \[kg]", r"reach \[m]", "closed form", "description", **look)
    for robot in robots:
        numbers = ["—" if number is None else f"{number:g}" for number in (robot.payload_kg, robot.reach_m)]
        table.add_row(
            robot.name, str(robot.joints), robot.maker or "—", *numbers, robot.closed_form or "—", robot.description
        )
    console.print(table)
    table = Table("mechanism", "joints", "description", "source", **look)
    for robot in mechanisms:
        table.add_row(robot.name, str(robot.joints), robot.description, robot.source)
    if mechanisms:
        console.print(table)


def _plain(robots: "list[LibraryRobot]") -> list[dict[str, Any]]:
    return [{key: value for key, value in asdict(robot).items() if key != "path"} for robot in robots]


def schema(
    analysis: Annotated[
        str | None,
        typer.Argument(help="Only the job documents of this analysis.", autocompletion=completion.analyses),
    ] = None,
    named: Annotated[str | None, typer.Option("--analysis", hidden=True)] = None,
) -> None:
    """Print the JSON Schema of job documents, with every default."""
    with one_line_faults():
        from wsrender.analyses.jobs import job_schema

        if analysis and named and analysis != named:
            raise InputError("analysis", f"is given twice, as {analysis} and as {named}")
        typer.echo(json.dumps(job_schema(analysis or named), indent=2))
