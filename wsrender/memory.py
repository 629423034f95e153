"""Memory of the host."""

import os
from pathlib import Path

SHARE = 0.8  # of the free memory, that is taken


def available_bytes() -> int:
    """Host memory that can be taken without swapping, within the process's control group."""
    limits = [_meminfo(), *_control_group()]
    known = [limit for limit in limits if limit is not None]
    return min(known) if known else 2**63


def _meminfo() -> int | None:
    try:
        lines = Path("/proc/meminfo").read_text().splitlines()
    except OSError:
        return _physical_bytes()
    return next((int(line.split()[1]) * 1024 for line in lines if line.startswith("MemAvailable")), None)


def _physical_bytes() -> int | None:
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return None


def _control_group() -> list[int]:
    """What is left of a version 2 control group's limit, if there is one."""
    folder = Path("/sys/fs/cgroup")
    try:
        limit = (folder / "memory.max").read_text().strip()
        used = int((folder / "memory.current").read_text())
    except (OSError, ValueError):
        return []
    return [] if limit == "max" else [int(limit) - used]
