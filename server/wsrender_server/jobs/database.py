"""Connections to SQLite or PostgreSQL, and their transactions."""

import sqlite3
import threading
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, Engine, create_engine, event, func, make_url, select
from sqlalchemy.exc import DBAPIError, IntegrityError
from sqlalchemy.orm import Session

from wsrender_server.jobs.faults import CommitUnknown, StoreUnavailable

LOCK_WAIT_S = 5.0
LONGEST_LOG = 1 << 23  # bytes of SQLite's write-ahead log; it writes back half of that by itself
READERS_S = 0.5  # that those who read an earlier state are waited for


def open_database(url: str, lock_wait_s: float = LOCK_WAIT_S) -> Engine:
    """An engine for a SQLite file (made if absent, WAL mode) or any other database of SQLAlchemy.

    ``lock_wait_s`` is how long SQLite waits for another process's lock.
    """
    address = make_url(url)
    if address.get_backend_name() != "sqlite":
        # No transaction of the store takes seconds; one that does holds a dead connection's lock.
        options = "-c lock_timeout=5000 -c statement_timeout=15000"
        return create_engine(
            url,
            pool_pre_ping=True,
            pool_size=10,
            max_overflow=20,
            connect_args={"connect_timeout": 5, "options": options},
        )
    if address.database:
        Path(address.database).parent.mkdir(parents=True, exist_ok=True)
    engine = create_engine(url, connect_args={"timeout": lock_wait_s}, pool_size=10, max_overflow=40)
    event.listen(engine, "connect", _set_up_sqlite)
    event.listen(engine, "begin", _begin_sqlite)
    return engine


def _set_up_sqlite(connection: sqlite3.Connection, record: Any) -> None:
    connection.isolation_level = None  # transactions begin where _begin_sqlite says so
    for pragma in ("journal_mode = WAL", "synchronous = FULL", "foreign_keys = ON"):
        connection.execute(f"PRAGMA {pragma}")


def _begin_sqlite(connection: Connection) -> None:
    # A transaction that will write takes the lock at once: upgrading a read lock later may deadlock.
    writes = connection.get_execution_options().get("writes", False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")


def lock_name(session: Session, name: str) -> None:
    """Let nobody else past this line with the same name before the transaction has ended.

    In SQLite no other transaction writes meanwhile anyway.
    """
    if session.get_bind().dialect.name == "postgresql":
        session.execute(select(func.pg_advisory_xact_lock(func.hashtextextended(name, 0))))


class Transactions:
    """Short transactions; a database that is locked, gone or full raises StoreUnavailable and changes nothing."""

    def __init__(self, engine: Engine):
        self.engine = engine
        self._writing = engine.execution_options(writes=True)
        # SQLite has one writer; threads of this process queue here rather than poll its lock.
        self.written = 0  # goes on with every transaction that may have changed something
        self._turn = threading.Lock() if engine.dialect.name == "sqlite" else None

    @contextmanager
    def read(self) -> Iterator[Session]:
        """A session that only reads."""
        try:
            with Session(self.engine) as session, session.begin():
                yield session
        except DBAPIError as error:
            raise _fault(error) from error

    @contextmanager
    def write(self) -> Iterator[Session]:
        """A session that is committed at the end of the block, or rolled back by an exception.

        Raises CommitUnknown where the database has not said which of the two it was; IntegrityError as it is.
        """
        committing = False
        try:
            with self._my_turn(), Session(self._writing) as session, session.begin():
                yield session
                session.flush()
                committing = self.engine.dialect.name != "sqlite"  # which says so, and rolls back
        except IntegrityError:
            raise
        except DBAPIError as error:
            raise _fault(error, committing) from error
        finally:
            self.written += 1

    def shorten_log(self) -> None:
        """Write back, and empty, a write-ahead log of SQLite that has become long. Raises StoreUnavailable.

        It goes on for as long as there is always somebody who reads, and nothing else makes its file shorter.
        """
        file = self.engine.url.database if self.engine.dialect.name == "sqlite" else None
        if not file or _size(Path(f"{file}-wal")) <= LONGEST_LOG:
            return
        try:
            with self._my_turn(), closing(sqlite3.connect(file, timeout=READERS_S)) as connection:
                connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")  # later where somebody reads for long
        except sqlite3.Error as error:
            raise StoreUnavailable(f"the database does not answer ({error}); nothing was changed") from error

    @contextmanager
    def _my_turn(self) -> Iterator[None]:
        if self._turn is None:
            yield
        elif self._turn.acquire(timeout=2 * LOCK_WAIT_S):
            try:
                yield
            finally:
                self._turn.release()
        else:
            raise StoreUnavailable("the database is busy; nothing was changed, try again")


def _size(file: Path) -> int:
    """Bytes of a file; 0 where there is none."""
    try:
        return file.stat().st_size
    except FileNotFoundError:
        return 0


def _fault(error: DBAPIError, committing: bool = False) -> StoreUnavailable:
    if committing:
        return CommitUnknown(
            f"the database has not said whether it took the change ({error.orig}); look, then try again"
        )
    return StoreUnavailable(f"the database does not answer ({error.orig}); nothing was changed")
