"""Packages of others, found through their entry points as installed ones are."""

import sys
from pathlib import Path

import pytest

from tests.server.http.conftest import client, finished, jobs, result, result_folder, settings, submit  # noqa: F401
from wsrender.analyses import jobs as jobs_of_documents
from wsrender.analyses import registry
from wsrender.results.export import formats

HERE = Path(__file__).parent


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
    for name in set(sys.modules) - before:
        if name.partition(".")[0] in {"voxel_list", "middle_tip", "broken_formats", "broken_analyses"}:
            del sys.modules[name]


def forget():
    """What has been read of packages."""
    for read in (formats._extensions, registry._table, registry.job_classes, jobs_of_documents._adapter):
        read.cache_clear()


@pytest.fixture
def package(installed):
    """The package that adds one of each; first among a test's fixtures, so that a server starts with it."""
    installed("package")
