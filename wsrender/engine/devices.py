"""Devices: what the kernels run on, and what identifies a binary-identical target."""

import os
import platform
import re
from functools import cache
from numbers import Integral
from pathlib import Path
from tempfile import TemporaryFile

import warp as wp

from wsrender.errors import InputError

THREADS_VARIABLE = "WSRENDER_THREADS"


NO_DRIVER = b"Could not find or load the NVIDIA CUDA driver"


@cache
def initialize() -> None:
    """Start Warp quietly: a machine without a GPU is nothing to warn of, and its native code would."""
    wp.config.log_level = wp.LOG_WARNING
    with TemporaryFile() as captured:
        standard_error = os.dup(2)
        os.dup2(captured.fileno(), 2)
        try:
            wp.init()
        finally:
            os.dup2(standard_error, 2)
            os.close(standard_error)
        captured.seek(0)
        rest = b"".join(line for line in captured if NO_DRIVER not in line)
    os.write(2, rest)


def devices_of(request: str) -> list[wp.Device]:
    """Warp devices of "auto" (a GPU if there is one), "cpu", "cuda" (all GPUs) or "cuda:N"; InputError if absent."""
    initialize()
    gpus = wp.get_cuda_devices()
    if request == "cpu" or (request == "auto" and not gpus):
        return [wp.get_device("cpu")]
    if request in ("auto", "cuda") and gpus:
        return gpus
    match = re.fullmatch(r"cuda:(\d+)", request)
    if match and int(match[1]) < len(gpus):
        return [gpus[int(match[1])]]
    raise InputError("device", f"{request!r} is not available; here: {', '.join(['cpu', *(d.alias for d in gpus)])}")


def target_of(devices: list[wp.Device]) -> str:
    """Name of the target: results of one version, precision and target are identical bits."""
    device = devices[0]
    if device.is_cuda:
        return f"cuda:sm_{device.arch}"
    return f"cpu:{platform.machine()}+{_vector_extension()}"


def _vector_extension() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    flags = next((line for line in lines if line.startswith(("flags", "Features"))), "")
    names = set(flags.split())
    return next((name for name in ("avx512f", "avx2", "avx", "asimd") if name in names), "generic")


def thread_count(requested: int | None = None) -> int:
    """CPU threads: the argument, else WSRENDER_THREADS, else the cores this process may use. Raises InputError."""
    if requested is not None:
        return whole_number("threads", requested)
    text = os.environ.get(THREADS_VARIABLE, "")
    if not text:
        return _usable_cores()
    if re.fullmatch("0*[1-9][0-9]{0,8}", text) is None:
        raise InputError(THREADS_VARIABLE, f"{text!r} is not allowed; a positive whole number is")
    return int(text)


def whole_number(field: str, requested: int) -> int:
    """A number that counts something of a field; raises InputError unless it is a whole one above 0."""
    if not isinstance(requested, Integral) or isinstance(requested, bool) or requested < 1:
        raise InputError(field, f"{requested!r} is not allowed; a positive whole number is")
    return int(requested)


def _usable_cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else (os.cpu_count() or 1)
