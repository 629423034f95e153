"""Dask workers: one kernel process each, described to the scheduler by the targets that it can compute for."""

import asyncio
import logging
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import psutil
from dask import config
from distributed import Nanny, Reschedule, Security, Status, Worker, WorkerPlugin, get_worker

from wsrender_server.jobs.kernel_process import KernelProcess
from wsrender_server.jobs.task import Outcome, Step, Task, Verdict
from wsrender_server.settings import Settings

TOPIC = "wsrender"
PLUGIN = "wsrender-kernels"
RECONNECT_S = 2.0
STOP_S = 1.0

log = logging.getLogger(__name__)

DASK = {
    "distributed.worker.daemon": False,  # daemons may not have processes of their own
    # Dask would look at itself up to a hundred times a second, and take a tenth of a core from the kernels.
    "distributed.worker.profile.enabled": False,
    "distributed.admin.system-monitor.interval": "5s",
    "distributed.admin.tick.interval": "1s",
}
config.set(DASK)


class Kernels(WorkerPlugin):
    """Gives a Dask worker its kernel process.

    It is set up before the worker registers, so that the scheduler knows from the first moment as resources what the
    worker computes on: its targets, their kinds of device, and "auto".
    """

    name = PLUGIN

    def __init__(self, settings: dict[str, Any]):
        self.settings = settings
        self.process: KernelProcess

    async def setup(self, worker: Worker) -> None:
        """Start the kernel process and declare what it can compute for."""
        self.process = KernelProcess(Settings.model_validate(self.settings))
        self.targets = await asyncio.to_thread(self.process.describe)
        for name in ("auto", *self.targets, *self.targets.values()):
            worker.state.total_resources[name] = worker.state.available_resources[name] = 1

    async def teardown(self, worker: Worker) -> None:
        """End the kernel process."""
        await asyncio.to_thread(self.process.close)


def run_task(task: Task) -> Outcome:
    """What Dask runs in a worker's thread: the task, in the worker's kernel process."""
    worker = get_worker()

    def report(done: int, total: int) -> None:
        news = {"shard": task.shard, "done": done} if task.step == Step.SHARD else {"decided": (done, total)}
        worker.log_event(TOPIC, {"token": task.token, **news})

    worker.log_event(TOPIC, {"token": task.token, "step": str(task.step)})
    process = _process(worker)
    outcome = process.run(task, report)
    if outcome.verdict == Verdict.LOST and process.closed:
        raise Reschedule  # on another worker: no fault of the task's
    return outcome


def stop_tokens(tokens: list[str], dask_worker: Worker) -> None:
    """Called on every worker's event loop to stop attempts (see `KernelProcess.stop`)."""
    for token in tokens:
        _process(dask_worker).stop(token)


def is_busy(dask_worker: Worker) -> bool:
    """Whether a worker's kernel process is at work."""
    return _process(dask_worker).busy


def kernel_pid(dask_worker: Worker) -> int | None:
    """Process id of a worker's kernel process."""
    return _process(dask_worker).pid


def serve_scheduler(
    settings: Settings,
    on_start: Callable[[], None] | None = None,
    stop: threading.Event | None = None,
    name: str | None = None,
) -> None:
    """Run a worker for the settings' scheduler until ``stop`` is set; it joins again where the scheduler was lost.

    ``name`` is what the scheduler calls it, its address by default.
    """
    asyncio.run(_serve(settings, on_start, stop or threading.Event(), name))


async def _serve(
    settings: Settings, on_start: Callable[[], None] | None, stop: threading.Event, name: str | None
) -> None:
    while not stop.is_set():
        options = {**worker_options(settings), "dashboard": False, "dashboard_address": "127.0.0.1:0"}
        worker = Nanny(settings.scheduler, name=name, security=security(settings), **options)
        life = asyncio.ensure_future(_live(worker, on_start))
        while not (stop.is_set() or life.done()):
            await asyncio.wait([life], timeout=0.1)
        try:
            if not life.done():
                await _end(worker)
                await asyncio.wait([life], timeout=STOP_S)
                life.cancel()
            await life
        except asyncio.CancelledError:
            continue
        except (OSError, TimeoutError, RuntimeError) as error:  # RuntimeError: Dask's nanny could not start its worker
            if not stop.is_set():
                log.warning("no worker at %s: %s; trying again", settings.scheduler, error)
        if not stop.is_set():
            await asyncio.sleep(RECONNECT_S)


async def _live(worker: Nanny, on_start: Callable[[], None] | None) -> None:
    async with worker:
        if on_start is not None:
            on_start()
        await worker.finished()


async def _end(worker: Nanny) -> None:
    """Let a worker leave its scheduler, or kill it where it takes longer than STOP_S or has not joined yet."""
    if worker.status == Status.running:
        await worker.close(timeout=STOP_S)
    elif worker.process is not None and worker.process.process is not None:
        kernels = _descendants(worker.process.process.pid)  # which miss their parent once all is imported
        await worker.process.process.kill()
        for process in kernels:
            with suppress(psutil.Error):  # it may have ended by itself
                process.kill()


def _descendants(pid: int | None) -> list[psutil.Process]:
    with suppress(psutil.Error):
        return psutil.Process(pid).children(recursive=True) if pid is not None else []
    return []


def worker_options(settings: Settings) -> dict[str, Any]:
    """Options of every Dask worker: one task at a time, a kernel process, memory watched by us."""
    return {
        "nthreads": 1,
        "memory_limit": 0,
        "death_timeout": settings.worker_start_s,
        "plugins": (Kernels(settings.model_dump()),),
        "local_directory": str(settings.data_dir.absolute() / "dask"),
    }


def security(settings: Settings) -> Security:
    """Mutual TLS with the settings' certificates."""
    files = {
        f"tls_{role}_{kind}": str(path)
        for role in ("scheduler", "worker", "client")
        for kind, path in (("cert", settings.tls_cert_file), ("key", settings.tls_key_file))
    }
    return Security(tls_ca_file=str(settings.tls_ca_file), require_encryption=True, **files)


def _process(worker: Worker) -> KernelProcess:
    kernels = worker.plugins[PLUGIN]
    assert isinstance(kernels, Kernels)
    return kernels.process
