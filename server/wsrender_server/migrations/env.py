"""Run by Alembic: migrates the connection that `upgrade` hands over."""

from alembic import context

from wsrender_server.jobs.tables import Table

context.configure(connection=context.config.attributes["connection"], target_metadata=Table.metadata)
context.run_migrations()
