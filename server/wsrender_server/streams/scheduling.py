"""Real-time scheduling of processes that must not wait for others, where the system lets us (CAP_SYS_NICE)."""

import contextlib
import os
from pathlib import Path


def hurry() -> bool:
    """Let this process run before everything else; whether the system allows it.

    All of its threads, for one that holds Python's lock holds up the others; not those, nor the processes, that it
    starts from now on.
    """
    return hasattr(os, "SCHED_RESET_ON_FORK") and _schedule(os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, 1)


def calm_down() -> None:
    """Let this process take its turn again."""
    if hasattr(os, "SCHED_OTHER"):
        _schedule(os.SCHED_OTHER, 0)


def _schedule(policy: int, priority: int) -> bool:
    try:
        os.sched_setscheduler(0, policy, os.sched_param(priority))  # 0: the calling thread
    except OSError:  # not allowed
        return False
    for thread in Path("/proc/self/task").iterdir():
        with contextlib.suppress(OSError):  # it has just ended
            os.sched_setscheduler(int(thread.name), policy, os.sched_param(priority))
    return True
