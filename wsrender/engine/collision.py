"""Labels of samples by collisions: the filter, the narrow phase, and MuJoCo for what is open after them."""

from typing import Any

import numpy as np
import warp as wp
from wsrender_kernels.collision import ARRAYS, CAPACITY, DECIDED, filter_kernel, narrow_kernel, program_type, put_kernel
from wsrender_kernels.sweep import Shape

from wsrender.collision.distance import blocked_by
from wsrender.collision.program import Program
from wsrender.collision.solids import Pairs
from wsrender.collision.store import stored_program
from wsrender.engine.drawn_configurations import configurations
from wsrender.engine.evaluation import REAL, device_array
from wsrender.engine.kernel_cache import launch, loaded
from wsrender.engine.memory import device_memory, fetched
from wsrender.pipeline.constraints.collision import labelling
from wsrender.pipeline.pipeline import Pipeline


class Collisions:
    """Labels the samples of chunks of at most ``chunk`` on a device: 0, or the number from 1 of what rejects them."""

    def __init__(self, pipeline: Pipeline, pairs: Pairs, program: Program, shape: Shape, device: wp.Device, chunk: int):
        first, *_ = labelling(pipeline.constraints)
        self.pipeline, self.pairs, self.device = pipeline, pairs, device
        self.chain, self.distances = first.chain, first.distances
        real, n, joints, cuda = REAL[pipeline.precision], first.chain.n, len(first.chain.joint_source), device.is_cuda
        self.words = max(-(-len(pairs.pairs) // 32), 1)
        capacity = max(-(-len(program.capsules) // CAPACITY), 1) * CAPACITY
        kernel = filter_kernel(real, n, joints, capacity, self.words, shape.method, shape.shared, cuda)
        self._filter = loaded(kernel, device)
        self._narrow = loaded(narrow_kernel(real, n, joints, self.words, shape.method, cuda), device)
        self._program = _on_device(program, pairs, self.words, device)
        self.labels = device_memory(chunk, wp.uint8, device)
        self._listed = device_memory(1, wp.int32, device)
        self._ids = device_memory(chunk, wp.int32, device)
        self._masks = device_memory(chunk * self.words, wp.uint32, device)
        self._pending = device_memory(chunk, wp.uint8, device)
        self.decided = np.zeros(3, np.int64)  # by the filter, by the narrow phase, by MuJoCo

    def label(self, space: Any, first: int, count: int, tasks: int) -> wp.array:
        """Labels (chunk,) uint8 of samples first … first + count - 1; ``tasks``: blocks of the CPU."""
        self._listed.zero_()
        dim = count if self.device.is_cuda else tasks
        outputs = [self.labels, self._listed, self._ids, self._masks]
        launch(self._filter, dim=dim, inputs=[self._program, space, first, count], outputs=outputs, device=self.device)
        listed = int(self._listed.numpy()[0])
        left = 0
        if listed:
            inputs = [self._program, space, first, self._ids]
            outputs = [self.labels, self._masks, self._pending]
            launch(self._narrow, dim=listed, inputs=inputs, outputs=outputs, device=self.device)
            left = self._settle(first, listed)
        self.decided += [count - listed, listed - left, left]
        return self.labels

    def _settle(self, first: int, listed: int) -> int:
        """Ask MuJoCo about what is open; how many samples."""
        pending = fetched(self._pending, 0, listed)
        items = np.flatnonzero(pending != DECIDED)
        if not len(items):
            return 0
        open_ = fetched(self._ids, 0, listed)[items]
        masks = fetched(self._masks, 0, listed * self.words).reshape(listed, self.words)[items]
        bits = np.unpackbits(masks.view(np.uint8), axis=1, bitorder="little")[:, : len(self.pairs.pairs)]
        q = self._configurations(first + open_.astype(np.int64))
        found = blocked_by(self.pairs, self.distances, self.chain, q, bits.astype(bool))
        found = np.where(found > 0, found, pending[items])
        inputs = [device_array(open_, wp.int32, self.device), device_array(found, wp.uint8, self.device)]
        put = loaded(put_kernel(), self.device)
        launch(put, dim=len(items), inputs=inputs, outputs=[self.labels], device=self.device)
        return len(items)

    def _configurations(self, indices: np.ndarray) -> np.ndarray:
        """Those of samples (N,), as the kernels draw them, (N, n) float64."""
        given = self.pipeline.sampling.given
        q = configurations(self.pipeline, indices) if given is None else given[indices]
        return np.asarray(q, np.float64)


def collisions_of(pipeline: Pipeline, shape: Shape, device: wp.Device, chunk: int) -> Collisions:
    """What labels the samples of a pipeline before they are swept with a kernel of a shape."""
    constraints = labelling(pipeline.constraints)
    pairs = Pairs.of(constraints[0].solids, *(each.group for each in constraints))
    program = stored_program(pairs, constraints[0].chain, constraints[0].distances)
    return Collisions(pipeline, pairs, program, shape, device, chunk)


def _on_device(program: Program, pairs: Pairs, words: int, device: wp.Device) -> Any:
    struct = program_type()()
    first_reason = np.zeros(words * 32, bool)
    first_reason[: len(pairs.pairs)] = pairs.reason == 0
    values = {"first_reason": np.packbits(first_reason, bitorder="little").view(np.uint32)}
    for name, dtype in ARRAYS.items():
        value = values[name] if name in values else getattr(program, name)
        setattr(struct, name, device_array(np.ravel(value) if value.size else np.zeros(1), dtype, device))
    struct.n_capsules, struct.n_pairs, struct.n_planes = len(program.capsules), len(program.pairs), len(program.planes)
    struct.n_tables, struct.n_solid_pairs = len(program.tables), len(pairs.pairs)
    struct.columns, struct.epsilon = program.columns, program.epsilon
    return struct
