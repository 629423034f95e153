"""Per-voxel statistics of a distribution map, accumulated sample by sample in plain Python."""

import numpy as np


def accumulated(position, values, voxel_size_m):
    """{(i, j, k): (K, samples in the voxel) values}; floor(p / r) in the precision of the positions (N, 3)."""
    cells = np.floor(position / position.dtype.type(voxel_size_m)).astype(int)
    found = {}
    for cell, row in zip(map(tuple, cells), np.stack(values, axis=1), strict=True):
        found.setdefault(cell, []).append(row)
    return {cell: np.array(rows).T for cell, rows in found.items()}


def fixed_point(values, scale):
    """Sum of round(value * scale) as a Python integer, halves rounded up."""
    return sum(int(np.floor(float(v) * scale + 0.5)) for v in values)
