"""The database knows its data folder by an identity that is in both."""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"


def upgrade() -> None:
    """Add the table; the first server that starts fills it."""
    op.create_table("store_id", sa.Column("id", sa.String(length=32), nullable=False), sa.PrimaryKeyConstraint("id"))
