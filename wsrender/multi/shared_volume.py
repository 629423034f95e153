"""The volume that several robots share ([WSR] III.B eq. 7): voxel sets on one lattice, counted and combined."""

from collections.abc import Sequence

import numpy as np

from wsrender.volume.lattice import LatticeBlock, block_of_all
from wsrender.volume.registration import registered
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels

NUMBER, PRODUCT = "number", "product"


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
