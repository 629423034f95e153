"""Which poses a parallel mechanism reaches: the lattice at several orientations, or given poses."""

from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import warp as wp
from wsrender_kernels.legs import kind_of, pack_legs
from wsrender_kernels.membership import (
    ASKED_SLOTS,
    LANES,
    MembershipShape,
    lattice_kernel,
    lattice_type,
    mechanism_type,
    poses_kernel,
    survivors_kernels,
)

from wsrender.engine.constraint_code import device_constraints, packed_constraints
from wsrender.engine.devices import devices_of, thread_count
from wsrender.engine.evaluation import REAL, device_array, vector_of
from wsrender.engine.kernel_cache import launch, loaded
from wsrender.volume.lattice import LatticeBlock

CHUNK_CPU, CHUNK_CUDA, LEAST_CHUNK = 1 << 20, 1 << 26, 1 << 14
POSES_BATCH = 1 << 20
CHUNKS_PER_THREAD = 8


@dataclass(frozen=True, eq=False)
class LegTest:
    """Legs, and what is asked of them.

    ``legs`` has the fields of `wsrender.mechanisms.mechanism.Mechanism`, which stands above the engine. ``ends`` (L,)
    bool: whether a leg is the last of its subsystem.
    """

    legs: Any
    ends: np.ndarray
    precision: str = "float64"

    @property
    def shape(self) -> MembershipShape:
        """Compile-time part of the kernels."""
        legs = self.legs
        cones = max(legs.base_cone_cosine.max(), legs.platform_cone_cosine.max()) > -1
        kinds = tuple(sorted({kind_of(kind) for kind in legs.kinds}))
        asked = device_constraints(legs.constraints, legs, np.zeros(3), self.precision)
        (distances,) = asked["constraints"] or (None,)
        return MembershipShape(REAL[self.precision], kinds, legs.n, bool(cones), distances, asked["limits"])

    def model(self, shape: MembershipShape | None = None, origin: np.ndarray | None = None):
        """The struct of the kernels of a shape, by default the test's own; the world is seen from ``origin`` (3,)."""
        legs, real, count = self.legs, REAL[self.precision], self.legs.n
        model = mechanism_type(shape or self.shape)()
        packed = pack_legs(legs)
        model.legs = wp.types.matrix(packed.shape, real)(*packed.ravel().tolist())
        model.ends = vector_of(self.ends.astype(np.int32), wp.int32)
        pairs = np.zeros((count, count), np.int32)
        for each in legs.constraints:
            pairs[tuple(np.transpose(each.pairs))] = 1
            model.limits = vector_of(packed_constraints((each,), legs, np.zeros(3), self.precision), real)
        model.pairs = vector_of(pairs.ravel(), wp.int32)
        model.lower, model.upper = vector_of(legs.region_lower, real), vector_of(legs.region_upper, real)
        model.axes = wp.types.matrix((3, 3), real)(*legs.T_world_base[:3, :3].T.ravel().tolist())
        model.origin = vector_of(legs.T_world_base[:3, 3] - (0.0 if origin is None else origin), real)
        return model


@dataclass(frozen=True, eq=False)
class OrientationCounts:
    """Of places, by number ``cells`` (V,) int64: orientations ``reached`` and the sum of their ``weights`` (V,) int32.

    ``asked``: the number of (pose, leg) pairs that were evaluated. ``undecided``: poses that count as not reached, for
    legs solved numerically were neither found to reach them nor not to. ``fitting``: with constraints, poses that the
    legs reach by themselves, of which ``rejected`` are not admitted.
    """

    cells: np.ndarray
    reached: np.ndarray
    weights: np.ndarray
    asked: int
    undecided: int = 0
    fitting: int = 0
    rejected: int = 0

    @staticmethod
    def totals(parts: "Iterable[OrientationCounts]") -> tuple[int, int, int, int]:
        """The sums of ``asked`` and of what follows it."""
        each = [(part.asked, part.undecided, part.fitting, part.rejected) for part in parts]
        asked, undecided, fitting, rejected = np.sum([(0, 0, 0, 0), *each], axis=0).tolist()
        return asked, undecided, fitting, rejected


def count_orientations(
    test: LegTest,
    block: LatticeBlock,
    rotations: np.ndarray,
    first: int,
    count: int,
    *,
    weights: np.ndarray | None = None,
    by_subsystem: bool = True,
    device: str = "auto",
    threads: int | None = None,
    chunk_size: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> OrientationCounts:
    """At how many of the platform orientations (N, 3, 3), base frame, each voxel centre is reached.

    Voxels, by their numbers in the block, are those first … first + count - 1, z fastest. ``weights`` (N,) whole
    numbers, whose sum is below 2^31; by default 1. All (pose, leg) pairs are evaluated (method A), or ``by_subsystem``
    only those of survivors (method B), with the same result.
    """
    devices = devices_of(device)
    on_gpu = devices[0].is_cuda
    workers = devices if on_gpu else devices * thread_count(threads)
    fair = max(LEAST_CHUNK, count // (CHUNKS_PER_THREAD * len(workers)))
    chunk = chunk_size or (CHUNK_CUDA if on_gpu else min(CHUNK_CPU, fair))
    chunk = -(-max(chunk // len(rotations), 1) // LANES) * LANES
    if weights is None:
        weights = np.ones(len(rotations), np.int32)
    launches = [_Lattice(test, block, rotations, weights, by_subsystem, worker) for worker in devices]
    ranges = [(start, min(chunk, first + count - start)) for start in range(first, first + count, chunk)]

    def run(number: int) -> OrientationCounts:
        return launches[number % len(launches)](*ranges[number])

    with ThreadPoolExecutor(len(workers)) as pool:
        futures = [pool.submit(run, number) for number in range(len(ranges))]
        try:
            pending = set(futures)
            while pending:
                done, pending = wait(pending, timeout=0.1, return_when=FIRST_COMPLETED)
                for future in done:
                    future.result()
                if progress:
                    progress(min((len(futures) - len(pending)) * chunk, count))
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    return joined([future.result() for future in futures])


def count_orientations_at(
    test: LegTest,
    positions: np.ndarray,
    rotations: np.ndarray,
    *,
    weights: np.ndarray | None = None,
    device: str = "auto",
    threads: int | None = None,
) -> OrientationCounts:
    """At how many of the orientations given positions (N, 3), base frame [m], are reached; as `count_orientations`.

    Positions that are reached at none are among the ``cells`` too.
    """
    devices = devices_of(device)
    workers = devices if devices[0].is_cuda else devices * thread_count(threads)
    if weights is None:
        weights = np.ones(len(rotations), np.int32)
    size = max(LEAST_CHUNK, -(-len(positions) // len(workers)))
    parts = [positions[first : first + size] for first in range(0, len(positions), size)]
    launches = [_Lattice(test, part, rotations, weights, True, workers[k]) for k, part in enumerate(parts)]
    with ThreadPoolExecutor(len(workers)) as pool:
        found = list(pool.map(lambda launch: launch(0, launch.given), launches))
    reached, weighted = np.zeros((2, len(positions)), np.int32)
    for k, part in enumerate(found):
        reached[k * size + part.cells], weighted[k * size + part.cells] = part.reached, part.weights
    return OrientationCounts(np.arange(len(positions)), reached, weighted, *OrientationCounts.totals(found))


def joined(parts: list[OrientationCounts]) -> OrientationCounts:
    """The counts of several ranges of places, one after the other."""
    none = np.zeros(0, np.int32)
    cells, reached, weights = (
        np.concatenate([none, *(getattr(part, name) for part in parts)]) for name in ("cells", "reached", "weights")
    )
    return OrientationCounts(cells.astype(np.int64), reached, weights, *OrientationCounts.totals(parts))


class _Lattice:
    """The lattice kernel with everything but the range of its places: voxels of a block, or given positions."""

    def __init__(
        self, test: LegTest, places: LatticeBlock | np.ndarray, rotations, weights, by_subsystem: bool, device
    ):
        real = REAL[test.precision]
        points = np.zeros((0, 3)) if isinstance(places, LatticeBlock) else places
        self.given = len(points)
        shape = replace(test.shape, given=not isinstance(places, LatticeBlock))
        self.columns = 2 if shape.distances else 1  # of what is counted
        self.device, self.by_subsystem, self.orientations = device, int(by_subsystem), len(rotations)
        self.kernel = loaded(lattice_kernel(shape, device.is_cuda), device)
        self.model = test.model(shape, places.origin if isinstance(places, LatticeBlock) else None)
        joints = np.einsum("nij,lj->nli", rotations, test.legs.platform)
        cones = np.einsum("nij,lj->nli", rotations, test.legs.platform_cone_axis)
        self.points = device_array(points.T.ravel(), real, device)
        self.turned = device_array(np.concatenate([joints, cones], axis=2).ravel(), real, device)
        self.weights = device_array(weights, wp.int32, device)
        self.grid = lattice_type(real)()
        self.grid.size_y = self.grid.size_z = 1
        if isinstance(places, LatticeBlock):
            self.grid.edge = places.voxel_size_m
            self.grid.first_x, self.grid.first_y, self.grid.first_z = places.first_from_origin
            _, self.grid.size_y, self.grid.size_z = places.shape

    def __call__(self, first: int, count: int) -> OrientationCounts:
        blocks = -(-count // LANES)
        reached, weighted = (_memory(blocks * LANES, self.device) for _ in range(2))
        places = [self.model, self.grid, self.points, self.turned, self.weights, self.orientations]
        inputs = [*places, first, count, self.by_subsystem]
        if self.device.is_cuda:
            asked = wp.zeros(ASKED_SLOTS * self.columns, dtype=wp.int32, device=self.device)  # type: ignore[arg-type]
            launch(self.kernel, dim=count, inputs=inputs, outputs=[reached, weighted, asked], device=self.device)
            cells, counts, sums = survivors(reached, weighted, count)
        else:
            found, asked = _memory(blocks, self.device), _memory(blocks * self.columns, self.device)
            outputs = [reached, weighted, found, asked]
            launch(self.kernel, dim=blocks, inputs=inputs, outputs=outputs, device=self.device)
            some = np.flatnonzero(found.numpy())  # only there anything was written
            at = np.flatnonzero(reached.numpy().reshape(-1, LANES)[some])
            cells = some[at // LANES] * LANES + at % LANES
            counts, sums = reached.numpy()[cells], weighted.numpy()[cells]
        total, *fitting = asked.numpy().reshape(-1, self.columns).sum(axis=0, dtype=np.int64).tolist()
        if not fitting:
            return OrientationCounts(cells + first, counts, sums, total)
        rejected = fitting[0] - int(counts.sum(dtype=np.int64))
        return OrientationCounts(cells + first, counts, sums, total, 0, fitting[0], rejected)


def survivors(reached: wp.array, weighted: wp.array, count: int) -> tuple[np.ndarray, ...]:
    """Numbers int64, counts and sums of those of ``count`` places that are reached, in order; only they are copied."""
    device: Any = reached.device
    are_reached, survivors_of = (loaded(kernel, device) for kernel in survivors_kernels())
    places = _memory(count, device)
    if not count:
        return (np.zeros(0, np.int64), *np.zeros((2, 0), np.int32))
    launch(are_reached, dim=count, inputs=[reached], outputs=[places], device=device)
    wp.utils.array_scan(places, places, inclusive=True)
    kept = int(places[count - 1 :].numpy()[0])
    out = [_memory(kept, device) for _ in range(3)]
    launch(survivors_of, dim=count, inputs=[reached, weighted, places], outputs=out, device=device)
    cells, counts, sums = (array.numpy() for array in out)
    return cells.astype(np.int64), counts, sums


def _memory(count: int, device: wp.Device) -> wp.array:
    return wp.empty(count, dtype=wp.int32, device=device)  # type: ignore[arg-type]


def poses_reached(test: LegTest, poses: np.ndarray, *, device: str = "auto", threads: int | None = None) -> np.ndarray:
    """Whether platform poses (N, 4, 4), base frame [m], are reached, (N,) bool."""
    devices = devices_of(device)
    workers = devices if devices[0].is_cuda else devices * thread_count(threads)
    model = test.model()
    kernel = loaded(poses_kernel(test.shape, devices[0].is_cuda), *devices)
    size = min(POSES_BATCH, max(LEAST_CHUNK, -(-len(poses) // len(workers))))
    batches = [poses[first : first + size] for first in range(0, len(poses), size)]

    def run(numbered: tuple[int, np.ndarray]) -> np.ndarray:
        number, batch = numbered
        return _poses_launch(kernel, model, batch, REAL[test.precision], workers[number % len(workers)])

    with ThreadPoolExecutor(len(workers)) as pool:
        return np.concatenate([np.zeros(0, bool), *pool.map(run, enumerate(batches))])


def _poses_launch(kernel, model, poses: np.ndarray, real, device) -> np.ndarray:
    count = len(poses)
    rows = np.concatenate([poses[:, :3, 3], poses[:, :3, :3].reshape(count, 9)], axis=1)
    given = device_array(rows.T.ravel(), real, device)
    reached = wp.empty(count, dtype=wp.int32, device=device)  # type: ignore[arg-type]
    tasks = count if device.is_cuda else -(-count // LANES)
    launch(kernel, dim=tasks, inputs=[model, given, count], outputs=[reached], device=device)
    return reached.numpy() > 0
