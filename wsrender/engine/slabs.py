"""Slabs of a lattice block whose voxel records fit in memory."""

from math import ceil, inf

import warp as wp
from wsrender_kernels.sweep import Shape

from wsrender.errors import ResourceError
from wsrender.memory import SHARE, available_bytes
from wsrender.volume.lattice import LatticeBlock, rounded_up

SHARE_SLAB = 0.4  # of the free memory, for a slab: what it held is kept beside the next
LARGEST_ARRAY = 2**31 - 1  # elements of a Warp array along one axis
VOXEL_SAMPLES = 0.25  # samples that take as long as one voxel's record to be cleared and read, at the least
MOST_SLABS = 32  # each costs another evaluation of all samples


def fitted(
    block: LatticeBlock, shape: Shape, workers: list[wp.Device], samples: int
) -> tuple[list[wp.Device], list[LatticeBlock]]:
    """The workers that sweep the block soonest, and the slabs of it whose records they keep at a time.

    That is the whole block, or where their private records of it do not fit in memory, equal slabs along x and a rest;
    on a CPU, whose workers share its memory, fewer workers may take fewer slabs, and less time where the samples are
    few beside the voxels.

    Raises ResourceError, with the numbers, where more than MOST_SLABS would be needed.
    """
    device, (nx, ny, nz) = workers[0], block.shape
    free = min(worker.free_memory for worker in workers) if device.is_cuda else available_bytes()
    counts = range(1, 2 if device.is_cuda else len(workers) + 1)
    widths = {count: _slab_width(block, shape, free / count) for count in counts}
    times = {
        count: ceil(nx / widths[count]) * samples / count + VOXEL_SAMPLES * block.size * count if widths[count] else inf
        for count in counts
    }
    count = min(reversed(counts), key=times.__getitem__)
    if times[count] == inf:
        fits = block.voxel_size_m * (block.size * shape.bytes_per_voxel / (MOST_SLABS * SHARE_SLAB * free)) ** (1 / 3)
        raise ResourceError(
            "voxel_size_m",
            f"{block.voxel_size_m} gives {nx} x {ny} x {nz} voxels, {block.size * shape.bytes_per_voxel / 2**30:.1f} "
            f"GiB of records; {free / 2**30:.1f} GiB are free on {device.alias}, too little for {MOST_SLABS} parts: "
            f"choose larger voxels or fewer statistics or indices; {rounded_up(fits, 2):g} fits",
        )
    x, y, z = block.first_voxel
    width = widths[count]
    parts = [((x + i, y, z), (min(width, nx - i), ny, nz)) for i in range(0, nx, width)]
    slabs = [LatticeBlock(block.voxel_size_m, *part, about=block.about) for part in parts]
    return workers if device.is_cuda else workers[:count], slabs


def _slab_width(block: LatticeBlock, shape: Shape, free: float) -> int:
    """Voxels along x of the slabs whose records fit in so many free bytes; 0 where MOST_SLABS are too few."""
    nx, ny, nz = block.shape
    slice_bytes = ny * nz * shape.bytes_per_voxel
    widest = max(shape.record_size, shape.sums_size, len(shape.constraints))
    largest = (LARGEST_ARRAY - widest) // (ny * nz * widest)
    if nx * slice_bytes <= SHARE * free and nx <= largest:
        return nx
    width = int(min(SHARE_SLAB * free // slice_bytes, largest))
    return width if width * MOST_SLABS >= nx else 0
