"""API keys: made once, kept as hashes."""

import hashlib
import hmac
import secrets
from collections.abc import Iterable
from datetime import UTC, datetime

from sqlalchemy import delete, select

from wsrender.errors import InputError
from wsrender_server.jobs.database import Transactions
from wsrender_server.jobs.records import KeyRecord
from wsrender_server.jobs.tables import Key, Webhook

SCOPES = ("read", "submit", "priority", "admin")
PREFIX = "wsr"


class KeyStore:
    """The API keys' part of the store."""

    transactions: Transactions

    def create_key(self, name: str, scopes: Iterable[str] = ("read", "submit")) -> tuple[KeyRecord, str]:
        """A new key and its secret, ``wsr_<id>_<43 characters>``, which is not kept and never shown again."""
        scopes = tuple(dict.fromkeys(scopes))
        if not scopes or not set(scopes) <= set(SCOPES):
            raise InputError("scopes", f"must be some of {', '.join(SCOPES)}, not {', '.join(scopes) or 'none'}")
        if not 1 <= len(name) <= 255:
            raise InputError("name", "must have 1 to 255 characters")
        key_id = secrets.token_hex(8)
        # 256 random bits need no slow hash: there is nothing to guess.
        secret = f"{PREFIX}_{key_id}_{secrets.token_urlsafe(32)}"
        row = Key(
            id=key_id,
            name=name,
            scopes=" ".join(scopes),
            secret_hash=_hash(secret),
            created_at=datetime.now(UTC),
            revoked_at=None,
        )
        with self.transactions.write() as session:
            session.add(row)
            return _record(row), secret

    def list_keys(self) -> list[KeyRecord]:
        """All keys, oldest first, revoked ones included."""
        with self.transactions.read() as session:
            return [_record(row) for row in session.scalars(select(Key).order_by(Key.created_at, Key.id))]

    def has_key(self) -> bool:
        """Whether there is a key that is not revoked."""
        with self.transactions.read() as session:
            return session.scalar(select(Key.id).where(Key.revoked_at.is_(None)).limit(1)) is not None

    def is_live(self, key_id: str) -> bool:
        """Whether a key is there and not revoked."""
        with self.transactions.read() as session:
            row = session.get(Key, key_id)
            return row is not None and row.revoked_at is None

    def revoke_key(self, key_id: str) -> KeyRecord | None:
        """Revoke a key, and forget its webhooks; None for an unknown one."""
        with self.transactions.write() as session:
            row = session.get(Key, key_id)
            if row is None:
                return None
            row.revoked_at = row.revoked_at or datetime.now(UTC)
            session.execute(delete(Webhook).where(Webhook.owner == key_id))
            return _record(row)

    def find_key(self, secret: str) -> KeyRecord | None:
        """The key of a secret; None for one that is unknown, wrong or revoked."""
        parts = secret.split("_", 2)
        key_id = parts[1] if len(parts) == 3 and parts[0] == PREFIX else ""
        with self.transactions.read() as session:
            row = session.get(Key, key_id) if key_id.isalnum() and len(key_id) == 16 else None
            # Compared in constant time, and also where there is nothing to compare with.
            matches = hmac.compare_digest(row.secret_hash if row else _hash(""), _hash(secret))
            return _record(row) if row and matches and row.revoked_at is None else None


def _hash(secret: str) -> str:
    return hashlib.sha256(secret.encode("utf-8", "surrogatepass")).hexdigest()


def _record(row: Key) -> KeyRecord:
    return KeyRecord(row.id, row.name, tuple(row.scopes.split()), row.created_at, row.revoked_at)
