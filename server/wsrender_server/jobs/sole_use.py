"""One server at a time, and one pair of database and data folder: a second server, or another folder, is refused."""

import contextlib
import os
import time
import uuid
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from sqlalchemy import Connection, Engine, delete, select, text
from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session

from wsrender.errors import InputError
from wsrender_server.jobs.database import Transactions
from wsrender_server.jobs.faults import StoreUnavailable
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.tables import ArtifactFile, Computation, Model, StoreId

LOCK = 0x7773_7265_6E64_6572  # "wsrender": number of PostgreSQL's advisory lock, of its own in every database
LOOK_S = 1.0
TAKEN = "is in use by another server"


class SoleUse:
    """The lock of a database, held by the server whose dispatcher works on it.

    PostgreSQL's is an advisory lock of a session, which goes with the connection; SQLite's a file beside the database.
    """

    def __init__(self, engine: Engine):
        self._engine = engine
        self._held: Connection | IO[str] | None = None
        self._looked = 0.0

    def take(self) -> None:
        """Take the lock. Raises InputError where another server has it, StoreUnavailable."""
        try:
            if self._engine.dialect.name == "postgresql":
                self._held = self._session_lock()
            elif self._engine.url.database:
                self._held = lock_file(Path(f"{self._engine.url.database}.lock"), "database")
        except DBAPIError as error:
            raise StoreUnavailable(f"the database does not answer ({error.orig})") from error

    def keep(self) -> None:
        """Take the lock again where its connection was lost; looks once a second.

        Raises StoreUnavailable where the database does not answer, or another server has the lock by now.
        """
        if not isinstance(self._held, Connection) or time.monotonic() - self._looked < LOOK_S:
            return
        self._looked = time.monotonic()
        if not _alive(self._held):
            try:
                self.take()
            except InputError as error:
                raise StoreUnavailable(f"another server has taken over: {error}") from error

    def release(self) -> None:
        """Let others have the lock."""
        held, self._held = self._held, None
        if isinstance(held, Connection) and not held.closed:
            with contextlib.suppress(DBAPIError):
                held.execute(text(f"SELECT pg_advisory_unlock({LOCK})"))  # at once: a session ends when it gets to it
            held.invalidate()
        if held is not None:
            held.close()

    def _session_lock(self) -> Connection:
        connection = self._engine.connect().execution_options(isolation_level="AUTOCOMMIT")
        if not connection.scalar(text(f"SELECT pg_try_advisory_lock({LOCK})")):
            connection.close()
            raise InputError("database", f"{self._engine.url.render_as_string()} {TAKEN}")
        return connection


def _alive(connection: Connection) -> bool:
    """Whether a connection answers; closed where it does not."""
    if connection.closed:
        return False
    try:
        connection.execute(text("SELECT 1"))
    except DBAPIError:
        connection.invalidate()
        connection.close()
        return False
    return True


def lock_file(path: Path, field: str) -> IO[str] | None:
    """An open file with a lock for as long as it is open; None where the system has no such locks.

    Raises InputError where another process has it.
    """
    try:
        import fcntl
    except ImportError:
        return None
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    file = path.open("a+")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        file.close()
        raise InputError(field, f"{path.with_suffix('') if field == 'database' else path.parent} {TAKEN}") from error
    file.truncate(0)
    file.write(f"{os.getpid()}\n")
    file.flush()
    return file


@contextlib.contextmanager
def locked_folder(folder: Path) -> Iterator[None]:
    """Hold the data folder's lock. Raises InputError where another server has it."""
    file = lock_file(folder / "server.lock", "data_dir")
    with contextlib.nullcontext() if file is None else file:
        yield


def bind(transactions: Transactions, files: DataFolder) -> None:
    """Give database and data folder one identity, or see that it is the same in both. Raises InputError.

    A folder without one is the database's if it holds what the database lists; it gets a new one, so that a folder that
    the database had before is no longer its.
    """
    with transactions.write() as session:
        known, found = session.scalar(select(StoreId.id)), files.read_id()
        if known is not None and known == found:
            return
        if found is not None or not _holds_files(session, files):
            raise InputError("data_dir", _foreign(files, known, found))
        identity = uuid.uuid4().hex
        session.execute(delete(StoreId))
        session.add(StoreId(id=identity))
    files.write_id(identity)


def check_bound(transactions: Transactions, files: DataFolder) -> None:
    """Raise StoreUnavailable where the data folder is not that of the database: nothing in it is missed then."""
    with transactions.read() as session:
        known = session.scalar(select(StoreId.id))
    found = files.read_id()
    if known is not None and known != found:
        raise StoreUnavailable(_foreign(files, known, found))


def _holds_files(session: Session, files: DataFolder) -> bool:
    """Whether the folder has a file of the database's, if the database lists any."""
    result = session.execute(select(ArtifactFile.computation_id, ArtifactFile.sha256).limit(1)).first()
    model = session.scalar(select(Model.sha256).limit(1))
    long = session.execute(select(Computation.id, Computation.facts).where(Computation.document == "").limit(1)).first()
    listed = [] if result is None else [files.artifact(*result)]
    listed += [] if long is None else [files.document(long.id, long.facts["sha256"])]
    listed += [] if model is None else [files.model(model)]
    return not listed or any(path.exists() for path in listed)


def _foreign(files: DataFolder, known: str | None, found: str | None) -> str:
    return (
        f"{files.root} is not the data folder of this database: its file store-id says {found or 'nothing'}, the "
        f"database {known or 'nothing'}; name the folder, or the database, that belongs to the other"
    )
