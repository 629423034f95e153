"""Labels of samples by collisions: the filter, the narrow phase, and MuJoCo for what is open after them."""

from typing import Any

import numpy as np
import warp as wp
from wsrender_kernels.collision import (
    ARRAYS,
    BATCH,
    CAPACITY,
    REAL_ARRAYS,
    filter_kernel,
    narrow_kernel,
    program_type,
    put_kernel,
)
from wsrender_kernels.collision_unrolled import unrolled
from wsrender_kernels.sweep import Shape

from wsrender.collision.distance import blocked_by
from wsrender.collision.program import Program
from wsrender.collision.solids import Pairs
from wsrender.collision.store import stored_program
from wsrender.engine.drawn_configurations import drawn_or_given
from wsrender.engine.evaluation import REAL, device_array
from wsrender.engine.kernel_cache import launch, loaded
from wsrender.engine.memory import device_memory, fetched
from wsrender.pipeline.constraints.collision import labelling
from wsrender.pipeline.pipeline import Pipeline

EXACT = 1.2e-6  # within which MuJoCo is asked: its own tolerance is 1e-6 [m]


class Collisions:
    """Labels the samples of chunks of at most ``chunk`` on a device: 0, or the number from 1 of what rejects them."""

    def __init__(self, pipeline: Pipeline, pairs: Pairs, program: Program, shape: Shape, device: wp.Device, chunk: int):
        first, *_ = labelling(pipeline.constraints)
        self.pipeline, self.pairs, self.program, self.device = pipeline, pairs, program, device
        self.chain, self.distances = first.chain, first.distances
        real, n, joints, cuda = REAL[pipeline.precision], first.chain.n, len(first.chain.joint_source), device.is_cuda
        self.words = _words(len(pairs.pairs))
        crowd = 0 if cuda else -(-len(program.crowd_balls) // CAPACITY) * CAPACITY
        capacity = max(-(-_sizes(program, bool(crowd))[0] // CAPACITY), 1) * CAPACITY
        surfaces = bool(len(program.lookups))
        body = unrolled(program, self.words) if cuda and not surfaces else None
        kernel = filter_kernel(
            real, n, joints, capacity, self.words, shape.method, shape.shared, cuda, body, surfaces, crowd
        )
        self._filter = loaded(kernel, device)
        self._narrow = [
            narrow_kernel(real, n, joints, self.words, shape.method, cuda, exact, surfaces) for exact in (False, True)
        ]
        self._at_a_time = 1 if cuda else BATCH
        self._programs = _on_device(program, pairs, self.words, device, bool(crowd))
        self.labels = device_memory(chunk, wp.uint8, device)
        self._otherwise = device_memory(chunk, wp.uint8, device)
        # What is open after one pass goes into the next: two lists in turn.
        self._lists = [
            (
                device_memory(1, wp.int32, device),
                device_memory(chunk, wp.int32, device),
                device_memory(chunk * self.words, wp.uint32, device),
            )
            for _ in range(2)
        ]
        self.decided = np.zeros(4, np.int64)  # by the filter, the narrow phase in float32 and in float64, MuJoCo

    def label(self, space: Any, first: int, count: int, tasks: int) -> wp.array:
        """Labels (chunk,) uint8 of samples first … first + count - 1; ``tasks``: blocks of the CPU."""
        into, after = self._lists
        into[0].zero_()
        dim = count if self.device.is_cuda else tasks
        inputs = [self._programs[0], space, first, count]
        launch(self._filter, dim=dim, inputs=inputs, outputs=[self.labels, *into], device=self.device)
        left = [count, int(into[0].numpy()[0])]
        for kernel, program in zip(self._narrow, self._programs, strict=True):
            if left[-1]:
                after[0].zero_()
                inputs = [program, space, first, left[-1], *into[1:]]
                outputs, dim = [self.labels, *after, self._otherwise], -(-left[-1] // self._at_a_time)
                launch(loaded(kernel, self.device), dim=dim, inputs=inputs, outputs=outputs, device=self.device)
                into, after = after, into
            left.append(int(into[0].numpy()[0]) if left[-1] else 0)
        if left[-1]:
            self._settle(first, left[-1], *into[1:])
        self.decided -= np.diff([*left, 0])
        return self.labels

    def _settle(self, first: int, count: int, ids: wp.array, masks: wp.array) -> None:
        """Ask MuJoCo about the ``count`` samples that are open still."""
        open_, rows = fetched(ids, 0, count), fetched(masks, 0, count * self.words).reshape(count, self.words)
        bits = np.unpackbits(rows.view(np.uint8), axis=1, bitorder="little")[:, : len(self.pairs.pairs)]
        q = drawn_or_given(self.pipeline, first + open_.astype(np.int64))
        found = blocked_by(self.pairs, self.distances, self.chain, q, bits.astype(bool))
        found = np.where(found > 0, found, fetched(self._otherwise, 0, count))
        if not self.device.is_cuda:
            self.labels.numpy()[open_] = found
            return
        inputs = [device_array(open_, wp.int32, self.device), device_array(found, wp.uint8, self.device)]
        put = loaded(put_kernel(), self.device)
        launch(put, dim=count, inputs=inputs, outputs=[self.labels], device=self.device)


def collisions_of(pipeline: Pipeline, shape: Shape, device: wp.Device, chunk: int) -> Collisions:
    """What labels the samples of a pipeline before they are swept with a kernel of a shape."""
    constraints = labelling(pipeline.constraints)
    pairs = Pairs.of(constraints[0].solids, *(each.group for each in constraints))
    program = stored_program(pairs, constraints[0].chain, constraints[0].distances)
    return Collisions(pipeline, pairs, program, shape, device, chunk)


def bytes_per_sample(pipeline: Pipeline) -> int:
    """What `Collisions` hold for each sample of a chunk."""
    return 2 + 2 * (4 + 4 * _words(sum(len(each.group[0]) for each in labelling(pipeline.constraints))))


def _words(pairs: int) -> int:
    """Words of a mask of so many pairs."""
    return max(-(-pairs // 32), 1)


def _sizes(program: Program, crowd: bool) -> tuple[int, int]:
    """Numbers of capsules and pairs that the filter takes one by one."""
    return (program.moving, program.alone) if crowd else (len(program.capsules), len(program.pairs))


def _on_device(program: Program, pairs: Pairs, words: int, device: wp.Device, crowd: bool = False) -> tuple[Any, Any]:
    """The program for float32, and for the narrow phase in float64; ``crowd``: whether the filter looks up in one."""
    first_reason = np.zeros(words * 32, bool)
    first_reason[: len(pairs.pairs)] = pairs.reason == 0
    values = {"first_reason": np.packbits(first_reason, bitorder="little").view(np.uint32)}

    def array(name: str, dtype: Any) -> wp.array:
        value = values[name] if name in values else getattr(program, name)
        return device_array(np.ravel(value) if value.size else np.zeros(1), dtype, device)

    arrays = {name: array(name, dtype) for name, dtype in ARRAYS.items()}
    structs = []
    for real, epsilon in ((wp.float32, program.epsilon), (wp.float64, EXACT)):
        struct = program_type(real)()
        for name, value in [*arrays.items(), *((name, array(name, real)) for name in REAL_ARRAYS)]:
            setattr(struct, name, value)
        struct.n_capsules, struct.n_pairs = _sizes(program, crowd)
        struct.n_planes = len(program.planes)
        struct.n_crowd_rows, struct.crowd_set_words = len(program.crowd_rows), program.crowd_sets.shape[1]
        struct.n_tables, struct.n_solid_pairs = len(program.tables), len(pairs.pairs)
        struct.root, struct.n_lookups = program.root, len(program.lookups)
        struct.columns, struct.epsilon = program.columns, epsilon
        structs.append(struct)
    return structs[0], structs[1]
