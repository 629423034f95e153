"""The migrations give exactly the tables that the code uses, on both databases."""

from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from wsrender_server.jobs.tables import Table


def test_migrated_tables_equal_the_declared_ones(database):
    with database.connect() as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True})
        assert compare_metadata(context, Table.metadata) == []
