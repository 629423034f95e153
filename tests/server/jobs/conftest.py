"""Stores on both databases."""

from contextlib import ExitStack

import pytest
from sqlalchemy import text
from wsrender_server.jobs.database import open_database
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.store import JobStore, open_store
from wsrender_server.jobs.tables import Row
from wsrender_server.migrations import upgrade

from tests.server.jobs.documents import canonical


@pytest.fixture(params=["sqlite", "postgresql"])
def database(request, tmp_path):
    """An empty, upgraded database of either kind."""
    if request.param == "sqlite":
        engine = open_database(f"sqlite:///{tmp_path / 'jobs.db'}")
    else:
        engine = open_database(request.getfixturevalue("postgres_url"))
        Row.metadata.drop_all(engine)
        with engine.begin() as connection:
            connection.execute(text("DROP TABLE IF EXISTS alembic_version"))
    upgrade(engine)
    yield engine
    engine.dispose()


@pytest.fixture
def store(database, tmp_path):
    """An empty store; five unfinished jobs are allowed."""
    return JobStore(database, DataFolder(tmp_path / "data"), max_queued_per_owner=5)


@pytest.fixture
def document():
    """A canonical job document."""
    return canonical()


@pytest.fixture
def opened():
    """``opened(settings)`` is a store of the settings, closed at the end of the test."""
    with ExitStack() as stores:

        def open_and_close(settings):
            store = open_store(settings)
            stores.callback(store.close)
            return store

        yield open_and_close


@pytest.fixture
def another_version(monkeypatch):
    """``another_version(version)`` is what this process is from now on."""

    def become(version):
        for module in ("identity", "store", "computations"):
            monkeypatch.setattr(f"wsrender_server.jobs.{module}.__version__", version)

    return become
