"""The jobs of a server as one object: table, files, dispatcher, engine."""

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

from wsrender.errors import InputError
from wsrender_server.jobs.dispatcher import Dispatcher
from wsrender_server.jobs.records import WorkerRecord
from wsrender_server.jobs.store import JobStore, open_store
from wsrender_server.settings import Settings


class JobService:
    """Everything about jobs that the HTTP side talks to. Use as a context manager, or start and stop it."""

    def __init__(self, settings: Settings, store: JobStore | None = None):
        self.settings = settings
        self.store = store or open_store(settings)
        self.dispatcher = Dispatcher(self.store, settings)
        self._guard = contextlib.ExitStack()

    def start(self) -> None:
        """Start dispatcher and engine, in the background: returns at once.

        Raises InputError where another server uses the data folder.
        """
        self._guard.enter_context(_only_server(self.settings.data_dir))
        self.dispatcher.start()

    def stop(self) -> None:
        """Stop dispatcher and engine; unfinished jobs go on at the next start."""
        self.dispatcher.stop()
        self.store.close()
        self._guard.close()

    def workers(self) -> list[WorkerRecord]:
        """The workers there are."""
        return self.dispatcher.engine.workers()

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


@contextlib.contextmanager
def _only_server(data_dir: Path) -> Iterator[None]:
    """Hold the data folder's lock: two dispatchers would do everything twice."""
    try:
        import fcntl
    except ImportError:  # a system without it: nothing guards the folder there
        yield
        return
    data_dir.mkdir(parents=True, exist_ok=True)
    with (data_dir / "server.lock").open("a+") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise InputError("data_dir", f"{data_dir} is in use by another server") from error
        file.truncate(0)
        file.write(f"{os.getpid()}\n")
        file.flush()
        yield
