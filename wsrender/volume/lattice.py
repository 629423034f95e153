"""The world lattice: voxels of one edge, anchored at the world origin ([WSR] II.C.2)."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import ceil, floor, log10

import numpy as np

from wsrender.errors import InputError, ResourceError
from wsrender.memory import SHARE, available_bytes
from wsrender.tolerances import FLAT

LARGEST_BLOCK = 2.0**30  # voxels along an axis: the kernels hold 32-bit integers
LARGEST_COORDINATE = 2.0**50  # of a voxel: float64 holds its corners
FAR = 4  # extents of a block away from the world's origin that single precision bears: three of its 24 bits
# 48 samples a voxel of the convex hull left at most .25 % holes in the workspace of a Panda, 32 .67, 16 up to 1.75 %.
SAMPLES_PER_VOXEL, MOST_DIVISIONS = 48, 100
POINT_M = 1.0  # counts as the size of a single point, which has none
THINNEST = 0.25  # of its extent is a hull at least as large as: voxels of curves and slabs would be too many else


@dataclass(frozen=True)
class LatticeBlock:
    """A dense block of the lattice: voxel edge [m], first voxel and shape (x, y, z).

    ``about``: the voxel that positions on a device are counted from if the block lies far away; None: its middle.
    """

    voxel_size_m: float
    first_voxel: tuple[int, int, int]
    shape: tuple[int, int, int]
    about: tuple[int, int, int] | None = field(default=None, kw_only=True)

    @property
    def size(self) -> int:
        """Number of voxels."""
        nx, ny, nz = self.shape
        return nx * ny * nz

    @property
    def origin_voxel(self) -> tuple[int, int, int]:
        """The voxel whose lower corner is the origin of positions on a device.

        That of the world; of a block that lies far away, ``about``, if that is near, else its middle. An arm whose base
        stands there has the same bits as by the world's origin.
        """
        middle = [first + size // 2 for first, size in zip(self.first_voxel, self.shape, strict=True)]
        for place in ((0, 0, 0), self.about):
            if place and max(abs(at - own) for at, own in zip(middle, place, strict=True)) <= FAR * max(self.shape):
                return place
        x, y, z = middle
        return x, y, z

    @property
    def origin(self) -> np.ndarray:
        """That corner in the world, (3,) [m]."""
        return np.array(self.origin_voxel) * self.voxel_size_m

    @property
    def first_from_origin(self) -> tuple[int, int, int]:
        """The first voxel as counted from there."""
        x, y, z = (first - at for first, at in zip(self.first_voxel, self.origin_voxel, strict=True))
        return x, y, z

    def places(self, points: np.ndarray) -> np.ndarray:
        """Indices (N, d) int64, in the block, of the voxels that hold points (N, d) [m]; d: of the first axes.

        Of points beside the block they are negative, or above its shape.
        """
        return np.floor(points / self.voxel_size_m).astype(np.int64) - self.first_voxel[: points.shape[1]]

    def centers(self, cells: np.ndarray) -> np.ndarray:
        """Centres (N, 3) [m] of voxels by their numbers (N,) in the block, z fastest."""
        at = np.stack(np.unravel_index(cells, self.shape), axis=1)
        return (at + self.first_voxel + 0.5) * self.voxel_size_m


def voxel_of(position: np.ndarray, voxel_size_m: float) -> tuple[int, int, int]:
    """The voxel (x, y, z) whose lower corner is nearest to a position (3,) [m]."""
    x, y, z = (int(v) for v in np.rint(position / voxel_size_m))
    return x, y, z


def block_around(
    lower: np.ndarray, upper: np.ndarray, voxel_size_m: float, about: np.ndarray | None = None
) -> LatticeBlock:
    """The block that contains the box lower … upper [m], with one voxel to spare for rounding.

    ``about`` (3,) [m]: where positions on a device are counted from, if the box lies far away.
    """
    extent, farthest = float(np.max(upper - lower)), float(np.abs([lower, upper]).max())
    if extent >= LARGEST_BLOCK * voxel_size_m:
        raise InputError(
            "voxel_size_m",
            f"{voxel_size_m} is too small for a workspace of {extent:.3g} m: {_least(extent / LARGEST_BLOCK)}",
        )
    if farthest >= LARGEST_COORDINATE * voxel_size_m:
        least = _least(farthest / LARGEST_COORDINATE)
        raise InputError(
            "voxel_size_m", f"{voxel_size_m} is too small {farthest:.3g} m from the world's origin: {least}"
        )
    first = np.floor(np.asarray(lower) / voxel_size_m).astype(np.int64) - 1
    last = np.floor(np.asarray(upper) / voxel_size_m).astype(np.int64) + 1
    x, y, z = (int(v) for v in first)
    nx, ny, nz = (int(v) for v in last - first + 1)
    near = None if about is None else voxel_of(about, voxel_size_m)
    return LatticeBlock(float(voxel_size_m), (x, y, z), (nx, ny, nz), about=near)


def block_of_all(blocks: Sequence[LatticeBlock]) -> LatticeBlock:
    """The least block that contains all of some with one voxel size."""
    first = np.min([block.first_voxel for block in blocks], axis=0)
    end = np.max([np.add(block.first_voxel, block.shape) for block in blocks], axis=0)
    (x, y, z), (nx, ny, nz) = first.tolist(), (end - first).tolist()
    return LatticeBlock(blocks[0].voxel_size_m, (x, y, z), (nx, ny, nz))


def _least(size: float) -> str:
    return f"at least {rounded_up(size * (1 + 1e-9), 2):g} is allowed"


def check_voxels(block: LatticeBlock, bytes_each: float) -> None:
    """Whether so many bytes for each voxel of a block fit in memory.

    Raises ResourceError, with the smallest voxel that does, for the field ``voxel_size_m``.
    """
    needed, free = float(block.size) * bytes_each, available_bytes()
    if needed <= SHARE * free:
        return
    smallest = rounded_up(block.voxel_size_m * (needed / max(SHARE * free, 1.0)) ** (1 / 3), 2)
    raise ResourceError(
        "voxel_size_m",
        f"{block.voxel_size_m:g} gives {' x '.join(map(str, block.shape))} voxels, which need "
        f"{needed / 2**30:.1f} GiB; {free / 2**30:.1f} GiB are free: choose {smallest:g} or more",
    )


def default_voxel_size(
    positions: np.ndarray, samples: float = np.inf, *, least: float = 0.0, divisions: float = MOST_DIVISIONS
) -> float:
    """Edge of a voxel [m] at which so many ``samples`` of a workspace leave next to no holes in it.

    The positions (N, 3) [m] span a convex hull of volume V: max(∛(48 V / samples), ∛V / divisions), the former at
    most ∛V, but not below ``least`` [m], rounded up to two significant digits. A planar set uses the square root of
    its area, a linear one its length; a hull smaller than a cube of a quarter of its extent counts as that cube. A
    single point has no holes, and counts as a metre. 0 where nothing bounds the edge from below.
    """
    return voxel_size_of(measured(positions), samples, least=least, divisions=divisions)


def voxel_size_of(
    hull: tuple[int, float, float], samples: float = np.inf, *, least: float = 0.0, divisions: float = MOST_DIVISIONS
) -> float:
    """The same of positions that are `measured`."""
    dimension, measure, extent = hull
    whole, holding = POINT_M, 0.0
    if dimension:
        whole = max(measure ** (1 / dimension), extent * THINNEST)
        holding = min((SAMPLES_PER_VOXEL / samples) ** (1 / dimension), 1.0) * whole
    edge = max(holding, whole / divisions, least)
    return rounded_up(edge, 2) if edge else 0.0


def expected_voxels(positions: np.ndarray, voxel_size_m: float, hull: tuple[int, float, float] | None = None) -> float:
    """How many voxels a workspace has of which samples (N, 3) [m] are known, however small the voxels are.

    The volume (area, length) is measured with voxels so large that the samples leave next to no holes: half of those
    at its boundary belong to it. Its share per voxel is the answer, at least 1. ``hull``: the positions, `measured`.
    """
    hull = hull or measured(positions)
    size = voxel_size_of(hull, len(positions))
    cells = np.floor(positions / size).astype(np.int64)
    cells -= cells.min(axis=0) - 1
    strides = np.cumprod([1, *(cells.max(axis=0) + 2)[:2]])
    held = np.unique(cells @ strides)
    around = np.isin(held + np.concatenate([strides, -strides])[:, None], held).sum(axis=0)
    inner = int((around >= 2 * hull[0]).sum())
    return max((inner + len(held)) / 2 * (size / voxel_size_m) ** hull[0], 1.0)


def measured(positions: np.ndarray) -> tuple[int, float, float]:
    """Dimension of a set of positions (N, 3), length, area or volume of its convex hull, and largest extent [m]."""
    from scipy.spatial import ConvexHull

    centered = positions - positions.mean(axis=0)
    _, sizes, axes = np.linalg.svd(centered, full_matrices=False)
    dimension = int((sizes > FLAT * sizes[0]).sum()) if sizes[0] > 1e-9 * np.sqrt(len(positions)) else 0
    if dimension == 0:
        return 0, 0.0, 0.0
    inside = centered @ axes[:dimension].T
    extent = float(np.ptp(inside, axis=0).max())
    return dimension, extent if dimension == 1 else float(ConvexHull(inside).volume), extent


def round_to_digits(value: float, digits: int) -> float:
    """The decimal number of so many significant digits that is nearest to a positive value."""
    return round(value, digits - 1 - floor(log10(value)))


def rounded_up(value: float, digits: int) -> float:
    """The least decimal number of so many significant digits that is not below a positive value."""
    places = digits - 1 - floor(log10(value))
    # A value that has so many digits stays as it is.
    return round(ceil(value * 10.0**places * (1 - 1e-12)) / 10.0**places, places)
