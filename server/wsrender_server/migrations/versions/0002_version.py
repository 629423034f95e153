"""Computations know the version of wsrender that computes them; all before were of 0.1.0."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"


def upgrade() -> None:
    """Add the column."""
    op.add_column("computations", sa.Column("version", sa.String(length=32), nullable=False, server_default="0.1.0"))
