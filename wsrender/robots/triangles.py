"""Triangles of a closed surface: distances and winding numbers of points, and a tree of balls around them."""

from dataclasses import dataclass

import numpy as np

LEAF = 4  # triangles
AT_ONCE = 1 << 18  # pairs of points and triangles


def closest_points(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Points (N, 3) of triangles (N, 3, 3) that are nearest to ``points`` (N, 3) (Ericson 2004, 5.1.5)."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, ac, bc = b - a, c - a, c - b
    found, least = np.empty_like(points), np.full(len(points), np.inf)
    for origin, along in ((a, ab), (a, ac), (b, bc)):
        length = np.maximum(_dot(along, along), 1e-300)
        foot = origin + np.clip(_dot(points - origin, along) / length, 0, 1)[:, None] * along
        distance = _dot(points - foot, points - foot)
        nearer = distance < least
        found[nearer], least[nearer] = foot[nearer], distance[nearer]
    normal = np.cross(ab, ac)
    size = np.maximum(_dot(normal, normal), 1e-300)
    foot = points - (_dot(points - a, normal) / size)[:, None] * normal
    within = np.ones(len(points), bool)
    for origin, along in ((a, ab), (b, bc), (c, -ac)):
        within &= _dot(np.cross(along, foot - origin), normal) > 0
    found[within] = foot[within]
    return found


def winding_numbers(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """How often (N,) triangles (F, 3, 3) wind around points (N, 3) (van Oosterom and Strackee 1983)."""
    found = np.empty(len(points))
    step = max(AT_ONCE // max(len(corners), 1), 1)
    for start in range(0, len(points), step):
        a, b, c = (corners[None, :, k] - points[start : start + step, None] for k in range(3))
        la, lb, lc = (np.sqrt(_dot(each, each)) for each in (a, b, c))
        under = la * lb * lc + _dot(a, b) * lc + _dot(b, c) * la + _dot(c, a) * lb
        found[start : start + step] = np.arctan2(_dot(a, np.cross(b, c)), under).sum(axis=1) / (2 * np.pi)
    return found


def pieces(corners: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Middles (M, 3) of the parts of triangles (F, 3, 3), none farther than ``radius`` from its corners; whose each is.

    The longest edge is halved until that holds.
    """
    owner, done = np.arange(len(corners)), []
    while len(corners):
        middle = corners.mean(axis=1)
        small = np.linalg.norm(corners - middle[:, None], axis=2).max(axis=1) <= radius
        done.append((middle[small], owner[small]))
        corners, owner = corners[~small], owner[~small]
        edges = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
        rows = np.arange(len(corners))[:, None]
        a, b, c = (corners[rows, (edges.argmax(axis=1)[:, None] + k) % 3][:, 0] for k in range(3))
        half = (a + b) / 2
        corners = np.concatenate([np.stack([a, half, c], axis=1), np.stack([half, b, c], axis=1)])
        owner = np.concatenate([owner, owner])
    return np.concatenate([middle for middle, _ in done]), np.concatenate([own for _, own in done])


def ground(heights: np.ndarray, size_m: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """The closed surface of heights (R, C) [m] over a base of full lengths ``size_m`` [m] about the origin.

    Vertices (V, 3) [m] and faces (F, 3); a cell is cut as MuJoCo cuts it, from its lowest x and y to its highest.
    """
    rows, columns = heights.shape
    x, y = ((np.linspace(-0.5, 0.5, count) * edge) for count, edge in zip((columns, rows), size_m, strict=True))
    top = np.column_stack([np.tile(x, rows), np.repeat(y, columns), heights.ravel()])
    number = np.arange(rows * columns).reshape(rows, columns)
    low, right, up, beyond = (
        number[r : rows - 1 + r, c : columns - 1 + c].ravel() for r, c in ((0, 0), (0, 1), (1, 0), (1, 1))
    )
    faces = [np.column_stack([low, right, beyond]), np.column_stack([low, beyond, up])]
    rim = np.concatenate([number[0], number[1:, -1], number[-1, -2::-1], number[-2:0:-1, 0]])  # counterclockwise
    foot, middle = rows * columns + np.arange(len(rim)), rows * columns + len(rim)
    next_rim, next_foot = np.roll(rim, -1), np.roll(foot, -1)
    faces += [np.column_stack([rim, foot, next_rim]), np.column_stack([next_rim, foot, next_foot])]
    faces.append(np.column_stack([foot, np.full(len(rim), middle), next_foot]))
    return np.vstack([top, top[rim] * [1, 1, 0], np.zeros(3)]), np.concatenate(faces)


@dataclass(frozen=True, eq=False)
class Tree:
    """Balls around triangles, from the whole down; each is followed by those within it.

    ``order`` (F,): the triangles, as leaves hold them; ``balls`` (M, 4): centre and radius [m]; ``links`` (M, 3): the
    next ball where nothing in this one is asked for, its first triangle and their number, 0 of one that is no leaf.
    """

    order: np.ndarray
    balls: np.ndarray
    links: np.ndarray


def tree(corners: np.ndarray) -> Tree:
    """The tree of triangles (F, 3, 3), halved along the longest side of the box of their middles."""
    middles = corners.mean(axis=1)
    order, balls, links = np.arange(len(corners)), [], []
    left = [(0, len(corners))]
    while left:
        first, end = left.pop()
        own = corners[order[first:end]].reshape(-1, 3)
        center = (own.min(axis=0) + own.max(axis=0)) / 2
        balls.append([*center, np.linalg.norm(own - center, axis=1).max()])
        is_leaf = end - first <= LEAF
        links.append([0, first, end - first if is_leaf else 0])
        if not is_leaf:
            axis = int(np.ptp(middles[order[first:end]], axis=0).argmax())
            half = (end - first) // 2
            order[first:end] = order[first:end][np.argpartition(middles[order[first:end], axis], half)]
            left += [(first + half, end), (first, first + half)]
    numbers, spans = np.array(links), np.ones(len(links), int)
    # A ball is followed by its two halves: how many balls each holds, from the last to the first.
    for ball in range(len(links) - 1, -1, -1):
        if numbers[ball, 2] == 0:
            one = ball + 1
            spans[ball] += spans[one] + spans[one + spans[one]]
    numbers[:, 0] = np.arange(len(links)) + spans
    return Tree(order, np.array(balls), numbers)


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("...i,...i->...", a, b)
