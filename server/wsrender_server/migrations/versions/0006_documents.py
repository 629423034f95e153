"""Long job documents lie in files: rows keep facts of theirs. Null in rows from before, whose documents are theirs."""

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"


def upgrade() -> None:
    """Add the column."""
    op.add_column("computations", sa.Column("facts", sa.JSON(), nullable=True))
