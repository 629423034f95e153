"""Slabs of a lattice block whose voxel records fit in memory."""

from math import ceil

import warp as wp
from wsrender_kernels.sweep import Shape

from wsrender.engine.memory import available_bytes
from wsrender.errors import ResourceError
from wsrender.volume.lattice import LatticeBlock

SHARE = 0.8  # of the free memory, for a whole block
SHARE_SLAB = 0.4  # and for a slab: what it held is kept beside the next
LARGEST_ARRAY = 2**31 - 1  # elements of a Warp array along one axis
MOST_SLABS = 32  # each costs another evaluation of all samples


def fitting_workers(block: LatticeBlock, shape: Shape, workers: list[wp.Device]) -> list[wp.Device]:
    """As many of the workers as sweep the block soonest: on a CPU fewer where their records then take fewer slabs."""
    if workers[0].is_cuda:
        return workers
    free, (nx, ny, nz) = available_bytes(), block.shape
    record_bytes = nx * ny * nz * shape.bytes_per_voxel

    def seconds(count: int) -> float:  # in units of a sweep by one worker
        slabs = 1 if record_bytes * count <= SHARE * free else ceil(record_bytes * count / (SHARE_SLAB * free))
        return slabs / count

    return workers[: min(range(len(workers), 0, -1), key=seconds)]


def slabs_of(block: LatticeBlock, shape: Shape, workers: list[wp.Device]) -> list[LatticeBlock]:
    """The block, or where the workers' private records of it do not fit in memory, equal slabs along x and a rest.

    Raises ResourceError, with the numbers, where more than MOST_SLABS would be needed.
    """
    device, share = workers[0], 1 if workers[0].is_cuda else len(workers)
    free = min(worker.free_memory for worker in workers) if device.is_cuda else available_bytes()
    nx, ny, nz = block.shape
    slice_bytes = ny * nz * shape.bytes_per_voxel * share
    slice_elements = ny * nz * max(shape.record_size, shape.sums_size)
    if nx * slice_bytes <= SHARE * free and nx * slice_elements + shape.record_size < LARGEST_ARRAY:
        return [block]
    width = int(min(SHARE_SLAB * free // slice_bytes, (LARGEST_ARRAY - shape.record_size) // slice_elements))
    if width < 1 or ceil(nx / width) > MOST_SLABS:
        raise ResourceError(
            "voxel_size_m",
            f"{block.voxel_size_m} gives {nx} x {ny} x {nz} voxels, {nx * slice_bytes / 2**30:.1f} GiB of records; "
            f"{free / 2**30:.1f} GiB are free on {device.alias}, too little for {MOST_SLABS} parts: choose larger "
            "voxels or fewer statistics or indices",
        )
    x, y, z = block.first_voxel
    starts = range(0, nx, width)
    return [LatticeBlock(block.voxel_size_m, (x + i, y, z), (min(width, nx - i), ny, nz)) for i in starts]
