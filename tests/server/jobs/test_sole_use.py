"""A database has one server at a time, and one data folder."""

import shutil

import pytest
from sqlalchemy import Connection, delete, text
from wsrender_server.jobs.database import open_database
from wsrender_server.jobs.faults import StoreUnavailable
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.records import JobState
from wsrender_server.jobs.store import JobStore
from wsrender_server.jobs.tables import StoreId

from tests.server.jobs.documents import indices_at
from tests.server.jobs.test_store import complete, running, states
from wsrender.errors import InputError


@pytest.fixture
def second(database, tmp_path):
    """``second(folder)`` is a store as of another server, with connections of its own."""
    engine = open_database(database.url.render_as_string(hide_password=False))
    yield lambda folder: JobStore(engine, DataFolder(tmp_path / folder))
    engine.dispose()


@pytest.mark.parametrize("folder", ["data", "elsewhere"])
def test_a_second_server_is_refused_while_the_first_runs(store, second, folder):
    with store.claimed():
        with pytest.raises(InputError, match="in use by another server"), second(folder).claimed():
            pass
        store.sole_use.keep()
    with store.claimed():  # which nothing of the refused one is left of
        pass


def test_another_data_folder_is_refused(store, second, document):
    with store.claimed():
        _, computation = running(store, document)
        complete(store, computation)
    with pytest.raises(InputError, match="is not the data folder of this database") as refused, second("new").claimed():
        pass
    assert refused.value.field == "data_dir"
    with second("data").claimed():
        pass


def test_a_folder_that_the_database_has_left_is_not_its_again(store, second):
    """An empty database goes with any folder; from then on with that one only."""
    with store.claimed():
        pass
    with second("new").claimed():
        pass
    with pytest.raises(InputError, match="is not the data folder"), store.claimed():
        pass


def test_the_folder_of_another_database_is_refused(store, tmp_path):
    (tmp_path / "data" / "store-id").write_text("0" * 32 + "\n")
    with pytest.raises(InputError, match="says 0000"), store.claimed():
        pass


@pytest.mark.parametrize("kind", ["result", "model", "document"])
def test_folders_of_earlier_versions_are_known_by_their_files(store, second, document, kind):
    if kind == "model":
        store.put_model("ann", b"<mujoco/>")
    elif kind == "document":
        store.submit("ann", indices_at(configurations=[[k / 4096, 0.5, 0.1, 0.2] for k in range(2048)]))
    else:
        complete(store, running(store, document)[1])
    with pytest.raises(InputError, match="is not the data folder"), second("new").claimed():
        pass
    with store.claimed():
        pass
    with store.transactions.write() as session:  # as where the first start was cut off between the two
        session.execute(delete(StoreId))
        session.add(StoreId(id="1" * 32))
    (store.files.root / "store-id").unlink()
    with store.claimed():
        assert store.files.read_id() not in (None, "1" * 32)


def test_a_folder_that_is_not_there_has_lost_nothing(store, document):
    with store.claimed():
        job, computation = running(store, document)
        complete(store, computation)
        store.files.root.rename(hidden := store.files.root.with_name("hidden"))
        for look in (lambda: store.result_document("ann", job), lambda: store.submit("ann", document)):
            with pytest.raises((StoreUnavailable, FileNotFoundError)):
                look()
        with pytest.raises(StoreUnavailable, match="is not the data folder"):
            store.check_result(computation)
        hidden.rename(store.files.root)
        assert states(store, "ann", job) == [JobState.SUCCEEDED] and store.result_document("ann", job)


def test_a_lost_connection_takes_the_lock_again_or_says_who_has_it(store, second, monkeypatch):
    if store.transactions.engine.dialect.name != "postgresql":
        pytest.skip("a file's lock goes with its process")
    monkeypatch.setattr("wsrender_server.jobs.sole_use.LOOK_S", 0.0)
    lost = text(
        "SELECT pg_terminate_backend(pid, 30000) FROM pg_locks WHERE locktype = 'advisory'"
    )  # and waits for its end
    with store.claimed():
        for other_is_there in (False, True):
            with store.transactions.read() as session:
                session.execute(lost)
            if other_is_there:
                rival = second("data").sole_use
                rival.take()
                with pytest.raises(StoreUnavailable, match="another server has taken over"):
                    store.sole_use.keep()
                rival.release()
            store.sole_use.keep()
            with pytest.raises(InputError, match="in use"):
                second("data").sole_use.take()


def test_a_lock_is_let_go_before_its_session_ends(store, second, monkeypatch):
    if store.transactions.engine.dialect.name != "postgresql":
        pytest.skip("a file's lock goes with its process")
    store.sole_use.take()
    with monkeypatch.context() as patched:
        patched.setattr(Connection, "invalidate", lambda self, exception=None: None)  # the session lasts
        store.sole_use.release()
    rival = second("data").sole_use
    rival.take()
    rival.release()


def test_a_copy_of_both_is_a_pair_as_well(database, store, second, tmp_path):
    with store.claimed():
        store.put_model("ann", b"<mujoco/>")
    shutil.copytree(tmp_path / "data", tmp_path / "copy")
    with second("copy").claimed():
        pass
