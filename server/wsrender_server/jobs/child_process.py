"""What every child process that runs native code is: quick to die, and watched for its memory."""

import contextlib
import ctypes
import errno
import multiprocessing
import os
import signal
import threading
from multiprocessing.connection import wait
from multiprocessing.process import BaseProcess
from pathlib import Path

import psutil

from wsrender_server.logs import configure_logs


def settle_in() -> None:
    """Set up this process as a child: it dies when it is told to, when its parent has died, or for want of memory."""
    signal.signal(signal.SIGTERM, signal.SIG_DFL)  # native code never returns to a handler
    configure_logs()
    threading.Thread(target=_die_with_parent, daemon=True).start()
    _offer_to_be_killed_first()


def give_back_memory() -> None:
    """Let the system have what was freed; the allocator of glibc keeps it otherwise."""
    with contextlib.suppress(OSError, AttributeError):  # another C library
        ctypes.CDLL(None).malloc_trim(0)


def kill(pid: int | None) -> None:
    """Kill a child of this process, if it is there; whoever else has got its number since it ended is left alone."""
    if pid is not None:
        with contextlib.suppress(psutil.Error):  # it may have ended by itself
            process = psutil.Process(pid)
            if process.ppid() == os.getpid():
                process.kill()


def how_it_ended(exit_code: int | None) -> str:
    """What an exit code of `multiprocessing` says: the name of the signal that ended a process, or the code."""
    if exit_code is None:
        return "unknown how"
    if exit_code >= 0:
        return f"exit code {exit_code}"
    try:
        return signal.Signals(-exit_code).name
    except ValueError:  # a real-time signal, which has no name
        return f"signal {-exit_code}"


def end_of(process: BaseProcess, patience_s: float = 2.0) -> str:
    """How a process ended that has closed its link, which it does a moment before its end."""
    process.join(patience_s)
    return "it goes on" if process.is_alive() else how_it_ended(process.exitcode)


def resident_bytes(pid: int | None) -> int:
    """Memory that a process holds; 0 where it is not there."""
    try:
        return 0 if pid is None else psutil.Process(pid).memory_info().rss
    except psutil.Error:
        return 0


def _die_with_parent() -> None:
    """A process whose parent was killed would compute on for nobody."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(errno.EOWNERDEAD)


def _offer_to_be_killed_first() -> None:
    """Where memory runs out, Linux should end this process rather than a server."""
    try:
        Path("/proc/self/oom_score_adj").write_text("1000")
    except OSError:
        return  # another system, or not allowed: the parent watches the memory anyway
