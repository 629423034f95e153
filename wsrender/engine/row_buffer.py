"""Kept rows of a sweep on their way to the host."""

import numpy as np
import warp as wp


class RowBuffer:
    """Rows of one chunk of samples where a kernel writes them, and, for a GPU, in pinned memory of the host.

    The copy runs in a stream of its own, so that a kernel that writes to another buffer does not wait for it.
    """

    def __init__(self, n_rows: int, chunk: int, real: type, device: wp.Device, interleaved: bool = False):
        self.on_device = wp.empty(n_rows * chunk, dtype=real, device=device)
        self._on_host = self.on_device  # a GPU's when it is first needed
        self._shape, self._interleaved = (n_rows, chunk), interleaved
        self._first, self._count = 0, 0
        self._device = device
        self._stream = wp.Stream(device) if device.is_cuda else None
        self._copied: wp.Event | None = None

    def fetch(self, first: int, count: int) -> None:
        """Begin to copy rows of samples first … first + count - 1, once the kernels launched so far have ended."""
        self._first, self._count = first, count
        if self._stream:
            if self._on_host is self.on_device:
                self._on_host = wp.empty_like(self.on_device, device="cpu", pinned=True)
            self._stream.wait_stream(self._device.stream)
            wp.copy(self._on_host, self.on_device, stream=self._stream)
            self._copied = self._stream.record_event()

    def take(self) -> dict[int, np.ndarray]:
        """The fetched rows (n_rows, count) by their first sample, once; waits for the copy."""
        if not self._count:
            return {}
        if self._copied:
            wp.synchronize_event(self._copied)
        rows, count, self._count = self._on_host.numpy(), self._count, 0
        if self._interleaved:
            return {self._first: rows.reshape(self._shape[::-1])[:count].copy().T}
        return {self._first: rows.reshape(self._shape)[:, :count].copy()}
