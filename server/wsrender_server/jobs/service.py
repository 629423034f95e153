"""The jobs of a server as one object: table, files, dispatcher, engine."""

import contextlib

from wsrender_server.jobs.dispatcher import Dispatcher
from wsrender_server.jobs.records import WorkerRecord
from wsrender_server.jobs.retention import Retention
from wsrender_server.jobs.store import JobStore, open_store
from wsrender_server.jobs.webhooks.deliveries import Deliveries
from wsrender_server.settings import Settings


class JobService:
    """Everything about jobs that the HTTP side talks to. Use as a context manager, or start and stop it."""

    def __init__(self, settings: Settings, store: JobStore | None = None):
        self.settings = settings
        self.store = store or open_store(settings)
        self.dispatcher = Dispatcher(self.store, settings)
        self.retention = Retention(self.store, settings)
        self.deliveries = Deliveries(self.store, settings)
        self._guard = contextlib.ExitStack()

    def start(self) -> None:
        """Start dispatcher and engine, in the background: returns at once.

        Raises InputError where another server uses database or data folder, or they are not a pair.
        """
        self._guard.enter_context(self.store.claimed())
        self._guard.enter_context(self.retention.running())
        self._guard.enter_context(self.deliveries.running())
        self.dispatcher.start()

    def stop(self) -> None:
        """Stop dispatcher and engine; unfinished jobs go on at the next start."""
        self.dispatcher.stop()
        self._guard.close()
        self.store.close()

    def workers(self) -> list[WorkerRecord]:
        """The workers there are."""
        return self.dispatcher.engine.workers()

    def waits_for(self, device: str) -> str:
        """What queued jobs that ask for a device wait for."""
        return self.dispatcher.waits_for(device)

    @property
    def scheduler_ready(self) -> bool:
        """Whether the scheduler answers."""
        return self.dispatcher.engine.connected

    @property
    def worker_ready(self) -> bool:
        """Whether a live worker is there."""
        return self.dispatcher.alive

    def __enter__(self) -> "JobService":
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()
