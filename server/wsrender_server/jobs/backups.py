"""Check, back up and restore a store: its database and the files that the database lists.

::

    BACKUP/wsrender.db                    every table, whatever database they came from
    BACKUP/models/…, documents/…, results/…
                                          as in the data folder
"""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import Engine, delete, insert, inspect, select, text
from sqlalchemy.exc import DBAPIError

from wsrender.errors import InputError
from wsrender_server.jobs.database import open_database
from wsrender_server.jobs.files import DATABASE, DataFolder, full_disk
from wsrender_server.jobs.records import ComputationState
from wsrender_server.jobs.retention import Removal, Retention
from wsrender_server.jobs.sole_use import check_bound, locked_folder
from wsrender_server.jobs.store import JobStore
from wsrender_server.jobs.tables import ArtifactFile, Computation, Model, Row, StoreId
from wsrender_server.migrations import upgrade
from wsrender_server.settings import Settings

KEPT = ("models", "documents", "results")  # folders of files that the database lists
AT_A_TIME = 50  # rows: a document may have megabytes


@dataclass(frozen=True)
class Discrepancy:
    """Something that is not as the database says; ``computation`` is that whose result is lost."""

    text: str
    computation: str | None = None


@dataclass(frozen=True)
class Checked:
    """What a check has looked at, what it has found, and files that nothing names."""

    files: int
    bytes: int
    findings: list[Discrepancy]
    strays: list[Removal]


def check(store: JobStore, retention: Retention) -> Checked:
    """Read every file that the database lists; see to the database itself, and whose folder it is. Changes nothing.

    A server may run meanwhile: what it removes between the list and the look is no finding. Raises StoreUnavailable.
    """
    check_bound(store.transactions, store.files)
    intact = [path.stat().st_size for path in _listed(store) if store.files.is_intact(path)]
    bad = {path: listed for path, listed in _listed(store).items() if not store.files.is_intact(path)}
    findings = [Discrepancy(fault) for fault in _database_faults(store.transactions.engine)]
    for path, (name, computation) in bad.items():
        findings.append(Discrepancy(f"{name} is {'damaged' if path.exists() else 'missing'}: {path}", computation))
    strays = [removal for removal in retention.due() if removal.what in ("files", "model")]
    return Checked(len(intact), sum(intact), findings, strays)


def repair(store: JobStore, retention: Retention, checked: Checked) -> None:
    """Let jobs whose files are lost expire, so that they can be retried; remove files that nothing names."""
    for computation in {finding.computation for finding in checked.findings}:
        if computation is not None:
            store.check_result(computation)
    for removal in checked.strays:
        retention.remove(removal)


def back_up(store: JobStore, target: Path) -> tuple[int, list[str]]:
    """Copy a store into a new folder, while a server may run: number of files, and names of those that are not there.

    The database is as of one moment. A result whose files are lost, or were removed since, is expired in the copy,
    where its jobs can be retried; unfinished jobs begin anew there. Raises InputError, StoreUnavailable, DiskFull.
    """
    check_bound(store.transactions, store.files)
    if target.exists() and any(target.iterdir()):
        raise InputError("folder", f"{target} is not empty; name a new one")
    copy = DataFolder(target)
    with full_disk(), _database(f"sqlite:///{copy.root / DATABASE}") as engine:
        upgrade(engine)
        _copy_tables(store.transactions.engine, engine)
        copied = JobStore(engine, copy)
        listed = _listed(copied)
        for path in listed:
            path.parent.mkdir(mode=0o700, exist_ok=True)
            with suppress(FileNotFoundError):
                shutil.copyfile(store.files.root / path.relative_to(copy.root), path)
        lost = [name for path, (name, _) in listed.items() if not copy.is_intact(path)]
        _settle(copied)
    for name in ("partials", "scratch"):
        (copy.root / name).rmdir()
    return len(listed) - len(lost), lost


def restore(settings: Settings, source: Path) -> int:
    """Fill an empty database and data folder from a backup, of this version or an earlier one: number of files.

    Raises InputError for a folder that is no backup, and where database or data folder hold something already.
    """
    if not (source / DATABASE).is_file():
        raise InputError("folder", f"{source} is no backup: it has no {DATABASE}")
    data = settings.data_dir.absolute()
    if any((data / DATABASE).parent.glob(f"{DATABASE}*")) or any(_files_in(data)):
        raise InputError("data_dir", f"{data} holds jobs already: a backup is restored into an empty folder")
    files = DataFolder(data)
    with full_disk(), locked_folder(data), _database(settings.database_url) as engine:
        if _has_rows(engine):
            raise InputError("database", "holds jobs already: a backup is restored into an empty database")
        try:
            paths = list(_files_in(source))
            for path in paths:
                target = files.root / path.relative_to(source)
                target.parent.mkdir(mode=0o700, exist_ok=True)
                shutil.copyfile(path, target)
            between = files.root / "scratch" / DATABASE
            for name in (DATABASE, f"{DATABASE}-wal"):  # a folder that was copied by hand has its newest rows there
                with suppress(FileNotFoundError):
                    shutil.copyfile(source / name, between.with_name(name))
            with _database(f"sqlite:///{between}") as earlier:
                upgrade(earlier)
                upgrade(engine)
                _copy_tables(earlier, engine)
            files.empty_scratch()
            _settle(JobStore(engine, files))
        except BaseException:  # another attempt finds nothing of this one
            with suppress(DBAPIError):
                _empty_tables(engine)
            engine.dispose()
            for name in (*KEPT, "scratch"):
                shutil.rmtree(files.root / name, ignore_errors=True)
            for path in data.glob(f"{DATABASE}*"):
                path.unlink()
            raise
    return len(paths)


def _listed(store: JobStore) -> dict[Path, tuple[str, str | None]]:
    """Every file that the database lists: what it is, and the computation whose result it belongs to."""
    results = select(ArtifactFile.computation_id, ArtifactFile.sha256, ArtifactFile.name)
    with store.transactions.read() as session:
        listed: dict[Path, tuple[str, str | None]] = {
            store.files.artifact(row.computation_id, row.sha256): (f"{row.name} of {row.computation_id}", row[0])
            for row in session.execute(results)
        }
        for row in session.execute(select(Computation.id, Computation.facts).where(Computation.document == "")):
            path = store.files.document(row.id, row.facts["sha256"])
            listed[path] = (f"the document of {row.id}", None)
        models = session.execute(select(Model.sha256, Model.owner))
        return listed | {store.files.model(row.sha256): (f"a model of {row.owner}", None) for row in models}


def _database_faults(engine: Engine) -> list[str]:
    """What SQLite finds wrong with its file; PostgreSQL has tools of its own for that."""
    if engine.dialect.name != "sqlite":
        return []
    with engine.connect() as connection:
        found = [str(row[0]) for row in connection.execute(text("PRAGMA integrity_check")) if row[0] != "ok"]
        foreign = connection.execute(text("PRAGMA foreign_key_check")).all()
    return found + [f"a row of {row[0]} refers to one of {row[2]} that is not there" for row in foreign]


def _copy_tables(source: Engine, target: Engine) -> None:
    """Copy all rows, as of one moment, in one transaction."""
    snapshot = {"isolation_level": "REPEATABLE READ"} if source.dialect.name == "postgresql" else {}
    with (
        source.connect().execution_options(**snapshot, yield_per=AT_A_TIME) as reading,
        target.execution_options(writes=True).begin() as writing,
    ):
        for table in Row.metadata.sorted_tables:
            for rows in reading.execute(select(table)).mappings().partitions():
                writing.execute(insert(table), [dict(row) for row in rows])


def _settle(store: JobStore) -> None:
    """Make a copied database and its folder a pair, and let the jobs whose files have not come with it expire."""
    with store.transactions.read() as session:
        identity = session.scalar(select(StoreId.id))
        succeeded = select(Computation.id).where(Computation.state == ComputationState.SUCCEEDED)
        computations = list(session.scalars(succeeded))
    if identity is not None:
        store.files.write_id(identity)
    for computation in computations:
        store.check_result(computation)


def _has_rows(engine: Engine) -> bool:
    with engine.connect() as connection:
        there = set(inspect(connection).get_table_names())
        tables = [table for table in Row.metadata.sorted_tables if table.name in there]
        return any(connection.execute(select(text("1")).select_from(table).limit(1)).first() for table in tables)


def _empty_tables(engine: Engine) -> None:
    with engine.execution_options(writes=True).begin() as connection:
        for table in reversed(Row.metadata.sorted_tables):
            connection.execute(delete(table))


def _files_in(folder: Path) -> Iterator[Path]:
    return (path for kind in KEPT for path in sorted((folder / kind).rglob("*")) if path.is_file())


@contextmanager
def _database(url: str) -> Iterator[Engine]:
    engine = open_database(url)
    try:
        yield engine
    finally:
        engine.dispose()
