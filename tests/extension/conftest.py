"""Packages of others, found through their entry points as installed ones are."""

import os
import sys
from contextlib import ExitStack
from pathlib import Path

import pytest
from wsrender_server import job_body
from wsrender_server.local_server import LocalServer

import wsrender as ws
from tests.server.http.conftest import client, finished, jobs, result, result_folder, settings, submit  # noqa: F401
from wsrender import cli, extensions
from wsrender.analyses import jobs as jobs_of_documents
from wsrender.analyses import registry
from wsrender.indices import index_catalogue
from wsrender.pipeline.constraints import registry as constraints
from wsrender.results import presentation
from wsrender.results.export import formats

HERE = Path(__file__).parent
# What has been read of packages.
READ = (
    formats._extensions,
    presentation._extensions,
    index_catalogue._extensions,
    constraints._extensions,
    registry._table,
    registry.job_classes,
    jobs_of_documents._adapter,
    job_body._validator,
)


@pytest.fixture
def installed(monkeypatch):
    """Installs a folder of this one for the time of a test."""

    def install(folder):
        monkeypatch.syspath_prepend(HERE / folder)
        forget()

    before = set(sys.modules)
    yield install
    monkeypatch.undo()
    forget()
    theirs = {path.stem for folder in ("package", "broken") for path in (HERE / folder).iterdir()}
    for name in set(sys.modules) - before:
        if name.partition(".")[0] in theirs:
            del sys.modules[name]


def forget():
    for read in READ:
        read.cache_clear()
    extensions._LEFT_OUT.clear()


@pytest.fixture
def package(installed):
    """The package that adds one of each; first among a test's fixtures, so that a server starts with it."""
    installed("package")


@pytest.fixture(scope="session")
def live(tmp_path_factory):
    """A client of a running server in whose environment the package is installed."""
    with ExitStack() as stack:
        with (
            pytest.MonkeyPatch.context() as patch
        ):  # while it starts: the tests of other folders have their own servers
            patch.setenv("PYTHONPATH", os.pathsep.join([str(HERE / "package"), *filter(None, sys.path)]))
            server = stack.enter_context(LocalServer(tmp_path_factory.mktemp("server")))
        client = stack.enter_context(ws.Client(server.url))
        client.url = server.url
        yield client


@pytest.fixture
def wsrender(capsys):
    """Runs the command line: the exit code, standard output and standard error."""

    def run(*arguments):
        with pytest.raises(SystemExit) as ended:
            cli.main([str(each) for each in arguments])
        written = capsys.readouterr()
        return ended.value.code, written.out, written.err

    return run
