"""How long jobs have run is kept, in place of the time of day at which they are to end."""

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"


def upgrade() -> None:
    """Exchange the columns; the jobs that run now have their whole timeout before them."""
    op.add_column("jobs", sa.Column("ran_s", sa.Float(), nullable=False, server_default="0"))
    op.drop_index("ix_jobs_deadline", "jobs")
    op.drop_column("jobs", "deadline")
