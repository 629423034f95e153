"""Commands of the server: ``wsrender serve | worker | keys | database | demo``."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager, nullcontext
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer
from pydantic import ValidationError

from wsrender.cli.faults import one_line_faults
from wsrender.errors import InputError, NotFoundError
from wsrender_server.gpus import present_gpus
from wsrender_server.jobs.files import DataFolder, keep_private
from wsrender_server.settings import PREFIX, Settings

app = typer.Typer(no_args_is_help=True)
keys = typer.Typer(no_args_is_help=True, help="Create, list and revoke API keys.", callback=keep_private)
database = typer.Typer(no_args_is_help=True, help="The database of jobs.", callback=keep_private)
app.add_typer(keys, name="keys")
app.add_typer(database, name="database")

_WORKERS = "Workers"
_TLS = "Certificates of the cluster"

DataDir = Annotated[
    Path | None,
    typer.Option(help="Folder of database, models and results. [the user's own, such as ~/.local/share/wsrender]"),
]
Database = Annotated[
    str | None, typer.Option(help="postgresql+psycopg://…; default: SQLite in the data folder.", metavar="URL")
]
Scheduler = Annotated[
    str | None, typer.Option(help="Dask scheduler, tls://host:port.", metavar="ADDRESS", rich_help_panel=_WORKERS)
]
CaFile = Annotated[Path | None, typer.Option(help="Certificate authority (PEM).", rich_help_panel=_TLS)]
CertFile = Annotated[Path | None, typer.Option(help="Certificate of this process (PEM).", rich_help_panel=_TLS)]
KeyFile = Annotated[Path | None, typer.Option(help="Private key of this process (PEM).", rich_help_panel=_TLS)]
RESTART_S = 2.0
LOOK_S = 0.2


@app.command()
def serve(
    host: Annotated[
        str | None, typer.Option(help="Address to listen on; other than loopback needs an API key. [127.0.0.1]")
    ] = None,
    port: Annotated[int | None, typer.Option(help="Port to listen on; 0 takes a free one. [8000]")] = None,
    data_dir: DataDir = None,
    workers: Annotated[
        int | None, typer.Option(help="Processes that compute, without --scheduler.", rich_help_panel=_WORKERS)
    ] = None,
    api_key_file: Annotated[Path | None, typer.Option(help="API keys, one to a line.")] = None,
    database: Database = None,
    scheduler: Scheduler = None,
    tls_ca_file: CaFile = None,
    tls_cert_file: CertFile = None,
    tls_key_file: KeyFile = None,
) -> None:
    """Run the job server.

    Every option can be given by an environment variable as well, such as WSRENDER_PORT; server/README.md lists more.
    """
    keep_private()
    with one_line_faults():
        settings = settings_of(**locals())

        from wsrender_server.local_server import READY
        from wsrender_server.serving import listen, serve_until_stopped

        listener = listen(settings)
        _say_where(settings)

        from wsrender_server.app import create_app  # takes a second: after what may be wrong
        from wsrender_server.parts import Parts

        app = create_app(settings)
        parts: Parts = app.state.parts

        def announce(url: str) -> None:
            typer.echo(f"wsrender {READY}{url}")
            parts.admissions.warm_up()

        serve_until_stopped(app, settings, listener, announce, parts.store.changes.close)


@app.command()
def worker(
    scheduler: Scheduler = None,
    data_dir: DataDir = None,
    gpus: Annotated[
        str | None, typer.Option(help='"all", or numbers such as 0,1: one process per GPU. Default: one process.')
    ] = None,
    name: Annotated[str | None, typer.Option(help="What the scheduler calls it, without --gpus. [its address]")] = None,
    tls_ca_file: CaFile = None,
    tls_cert_file: CertFile = None,
    tls_key_file: KeyFile = None,
) -> None:
    """Compute for a Dask scheduler; the data folder must be the server's, shared between the machines."""
    keep_private()
    with one_line_faults():
        settings = settings_of(**locals())
        if settings.scheduler is None:
            raise InputError("--scheduler", "must be given, such as tls://lab:8786")
        if name is not None and gpus is not None:
            raise InputError("--name", "is for one worker; leave out --gpus, or start a worker for each GPU")
        DataFolder(settings.data_dir)  # looks who else may read it
        _say_where(settings)
        stop = threading.Event()
        for number in (signal.SIGTERM, signal.SIGINT):
            signal.signal(number, lambda number, frame: stop.set())
        if gpus is not None:
            _work_on(gpus, settings, stop)
        else:
            from wsrender_server.jobs.worker import serve_scheduler

            serve_scheduler(settings, lambda: typer.echo(f"wsrender worker joined {settings.scheduler}"), stop, name)


@app.command()
def doctor(
    host: Annotated[str | None, typer.Option(help="Address to listen on.")] = None,
    port: Annotated[int | None, typer.Option(help="Port to listen on.")] = None,
    data_dir: DataDir = None,
    api_key_file: Annotated[Path | None, typer.Option(help="API keys, one to a line.")] = None,
    database: Database = None,
    scheduler: Scheduler = None,
    tls_ca_file: CaFile = None,
    tls_cert_file: CertFile = None,
    tls_key_file: KeyFile = None,
    as_json: Annotated[bool, typer.Option("--json", help="As JSON.")] = False,
) -> None:
    """Check whether a server can run here: what is wrong, and the command that mends it. Changes nothing."""
    with one_line_faults():
        from wsrender_server.doctor import findings

        found = list(findings(settings_of(**locals())))
        if as_json:
            typer.echo(json.dumps([{**asdict(each), "ok": not each.remedy} for each in found], indent=2))
        else:
            for each in found:
                typer.echo(f"{'wrong' if each.remedy else 'ok   '}  {each.check}: {each.found}")
                if each.remedy:
                    typer.echo(f"         {each.remedy}")
        if any(each.remedy for each in found):
            raise typer.Exit(1)


@app.command("settings")
def list_settings(as_json: Annotated[bool, typer.Option("--json", help="As JSON.")] = False) -> None:
    """List the server's settings: variable, value, where that comes from, meaning. Passwords are hidden."""
    with one_line_faults():
        settings = settings_of()
        rows = []
        for name, field in Settings.model_fields.items():
            variable, value = PREFIX + name.upper(), getattr(settings, name)
            text = settings.database_place if name == "database" and value else settings.model_dump(mode="json")[name]
            source = "environment" if variable in {each.upper() for each in os.environ} else "default"
            meaning = " ".join((field.description or "").split())
            rows.append({"variable": variable, "value": text, "source": source, "meaning": meaning})
        if as_json:
            typer.echo(json.dumps(rows, indent=2))
        else:
            for row in rows:
                shown = "" if row["value"] is None else row["value"]
                typer.echo(f"{row['variable']}={shown}  ({row['source']})\n    {row['meaning']}")


@keys.command("create")
def create_key(
    name: Annotated[str, typer.Option(help="Whose key it is.")] = "unnamed",
    scope: Annotated[
        list[str] | None, typer.Option(help="read, submit, priority or admin; repeatable. [read and submit]")
    ] = None,
    data_dir: DataDir = None,
    database: Database = None,
) -> None:
    """Make an API key and print it: it is kept as a hash only and never shown again."""
    with one_line_faults():
        from wsrender_server.jobs.store import open_store

        settings = settings_of(**locals())
        with closing(open_store(settings)) as store:
            key, secret = store.create_key(name, *([scope] if scope else []))
        typer.echo(secret)
        typer.echo(
            f"key {key.id} of {name}: keep it now, it is never shown again; servers on {settings.database_place} "
            "ask for keys from now on",
            err=True,
        )


@keys.command("list")
def list_keys(data_dir: DataDir = None, database: Database = None) -> None:
    """List the API keys, without their secrets."""
    with one_line_faults():
        from rich.box import SIMPLE_HEAD
        from rich.console import Console
        from rich.table import Table

        table = Table("id", "name", "scopes", "created", "revoked", box=SIMPLE_HEAD, show_edge=False)
        settings = settings_of(**locals())
        with _existing_store(settings) as store:
            found = [] if store is None else store.list_keys()
        if store is None:
            typer.echo(f"there is no database at {settings.database_place}, so there are no keys", err=True)
        for key in found:
            revoked = "" if key.revoked_at is None else f"{key.revoked_at:%Y-%m-%d %H:%M}"
            table.add_row(key.id, key.name, " ".join(key.scopes), f"{key.created_at:%Y-%m-%d %H:%M}", revoked)
        Console().print(table)


@keys.command("revoke")
def revoke_key(
    id: Annotated[str, typer.Argument(metavar="ID")], data_dir: DataDir = None, database: Database = None
) -> None:
    """Revoke an API key: requests with it are refused from now on."""
    with one_line_faults():
        settings = settings_of(**locals())
        with _existing_store(settings) as store:
            revoked = None if store is None else store.revoke_key(id)
        if revoked is None:
            raise NotFoundError(f"there is no key {id} in {settings.database_place}")
        typer.echo(f"key {id} is revoked")


@database.command("upgrade")
def upgrade_database(data_dir: DataDir = None, database: Database = None) -> None:
    """Make the database, or bring it to this version's tables."""
    with one_line_faults():
        from wsrender_server.jobs.database import open_database
        from wsrender_server.migrations import upgrade

        settings = settings_of(**locals())
        upgrade(open_database(settings.database_url))
        typer.echo("the database is up to date")


@database.command("check")
def check_database(
    repair: Annotated[
        bool, typer.Option("--repair", help="Expire results whose files are lost, remove files that nothing names.")
    ] = False,
    data_dir: DataDir = None,
    database: Database = None,
) -> None:
    """Read every file that the database lists, and the database itself; a server may run meanwhile."""
    with one_line_faults():
        from wsrender_server.jobs import backups
        from wsrender_server.jobs.retention import Retention

        settings = settings_of(**locals())
        with _needed_store(settings) as store:
            retention = Retention(store, settings)
            checked = backups.check(store, retention)
            for finding in checked.findings:
                typer.echo(finding.text)
            for stray in checked.strays:
                typer.echo(f"{stray.id} ({stray.bytes} bytes) is not needed: {stray.reason}")
            typer.echo(f"{checked.files} files, {checked.bytes} bytes, are as they were written")
            if repair:
                backups.repair(store, retention, checked)
                typer.echo("results that are lost have expired, and can be retried; files without a name are removed")
        if checked.findings and not repair:
            raise InputError("database", f"{len(checked.findings)} findings; --repair lets lost results expire")


@database.command("prune")
def prune_database(
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Say what would go, and remove nothing.")] = False,
    data_dir: DataDir = None,
    database: Database = None,
) -> None:
    """Remove what the settings WSRENDER_KEEP_… keep no longer, as a server does every minute."""
    with one_line_faults():
        from wsrender_server.jobs.retention import Retention

        settings = settings_of(**locals())
        with _needed_store(settings) as store:
            retention = Retention(store, settings)
            removals = retention.due() if dry_run else retention.sweep()
        for each in removals:
            typer.echo(f"{each.what} {each.id} of {each.owner or 'nobody'}, {each.bytes} bytes: {each.reason}")
        size = sum(each.bytes for each in removals)
        typer.echo(f"{len(removals)} things, {size} bytes, {'would go' if dry_run else 'are gone'}")


@database.command("backup")
def back_up_database(
    folder: Annotated[Path, typer.Argument(help="A new folder.")], data_dir: DataDir = None, database: Database = None
) -> None:
    """Copy database, results and models into a folder, while the server runs."""
    with one_line_faults():
        from wsrender_server.jobs.backups import back_up

        with _needed_store(settings_of(data_dir=data_dir, database=database)) as store:
            files, lost = back_up(store, folder)
        for name in lost:
            typer.echo(f"not there, or damaged: {name}; its jobs are expired in the backup", err=True)
        typer.echo(f"{folder} holds the database and {files} files")


@database.command("restore")
def restore_database(
    folder: Annotated[Path, typer.Argument(help="A backup.")], data_dir: DataDir = None, database: Database = None
) -> None:
    """Fill an empty data folder, and an empty database of either kind, from a backup."""
    with one_line_faults():
        from wsrender_server.jobs.backups import restore

        settings = settings_of(data_dir=data_dir, database=database)
        files = restore(settings, folder)
        typer.echo(f"{settings.database_place} and {files} files in {settings.data_dir} are as in the backup")


@app.command()
def demo(
    output: Annotated[Path, typer.Option("--output", "-o", help="Folder for the results.")] = Path("demo"),
    robot: Annotated[str, typer.Option(help="A robot of the library.")] = "ur5e",
) -> None:
    """Start a server, analyse a robot through it, and leave maps, volume and pictures in a folder."""
    with one_line_faults():
        from wsrender.cli.saving import check_output, save_and_report
        from wsrender.client import Client
        from wsrender_server.local_server import LocalServer

        check_output(output, None)
        with (
            tempfile.TemporaryDirectory(prefix="wsrender-demo-", ignore_cleanup_errors=True) as data,
            LocalServer(Path(data)) as server,
            Client(server.url) as client,
        ):
            job = {"analysis": "workspace", "robot": {"library": robot}, "keep_map": True}
            save_and_report(client.submit(job).wait(progress=True).result(), output, None)


def settings_of(**given: Any) -> Settings:
    """Settings from those of a command's options that are given, then environment variables, then defaults.

    Raises InputError.
    """
    try:
        return Settings(**{name: given[name] for name in Settings.model_fields if given.get(name) is not None})
    except ValidationError as error:
        fault = error.errors()[0]
        field = ".".join(str(part) for part in fault["loc"]) or "settings"
        raise InputError(field, fault["msg"].removeprefix("Value error, ")) from None


@contextmanager
def _existing_store(settings: Settings) -> Iterator[Any]:
    """The store for as long as it is needed, None where there is none yet: nothing is made."""
    from wsrender_server.jobs.store import open_existing_store

    store = open_existing_store(settings)
    with nullcontext() if store is None else closing(store):
        yield store


@contextmanager
def _needed_store(settings: Settings) -> Iterator[Any]:
    """The store for as long as it is needed. Raises NotFoundError where there is none."""
    with _existing_store(settings) as store:
        if store is None:
            raise NotFoundError(f"there is no database at {settings.database_place}")
        yield store


def _say_where(settings: Settings) -> None:
    typer.echo(f"wsrender keeps its data in {settings.data_dir.absolute()}")


def _work_on(gpus: str, settings: Settings, stop: threading.Event) -> None:
    files = {
        "--tls-ca-file": settings.tls_ca_file,
        "--tls-cert-file": settings.tls_cert_file,
        "--tls-key-file": settings.tls_key_file,
    }
    arguments = ["--scheduler", str(settings.scheduler), "--data-dir", str(settings.data_dir)]
    arguments += [str(part) for option in files.items() for part in option]
    run_workers(gpu_numbers(gpus), arguments, stop)


def gpu_numbers(choice: str) -> list[str]:
    """The GPUs that ``choice`` names: "all", or numbers separated by commas. Raises InputError."""
    present = present_gpus()
    if choice == "all":
        if not present:
            raise InputError("--gpus", "this machine has no NVIDIA GPU, or nvidia-smi does not see it")
        return present
    chosen = [number.strip() for number in choice.split(",")]
    for number in chosen:
        if number not in present:
            raise InputError("--gpus", f'GPU "{number}" is not one of {", ".join(present) or "none"}')
    return chosen


def run_workers(gpus: Sequence[str], arguments: Sequence[str], stop: threading.Event) -> None:
    """Keep one ``wsrender worker`` per GPU running until ``stop``; each sees its GPU only.

    ``arguments`` are those of each worker. One that ends is started again.
    """
    workers = {gpu: _start_worker(gpu, arguments) for gpu in gpus}
    while not stop.wait(LOOK_S):
        for gpu, worker in workers.items():
            if worker.poll() is not None:
                time.sleep(RESTART_S)
                workers[gpu] = _start_worker(gpu, arguments)
    for worker in workers.values():
        worker.send_signal(signal.SIGTERM)
    for worker in workers.values():
        worker.wait()


def _start_worker(gpu: str, arguments: Sequence[str]) -> subprocess.Popen[bytes]:
    environment = {**os.environ, "CUDA_DEVICE_ORDER": "PCI_BUS_ID", "CUDA_VISIBLE_DEVICES": gpu}
    return subprocess.Popen([sys.executable, "-m", "wsrender", "worker", *arguments], env=environment)
