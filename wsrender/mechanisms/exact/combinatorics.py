"""Which surfaces meet in which circles and vertices: index tables that depend on the numbers of surfaces alone."""

from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

import numpy as np


@dataclass(frozen=True, eq=False)
class Combinatorics:
    """Index tables of K surfaces: first the spheres, then the planes.

    ``pairs`` (Q, 2), first below second, are the circles (lines between two planes; parallel planes have none).
    ``triples`` (T, 3), ascending, meet in at most two points where the first is a sphere; three planes of different
    axes meet in one. ``columns`` of candidate vertices (N): the + points of the sphere triples, their − points, then
    the corners. Of every column: ``circles`` (N, 3), the pairs (first, second), (first, third), (second, third);
    ``entering`` (N, 3), whether going along that circle the vertex is where one comes into what the remaining surface
    allows; ``own`` (N, K), the three surfaces. One goes along first normal × second normal, the normals pointing away
    from centres and out of half spaces.
    """

    pairs: np.ndarray
    is_line: np.ndarray
    sphere_circles: np.ndarray
    corners: np.ndarray
    circles: np.ndarray
    entering: np.ndarray
    own: np.ndarray
    pair_own: np.ndarray


@lru_cache(maxsize=64)
def combinatorics(side: tuple[int, ...], planes: tuple[tuple[int, int], ...]) -> Combinatorics:
    """Tables of spheres of these sides (+1: inside, −1: outside) and planes of (axis 0, 1 or 2, sign of the normal)."""
    spheres, count = len(side), len(side) + len(planes)
    sides = np.array((*side, *(1 for _ in planes)))
    normals = np.array([np.eye(3)[axis] * sign for axis, sign in planes]).reshape(-1, 3)

    def meet(*surfaces: int) -> bool:
        axes = [planes[k - spheres][0] for k in surfaces if k >= spheres]
        return len(set(axes)) == len(axes)

    pairs = np.array([pair for pair in combinations(range(count), 2) if meet(*pair)], int).reshape(-1, 2)
    number = np.full((count, count), -1)
    number[tuple(pairs.T)] = np.arange(len(pairs))
    triples = np.array([triple for triple in combinations(range(count), 3) if meet(*triple)], int).reshape(-1, 3)
    is_corner = triples[:, 0] >= spheres
    of_sphere, corners = triples[~is_corner], triples[is_corner]
    columns = np.concatenate([of_sphere, of_sphere, corners])
    at_corners = np.linalg.det(normals[corners - spheres]) if len(corners) else np.zeros(0)
    branch = np.sign(np.concatenate([np.ones(len(of_sphere)), -np.ones(len(of_sphere)), at_corners]))
    i, j, k = columns.T  # branch: sign of det(n_i, n_j, n_k)
    return Combinatorics(
        pairs,
        pairs[:, 0] >= spheres,
        _circles(number, of_sphere),
        corners,
        _circles(number, columns),
        # A point that goes along n_i × n_j leaves the k-th ball or half space at the rate det(n_i, n_j, n_k).
        np.stack([-branch * sides[k], branch * sides[j], -branch * sides[i]], axis=1) > 0,
        _membership(columns, count),
        _membership(pairs, count),
    )


def _circles(number: np.ndarray, triples: np.ndarray) -> np.ndarray:
    i, j, k = triples.T
    return np.stack([number[i, j], number[i, k], number[j, k]], axis=1)


def _membership(groups: np.ndarray, count: int) -> np.ndarray:
    own = np.zeros((len(groups), count), bool)
    own[np.arange(len(groups))[:, None], groups] = True
    return own
