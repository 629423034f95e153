"""Check, backup and restore, on both databases, and by the commands."""

import shutil
import threading
from contextlib import ExitStack, closing

import pytest
from sqlalchemy import text
from wsrender_server.jobs import backups, documents
from wsrender_server.jobs.records import JobState
from wsrender_server.jobs.retention import Retention
from wsrender_server.jobs.store import open_store
from wsrender_server.jobs.tables import Row
from wsrender_server.settings import Settings

from tests.server.jobs.test_kept_files import DAMAGES
from tests.server.jobs.test_retention import document_of
from tests.server.jobs.test_store import complete, running, states
from wsrender import cli
from wsrender.errors import InputError


@pytest.fixture
def filled(store):
    """A store with two results, a failed job, one that runs, one that waits, a model and a key; jobs by state."""
    with store.claimed():
        pass
    jobs = {}
    for number, state in enumerate(("first", "second", "failed", "running", "queued")):
        if state == "queued":
            jobs[state] = store.submit("ann", document_of(number), labels={"a": "b"}).job.id
            break
        jobs[state], computation = running(store, document_of(number), labels={"number": str(number)})
        if state == "failed":
            store.fail(computation, 1, {"code": "x", "message": "y", "retryable": True})
        elif state != "running":
            complete(store, computation, content=b'{"number": %d}' % number)
        else:
            store.cancel("ann", jobs[state])
            store.stopped(computation, 1)
    store.put_model("ann", b"<mujoco/>")
    store.create_key("ann")
    return jobs


@pytest.fixture
def wsrender(capsys):
    """Run the command line: exit code, output, error."""

    def run(*arguments):
        with pytest.raises(SystemExit) as ended:
            cli.main([*arguments])
        written = capsys.readouterr()
        return ended.value.code, written.out, written.err

    return run


def check(store):
    settings = Settings(data_dir=store.files.root)
    return backups.check(store, Retention(store, settings))


def contents(store):
    """All rows of all tables, and all files that are kept."""
    with store.transactions.read() as session:
        rows = {
            table.name: sorted(map(repr, session.execute(table.select()).all())) for table in Row.metadata.sorted_tables
        }
    folders = [store.files.root / kind for kind in ("results", "models", "documents")]
    paths = [path for folder in folders for path in folder.rglob("*") if path.is_file()]
    return rows, {str(path.relative_to(store.files.root)): path.read_bytes() for path in paths}


def test_a_sound_store_has_no_findings(store, filled):
    checked = check(store)
    assert (checked.findings, checked.strays, checked.files) == ([], [], 3)
    assert checked.bytes == 2 * len(b'{"number": 0}') + len(b"<mujoco/>")


@DAMAGES
def test_a_lost_file_is_found_and_its_jobs_expire_on_repair(store, filled, damage):
    path = store.artifact_path("ann", filled["first"], "result.json")
    damage(path)
    stray = store.files.root / "results" / ("0" * 32) / ("1" * 64)
    stray.parent.mkdir()
    stray.write_bytes(b"12")
    checked = check(store)
    (finding,) = checked.findings
    assert ("missing" if not path.exists() else "damaged") in finding.text and str(path) in finding.text
    assert [(each.id, each.bytes) for each in checked.strays] == [("0" * 32, 2)] and checked.files == 2
    assert states(store, "ann", filled["first"]) == [JobState.SUCCEEDED] and stray.exists()
    backups.repair(store, Retention(store, Settings(data_dir=store.files.root)), checked)
    assert states(store, "ann", filled["first"], filled["second"]) == [JobState.EXPIRED, JobState.SUCCEEDED]
    assert not stray.parent.exists() and check(store).findings == check(store).strays == []


def restored(backup, folder, url=None):
    """A store filled from a backup."""
    settings = Settings(data_dir=folder, database=url)
    backups.restore(settings, backup)
    return open_store(settings)


def test_a_restored_store_holds_what_was_backed_up(store, filled, tmp_path, postgres_url):
    """Into SQLite, and back into a database of the same kind."""
    before = contents(store)
    assert backups.back_up(store, tmp_path / "backup") == (3, [])
    with closing(restored(tmp_path / "backup", tmp_path / "again")) as again, again.claimed():
        assert contents(again) == before and check(again).findings == []
        again.recover()
        assert again.submit("ann", document_of(1)).cached
        assert again.retry("ann", filled["failed"]).state == JobState.QUEUED
    if store.transactions.engine.dialect.name == "postgresql":
        Row.metadata.drop_all(store.transactions.engine)
        with store.transactions.write() as session:
            session.execute(text("DROP TABLE alembic_version"))
        with closing(restored(tmp_path / "backup", tmp_path / "third", postgres_url)) as third, third.claimed():
            assert contents(third) == before
            assert third.submit("ann", document_of(0)).cached


def test_a_folder_that_was_copied_by_hand_is_restored_with_its_newest_rows(store, filled, tmp_path):
    """They are in the log beside the database until SQLite writes them into it."""
    engine = store.transactions.engine
    if engine.dialect.name != "sqlite":
        pytest.skip("of SQLite")
    with engine.connect():  # the last connection that closes empties the log
        shutil.copytree(store.files.root, tmp_path / "copy")
        for name in ("", "-wal"):
            shutil.copyfile(f"{engine.url.database}{name}", tmp_path / f"copy/wsrender.db{name}")
    assert (tmp_path / "copy/wsrender.db-wal").stat().st_size > 0
    with closing(restored(tmp_path / "copy", tmp_path / "new")) as other:
        assert contents(other) == contents(store)


def test_long_documents_are_checked_and_restored(store, tmp_path, monkeypatch):
    monkeypatch.setattr(documents, "LONGEST_IN_ROW", 100)
    job = store.submit("ann", document_of(1)).job.id
    assert check(store).files == 1
    assert backups.back_up(store, tmp_path / "backup") == (1, [])
    with closing(restored(tmp_path / "backup", tmp_path / "new")) as other:
        assert other.document("ann", job) == document_of(1) and contents(other) == contents(store)
    (path,) = (path for path in (store.files.root / "documents").rglob("*") if path.is_file())
    path.unlink()
    assert [finding.computation for finding in check(store).findings] == [None]


def test_what_is_lost_is_expired_in_the_backup(store, filled, tmp_path):
    store.artifact_path("ann", filled["first"], "result.json").unlink()
    copied, lost = backups.back_up(store, tmp_path / "backup")
    assert copied == 2 and len(lost) == 1 and lost[0].startswith("result.json of ")
    assert states(store, "ann", filled["first"]) == [JobState.SUCCEEDED]
    with closing(restored(tmp_path / "backup", tmp_path / "again")) as again:
        assert states(again, "ann", filled["first"], filled["second"]) == [JobState.EXPIRED, JobState.SUCCEEDED]


def test_a_backup_is_of_one_moment_while_jobs_come_and_end(store, tmp_path):
    """Every job of it is complete: its computation, its label, its first event, and a result where it has succeeded."""
    end = threading.Event()

    def work():
        number = 100
        while not end.is_set():
            _, computation = running(store, document_of(number), labels={"number": str(number)})
            complete(store, computation, content=b"%d" % number)
            number += 1

    with ExitStack() as stack:
        thread = threading.Thread(target=work)
        thread.start()
        stack.callback(thread.join)
        stack.callback(end.set)
        for number in range(3):
            backups.back_up(store, tmp_path / f"backup{number}")
    counts = []
    for number in range(3):
        with closing(restored(tmp_path / f"backup{number}", tmp_path / f"again{number}")) as again:
            assert check(again).findings == []
            found = again.list("ann", limit=10000)[0]
            counts.append(len(found))
            for job in found:
                assert again.get("ann", job.id).labels and again.news("ann", job.id, 0)[1][0].id == 1
                if job.state == JobState.SUCCEEDED:
                    assert (
                        again.artifact_path("ann", job.id, "result.json").read_bytes() == job.labels["number"].encode()
                    )
    assert counts == sorted(counts) and counts[-1] > 1


def test_a_backup_is_restored_into_nothing_else(store, filled, tmp_path):
    backups.back_up(store, tmp_path / "backup")
    with pytest.raises(InputError, match="is not empty"):
        backups.back_up(store, tmp_path / "backup")
    with pytest.raises(InputError, match="is no backup"):
        backups.restore(Settings(data_dir=tmp_path / "new"), tmp_path / "data")
    before = contents(store)
    with pytest.raises(InputError, match="holds jobs already"):
        backups.restore(Settings(data_dir=tmp_path / "data"), tmp_path / "backup")
    url = store.transactions.engine.url.render_as_string(hide_password=False)
    with pytest.raises(InputError, match="database: holds jobs already"):
        backups.restore(Settings(data_dir=tmp_path / "new", database=url), tmp_path / "backup")
    assert contents(store) == before
    next((tmp_path / "backup/results").glob("*/*")).unlink()
    elsewhere = f"sqlite:///{tmp_path / 'elsewhere.db'}" if store.transactions.engine.dialect.name == "sqlite" else url
    if elsewhere == url:
        backups._empty_tables(store.transactions.engine)
    broken = Settings(data_dir=tmp_path / "new", database=elsewhere)
    for part in ("_copy_tables", "_settle"):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(backups, part, lambda *_: 1 / 0)
            with pytest.raises(ZeroDivisionError):
                backups.restore(broken, tmp_path / "backup")
    assert backups.restore(broken, tmp_path / "backup") == 2  # nothing of the first attempt is in the way


def test_the_commands(store, filled, tmp_path, wsrender, monkeypatch):
    if store.transactions.engine.dialect.name != "sqlite":
        pytest.skip("the same code as for SQLite")
    url = ("--database", str(store.transactions.engine.url))
    data = ("--data-dir", str(tmp_path / "data"))
    code, said, _ = wsrender("database", "check", *data, *url)
    assert code == 0 and "3 files, 35 bytes, are as they were written" in said
    code, said, _ = wsrender("database", "backup", str(tmp_path / "backup"), *data, *url)
    assert code == 0 and "holds the database and 3 files" in said
    code, said, _ = wsrender("database", "restore", str(tmp_path / "backup"), "--data-dir", str(tmp_path / "again"))
    assert code == 0 and "and 3 files in" in said
    store.artifact_path("ann", filled["first"], "result.json").unlink()
    code, said, faults = wsrender("database", "check", *data, *url)
    assert code != 0 and "is missing" in said and "1 findings" in faults
    code, said, _ = wsrender("database", "check", "--repair", *data, *url)
    assert code == 0 and states(store, "ann", filled["first"]) == [JobState.EXPIRED]
    with store.transactions.write() as session:
        session.execute(text("UPDATE computations SET used_at = 1"))
    monkeypatch.setenv("WSRENDER_KEEP_RESULTS_S", "3600")
    code, said, _ = wsrender("database", "prune", "--dry-run", *data, *url)
    assert code == 0 and said.startswith("result ") and "\n1 things, 13 bytes, would go" in said
    assert states(store, "ann", filled["second"]) == [JobState.SUCCEEDED]
    code, said, _ = wsrender("database", "prune", *data, *url)
    assert code == 0 and "are gone" in said and states(store, "ann", filled["second"]) == [JobState.EXPIRED]
    code, _, faults = wsrender("database", "prune", "--data-dir", str(tmp_path / "none"))
    assert code != 0 and "there is no database at" in faults and not (tmp_path / "none").exists()
