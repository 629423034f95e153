"""Versions of the database (Alembic)."""

from pathlib import Path

from alembic import command
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Engine
from sqlalchemy.exc import DBAPIError

from wsrender.errors import InputError
from wsrender_server.jobs.faults import StoreUnavailable


def upgrade(engine: Engine, *, check_only: bool = False) -> None:
    """Bring a database to the newest version, or only check that it is there.

    Raises StoreUnavailable where it does not answer; with ``check_only`` InputError where it needs an upgrade.
    """
    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parent).replace("%", "%%"))
    try:
        # One transaction: SQLite and PostgreSQL both change tables in one, so an upgrade happens wholly or not at all.
        with engine.execution_options(writes=not check_only).begin() as connection:
            newest = ScriptDirectory.from_config(config).get_current_head()
            if MigrationContext.configure(connection).get_current_revision() == newest:
                return
            if check_only:
                raise InputError("database", "is not of this version; run: wsrender database upgrade")
            config.attributes["connection"] = connection
            command.upgrade(config, "head")
    except DBAPIError as error:
        raise StoreUnavailable(f"the database does not answer ({error.orig})") from error
