"""The command line: ``wsrender run | render | report | submit | jobs …``, and what the server adds to it."""

import shlex
import sys
from collections.abc import Sequence
from typing import Annotated

import typer

from wsrender.cli.cite_command import cite
from wsrender.cli.faults import one_line_faults, one_line_warnings
from wsrender.cli.job_command import run
from wsrender.cli.jobs_command import jobs, submit
from wsrender.cli.listing import robots, schema
from wsrender.cli.render_command import render, report
from wsrender.cli.reproduce_command import reproduce
from wsrender.cli.view_command import view
from wsrender.errors import InputError, MissingExtraError
from wsrender.extensions import load
from wsrender.origin import asked_by

COMMANDS = {
    "cite": cite,
    "run": run,
    "render": render,
    "report": report,
    "reproduce": reproduce,
    "robots": robots,
    "schema": schema,
    "submit": submit,
    "view": view,
}
GROUPS = {"jobs": jobs}
# Typer apps whose commands join these; loaded only where none of these is asked for.
EXTENSIONS = "wsrender.commands"
SERVER_COMMANDS = ("serve", "worker", "keys", "database", "demo", "doctor", "settings")


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line; exits with 0, 2 for a wrong input, 1 for any other fault.

    3: the result is there, and what its criteria ask for is not fulfilled, or not decided.
    """
    arguments = list(sys.argv[1:] if arguments is None else arguments)
    command = next((argument for argument in arguments if not argument.startswith("-")), None)
    typed = shlex.join(["wsrender", *arguments]) if command == "run" else None  # others may hold a server's key
    before = asked_by.set(typed)
    try:
        command_line(command)(arguments, prog_name="wsrender")
    finally:
        asked_by.reset(before)


def command_line(command: str | None) -> typer.Typer:
    """The command line that knows ``command``: extensions are loaded only if they may hold it."""
    app = typer.Typer(
        callback=_options, no_args_is_help=True, pretty_exceptions_enable=False, rich_markup_mode="markdown"
    )
    for name, function in COMMANDS.items():
        app.command(name)(function)
    for name, group in GROUPS.items():
        app.add_typer(group, name=name)
    if command not in COMMANDS | GROUPS:
        _extend(app)
    return app


def _extend(app: typer.Typer) -> None:
    def add(_: str, extension: object) -> None:
        if not isinstance(extension, typer.Typer):
            raise InputError("command", f"must be a typer.Typer, not {type(extension).__name__}")
        app.add_typer(extension)

    with one_line_warnings():
        if "server" not in load(EXTENSIONS, add):  # or what it needs is not there
            for name in SERVER_COMMANDS:
                app.command(name, hidden=True, context_settings=_ANY_ARGUMENTS)(_no_server)


_ANY_ARGUMENTS = {"allow_extra_args": True, "ignore_unknown_options": True}


def _no_server() -> None:
    with one_line_faults():
        raise MissingExtraError("The server", "server")


def _print_version(asked: bool) -> None:
    if asked:
        from wsrender import __version__

        typer.echo(f"wsrender {__version__}")
        raise typer.Exit()


def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Workspace analysis of robotic manipulators: where an arm can reach, and how well it moves there."""
