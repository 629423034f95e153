"""Dask distributed, embedded or elsewhere: the only execution engine."""

import asyncio
import contextlib
import logging
import threading
import time
from collections.abc import Callable, Iterable
from typing import Any

from dask import config
from distributed import Client, Future, LocalCluster
from distributed.comm.core import CommClosedError

from wsrender_server.jobs import worker as workers_side
from wsrender_server.jobs.faults import EngineSlow, EngineUnavailable
from wsrender_server.jobs.records import WorkerRecord
from wsrender_server.jobs.task import Outcome, Step, Task
from wsrender_server.settings import Settings

CONNECT_S = 10
ANSWER_S = 3  # of the scheduler
LOST_S = 60.0  # one that is connected is slow until then
WORKER_ANSWER_S = 1.5  # whoever is canceled waits no longer for a worker that hangs
QUIET_S = 20.0  # a worker gives a sign of life every second or so
WORKER_TTL_S = 30  # a worker without one for so long is lost, and its tasks go to others
# A later step goes before the earlier steps of other jobs: what has begun is finished first.
URGENCY = {Step.PLAN: 0, Step.SHARD: 1, Step.FINISH: 2}

MOST_TURNS = 2**32  # of owners, within which the urgency is the same

LOST = (CommClosedError, OSError, TimeoutError, RuntimeError, ValueError)

log = logging.getLogger(__name__)


class Engine:
    """A Dask client and, without a scheduler in the settings, the cluster behind it.

    ``on_message(message)`` is called in a thread of Dask for everything that workers report.
    """

    def __init__(self, settings: Settings, on_message: Callable[[dict[str, Any]], None]):
        self._settings = settings
        self._on_message = on_message
        self._cluster: LocalCluster | None = None
        self._client: Client | None = None
        self._lock = threading.Lock()
        self.alive: set[str] = set()  # targets of the workers that are alive, as `targets` found them last
        self._answered = 0.0  # when the scheduler last did
        self._heard: dict[str, tuple[float, float]] = {}  # last sign of life of each worker, and when it was new here

    @property
    def embedded(self) -> bool:
        """Whether the cluster is this server's own."""
        return self._settings.scheduler is None

    @property
    def connected(self) -> bool:
        """Whether the scheduler answers."""
        return self._client is not None and self._client.status == "running"

    def connect(self, resume: Callable[[], None] = lambda: None) -> None:
        """Start the cluster or join it; after a loss, join it anew. Raises EngineUnavailable.

        ``resume`` hands out what was out before, by the same names, before the former connection ends: what a scheduler
        still knows runs on.
        """
        former = self._client
        try:
            # Where an embedded scheduler listens is nobody's business but its own workers'.
            with config.set(
                {
                    "distributed.comm.timeouts.connect": CONNECT_S,
                    "distributed.scheduler.worker-ttl": f"{WORKER_TTL_S}s",
                }
            ):
                if self._settings.scheduler is None:
                    client = Client(self._embedded(), timeout=CONNECT_S, set_as_default=False)
                else:
                    client = Client(
                        self._settings.scheduler,
                        security=workers_side.security(self._settings),
                        timeout=CONNECT_S,
                        set_as_default=False,
                    )
            _keep_no_spans(client)
            client.subscribe_topic(workers_side.TOPIC, lambda event: self._on_message(event[1]))
        except LOST as error:
            raise EngineUnavailable(f"the scheduler does not answer: {error}") from error
        self._client, self._answered = client, time.monotonic()
        try:
            resume()
        finally:
            _leave(former)

    def close(self) -> None:
        """Leave the scheduler; end an embedded cluster."""
        client, self._client = self._client, None
        _leave(client)
        cluster, self._cluster = self._cluster, None
        if cluster is not None:
            with contextlib.suppress(*LOST):
                cluster.close(timeout=ANSWER_S)

    def submit(self, tasks: dict[str, Task], priority: int, target: str, turn: int = 0) -> list[Future]:
        """Hand tasks of one step to the scheduler, by name; workers of ``target``, or of a kind of device, run them.

        One message for all: a thousand messages would keep this process from anything else for seconds. Raises
        EngineUnavailable.
        """
        (step,) = {task.step for task in tasks.values()}
        try:
            return self._connected().map(
                workers_side.run_task,
                list(tasks.values()),
                key=list(tasks),
                priority=(priority * len(URGENCY) + URGENCY[step]) * MOST_TURNS - turn,
                resources={target: 1},
                retries=0,
                pure=False,
            )
        except LOST as error:
            raise self._fault(error) from error

    def stop(self, tokens: list[str], futures: list[Future]) -> None:
        """End attempts: nothing of them starts any more, and their kernel processes are killed when this returns.

        A worker that does not answer within 1.5 s does so as soon as it can.
        """
        client = self._connected()
        try:
            known = self._known()
            client.cancel(futures, force=True)
            self._ask(known, workers_side.stop_tokens, tokens)
        except LOST as error:
            raise self._fault(error) from error

    def workers(self) -> list[WorkerRecord]:
        """The workers that answer; none where the scheduler does not."""
        if not self.connected:
            return []
        try:
            known = self._known()
            busy = self._ask(known, workers_side.is_busy)
        except (EngineUnavailable, *LOST):
            return []
        return [
            WorkerRecord(
                address=address,
                host=info["host"],
                target=max(_targets_of(info), default=None),
                devices=tuple(sorted({target.partition(":")[0] for target in _targets_of(info)})),
                busy=busy[address],
            )
            for address, info in known.items()
            if address in busy
        ]

    def targets(self) -> dict[str, str]:
        """The target that each kind of device ("auto", "cpu", "cuda") means on the workers that are alive."""
        try:
            known = self._known()
        except LOST as error:
            raise self._fault(error) from error
        self._heard = {address: self._news(address, info["last_seen"]) for address, info in known.items()}
        alive = [info for address, info in known.items() if time.monotonic() - self._heard[address][1] < QUIET_S]
        self.alive = {target for info in alive for target in _targets_of(info)}
        targets = {name.partition(":")[0]: name for name in sorted(self.alive)}
        if targets:
            targets["auto"] = targets.get("cuda", targets.get("cpu", ""))
        return targets

    def kernel_pids(self) -> dict[str, int | None]:
        """Process ids of the kernel processes by worker address."""
        return self._ask(self._known(), workers_side.kernel_pid)

    def _known(self) -> dict[str, Any]:
        """What the scheduler knows of its workers, by address."""
        client = self._connected()
        scheduler: Any = client.scheduler  # there is one while the client runs
        identity: Any = client.sync(scheduler.identity, n_workers=-1, callback_timeout=ANSWER_S)
        self._answered = time.monotonic()
        return identity["workers"]

    def _fault(self, error: Exception) -> EngineUnavailable:
        """What an error of Dask means: a scheduler that is connected is lost only once it was silent for long."""
        silent = time.monotonic() - self._answered
        slow = isinstance(error, TimeoutError) and self.connected and silent < LOST_S
        return (EngineSlow if slow else EngineUnavailable)(f"the scheduler does not answer: {error!r}")

    def _news(self, address: str, last_seen: float) -> tuple[float, float]:
        """A worker's last sign of life by the scheduler's clock, and when it was new by ours."""
        before = self._heard.get(address)
        return before if before is not None and before[0] == last_seen else (last_seen, time.monotonic())

    def _ask(self, addresses: Iterable[str], function: Callable[..., Any], *arguments: Any) -> dict[str, Any]:
        """Answers of workers by address, of those that answer in time."""
        client = self._connected()
        return client.sync(_answers, client, list(addresses), function, arguments)  # pyright: ignore[reportReturnType]

    def _connected(self) -> Client:
        client = self._client
        if client is None or client.status != "running":
            raise EngineUnavailable("there is no connection to the scheduler")
        return client

    def _embedded(self) -> LocalCluster:
        if self._cluster is None:
            # A worker that was lost begins anew; Dask would give its place up after 15 s.
            config.set({"distributed.deploy.lost-worker-timeout": f"{self._settings.worker_start_s}s"})
            self._cluster = LocalCluster(
                n_workers=self._settings.workers,
                threads_per_worker=1,
                processes=True,
                host="127.0.0.1",
                protocol="tls://",
                security=True,
                dashboard_address="127.0.0.1:0",
                worker_dashboard_address=None,
                silence_logs=logging.ERROR,
                **{k: v for k, v in workers_side.worker_options(self._settings).items() if k != "nthreads"},
            )
        return self._cluster


def _keep_no_spans(client: Client) -> None:
    """Let the scheduler measure no spans: it would keep those of every job for ever, and so would its workers."""

    class NoSpans:  # here, so that a scheduler without this package can have it
        def __bool__(self) -> bool:
            return False

        def heartbeat(self, worker: Any, measured: Any) -> None:
            """Forget what a worker has measured."""

    def replace(dask_scheduler: Any) -> None:
        dask_scheduler.extensions["spans"] = NoSpans()

    client.run_on_scheduler(replace)


def _leave(client: Client | None) -> None:
    if client is not None:
        with contextlib.suppress(*LOST):
            client.unsubscribe_topic(workers_side.TOPIC)  # else the scheduler tells the log whom it cannot tell
            client.close(timeout=ANSWER_S)


async def _answers(
    client: Client, addresses: list[str], function: Callable[..., Any], arguments: tuple[Any, ...]
) -> dict[str, Any]:
    """What ``function(*arguments)`` returns on each worker that answers within WORKER_ANSWER_S."""

    async def ask(address: str) -> Any:
        answer: Any = client.run(function, *arguments, workers=[address], asynchronous=True)
        return (await answer)[address]

    asked = {address: asyncio.ensure_future(ask(address)) for address in addresses}
    if asked:
        await asyncio.wait(asked.values(), timeout=WORKER_ANSWER_S)
    for task in asked.values():
        task.cancel()  # of one that has ended, nothing
    return {address: task.result() for address, task in asked.items() if task.done() and not _failed(task)}


def _targets_of(info: dict[str, Any]) -> list[str]:
    """The targets among what a worker computes on; a kind of device has no colon."""
    return [name for name in info["resources"] if ":" in name]


def _failed(task: asyncio.Task[Any]) -> bool:
    return task.cancelled() or task.exception() is not None


def outcome_of(future: Future) -> Outcome | None:
    """How a finished future's task ended; None where its worker or the scheduler was lost."""
    if future.status != "finished":
        return None
    try:
        return future.result(timeout=ANSWER_S)
    except Exception as error:
        log.warning("a task's outcome was lost: %r", error)
        return None
