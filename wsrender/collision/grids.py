"""Bounds of the signed distance from a closed surface, by cells of a grid, and solids that are looked up in it.

Distances change by no more than a point moves: what holds at the middle of a cell holds all over it within half its
diagonal. At middles they are exact but for what the surface's parts are long; on which side is known where a path along
the grid leads to a cell whose winding number was asked, without coming nearer to the surface than half a step.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import ndimage
from scipy.spatial import KDTree

from wsrender.collision.covers import Cover
from wsrender.robots.triangles import closest_points, pieces, winding_numbers

CELLS = 1 << 18  # 1 MiB
QUANTA = 64  # of a cell's edge, in which bounds are kept; sixteen bits hold 512 edges
PARTS = 0.4  # of a cell's edge, within which a part of the surface lies about its middle
MOST_PARTS = 1e6  # about so many, where there is more surface
NEARLY = 0.05  # by what share a part may be farther than the nearest: asked so, it takes half the time
SIDES_ASKED = 64  # regions whose side is found; smaller ones are of either
ROUNDING = 1e-4  # of a cell's edge, by which a point may be in a neighbour of its cell in float32
LEVEL = 1  # of covers


@dataclass(frozen=True, eq=False)
class DistanceGrid:
    """``words`` (X, Y, Z) uint32: bounds of the signed distance over a cell, int16, in ``cell`` / QUANTA.

    The lower one stands in the low half. ``origin`` (3,) [m]: the lowest corner, in the base's frame; ``pad`` [m]: the
    solid is that far from the border.
    """

    origin: np.ndarray
    cell: float
    pad: float
    words: np.ndarray

    @property
    def quantum(self) -> float:
        """Unit of the bounds [m]."""
        return self.cell / QUANTA

    def bounds(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper bounds (…) [m] at points (…, 3); the upper ones only of points within the grid."""
        at = np.clip((points - self.origin) / self.cell, 0, np.array(self.words.shape) - 1).astype(int)
        words = self.words[at[..., 0], at[..., 1], at[..., 2]]
        lower, upper = (half.astype(np.uint16).view(np.int16) for half in (words & 0xFFFF, words >> 16))
        return lower * self.quantum, upper * self.quantum


def surface_grid(corners: np.ndarray, pad: float) -> DistanceGrid:
    """The grid of the solid that triangles (F, 3, 3) [m] enclose, ``pad`` [m] wider than it all round."""
    low, high = corners.min(axis=(0, 1)) - pad, corners.max(axis=(0, 1)) + pad
    cell = float((np.prod(high - low) / CELLS) ** (1 / 3))
    shape = np.ceil((high - low) / cell).astype(int)
    axes = (low[k] + (np.arange(shape[k]) + 0.5) * cell for k in range(3))
    middles = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    lower, upper = _distances(corners, middles.reshape(-1, 3), PARTS * cell)
    sides = _sides(corners, middles, lower.reshape(shape) > cell / 2).ravel()
    lower, upper = np.where(sides > 0, lower, -upper), np.where(sides < 0, -lower, upper)
    beyond = (np.sqrt(3) / 2 + ROUNDING) * cell
    quantum = cell / QUANTA
    bounds = np.floor((lower - beyond) / quantum), np.ceil((upper + beyond) / quantum)
    low16, high16 = (np.clip(each, -32768, 32767).astype(np.int16).view(np.uint16) for each in bounds)
    return DistanceGrid(low, cell, pad, (low16 | high16.astype(np.uint32) << 16).reshape(shape))


def _distances(corners: np.ndarray, points: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper bounds (N,) of the distances of points (N, 3) from triangles."""
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    radius = max(radius, float(np.sqrt(np.linalg.norm(across, axis=1).sum() / MOST_PARTS)))
    middles, owner = pieces(corners, radius)
    # Trees by the middle of space are twice as fast here, and hardly slower to make.
    nearest, part = KDTree(middles, balanced_tree=False, compact_nodes=False).query(points, eps=NEARLY)
    foot = closest_points(corners[owner[part]], points)
    upper = np.linalg.norm(points - foot, axis=1)
    return np.clip(nearest / (1 + NEARLY) - radius, 0, upper), upper


def _sides(corners: np.ndarray, middles: np.ndarray, clear: np.ndarray) -> np.ndarray:
    """1 outside, -1 inside, 0 where nobody asked; steps between ``clear`` cells cannot cross the surface."""
    found: Any = ndimage.label(clear)
    regions, count = np.asarray(found[0]), int(found[1])
    sizes = np.bincount(regions.ravel(), minlength=count + 1)[1:]
    asked = np.argsort(-sizes, kind="stable")[:SIDES_ASKED]
    first = ndimage.minimum_position(clear, regions, asked + 1) if count else []
    points = np.array([middles[at] for at in first]).reshape(-1, 3)
    sides = np.zeros(count + 1, np.int8)
    sides[asked + 1] = np.where(winding_numbers(corners, points) > 0.5, -1, 1)
    return sides[regions]


@dataclass(frozen=True, eq=False)
class Lookup:
    """Balls that hold a solid, and balls within it, looked up in the grid of a surface that stands.

    ``balls`` (B, 5): middle in the frame of ``joint`` [m]; the solids keep apart where the lower bounds at all of them
    exceed the fourth number, and touch where the upper one at any is below the fifth, in the grid's quanta.
    """

    grid: DistanceGrid
    joint: int
    balls: np.ndarray

    def distance(self, frames: np.ndarray) -> np.ndarray:
        """What is left (N,) of the distance over the margin [m], of frames (N, 4, 4) of the joint in the base's.

        At least that where it is positive, at most where negative; 0 where neither is known.
        """
        points = np.einsum("nij,bj->nbi", frames[:, :3, :3], self.balls[:, :3]) + frames[:, None, :3, 3]
        lower, upper = self.grid.bounds(points)
        apart = (lower - self.balls[:, 3] * self.grid.quantum).min(axis=1)
        touch = (upper - self.balls[:, 4] * self.grid.quantum).min(axis=1)
        return np.where(apart > 0, apart, np.where(touch < 0, touch, 0.0))


def reach_of(cover: Cover, margin: float) -> float:
    """How far from a surface a solid's capsules can be and not be known to be clear of it [m]."""
    return float(max(cover.outer[0 if cover.exact else LEVEL].radius)) * 1.2 + margin


def lookup(grid: DistanceGrid, joint: int, T: np.ndarray, cover: Cover, margin: float, epsilon: float) -> Lookup:
    """How a solid at ``T`` (4, 4) in the frame of its joint is looked up; ``epsilon``: what float32 may be off [m]."""
    never, rows = float(-(1 << 20)), []
    level = 0 if cover.exact else LEVEL
    for side in ("outer",) if cover.exact else ("outer", "inner"):
        capsules = getattr(cover, side)[level]
        for a, b, radius in zip(capsules.a, capsules.b, capsules.radius, strict=True):
            length = float(np.linalg.norm(b - a))
            steps = int(np.ceil(length / max(radius, grid.cell)))
            around = np.hypot(radius, length / max(steps, 1) / 2) + margin + epsilon
            within = min(radius + margin - epsilon, grid.pad)
            free = around / grid.quantum if side == "outer" else never
            hit = within / grid.quantum if side == "inner" or cover.exact else never
            for share in np.linspace(0, 1, steps + 1):
                rows.append([*(T[:3, :3] @ (a + (b - a) * share) + T[:3, 3]), free, hit])
    return Lookup(grid, joint, np.array(rows))
