"""Computations know how large their results are, and when they were last used: at the latest now, at the upgrade."""

import json
import time

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"


def upgrade() -> None:
    """Add the columns."""
    op.add_column("computations", sa.Column("bytes", sa.BigInteger(), nullable=False, server_default="0"))
    op.add_column("computations", sa.Column("used_at", sa.BigInteger(), nullable=False, server_default="0"))
    connection = op.get_bind()
    connection.execute(sa.text("UPDATE computations SET used_at = :now"), {"now": round(time.time() * 1e6)})
    sizes: dict[tuple[str, str], int] = {}  # by computation and hash: a file that has two names is there once
    for computation, sha256, record in connection.execute(
        sa.text("SELECT computation_id, sha256, record FROM artifacts")
    ):
        sizes[computation, sha256] = (json.loads(record) if isinstance(record, str) else record)["bytes"]
    totals: dict[str, int] = {}
    for (computation, _), size in sizes.items():
        totals[computation] = totals.get(computation, 0) + size
    if totals:
        rows = [{"id": computation, "bytes": size} for computation, size in totals.items()]
        connection.execute(sa.text("UPDATE computations SET bytes = :bytes WHERE id = :id"), rows)
