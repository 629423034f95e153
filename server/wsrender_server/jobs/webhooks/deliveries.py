"""The delivery of what webhooks are to get: in a thread, at least once, again and again until it is given up."""

import asyncio
import random
import ssl
import threading
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import AbstractContextManager
from datetime import UTC, datetime, timedelta

import structlog

from wsrender_server.jobs.background import in_background
from wsrender_server.jobs.clock import Clock
from wsrender_server.jobs.faults import StoreUnavailable
from wsrender_server.jobs.records import DeliveryRecord
from wsrender_server.jobs.webhooks.sender import Sender
from wsrender_server.jobs.webhooks.store import AT_ONCE_OF_WEBHOOK, WebhookStore
from wsrender_server.settings import Settings

LOOK_S = 0.5  # between looks for what is due
AT_ONCE = 128  # attempts
LONGEST_WAIT_S = 3600.0  # between two attempts
PRUNE_S = 60.0
AFTER_FAULT_S = 5.0
LAST_S = 1.0  # for attempts that go on when the server stops; what they deliver later is delivered again

log = structlog.get_logger("wsrender.webhooks")
Attempts = dict[asyncio.Task, DeliveryRecord]


class Deliveries:
    """Sends what is due to its webhooks, few at a time to each; the rows of the store outlive the process.

    ``tls`` replaces what the system trusts.
    """

    def __init__(self, store: WebhookStore, settings: Settings, tls: ssl.SSLContext | None = None):
        self._store, self._settings, self._tls = store, settings, tls
        self._clock = Clock()

    def running(self) -> AbstractContextManager[None]:
        """Deliver in a thread, for as long as the block lasts."""
        return in_background("webhooks", self._loop)

    def wait_s(self, attempts: int) -> float:
        """The time to the next attempt after so many that failed before this one [s].

        Doubled each time, and a random part of it, at least half: what failed together does not come back together.
        """
        longest = min(self._settings.webhook_retry_s * 2.0 ** min(attempts, 32), LONGEST_WAIT_S)
        return longest * random.uniform(0.5, 1.0)

    def _loop(self, end: threading.Event) -> None:
        while not end.is_set():
            try:
                asyncio.run(self._deliver(end))
            except StoreUnavailable as fault:
                log.warning("webhooks try again later", fault=str(fault))
            except Exception:
                log.exception("webhooks go on after a fault")
            end.wait(AFTER_FAULT_S)

    async def _deliver(self, end: threading.Event) -> None:
        attempts: Attempts = {}
        pruned = -PRUNE_S
        async with Sender(self._settings, self._tls) as sender:
            while not end.is_set():
                if time.monotonic() - pruned > PRUNE_S:
                    await asyncio.to_thread(self._store.prune_deliveries)
                    pruned = time.monotonic()
                due = await asyncio.to_thread(self._store.due_deliveries, datetime.now(UTC), LONGEST_WAIT_S)
                for each in _next(due, attempts):
                    attempts[asyncio.create_task(sender.send(each))] = each
                if attempts:
                    await self._settle(attempts, LOOK_S, asyncio.FIRST_COMPLETED)
                else:
                    await asyncio.sleep(LOOK_S)
            if attempts:
                await self._settle(attempts, LAST_S, asyncio.ALL_COMPLETED)
            for attempt in attempts:
                attempt.cancel()
            await asyncio.gather(*attempts, return_exceptions=True)

    async def _settle(self, attempts: Attempts, seconds: float, until: str) -> None:
        """Wait so long for any or all attempts to end, and record those that have."""
        done, _ = await asyncio.wait(attempts, timeout=seconds, return_when=until)
        outcomes = {attempts[attempt]: attempt.result() for attempt in done}
        if outcomes:
            waits = {each: self.wait_s(each.attempts) for each in outcomes}
            too_old = self._clock.now() - timedelta(seconds=self._settings.webhook_give_up_s)
            await asyncio.to_thread(self._store.settle_deliveries, outcomes, waits, too_old)
        for attempt in done:  # after they are recorded: until then they are due, and must not be sent again
            del attempts[attempt]


def _next(due: list[DeliveryRecord], attempts: Attempts) -> Iterator[DeliveryRecord]:
    """Those that may begin now."""
    at_work = {each.id for each in attempts.values()}
    of_webhook = Counter(each.webhook for each in attempts.values())
    for each in due:
        if len(at_work) < AT_ONCE and each.id not in at_work and of_webhook[each.webhook] < AT_ONCE_OF_WEBHOOK:
            of_webhook[each.webhook] += 1
            at_work.add(each.id)
            yield each
