"""Memory of the host and of devices."""

import os
from pathlib import Path

import numpy as np
import warp as wp

CACHE_LINE = 64  # bytes
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


def device_memory(size: int, dtype, device: wp.Device) -> wp.array:
    """Uninitialised memory; on the CPU from NumPy, which asks for huge pages, and from the start of a cache line.

    Random access to many voxel records otherwise spends half its time on page tables, and on two lines per record.
    """
    if device.is_cuda:
        return wp.empty(size, dtype=dtype, device=device)
    width = wp.types.type_size_in_bytes(dtype)
    memory = np.empty(size * width + CACHE_LINE, np.uint8)
    start = -memory.ctypes.data % CACHE_LINE
    aligned = memory[start : start + size * width].view(wp.dtype_to_numpy(dtype))
    return wp.array(aligned, dtype=dtype, device=device, copy=False)


def as_type(values: wp.array, dtype) -> wp.array:
    """The same memory as an array of another type."""
    size = values.capacity // wp.types.type_size_in_bytes(dtype)
    return wp.array(ptr=values.ptr, dtype=dtype, shape=size, device=values.device, capacity=values.capacity)
