"""States of many poses by a search along a free joint that a GPU takes level by level."""

from dataclasses import replace

import warp as wp
from wsrender_kernels.free_joint import FREE_FIELDS, FreeJointShape
from wsrender_kernels.free_joint_levels import (
    LEVELS,
    POSE_ROWS,
    TRIED,
    free_joint_level_kernel,
    free_joint_start_kernel,
)

from wsrender.engine.evaluation import device_array
from wsrender.engine.kernel_cache import launch, loaded
from wsrender.robots.closed_form.numbers import packed

TOGETHER = 1 << 22  # poses of which a device holds the balls, 220 bytes each
TASKS = 1 << 17  # threads of a launch on a GPU, which share what a list holds
ROOM = 2  # balls of a list for each pose, on average
WIDEST, NARROWEST = 256, 2e-5  # the most balls of a pose in a level, and the narrowest [rad]


class LevelSearch:
    """Searches of an arm of a ``shape`` of kernels on a device, where its ``numbers`` are, by name.

    ``single``: whether the first levels are of float32.
    """

    def __init__(self, shape: FreeJointShape, numbers: dict[str, float], device: wp.Device, *, single: bool = True):
        self._device, self._tasks = device, TASKS if device.is_cuda else 1
        self._start = loaded(free_joint_start_kernel(shape, device.is_cuda), device)
        self._first = 0 if single else TRIED
        self._kernels = {}
        for real in [wp.float32, wp.float64] if single else [wp.float64]:
            kernel = loaded(
                free_joint_level_kernel(replace(shape, real=real, quaternions=False), device.is_cuda), device
            )
            self._kernels[real] = kernel, device_array(packed(numbers, FREE_FIELDS), real, device)

    def states(self, count: int, poses: wp.array, tips: wp.array) -> wp.array:
        """States (count,) of poses as `free_joint_kernel` takes them, on the device."""
        state = self._integers(count)
        size = min(count, TOGETHER)
        room = max(ROOM * size, 2 * WIDEST)  # of one pose at least
        held = self._held(size, room)
        left = [(first, min(size, count - first)) for first in range(0, count, max(size, 1))]
        while left:
            first, some = left.pop()
            if self._decide(first, some, room, poses, tips, state, *held) > room:  # balls were lost
                left += [(first, some // 2), (first + some // 2, some - some // 2)]
        return state

    def _held(self, size: int, room: int) -> list[wp.array]:
        """What is kept of so many poses, their open roots and widths, two lists, and the lengths of lists."""
        kept = wp.empty(POSE_ROWS * size, dtype=wp.float64, device=self._device)  # type: ignore[arg-type]
        return [kept, *(self._integers(n) for n in (size, 3 * size, 4 * room, LEVELS + 1))]

    def _integers(self, count: int) -> wp.array:
        return wp.empty(count, dtype=wp.int32, device=self._device)  # type: ignore[arg-type]

    def _decide(
        self,
        first: int,
        count: int,
        room: int,
        poses: wp.array,
        tips: wp.array,
        state: wp.array,
        kept: wp.array,
        open: wp.array,
        width: wp.array,
        items: wp.array,
        counts: wp.array,
    ) -> int:
        """Decide poses ``first`` and on; the most balls of a level, which are lost beyond ``room``."""
        for zeros in (open, width, counts):
            zeros.zero_()
        some = [first, count, room]
        numbers = self._kernels[wp.float64][1]
        self._launch(self._start, [self._tasks, self._first, *some, numbers, poses, tips], [state, kept, items, counts])
        for level in range(self._first, LEVELS):
            kernel, numbers = self._kernels[wp.float32 if level < TRIED else wp.float64]
            inputs = [self._tasks, level, *some, WIDEST, NARROWEST, numbers, kept]
            self._launch(kernel, inputs, [state, open, width, items, counts])
        return int(counts.numpy().max())

    def _launch(self, kernel: wp.Kernel, inputs: list, outputs: list[wp.array]) -> None:
        launch(kernel, dim=self._tasks, inputs=inputs, outputs=outputs, device=self._device)
