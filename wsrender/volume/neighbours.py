"""Voxels and their 26 neighbours."""

import numpy as np

from wsrender.volume.voxels import Voxels

LAYERS = 32  # of voxels at a time


def inner_and_outer(occupied: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of a set of voxels (nx, ny, nz) bool: those with all 26 neighbours in it, and it with all its neighbours.

    Both have one more layer of voxels on every side, (nx + 2, ny + 2, nz + 2). In a plane, cells (nx, ny) have 8
    neighbours, on a line 2.
    """
    inner = outer = np.pad(occupied, 1)
    for axis in range(occupied.ndim):
        before, after = _shifted(inner, 1, axis), _shifted(inner, -1, axis)
        inner = inner & before & after
        before, after = _shifted(outer, 1, axis), _shifted(outer, -1, axis)
        outer = outer | before | after
    return inner, outer


def neighbours_and_itself(occupied: np.ndarray) -> np.ndarray:
    """Of every voxel of a block, how many of it and its neighbours are in a set of voxels, int8 of the same shape."""
    number = np.pad(occupied, 1).astype(np.int8)
    for axis in range(occupied.ndim):
        number = number + _shifted(number, 1, axis) + _shifted(number, -1, axis)
    return number[(slice(1, -1),) * occupied.ndim]


def inner_and_outer_counts(voxels: Voxels) -> tuple[int, int]:
    """Numbers of the voxels that `inner_and_outer` gives of the occupied ones, counted in parts, of little memory."""
    nx, ny, nz = voxels.shape
    cells = voxels.cells[voxels.count > 0]
    inner = outer = 0
    for start in range(-1, nx + 1, LAYERS):
        stop = min(start + LAYERS, nx + 1)
        low, high = max(start - 1, 0), min(stop + 1, nx)
        first, last = np.searchsorted(cells, [low * ny * nz, high * ny * nz])
        if first == last:
            continue
        occupied = np.zeros((high - low, ny, nz), bool)
        occupied.flat[cells[first:last] - low * ny * nz] = True
        more_inner, more_outer = inner_and_outer(occupied)  # from the layer low - 1 on
        part = slice(start - low + 1, stop - low + 1)
        inner += int(np.count_nonzero(more_inner[part]))
        outer += int(np.count_nonzero(more_outer[part]))
    return inner, outer


def _shifted(voxels: np.ndarray, by: int, axis: int) -> np.ndarray:
    """The set moved by one voxel, what would leave the array lost."""
    moved = np.roll(voxels, by, axis)
    edge = [slice(None)] * voxels.ndim
    edge[axis] = slice(0, 1) if by > 0 else slice(-1, None)
    moved[tuple(edge)] = 0
    return moved
