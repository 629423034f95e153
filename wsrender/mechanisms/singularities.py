"""Where the determinants of a mechanism's Jacobians change sign between neighbouring voxels (Gosselin & Angeles 1990).

Type 1: det B, a leg is stretched or folded and its actuator has no effect. Type 2: det A, the platform moves while the
legs are locked.
"""

import numpy as np

from wsrender.volume.volume_data import VolumeData

TYPES = {1: "determinant_B", 2: "determinant_A"}


def sign_changes(volume: VolumeData) -> dict[int, np.ndarray]:
    """By type, points (N, 3) [m] where the determinant is 0, linear between the centres of voxels that share a face.

    The volume holds the determinants as statistic "center". A determinant that is 0 at a centre counts there.
    """
    first = np.array(volume.first_voxel)
    return {kind: zeros(volume.statistics["center"][name], first, volume.voxel_size_m) for kind, name in TYPES.items()}


def zeros(values: np.ndarray, first: np.ndarray, edge: float) -> np.ndarray:
    """Points (N, 3) [m] where values (nx, ny, nz) at centres of voxels, the ``first`` one (3,), pass through 0.

    NaN: no value there.
    """
    found = [np.argwhere(values == 0.0).astype(np.float64)]
    for axis in range(3):
        count = values.shape[axis]
        here, there = values.take(range(count - 1), axis), values.take(range(1, count), axis)
        cells = np.argwhere(here * there < 0)
        at = tuple(cells.T)
        points = cells.astype(np.float64)
        points[:, axis] += here[at] / (here[at] - there[at])
        found.append(points)
    return (np.concatenate(found) + first + 0.5) * edge
