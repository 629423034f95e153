"""The lattice of a ``parallel_workspace``: of the space, or of the plane or line in which the platform stays."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from wsrender.analyses.parallel_workspace.job import ParallelWorkspaceJob
from wsrender.errors import InputError
from wsrender.mechanisms.flat import MEASURES, Flat, flat_of
from wsrender.mechanisms.hybrid import Variant, reachable_box_of, reached_by_any
from wsrender.mechanisms.inverse_kinematics import SAME_ORIENTATION
from wsrender.mechanisms.membership import AxisBox, placed_box, reachable_box
from wsrender.mechanisms.orientations import OrientationSet
from wsrender.volume.lattice import LatticeBlock, block_around, round_to_digits

FIRST_POINTS, FEWEST_POINTS = 1 << 16, 1 << 10  # of the estimate that the default voxel size is made of
SHARE_POINTS = 1 << 12  # of the estimate of how many voxels are kept
LEAST_SHARE = 1e-3  # of the box: where hardly anything is reached
MOST_COMPARED = 8  # values of serial joints at which planes are compared
FLAT_AREA = 1e-9  # relative to its extent: thickness of a box that holds a plane


@dataclass(frozen=True)
class FlatLattice(LatticeBlock):
    """Cells of a plane or line as a block one voxel thick: its own axes first, then those across.

    Cell (i, j) covers [i, i + 1) edges along each of its axes from `Flat.origin`; its centre lies in the flat.
    """

    dimension: int = 2
    origin_m: tuple[float, ...] = (0.0, 0.0, 0.0)
    axes: tuple[tuple[float, ...], ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

    @cached_property
    def flat(self) -> Flat:
        """Where the cells lie."""
        return Flat(self.dimension, np.array(self.origin_m), np.array(self.axes))

    def centers(self, cells: np.ndarray) -> np.ndarray:
        """Centres (N, 3) of cells by number, world [m]."""
        return self.flat.in_world(super().centers(cells))


def lattice_of(
    job: ParallelWorkspaceJob, found: Sequence[Variant], orientations: OrientationSet, device: str
) -> LatticeBlock | None:
    """The lattice around all that the legs can reach; None where that is nothing.

    Raises InputError for a turned delta.
    """
    level = np.allclose(orientations.rotations, np.eye(3), rtol=0, atol=SAME_ORIENTATION)
    if found[0].mechanism.translational and not level:
        raise InputError("orientation", "must be null: the parallelograms of a delta do not let its platform turn")
    flat, _ = common_flat(found, orientations)
    return _in_space(job, found, orientations, device) if flat is None else _in_flat(job, flat, found, orientations)


def common_flat(found: Sequence[Variant], orientations: OrientationSet) -> tuple[Flat | None, str]:
    """The plane or line in which the platform's origin stays, whatever the serial joints; None where there is none.

    And why nothing is measured then, in words; empty where the platform has a volume.
    """
    if not found[0].mechanism.numeric:
        return None, ""
    some = found[:: max(len(found) // MOST_COMPARED, 1)]
    flats = [flat_of(v.mechanism, v.rotations(orientations.rotations[:1])[0]) for v in some]
    first = flats[0]
    if first is None:
        return None, ""
    size = max(leg.chain.reach for leg in found[0].mechanism.numeric)
    if not all(flat is not None and first.same(flat, size) for flat in flats):
        return None, "the platform stays in a plane or on a line that the serial joints leave: that is not measured"
    return first, "the platform stays at a point" if first.dimension == 0 else ""


def settled_lattice(block: list[Any] | None) -> LatticeBlock | None:
    """The lattice that `described` describes."""
    if block is None:
        return None
    size, first, shape, *flat = block
    if not flat:
        return LatticeBlock(size, tuple(first), tuple(shape))
    dimension, origin, axes = flat
    return FlatLattice(size, tuple(first), tuple(shape), dimension, tuple(origin), tuple(map(tuple, axes)))


def described(block: LatticeBlock | None) -> list[Any] | None:
    """A lattice as lists and numbers."""
    if block is None:
        return None
    entry: list[Any] = [block.voxel_size_m, list(block.first_voxel), list(block.shape)]
    if isinstance(block, FlatLattice):
        entry += [block.dimension, list(block.origin_m), [list(axis) for axis in block.axes]]
    return entry


def _in_space(job, found, orientations, device: str) -> LatticeBlock | None:
    box = reachable_box_of(found, orientations.rotations)
    if box is None:
        return None
    return block_around(box.lower, box.upper, job.voxel_size_m or _voxel_size(found, orientations, box, None, device))


def _in_flat(job, flat: Flat, found, orientations) -> LatticeBlock | None:
    box = _local_box(flat, found, orientations)
    if flat.dimension == 0 or np.any(box.lower[: flat.dimension] >= box.upper[: flat.dimension]):
        return None
    size = job.voxel_size_m or _voxel_size(found, orientations, box, flat, job.device)
    block = block_around(box.lower, box.upper, size)
    first, shape = list(block.first_voxel), list(block.shape)
    first[flat.dimension :], shape[flat.dimension :] = [0] * (3 - flat.dimension), [1] * (3 - flat.dimension)
    (x, y, z), (nx, ny, nz) = first, shape
    place = flat.dimension, tuple(flat.origin.tolist()), tuple(map(tuple, flat.axes.tolist()))
    return FlatLattice(block.voxel_size_m, (x, y, z), (nx, ny, nz), *place)


def _local_box(flat: Flat, found: Sequence[Variant], orientations: OrientationSet) -> AxisBox:
    """A box in the axes of a flat that holds all that any variant reaches."""
    corners = []
    for variant in found:
        box = reachable_box(variant.mechanism, variant.rotations(orientations.rotations))
        # Rounding may leave a box whose sides meet a hair apart: planes are thin.
        low, high = np.minimum(box.lower, box.upper), np.maximum(box.lower, box.upper)
        if np.any(box.lower > box.upper + FLAT_AREA * np.abs(high - low).max()):
            continue
        placed = placed_box(variant.mechanism, AxisBox(low, high))
        grid = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
        corners.append(flat.local(placed.lower + grid * (placed.upper - placed.lower)))
    if not corners:
        return AxisBox(np.zeros(3), np.zeros(3))
    points = np.concatenate(corners)
    return AxisBox(points.min(axis=0), points.max(axis=0))


def _voxel_size(found, orientations: OrientationSet, box: AxisBox, flat: Flat | None, device: str) -> float:
    """A hundredth of the cube root of the volume reached at any orientation, estimated, to two significant digits.

    In a plane of the square root of its area, on a line of its length.
    """
    points = max(FIRST_POINTS // len(orientations.rotations), FEWEST_POINTS)
    if flat is not None:
        points = min(points, FEWEST_POINTS)
    dimension = 3 if flat is None else flat.dimension
    share = max(_share(found, orientations, box, flat, points, device), LEAST_SHARE)
    size = np.prod((box.upper - box.lower)[:dimension]) * share
    return round_to_digits(float(size ** (1 / dimension)) / 100.0, 2)


def _share(found, orientations: OrientationSet, box: AxisBox, flat: Flat | None, points: int, device: str) -> float:
    """The share of a box that is reached at any orientation, from a Sobol set."""
    from scipy.stats.qmc import Sobol

    unit = Sobol(3, scramble=False).random_base2(int(points).bit_length() - 1)
    local = box.lower + unit * (box.upper - box.lower)
    world = local if flat is None else flat.in_world(local)
    return float(reached_by_any(found, world, orientations.rotations, device=device).mean())


def reached_share(block: LatticeBlock, found, orientations: OrientationSet, device: str) -> float:
    """The share of a lattice's voxels that is reached, estimated; at least LEAST_SHARE."""
    low = np.array(block.first_voxel) * block.voxel_size_m
    box = AxisBox(low, low + np.array(block.shape) * block.voxel_size_m)
    flat = block.flat if isinstance(block, FlatLattice) else None
    return max(_share(found, orientations, box, flat, SHARE_POINTS, device), LEAST_SHARE)


def quantity(block: LatticeBlock | None) -> tuple[str, str]:
    """What a lattice measures and in which unit: volume, area or length."""
    return MEASURES[block.dimension if isinstance(block, FlatLattice) else 3]
