"""One worker process per GPU of this machine."""

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Sequence

from wsrender.errors import InputError

RESTART_S = 2.0
LOOK_S = 0.2


def gpu_numbers(choice: str) -> list[str]:
    """The GPUs that ``choice`` names: "all", or numbers separated by commas. Raises InputError."""
    present = _present()
    if choice == "all":
        if not present:
            raise InputError("--gpus", "this machine has no NVIDIA GPU, or nvidia-smi does not see it")
        return present
    chosen = [number.strip() for number in choice.split(",")]
    for number in chosen:
        if number not in present:
            raise InputError("--gpus", f'GPU "{number}" is not one of {", ".join(present) or "none"}')
    return chosen


def run_workers(gpus: Sequence[str], arguments: Sequence[str], stop: threading.Event) -> None:
    """Keep one ``wsrender worker`` per GPU running until ``stop``; each sees its GPU only.

    ``arguments`` are those of each worker. One that ends is started again.
    """
    workers = {gpu: _start(gpu, arguments) for gpu in gpus}
    while not stop.wait(LOOK_S):
        for gpu, worker in workers.items():
            if worker.poll() is not None:
                time.sleep(RESTART_S)
                workers[gpu] = _start(gpu, arguments)
    for worker in workers.values():
        worker.send_signal(signal.SIGTERM)
    for worker in workers.values():
        worker.wait()


def _start(gpu: str, arguments: Sequence[str]) -> subprocess.Popen[bytes]:
    environment = {**os.environ, "CUDA_DEVICE_ORDER": "PCI_BUS_ID", "CUDA_VISIBLE_DEVICES": gpu}
    return subprocess.Popen([sys.executable, "-m", "wsrender", "worker", *arguments], env=environment)


def _present() -> list[str]:
    """Numbers of the GPUs in the order of their bus, asked without starting CUDA here."""
    query = ["nvidia-smi", "--query-gpu=index", "--format=csv,noheader"]
    try:
        return subprocess.run(query, capture_output=True, text=True, check=True, timeout=30).stdout.split()
    except (OSError, subprocess.SubprocessError):
        return []
