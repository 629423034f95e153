"""Versions of the database (Alembic)."""

from pathlib import Path

from alembic import command
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, Engine, inspect
from sqlalchemy.exc import DBAPIError

from wsrender import __version__
from wsrender.errors import InputError
from wsrender_server.jobs.faults import StoreUnavailable
from wsrender_server.jobs.tables import Row

BACKUP = "restore a backup of this version"


def upgrade(engine: Engine, *, check_only: bool = False) -> None:
    """Bring a database to the newest version, or only check that it is there.

    Raises StoreUnavailable where it does not answer; InputError where it is of a newer version, or has tables and says
    of no version, and with ``check_only`` where it needs an upgrade.
    """
    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parent).replace("%", "%%"))
    try:
        # One transaction: SQLite and PostgreSQL both change tables in one, so an upgrade happens wholly or not at all.
        with engine.execution_options(writes=not check_only).begin() as connection:
            scripts = ScriptDirectory.from_config(config)
            found = MigrationContext.configure(connection).get_current_heads()
            if found == (scripts.get_current_head(),):
                return
            _check_known(connection, found, {script.revision for script in scripts.walk_revisions()})
            if check_only:
                raise InputError("database", "is not of this version; run: wsrender database upgrade")
            config.attributes["connection"] = connection
            command.upgrade(config, "head")
    except DBAPIError as error:
        raise StoreUnavailable(f"the database does not answer ({error.orig})") from error


def _check_known(connection: Connection, found: tuple[str, ...], known: set[str]) -> None:
    """Raise InputError for a database whose tables are not those of one earlier version."""
    if len(found) > 1:
        raise InputError("database", f"says that it is of several versions, {', '.join(found)}: {BACKUP}")
    if found and found[0] not in known:
        newest = max(known)
        text = f"is of a newer version of wsrender: its tables are {found[0]}, those of {__version__} {newest}"
        raise InputError("database", f"{text}; install the version that it was last used with, or {BACKUP}")
    tables = sorted(set(Row.metadata.tables) & set(inspect(connection).get_table_names()))
    if not found and tables:
        text = f"has tables ({', '.join(tables)}) and says of no version: the table alembic_version is missing or empty"
        raise InputError("database", f"{text}; name an empty database, or {BACKUP}")
