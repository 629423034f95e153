"""``wsrender jobs``: the jobs on a server."""

import json
import sys
from pathlib import Path
from typing import Annotated

import typer
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from wsrender.cli.faults import one_line_faults
from wsrender.cli.listing import PIPED_WIDTH
from wsrender.cli.saving import Formats, check_output, save_and_report
from wsrender.cli.server_options import SERVER, Server, Token

jobs = typer.Typer(no_args_is_help=True, help="List, show, cancel, retry and download the jobs on a server.")

JobId = Annotated[str, typer.Argument(metavar="ID", help="Id of the job.")]


@jobs.command("list")
def list_jobs(
    server: Server = SERVER,
    token: Token = None,
    state: Annotated[
        str | None, typer.Option(help="queued, running, canceling, succeeded, failed, canceled or timed_out.")
    ] = None,
    limit: Annotated[int, typer.Option(min=1, help="Number of jobs, newest first.")] = 50,
) -> None:
    """List your jobs, newest first."""
    from wsrender.client import Client

    table = Table("id", "state", "analysis", "done", "created", "labels", box=SIMPLE_HEAD, show_edge=False)
    with one_line_faults(), Client(server, token) as client:
        for job in client.jobs(state=state, limit=limit):
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
    """Queue a job again that failed, was canceled or timed out."""
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
