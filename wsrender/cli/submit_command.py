"""``wsrender submit``: a job sent to a server."""

from pathlib import Path
from typing import Annotated, Any

import typer

from wsrender.cli.faults import INTERRUPTED
from wsrender.cli.job_command import job_command
from wsrender.cli.saving import Formats, check_output, save_and_report
from wsrender.cli.server_options import SERVER, Server, Token
from wsrender.errors import InputError


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
