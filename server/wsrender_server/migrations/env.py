"""Run by Alembic: migrates the connection that `upgrade` hands over."""

from alembic import context

from wsrender_server.jobs.tables import Row

context.configure(connection=context.config.attributes["connection"], target_metadata=Row.metadata)
context.run_migrations()
