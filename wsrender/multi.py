"""Several robots in one space: the volume that they share ([WSR] III.B eq. 7), and that of two arms by elements ([GX]).

[GX]: Gao, Xu, *Volume of collaborative space of 6R two-arm robot, body-elemental algorithm*. The volume is biased:
cells that both arms merely touch count whole, cells of the collaborative space that one arm's points miss are lost.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wsrender.errors import InputError, ResourceError
from wsrender.volume.lattice import LatticeBlock, block_of_all
from wsrender.volume.volume_data import VolumeData, registered
from wsrender.volume.voxels import Voxels

NUMBER, PRODUCT = "number", "product"
MOST_CELLS = 2**30  # one byte each
# Steps to the neighbours of a cell: in its layer of constant z, and across layers too.
NEIGHBOURS = {4: ((1, 0, 0), (0, 1, 0)), 6: ((1, 0, 0), (0, 1, 0), (0, 0, 1))}


def shared_volume(volumes: Sequence[VolumeData]) -> VolumeData:
    """What robots (K volumes on one lattice) reach together, on the block that holds all of them.

    ``count`` is the number of their samples. Statistic "number" of "robots": how many robots reach the voxel.
    Statistic "product" of each index that all volumes hold: the product, over the robots that reach the voxel, of the
    index's largest value there divided by the robot's largest anywhere; NaN where fewer than two do.

    Raises InputError for volumes of different voxel sizes.
    """
    volumes = registered(volumes)
    reached = np.sum([volume.occupied for volume in volumes], axis=0)
    number = np.where(reached > 0, reached, np.nan).astype(np.float32)
    return VolumeData(
        volumes[0].voxel_size_m,
        volumes[0].first_voxel,
        np.sum([volume.count for volume in volumes], axis=0),
        {NUMBER: {"robots": number}, PRODUCT: _products(volumes, reached)},
        {"robots": "1"},
    )


def volume_by_number(shared: VolumeData, robots: int) -> np.ndarray:
    """Volume [m³] reached by exactly k of the robots, k = 0 … robots, at [k]; [0] is 0: the lattice has no end."""
    number = np.nan_to_num(shared.statistics[NUMBER]["robots"]).astype(np.int64)
    cells = np.bincount(number.ravel(), minlength=robots + 1)
    cells[0] = 0
    return cells * shared.voxel_size_m**3


def scanned_volumes(
    others: Sequence[tuple[LatticeBlock, np.ndarray]], moved: Sequence[tuple[LatticeBlock, np.ndarray]]
) -> np.ndarray:
    """Volumes (N, K) [m³] that at least 1 … K robots reach: ``others`` (K - 1), and another at each of N placements.

    Of each the numbers (V,) of the voxels that it reaches in a block; all blocks are of one lattice.
    """
    whole = block_of_all([block for block, _ in (*others, *moved)])
    numbers, robots = np.unique(np.concatenate([_numbers_in(whole, *each) for each in others]), return_counts=True)
    alone, rows = np.bincount(robots, minlength=len(others) + 2), []
    for each in moved:
        own = _numbers_in(whole, *each)
        joined = robots[np.isin(numbers, own, assume_unique=True)]
        added = np.bincount(joined + 1, minlength=len(alone)) - np.bincount(joined, minlength=len(alone))
        by_number = alone + added
        by_number[1] += len(own) - len(joined)
        rows.append(np.cumsum((by_number * whole.voxel_size_m**3)[:0:-1])[::-1])
    return np.array(rows)


def _numbers_in(whole: LatticeBlock, block: LatticeBlock, cells: np.ndarray) -> np.ndarray:
    """The numbers in a larger block of the voxels of one."""
    return Voxels(block.shape, cells, cells).moved(whole.shape, np.subtract(block.first_voxel, whole.first_voxel)).cells


def reached_by(shared: VolumeData, least: int) -> VolumeData:
    """The voxels that at least so many robots reach."""
    number = np.nan_to_num(shared.statistics[NUMBER]["robots"])
    return VolumeData(shared.voxel_size_m, shared.first_voxel, np.where(number >= least, shared.count, 0))


def _products(volumes: Sequence[VolumeData], reached: np.ndarray) -> dict[str, np.ndarray]:
    held = [volume.statistics.get("maximum", {}) for volume in volumes]
    products = {}
    for name in held[0]:
        if not all(name in by_index for by_index in held):
            continue
        product = np.prod([_normalised(by_index[name]) for by_index in held], axis=0)
        products[name] = np.where(reached > 1, product, np.nan).astype(np.float32)
    return products


def _normalised(values: np.ndarray) -> np.ndarray:
    """Values over their maximum, 1 in empty voxels so that they leave a product as it is."""
    largest = np.nanmax(values)
    shares = values.astype(np.float64) / largest if largest > 0 else np.zeros(values.shape)
    return np.where(np.isnan(values), 1.0, shares)


@dataclass(frozen=True, eq=False)
class BodyElements:
    """Result of the algorithm.

    ``volumes_m3`` (d + 1,): V₀ of the whole cells, V₁ … V_d with the boundary cells split in (i + 1)³. ``lower_m``,
    ``upper_m`` (3,): the cropped box. ``collaborative`` (m, n, p): cells that hold points of both arms; ``boundary``:
    those of them beside one that does not.
    """

    volumes_m3: np.ndarray
    lower_m: np.ndarray
    upper_m: np.ndarray
    collaborative: np.ndarray
    boundary: np.ndarray


def body_elements(
    left: np.ndarray,
    right: np.ndarray,
    cells: Sequence[int] = (20, 20, 20),
    refinements: int = 3,
    neighbours: int = 4,
) -> BodyElements:
    """Collaborative volume of the points (N, 3) [m] of a left and a right arm.

    The box is cropped to x from the left arm's smallest to the right arm's largest, and holds the y and z of all
    points between. ``neighbours`` 4 looks for the boundary in layers of constant z, 6 across them too. Arms that do
    not meet in x have no collaborative volume.

    Raises InputError for other numbers of neighbours, cells or refinements, or a set without points.
    """
    if neighbours not in NEIGHBOURS:
        raise InputError("neighbours", f"{neighbours!r} is not allowed; 4 (in a layer) or 6 is")
    if len(cells) != 3 or min(cells) < 1:
        raise InputError("cells", f"{list(cells)} is not allowed; three positive whole numbers are")
    if refinements < 0:
        raise InputError("refinements", f"{refinements} is not allowed; 0 or more is")
    for name, points in (("left", left), ("right", right)):
        if points.ndim != 2 or points.shape[1] != 3 or len(points) == 0:
            raise InputError(name, f"has shape {points.shape}; (N, 3) with N at least 1 is needed")
    shape = np.array(cells)
    if np.prod(shape.astype(float)) * (refinements + 1) ** 3 > MOST_CELLS:
        finest = " × ".join(str(n * (refinements + 1)) for n in cells)
        raise ResourceError("refinements", f"{refinements} of them make {finest} cells; at most 2^30 are allowed")
    lower, upper = _cropped_box(left, right)
    if not (upper > lower).all():
        nothing = np.zeros(tuple(cells), bool)
        return BodyElements(np.zeros(refinements + 1), lower, upper, nothing, nothing)
    inside = [_fractions(points, lower, upper) for points in (left, right)]
    held = [_occupied(at, shape) for at in inside]
    collaborative = held[0] & held[1]
    boundary = collaborative & ~_surrounded(collaborative, neighbours)
    cell = float(np.prod((upper - lower) / shape))
    whole = np.count_nonzero(collaborative & ~boundary)
    volumes = [np.count_nonzero(collaborative) * cell]
    near = [at[boundary[tuple((at * shape).astype(np.int64).T)]] for at in inside]
    for parts in range(2, refinements + 2):
        both = np.count_nonzero(_occupied(near[0], shape * parts) & _occupied(near[1], shape * parts))
        volumes.append((whole + both / parts**3) * cell)
    return BodyElements(np.array(volumes), lower, upper, collaborative, boundary)


def _cropped_box(left: np.ndarray, right: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    low, high = left[:, 0].min(), right[:, 0].max()
    points = np.concatenate([points[(points[:, 0] >= low) & (points[:, 0] < high)] for points in (left, right)])
    if len(points) == 0:
        return np.array([low, 0.0, 0.0]), np.array([high, 0.0, 0.0])
    lower, upper = points.min(axis=0), points.max(axis=0)
    lower[0], upper[0] = low, high
    return lower.astype(np.float64), upper.astype(np.float64)


def _fractions(points: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """Places in the box, [0, 1), of the points (N, 3) in it; what lies on its upper faces in y and z is in it too."""
    cropped = points[(points[:, 0] >= lower[0]) & (points[:, 0] < upper[0])]
    return np.minimum((cropped - lower) / (upper - lower), 1 - 2.0**-53)


def _occupied(fractions: np.ndarray, shape: np.ndarray) -> np.ndarray:
    """Cells of a division of the box that hold a point, bool of that shape."""
    at = (fractions * shape).astype(np.int64)
    occupied = np.zeros(tuple(shape), bool)
    occupied[tuple(at.T)] = True
    return occupied


def _surrounded(collaborative: np.ndarray, neighbours: int) -> np.ndarray:
    """Whether all neighbours of a cell are collaborative; outside the box none is."""
    padded = np.pad(collaborative, 1)
    around = np.ones(collaborative.shape, bool)
    for step in NEIGHBOURS[neighbours]:
        for sign in (1, -1):
            ahead = np.roll(padded, np.multiply(step, sign), axis=(0, 1, 2))
            around &= ahead[1:-1, 1:-1, 1:-1]
    return around
