"""``wsrender submit`` and ``wsrender jobs``: a job sent to a server, and the jobs there."""

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

import typer
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from wsrender.cli.completion import STATES, one_of
from wsrender.cli.faults import INTERRUPTED, one_line_faults
from wsrender.cli.job_command import job_command
from wsrender.cli.listing import PIPED_WIDTH
from wsrender.cli.saving import Formats, check_output, save_and_report
from wsrender.errors import InputError

if TYPE_CHECKING:
    from wsrender.client.records import JobState

SERVER = "http://127.0.0.1:8000"

Server = Annotated[str, typer.Option(envvar="WSRENDER_SERVER", help="Address of the server.", metavar="URL")]
Token = Annotated[
    str | None, typer.Option(envvar="WSRENDER_TOKEN", help="API key, where the server asks for one.", show_envvar=True)
]
jobs = typer.Typer(no_args_is_help=True, help="List, show, cancel, retry and download the jobs on a server.")

JobId = Annotated[str, typer.Argument(metavar="ID", help="Id of the job.")]


@jobs.command("list")
def list_jobs(
    server: Server = SERVER,
    token: Token = None,
    state: Annotated[
        str | None,
        typer.Option(
            help="queued, running, canceling, succeeded, failed, canceled, timed_out or expired.",
            autocompletion=one_of(*STATES),
        ),
    ] = None,
    limit: Annotated[int, typer.Option(min=1, help="Number of jobs, newest first.")] = 50,
) -> None:
    """List your jobs, newest first."""
    from wsrender.client import Client

    table = Table("id", "state", "analysis", "done", "created", "labels", box=SIMPLE_HEAD, show_edge=False)
    with one_line_faults(), Client(server, token) as client:
        for job in client.jobs(state=cast("JobState | None", state), limit=limit):
            labels = " ".join(f"{key}={value}" for key, value in (job.record.get("labels") or {}).items())
            done = f"{100 * (job.progress.get('fraction') or 0):.0f} %"
            created = str(job.record.get("created_at") or "")[:19]
            table.add_row(job.id, job.state, job.record.get("analysis"), done, created, labels)
        console = Console() if sys.stdout.isatty() else Console(width=PIPED_WIDTH)
        console.print(table)


@jobs.command()
def show(id: JobId, server: Server = SERVER, token: Token = None) -> None:
    """Print what the server says of a job, as JSON."""
    from wsrender.client import Client

    with one_line_faults(), Client(server, token) as client:
        typer.echo(json.dumps(client.job(id).record, indent=2, ensure_ascii=False))


@jobs.command()
def cancel(id: JobId, server: Server = SERVER, token: Token = None) -> None:
    """Stop a job."""
    from wsrender.client import Client

    with one_line_faults(), Client(server, token) as client:
        typer.echo(client.job(id).cancel().state)


@jobs.command()
def retry(id: JobId, server: Server = SERVER, token: Token = None) -> None:
    """Queue a job again that failed, was canceled, timed out or has expired."""
    from wsrender.client import Client

    with one_line_faults(), Client(server, token) as client:
        typer.echo(client.job(id).retry().state)


@jobs.command()
def download(
    id: JobId,
    output: Annotated[Path, typer.Option("--output", "-o", help="Folder for the results.")] = Path("out"),
    server: Server = SERVER,
    token: Token = None,
    formats: Formats = None,
) -> None:
    """Save the result of a job, waiting for it if need be."""
    from wsrender.client import Client

    with one_line_faults(), Client(server, token) as client:
        check_output(output, formats)
        save_and_report(client.job(id).wait(progress=True).result(), output, formats)


@job_command
def submit(
    document: dict[str, Any],
    server: Server = SERVER,
    token: Token = None,
    wait: Annotated[bool, typer.Option("--wait", help="Wait for the job, then save its result.")] = False,
    output: Annotated[Path, typer.Option("--output", "-o", help="With --wait: folder for the results.")] = Path("out"),
    formats: Formats = None,
    label: Annotated[list[str] | None, typer.Option(help="KEY=VALUE to find the job by; repeatable.")] = None,
    priority: Annotated[int, typer.Option(help="Jobs of higher priority go first.")] = 0,
    timeout: Annotated[float | None, typer.Option(help="Seconds that the job may run.")] = None,
) -> None:
    """Submit a job to a server and print its id.

    Takes what `wsrender run` takes; robot files are uploaded.
    """
    from wsrender.client import Client

    if wait:
        check_output(output, formats)
    labels = dict(_labelled(text) for text in label or [])
    with Client(server, token) as client:
        job = client.submit(document, labels=labels, priority=priority, timeout_s=timeout)
        typer.echo(job.id)
        if wait:
            try:
                result = job.wait(progress=True).result()
            except KeyboardInterrupt:
                typer.echo(f"the job goes on: wsrender jobs show {job.id} --server {server}", err=True)
                raise typer.Exit(INTERRUPTED) from None
            save_and_report(result, output, formats)


def _labelled(text: str) -> tuple[str, str]:
    key, equals, value = text.partition("=")
    if not equals or not key:
        raise InputError("--label", f'must be KEY=VALUE, not "{text}"')
    return key, value
