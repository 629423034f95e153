"""Dask workers: one kernel process each, described to the scheduler by the targets that it can compute for."""

import asyncio
import logging
import threading
from collections.abc import Callable
from typing import Any

from dask import config
from distributed import Nanny, Reschedule, Security, Worker, WorkerPlugin, get_worker

from wsrender_server.jobs.kernel_process import KernelProcess
from wsrender_server.jobs.task import Outcome, Step, Task, Verdict
from wsrender_server.settings import Settings

TOPIC = "wsrender"
PLUGIN = "wsrender-kernels"
RECONNECT_S = 2.0

log = logging.getLogger(__name__)

config.set({"distributed.worker.daemon": False})  # daemons may not have processes of their own


class Kernels(WorkerPlugin):
    """Gives a Dask worker its kernel process.

    It is set up before the worker registers, so that the scheduler knows the worker's targets as resources from the
    first moment.
    """

    name = PLUGIN

    def __init__(self, settings: dict[str, Any]):
        self.settings = settings
        self.process: KernelProcess

    async def setup(self, worker: Worker) -> None:
        """Start the kernel process and declare what it can compute for."""
        self.process = KernelProcess(Settings.model_validate(self.settings))
        self.targets = await asyncio.to_thread(self.process.describe)
        for target in self.targets.values():
            worker.state.total_resources[target] = worker.state.available_resources[target] = 1

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
    settings: Settings, on_start: Callable[[], None] | None = None, stop: threading.Event | None = None
) -> None:
    """Run a worker for the settings' scheduler until ``stop`` is set; it joins again where the scheduler was lost."""
    asyncio.run(_serve(settings, on_start, stop or threading.Event()))


async def _serve(settings: Settings, on_start: Callable[[], None] | None, stop: threading.Event) -> None:
    while not stop.is_set():
        options = {**worker_options(settings), "dashboard": False, "dashboard_address": "127.0.0.1:0"}
        worker = Nanny(settings.scheduler, security=security(settings), **options)
        try:
            async with worker:
                if on_start is not None:
                    on_start()
                finished = asyncio.ensure_future(worker.finished())
                while not (stop.is_set() or finished.done()):
                    await asyncio.wait([finished], timeout=0.2)
                finished.cancel()
        except (OSError, TimeoutError, RuntimeError) as error:  # RuntimeError: Dask's nanny could not start its worker
            log.warning("no worker at %s: %s; trying again", settings.scheduler, error)
        if not stop.is_set():
            await asyncio.sleep(RECONNECT_S)


def worker_options(settings: Settings) -> dict[str, Any]:
    """Options of every Dask worker: one task at a time, a kernel process, memory watched by us."""
    return {
        "nthreads": 1,
        "memory_limit": 0,
        "death_timeout": 60,
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
