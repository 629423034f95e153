"""Packages of others, found through their entry points as installed ones are."""

import sys
from pathlib import Path

import pytest

from tests.server.http.conftest import client, finished, jobs, result, result_folder, settings, submit  # noqa: F401
from wsrender.results.export import formats

HERE = Path(__file__).parent


@pytest.fixture
def installed(monkeypatch):
    """Installs a folder of this one for the time of a test."""

    def install(folder):
        monkeypatch.syspath_prepend(HERE / folder)
        formats._extensions.cache_clear()

    before = set(sys.modules)
    yield install
    monkeypatch.undo()
    formats._extensions.cache_clear()
    for name in {"voxel_list", "broken_formats"} & (set(sys.modules) - before):
        del sys.modules[name]


@pytest.fixture
def package(installed):
    """The package that adds one of each; first among a test's fixtures, so that a server starts with it."""
    installed("package")
