"""The migrations give exactly the tables that the code uses, on both databases."""

from pathlib import Path

import wsrender_server.migrations
from alembic import command
from alembic.autogenerate import compare_metadata
from alembic.config import Config
from alembic.migration import MigrationContext
from sqlalchemy import text
from wsrender_server.jobs.database import open_database
from wsrender_server.jobs.tables import Table
from wsrender_server.migrations import upgrade


def test_migrated_tables_equal_the_declared_ones(database):
    with database.connect() as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True})
        assert compare_metadata(context, Table.metadata) == []


def test_computations_of_the_first_version_are_its_own(tmp_path):
    engine, config = open_database(f"sqlite:///{tmp_path / 'jobs.db'}"), Config()
    config.set_main_option("script_location", str(Path(wsrender_server.migrations.__file__).parent))
    with engine.execution_options(writes=True).begin() as connection:
        config.attributes["connection"] = connection
        command.upgrade(config, "0001")
        connection.execute(text("INSERT INTO computations VALUES ('a','k','ann','succeeded','{}',0,1,0,NULL,NULL)"))
    upgrade(engine)
    with engine.connect() as connection:
        assert list(connection.execute(text("SELECT id, version FROM computations"))) == [("a", "0.1.0")]
    engine.dispose()
