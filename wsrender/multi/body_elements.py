"""The body-elemental algorithm: collaborative volume of two arms from points that each reaches ([GX]).

[GX]: Gao, Xu, *Volume of collaborative space of 6R two-arm robot, body-elemental algorithm*. The volume is biased:
cells that both arms merely touch count whole, cells of the collaborative space that one arm's points miss are lost.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wsrender.errors import InputError, ResourceError

MOST_CELLS = 2**30  # one byte each
# Steps to the neighbours of a cell: in its layer of constant z, and across layers too.
NEIGHBOURS = {4: ((1, 0, 0), (0, 1, 0)), 6: ((1, 0, 0), (0, 1, 0), (0, 0, 1))}


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
