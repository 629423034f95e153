"""Sweeps a range of samples through the fused kernel, in chunks of bounded memory, on CPU threads or GPUs."""

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from dataclasses import dataclass, field, replace
from functools import cached_property, reduce
from typing import Any

import numpy as np
import warp as wp
from wsrender_kernels.elementary import bits_type
from wsrender_kernels.sampling import LANES
from wsrender_kernels.sweep import TOTAL_SLOTS, Shape, outputs_type, record_type_of, sums_type_of, sweep_kernel
from wsrender_kernels.voxels import lattice, lowest

from wsrender.engine.chain_values import device_values, packed_values
from wsrender.engine.constraint_code import device_constraints, packed_constraints
from wsrender.engine.devices import thread_count
from wsrender.engine.drawn_configurations import configurations, device_space, given_space
from wsrender.engine.evaluation import device_array, pipeline_model, shape_of
from wsrender.engine.grid_structure import (
    GridStructure,
    block_count,
    device_base,
    run_length,
    shared_coordinates,
    structure_of,
)
from wsrender.engine.kernel_cache import launch, loaded
from wsrender.engine.memory import as_type, device_memory, fetched
from wsrender.engine.partial import NONE, Partial, best_of, joined, merge
from wsrender.engine.ranges import check_range
from wsrender.engine.row_buffer import RowBuffer
from wsrender.engine.slabs import fitted
from wsrender.engine.sums import has_own_bound, scales_of
from wsrender.errors import NumericalError
from wsrender.pipeline.constraints.collision import labelling
from wsrender.pipeline.constraints.constraint import STRUCTURES, Structure
from wsrender.pipeline.constraints.host_function import on_host
from wsrender.pipeline.pipeline import Pipeline
from wsrender.volume.lattice import LatticeBlock

CHUNK_CPU, CHUNK_CUDA, CHUNK_ROWS, CHUNK_GIVEN = 1 << 20, 1 << 28, 1 << 18, 1 << 14
LABELLED_BYTES_CPU, LABELLED_BYTES_CUDA = 1 << 26, 1 << 31  # of labels and lists of what is open, of one worker
CHUNK_LEAST, CHUNKS_PER_THREAD = 1 << 15, 8
LABELLED_PER_THREAD = 4  # chunks whose samples are labelled: of each MuJoCo settles a few samples, which takes 1 ms
LOOK_S = 0.1  # between two looks at what is done
THREADS_PER_SM = 2048  # of a GPU: a whole multiple of those that run at a time
VOXELS_ABSORBED, VOXELS_FETCHED = 1 << 14, 1 << 23  # at a time
FOLD_AFTER = 2**31 - 2**29  # samples until the CPU, which counts in 32 bits, moves its counts to 64-bit ones


@dataclass(frozen=True, eq=False)
class SweepPlan:
    """What the engine makes of a pipeline."""

    pipeline: Pipeline

    @cached_property
    def structure(self) -> GridStructure:
        """The samples that are evaluated, and those that each of them stands for."""
        each = self.pipeline
        if each.kept_rows is not None or not each.collapse:
            return GridStructure(each.sampling)
        kept = frozenset[Structure](STRUCTURES).intersection(*(constraint.keeps for constraint in each.constraints))
        return structure_of(each.evaluation, each.sampling, kept)

    @property
    def evaluated(self) -> Pipeline:
        """The pipeline of the samples that are evaluated."""
        return replace(self.pipeline, sampling=self.structure.evaluated)

    @property
    def sampling_path(self) -> str:
        """How the samples are evaluated: "direct", one by one, or "collapsed", by the structure of a grid."""
        return "collapsed" if self.structure.multiplicity > 1 else "direct"

    @property
    def division(self) -> int:
        """Samples at multiples of which a range may start."""
        return LANES * self.structure.multiplicity

    @cached_property
    def shape(self) -> Shape:
        """Compile-time part of the kernel."""
        each, rows = self.pipeline, self.pipeline.kept_rows
        asked = device_constraints(
            each.constraints, each.evaluation.chain, each.origin, each.precision, len(packed_values(each))
        )
        return shape_of(
            each,
            base_levels=self.structure.base_levels > 1,
            voxels=each.block is not None,
            maximum="maximum" in each.statistics,
            minimum="minimum" in each.statistics,
            sums="mean" in each.statistics,
            keep_rows=rows is not None,
            keep_configuration="configuration" in (rows or ()),
            keep_orientation="orientation" in (rows or ()),
            best=None if each.best is None else each.evaluation.indices.index(each.best),
            **asked,
            **device_values(each, asked["limits"] - len(packed_values(each))),
        )


def sweep(
    pipeline: Pipeline,
    first: int,
    count: int,
    devices: list[wp.Device],
    *,
    threads: int | None = None,
    chunk_size: int | None = None,
    progress: Callable[[int], None] | None = None,
    look_s: float = LOOK_S,
) -> Partial:
    """Evaluate samples first … first + count - 1, from a multiple of the plan's ``division`` to another or the end.

    ``chunk_size`` is rounded up to a multiple of that; neither it nor ``threads`` changes a bit of the result.
    ``progress`` is called in this thread with the number of samples done, every ``look_s`` [s]; where it raises, the
    sweep ends after the chunks that run. Where the voxel records do not fit in memory
    the samples are swept once for every slab of the lattice block. Raises InputError for another range, ResourceError
    where that would take too many slabs, NumericalError for a value that is not finite or beyond its bound.
    """
    plan = SweepPlan(pipeline)
    check_range(first, count, pipeline.sampling.count, plan.division)
    shape, each = plan.shape, plan.structure.multiplicity
    first, count, chunk_size = first // each, count // each, chunk_size and -(-chunk_size // each)
    workers = devices
    if not devices[0].is_cuda:
        workers = devices * thread_count(threads)
        if not pipeline.evaluation.on_host:
            shape = replace(shape, shared=shared_coordinates(plan.structure.evaluated))
    chunk = _chunk_size(plan, chunk_size or _fair_share(plan, count, workers), devices[0])
    workers = workers[: max(-(-count // chunk), 1)]
    slabs = [None]
    if pipeline.block is not None:
        workers, slabs = fitted(pipeline.block, shape, workers, count * plan.structure.base_levels)
    partials = []
    for number, slab in enumerate(slabs):

        def report(done: int, before: int = number * count) -> None:
            if progress:
                progress((before + done) * each // len(slabs))

        accumulators = [Accumulator(plan, shape, slab, device, chunk) for device in workers]
        partials.append(_swept(accumulators, _Queue(_chunks(first, count, chunk)), report, look_s))
    result = joined(partials, slabs[0].size if slabs[0] else 0)
    _check_values(pipeline, result)
    return result


def _collisions(plan: SweepPlan, shape: Shape, device: wp.Device, chunk: int) -> Any:
    """What labels the samples first, where a constraint asks for it."""
    if not shape.labelled:
        return None
    from wsrender.engine.collision import collisions_of
    from wsrender.engine.host_labels import HostLabels

    constraints = plan.pipeline.constraints
    apart = collisions_of(plan.evaluated, shape, device, chunk) if labelling(constraints) else None
    return HostLabels(plan.evaluated, apart, device, chunk) if on_host(constraints) else apart


def _swept(accumulators: list["Accumulator"], queue: "_Queue", report: Callable[[int], None], look_s: float) -> Partial:
    """What the accumulators make of the chunks of a queue, each in a thread of its own."""
    with ThreadPoolExecutor(len(accumulators)) as pool:
        futures = [pool.submit(_work, accumulator, queue) for accumulator in accumulators]
        try:
            pending = set(futures)
            while pending:
                done, pending = wait(pending, timeout=look_s, return_when=FIRST_COMPLETED)
                report(queue.done)
                for future in done:
                    future.result()
        except BaseException:
            queue.stop()
            raise
        if not accumulators[0].device.is_cuda:
            accumulators = [_combined(accumulators, pool)]
        return reduce(merge, pool.map(Accumulator.partial, accumulators))


def _combined(accumulators: list["Accumulator"], pool: ThreadPoolExecutor) -> "Accumulator":
    """The first of several accumulators of the CPU with what the others hold, added where it stands."""
    first, *others = accumulators
    for other in others:
        first.absorb(other, pool)
    return first


def _fair_share(plan: SweepPlan, count: int, workers: list[wp.Device]) -> int:
    """Chunk size (samples) that keeps all workers busy to the end."""
    if workers[0].is_cuda:
        return CHUNK_CUDA
    per_thread = LABELLED_PER_THREAD if plan.shape.labelled else CHUNKS_PER_THREAD
    return min(CHUNK_CPU, max(CHUNK_LEAST, count // (per_thread * len(workers))))


def _chunk_size(plan: SweepPlan, size: int, device: wp.Device) -> int:
    size = min(size, FOLD_AFTER // plan.structure.base_levels)
    if plan.shape.keep_rows:
        size = min(size, CHUNK_ROWS)
    if plan.shape.method == "given":
        size = min(size, CHUNK_GIVEN)
    if plan.shape.labelled:
        from wsrender.engine.collision import bytes_per_sample

        allowed = LABELLED_BYTES_CUDA if device.is_cuda else LABELLED_BYTES_CPU
        size = min(size, max(allowed // bytes_per_sample(plan.pipeline), LANES))
    return -(-size // LANES) * LANES


def label_bytes(plan: SweepPlan, devices: list[wp.Device]) -> float:
    """Of the host's memory for labels of samples, and lists of those that are open, while all of a plan are swept."""
    pipeline = plan.pipeline
    if devices[0].is_cuda or not labelling(pipeline.constraints):
        return 0.0
    from wsrender.engine.collision import bytes_per_sample

    count = pipeline.sampling.count // plan.structure.multiplicity
    chunk = _chunk_size(plan, _fair_share(plan, count, devices), devices[0])
    return float(min(len(devices), -(-count // chunk)) * chunk * bytes_per_sample(pipeline))


def _chunks(first: int, count: int, chunk: int) -> Iterator[tuple[int, int]]:
    for start in range(first, first + count, chunk):
        yield start, min(chunk, first + count - start)


@dataclass(eq=False)
class _Queue:
    """Chunks handed to the workers, one after the other."""

    chunks: Iterator[tuple[int, int]]
    done: int = 0
    stopped: bool = False
    lock: threading.Lock = field(default_factory=threading.Lock)

    def take(self) -> tuple[int, int] | None:
        with self.lock:
            return None if self.stopped else next(self.chunks, None)

    def finished(self, count: int) -> None:
        with self.lock:
            self.done += count

    def stop(self) -> None:
        self.stopped = True


def _work(accumulator: "Accumulator", queue: _Queue) -> None:
    with wp.ScopedDevice(accumulator.device):
        while (chunk := queue.take()) is not None:
            accumulator.add(*chunk)
            queue.finished(chunk[1])
        accumulator.find_best(queue)


class Accumulator:
    """One worker's private totals, and its voxel records of a slab of the lattice block, on its device."""

    def __init__(self, plan: SweepPlan, shape: Shape, slab: LatticeBlock | None, device: wp.Device, chunk: int):
        self.plan, self.shape, self.device, self.chunk = plan, shape, device, chunk
        real, pipeline = shape.real, plan.pipeline
        bits = bits_type(real)
        self._lowest = lowest(real)
        self._empty_count = int(np.full(shape.count_size, self._lowest, wp.dtype_to_numpy(bits)).view(np.int64)[0])
        self._size = slab.size if slab else 0
        voxels = self._size + 1 if slab else 0  # one to spare for positions outside
        self._kernel = loaded(sweep_kernel(shape, device.is_cuda), device)
        limits = packed_constraints(
            pipeline.constraints, pipeline.evaluation.chain, pipeline.origin, pipeline.precision
        )
        self._model = pipeline_model(pipeline, np.concatenate([limits, packed_values(pipeline)]), shape)
        given = shape.method == "given"
        evaluated = plan.structure.evaluated
        self._run = run_length(evaluated, shape.shared)
        self._space = None if given else device_space(evaluated, pipeline.precision, device, self._run)
        self._base = device_base(plan.structure, pipeline.sampling, real)
        self._collisions = _collisions(plan, shape, device, chunk)
        self._lattice = _device_lattice(slab, pipeline.block, real)
        reduced = shape.reduced
        self._extremes = device_memory(2 * reduced, bits, device)
        self._totals = device_memory(TOTAL_SLOTS * shape.n_totals, wp.int64, device)
        self._records = device_memory(voxels * shape.record_size, bits, device)
        self._sums = device_memory(voxels * shape.sums_size, wp.int64, device)
        self._rejections = device_memory(voxels * len(shape.constraints), wp.int64, device)
        self._earliest = device_memory(len(shape.constraints), wp.int64, device)
        self._best = device_memory(voxels * (shape.best is not None), wp.int64, device)
        buffers = (2 if device.is_cuda else 1) if shape.keep_rows else 0
        self._row_buffers = [RowBuffer(shape.n_rows, chunk, real, device, shape.interleaved) for _ in range(buffers)]
        outputs = self._outputs = outputs_type(shape)()
        outputs.scales = device_array(scales_of(pipeline), real, device)
        outputs.extremes, outputs.totals = self._extremes, self._totals
        self._counts = as_type(self._records, wp.int64)
        outputs.records = as_type(self._records, record_type_of(shape))
        outputs.sums = as_type(self._sums, sums_type_of(shape))
        outputs.rows_out, outputs.rows_stride = wp.empty(0, dtype=real, device=device), chunk
        if shape.cuts:
            outputs.cuts = device_array(np.array([*pipeline.evaluation.cuts.values()]), real, device)
        if shape.constraints:
            outputs.earliest = self._earliest
            if slab:
                outputs.rejections = self._rejections
        if shape.best is not None:
            outputs.best, outputs.weight = self._best, plan.structure.weight
            outputs.level_stride = pipeline.sampling.count // plan.structure.base_levels
        self._added: list[tuple[int, int]] = []
        self._folded: Partial | None = None
        self._clear()

    def add(self, first: int, count: int) -> None:
        """Sweep one chunk."""
        counted = count * self.plan.structure.base_levels
        if not self.device.is_cuda and self._counted + counted > FOLD_AFTER:
            self._fold()
            self._clear()
        self.launch(first, count)
        self._added.append((first, count))
        self._counted += counted
        if self.shape.keep_rows:
            self._row_buffers[0].fetch(first, count)
            # Of two, the other: its rows are stored while the kernel and the copy of this chunk run.
            self._row_buffers.reverse()
            self._rows |= self._row_buffers[0].take()
        elif self.device.is_cuda:
            wp.synchronize_device(self.device)

    def find_best(self, queue: "_Queue") -> None:
        """On a GPU, whose maxima are known now, find the samples that have them: see `outputs_type`."""
        if self.shape.best is None or not self.device.is_cuda:
            return
        for buffer in self._row_buffers:
            self._rows |= buffer.take()  # which the kernel writes again
        self._outputs.second = 1
        for first, count in self._added:
            if queue.stopped:
                return
            self.launch(first, count)
            wp.synchronize_device(self.device)

    def absorb(self, other: "Accumulator", pool: ThreadPoolExecutor) -> None:
        """Take over what another accumulator of the CPU holds; nothing but ``partial`` and ``absorb`` may follow.

        Where the records stand, slice by slice: they are large, and memory that is used for the first time is slow.
        """
        self._counted += other._counted
        self._rows |= other._rows
        if other._folded is not None:
            self._folded = other._folded if self._folded is None else merge(self._folded, other._folded)
        extremes, totals = self._extremes.numpy(), self._totals.numpy()
        np.maximum(extremes, other._extremes.numpy(), out=extremes)
        totals += other._totals.numpy()
        earliest = self._earliest.numpy()
        np.minimum(earliest, other._earliest.numpy(), out=earliest)
        everywhere = slice(0, self._size)
        own, added = self._voxels(everywhere), other._voxels(everywhere)

        def absorb_voxels(start: int) -> None:
            part = slice(start, start + VOXELS_ABSORBED)
            records, sums, rejections, best = (table[part] for table in own)
            more_records, more_sums, more_rejections, more_best = (table[part] for table in added)
            if self.shape.best is not None:
                slot = self.shape.count_size + self.shape.best
                best[:, 0] = best_of(records[:, slot], best[:, 0], more_records[:, slot], more_best[:, 0])
            counts = _counts(records) + (_counts(more_records) - self._empty_count)
            np.maximum(records, more_records, out=records)
            _counts(records)[:] = counts
            sums += more_sums
            rejections += more_rejections

        list(pool.map(absorb_voxels, range(0, len(own[0]), VOXELS_ABSORBED)))

    def partial(self) -> Partial:
        """What all chunks contributed."""
        for buffer in self._row_buffers:
            self._rows |= buffer.take()
        self._fold()
        assert self._folded is not None
        return self._folded

    def launch(self, first: int, count: int) -> None:
        """Run the kernel over one chunk; on a GPU, begin to."""
        if self._row_buffers:
            self._outputs.rows_out = self._row_buffers[0].on_device
        space = self._space or self._given(first, count)
        tasks = block_count(self._run, first, count)
        if self._collisions is not None:
            self._model.labels, self._model.first_label = self._collisions.label(space, first, count, tasks), first
        inputs = [self._model, space, self._base, self._lattice, first, count]
        if self.device.is_cuda:
            threads = min(count, THREADS_PER_SM * self.device.sm_count)
            outputs = [self._outputs, self._counts, self._records, self._sums]
            launch(self._kernel, dim=threads, inputs=[*inputs, threads], outputs=outputs, device=self.device)
        else:
            launch(self._kernel, dim=tasks, inputs=inputs, outputs=[self._outputs], device=self.device)

    def _given(self, first: int, count: int):
        """Configurations and what the host computes of them; puts the latter into the model."""
        pipeline = self.plan.pipeline
        evaluation, given = pipeline.evaluation, pipeline.sampling.given
        part = slice(first, first + count)
        q = configurations(pipeline, np.arange(part.start, part.stop)) if given is None else given[part]
        real, device, model = self.shape.real, self.device, self._model
        if evaluation.given_kinematics:
            chain = evaluation.chain.relative_to(pipeline.origin)
            model.position_given = device_array(chain.poses(q)[:, :3, 3].T.ravel(), real, device)
            if evaluation.indices:  # they may cost a Python class many times as much as poses
                model.jacobian_given = device_array(chain.jacobians(q).reshape(count, -1).T.ravel(), real, device)
        if evaluation.dynamic and evaluation.host_inertia is not None:
            inertia = evaluation.host_inertia(q)
            model.inertia_given = device_array(inertia.reshape(count, -1).T.ravel(), real, device)
        if evaluation.given:
            found = [of(np.asarray(q, np.float64)) for of in evaluation.given.values()]
            model.values_given = device_array(np.concatenate(found), real, device)
        return given_space(q, first, pipeline.precision, device)

    def _voxels(self, part: slice) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Of some of the slab's voxels records (V, record_size), sums (V, sums_size) and rejected samples (V, C).

        And the numbers of the best samples (V, 1), or none, (V, 0).
        """
        shape = self.shape
        records, sums, rejections, best = (
            fetched(values, part.start * width, part.stop * width).reshape(part.stop - part.start, width)
            for values, width in (
                (self._records, shape.record_size),
                (self._sums, shape.sums_size),
                (self._rejections, len(shape.constraints)),
                (self._best, int(shape.best is not None)),
            )
        )
        return records, sums, rejections, best

    def _occupied(self) -> list[np.ndarray]:
        """Cells, counts, extremes, sums and best samples of occupied voxels; cells and numbers of rejected samples.

        Part by part: the host of a GPU may not have the memory for all records.
        """
        first, found = self.shape.count_size, []
        for start in range(0, max(self._size, 1), VOXELS_FETCHED):
            records, sums, rejections, best = self._voxels(slice(start, min(start + VOXELS_FETCHED, self._size)))
            counts = _counts(records)
            cells = np.flatnonzero(counts != self._empty_count)
            extremes = records[cells, first : first + self.shape.extremes]
            kept = sums[cells, : self.shape.n_indices * self.shape.sums]
            blocked = np.flatnonzero(rejections.any(axis=1))
            occupied = start + cells, counts[cells] - self._empty_count, extremes, kept, best[cells].ravel()
            found.append((*occupied, start + blocked, rejections[blocked]))
        return [np.concatenate(parts) for parts in zip(*found, strict=True)]

    def _fold(self) -> None:
        """Add what the device holds to the 64-bit host arrays."""
        cells, count, extremes, sums, best, blocked_cells, blocked = self._occupied()
        weight = self.plan.structure.weight
        totals = self._totals.numpy().reshape(TOTAL_SLOTS, -1).sum(axis=0) * weight
        of_indices, rejected, cut = np.split(totals, np.cumsum([self.shape.n_indices, len(self.shape.constraints)]))
        held = Partial(
            self._counted * weight,
            self._extremes.numpy().copy(),
            of_indices,
            cells,
            count * weight,
            extremes,
            sums * weight,
            self._rows,
            rejected,
            self._first_samples(),
            blocked_cells,
            blocked * weight,
            cut,
            best,
            self.shape.best,
        )
        self._folded = held if self._folded is None else merge(self._folded, held)

    def _first_samples(self) -> np.ndarray:
        """Of every constraint the first sample that it rejects: of those that one stands for, the first."""
        earliest = self._earliest.numpy()
        return np.where(earliest == NONE, NONE, earliest * self.plan.structure.weight)

    def _clear(self) -> None:
        self._counted = 0
        self._rows: dict[int, np.ndarray] = {}
        self._records.fill_(self._lowest)
        self._sums.zero_()
        self._rejections.zero_()
        self._earliest.fill_(NONE)
        self._best.fill_(NONE)
        self._totals.zero_()
        self._extremes.fill_(self._lowest)


def _counts(records: np.ndarray) -> np.ndarray:
    """The 64-bit counts in voxel records (V, record_size), as a view."""
    return records.view(np.int64)[:, 0]


def _device_lattice(block: LatticeBlock | None, whole: LatticeBlock | None, real):
    """The Lattice struct of a block, or of a slab of the ``whole``, which says where positions are counted from."""
    grid = lattice(real)()
    # The reciprocal of the edge as the kernel holds it, rounded once.
    edge = wp.dtype_to_numpy(real)(block.voxel_size_m if block else 1.0)
    grid.edge, grid.per_edge = float(edge), float(1 / edge)
    first, origin = (block.first_voxel, whole.origin_voxel) if block and whole else ((0, 0, 0), (0, 0, 0))
    grid.first_x, grid.first_y, grid.first_z = (at - start for at, start in zip(first, origin, strict=True))
    grid.size_x, grid.size_y, grid.size_z = block.shape if block else (1, 1, 1)
    grid.spare = block.size if block else 1
    return grid


def _check_values(pipeline: Pipeline, partial: Partial) -> None:
    if not partial.admitted:
        return
    high, low = partial.maximum.astype(np.float64), partial.minimum.astype(np.float64)
    for k, name in enumerate(pipeline.evaluation.indices):
        largest = max(abs(high[3 + k]), abs(low[3 + k]))
        if not np.isfinite([high[3 + k], low[3 + k]]).all():
            raise NumericalError(f"index {name} has a value that is not finite (largest {high[3 + k]})")
        if pipeline.bounds and largest > pipeline.bounds[k]:
            raise NumericalError(_beyond(pipeline, name, largest, pipeline.bounds[k]))
    if pipeline.block is not None:
        edge, first, shape = pipeline.block.voxel_size_m, pipeline.block.first_from_origin, pipeline.block.shape
        for axis in range(3):
            if not np.isfinite([low[axis], high[axis]]).all():
                raise NumericalError(f"the end effector's {'xyz'[axis]} is not finite")
            if low[axis] < first[axis] * edge or high[axis] > (first[axis] + shape[axis]) * edge:
                raise NumericalError(
                    f"the end effector reaches {'xyz'[axis]} = {low[axis]:.6g} … {high[axis]:.6g} m from "
                    f"{pipeline.origin[axis]:.9g} m, outside the lattice block planned for it"
                )


def _beyond(pipeline: Pipeline, name: str, largest: float, bound: float) -> str:
    """What to do about an index beyond its bound."""
    told = f"index {name} reaches {largest:.6g}, beyond {bound:.6g}"
    if has_own_bound(pipeline.evaluation, name):
        return (
            f"{told}, the bound of its entry and one per cent: its sums would overflow; give the entry a larger bound, "
            "or None for twice its maximum over a first pass"
        )
    return (
        f"{told}, what its values over the first pass allow: its sums would overflow; register the index with a bound, "
        "bound its values with wsrender.math.minimum, or give another seed"
    )
