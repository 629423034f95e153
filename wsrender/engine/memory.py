"""Memory of devices."""

import numpy as np
import warp as wp

CACHE_LINE = 64  # bytes


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


def fetched(values: wp.array, start: int, stop: int) -> np.ndarray:
    """Part of an array on the host, its own memory on the CPU, else a copy; unlike a slice of Warp it may be empty."""
    return values[start:stop].numpy() if start < stop else np.empty(0, wp.dtype_to_numpy(values.dtype))
