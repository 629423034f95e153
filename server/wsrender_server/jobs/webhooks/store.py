"""Webhooks in the database: registered by their owners, and what is to be delivered to them."""

import uuid
from collections import Counter
from collections.abc import Iterable, Mapping
from datetime import UTC, datetime, timedelta
from typing import Any

import structlog
from sqlalchemy import delete, func, or_, select
from sqlalchemy.orm import Session

from wsrender.errors import InputError
from wsrender_server.jobs.database import Transactions, lock_name
from wsrender_server.jobs.faults import InvalidTransition, QuotaExceeded
from wsrender_server.jobs.records import DeliveryOutcome, DeliveryRecord, JobState, WebhookRecord
from wsrender_server.jobs.tables import Delivery, Webhook, add_delivery, message
from wsrender_server.jobs.webhooks.signature import new_secret

MOST_OF_OWNER = 8
MOST_WAITING = 10_000  # deliveries of a webhook; of more the oldest are given up
AT_ONCE_OF_WEBHOOK = 4

log = structlog.get_logger("wsrender.webhooks")


class WebhookStore:
    """The webhooks' part of the store."""

    transactions: Transactions
    deliveries: "Counter[str]"  # of this process: attempts that delivered or failed, and messages that were given up

    def create_webhook(self, owner: str, url: str, states: Iterable[JobState]) -> tuple[WebhookRecord, str]:
        """A new webhook and its secret, which is never shown again. Raises QuotaExceeded, InputError."""
        wanted = tuple(dict.fromkeys(JobState(state) for state in states))
        if not wanted:
            raise InputError("states", f"must be some of {', '.join(JobState)}, not none")
        row = Webhook(
            id=uuid.uuid4().hex,
            owner=owner,
            url=url,
            states=" ".join(wanted),
            secret=new_secret(),
            created_at=datetime.now(UTC),
            delivered=0,
            given_up=0,
        )
        with self.transactions.write() as session:
            lock_name(session, f"webhooks of {owner}")
            if _count(session, Webhook.owner == owner) >= MOST_OF_OWNER:
                raise QuotaExceeded(f"{MOST_OF_OWNER} webhooks are allowed; delete one")
            session.add(row)
            return _record(row, 0), row.secret

    def list_webhooks(self, owner: str) -> list[WebhookRecord]:
        """An owner's webhooks, oldest first."""
        with self.transactions.read() as session:
            query = select(Webhook).where(Webhook.owner == owner).order_by(Webhook.created_at, Webhook.id)
            return [_record(row, _waiting(session, row.id)) for row in session.scalars(query)]

    def webhook(self, owner: str, webhook_id: str) -> WebhookRecord | None:
        """A webhook; None where there is none."""
        with self.transactions.read() as session:
            row = session.scalar(select(Webhook).where(Webhook.id == webhook_id, Webhook.owner == owner))
            return None if row is None else _record(row, _waiting(session, row.id))

    def delete_webhook(self, owner: str, webhook_id: str) -> bool:
        """Forget a webhook and what it has not got yet; False where there is none."""
        with self.transactions.write() as session:
            mine = Webhook.id == webhook_id, Webhook.owner == owner
            row = session.scalar(select(Webhook).where(*mine).with_for_update())
            if row is None:
                return False
            session.execute(delete(Delivery).where(Delivery.webhook_id == webhook_id))
            session.delete(row)
        return True

    def test_webhook(self, owner: str, webhook_id: str) -> str | None:
        """Let a webhook get a message that says nothing of any job: its id; None where there is no such webhook.

        Raises InvalidTransition for one that is disabled.
        """
        now = datetime.now(UTC)
        with self.transactions.write() as session:
            row = session.scalar(select(Webhook).where(Webhook.id == webhook_id, Webhook.owner == owner))
            if row is None:
                return None
            if row.disabled_at is not None:
                raise InvalidTransition("disabled", "tested", "a webhook")
            return add_delivery(session, row.id, now, message("webhook.test", now, {"id": row.id}))

    def due_deliveries(self, now: datetime, longest_wait_s: float) -> list[DeliveryRecord]:
        """What is to be sent by now: of every webhook the first few, the first of all of them before the second of any.

        What waits longer than anything may is due as well: the clock was set back meanwhile.
        """
        far = now + timedelta(seconds=longest_wait_s)
        place = func.row_number().over(partition_by=Delivery.webhook_id, order_by=(Delivery.next_at, Delivery.id))
        due = select(Delivery.id, Delivery.next_at, place.label("place"))
        due = due.where(or_(Delivery.next_at <= now, Delivery.next_at > far)).subquery()
        query = select(Delivery.id, Delivery.webhook_id, Webhook.url, Webhook.secret, Delivery.body, Delivery.attempts)
        query = query.join(due, due.c.id == Delivery.id).join(Webhook, Webhook.id == Delivery.webhook_id)
        query = query.where(due.c.place <= AT_ONCE_OF_WEBHOOK, Webhook.disabled_at.is_(None))
        query = query.order_by(due.c.place, due.c.next_at, Delivery.id)
        with self.transactions.read() as session:
            return [DeliveryRecord(*row) for row in session.execute(query)]

    def settle_deliveries(
        self,
        outcomes: Mapping[DeliveryRecord, DeliveryOutcome],
        waits_s: Mapping[DeliveryRecord, float],
        too_old: datetime,
    ) -> None:
        """Record what came of attempts; ``waits_s`` is the time to the next of one that has failed [s].

        A failure of a message that was made before ``too_old`` is its last.
        """
        now = datetime.now(UTC)
        told: Counter[str] = Counter()
        with self.transactions.write() as session:
            ids = sorted({each.webhook for each in outcomes})
            query = select(Webhook).where(Webhook.id.in_(ids)).order_by(Webhook.id).with_for_update()
            webhooks = {row.id: row for row in session.scalars(query)}
            for sent, outcome in outcomes.items():
                webhook, row = webhooks.get(sent.webhook), session.get(Delivery, sent.id)
                told["delivered" if outcome.delivered else "failed"] += 1
                if webhook is None or row is None:  # deleted meanwhile
                    continue
                if outcome.delivered:
                    webhook.delivered, webhook.last_delivered_at = webhook.delivered + 1, now
                    session.delete(row)
                    continue
                webhook.last_error, webhook.last_error_at = outcome.said, now
                row.attempts += 1
                row.next_at = now + timedelta(seconds=waits_s[sent])
                if outcome.gone:
                    webhook.disabled_at = webhook.disabled_at or now
                if outcome.gone or row.created_at < too_old:
                    webhook.given_up += 1
                    told["given_up"] += 1
                    session.delete(row)
                    log.warning("a delivery is given up", webhook=webhook.id, message=sent.id, reason=outcome.said)
        self.deliveries.update(told)

    def prune_deliveries(self) -> None:
        """Forget what nobody is to get any more, and the oldest of a webhook for which too many wait."""
        live = select(Webhook.id).where(Webhook.disabled_at.is_(None))
        count = func.count().label("count")
        query = select(Delivery.webhook_id, count).group_by(Delivery.webhook_id).having(count > MOST_WAITING)
        with self.transactions.write() as session:
            session.execute(delete(Delivery).where(Delivery.webhook_id.not_in(live)))
            for webhook_id, waiting in session.execute(query.order_by(Delivery.webhook_id)).all():
                row = session.scalar(select(Webhook).where(Webhook.id == webhook_id).with_for_update())
                if row is None:  # deleted at this moment
                    continue
                oldest = select(Delivery.id).where(Delivery.webhook_id == webhook_id)
                oldest = oldest.order_by(Delivery.created_at, Delivery.id).limit(waiting - MOST_WAITING)
                session.execute(delete(Delivery).where(Delivery.id.in_(oldest.scalar_subquery())))
                row.given_up += waiting - MOST_WAITING
                row.last_error = f"more than {MOST_WAITING} messages waited; the oldest were given up"
                row.last_error_at = datetime.now(UTC)
                self.deliveries["given_up"] += waiting - MOST_WAITING

    def waiting_deliveries(self) -> int:
        """Messages that are still to be delivered, of all owners."""
        with self.transactions.read() as session:
            return session.scalar(select(func.count()).select_from(Delivery)) or 0


def _count(session: Session, condition: Any) -> int:
    return session.scalar(select(func.count()).where(condition)) or 0


def _waiting(session: Session, webhook_id: str) -> int:
    return _count(session, Delivery.webhook_id == webhook_id)


def _record(row: Webhook, waiting: int) -> WebhookRecord:
    return WebhookRecord(
        id=row.id,
        url=row.url,
        states=tuple(map(JobState, row.states.split())),
        created_at=row.created_at,
        disabled_at=row.disabled_at,
        waiting=waiting,
        delivered=row.delivered,
        given_up=row.given_up,
        last_delivered_at=row.last_delivered_at,
        last_error_at=row.last_error_at,
        last_error=row.last_error,
    )
