"""Solids with closed forms: points in them, and their voxels."""

import numpy as np

from wsrender.volume.volume_data import VolumeData

BALL = 4 / 3 * np.pi
SHELL = 4 / 3 * np.pi * (1 - 0.5**3)
TORUS = 2 * np.pi**2 * 0.7 * 0.25**2


def in_ball(points):
    return np.linalg.norm(points, axis=-1) < 1


def in_shell(points):
    return in_ball(points) & (np.linalg.norm(points, axis=-1) > 0.5)


def in_torus(points):
    """Around z, radii 0.7 and 0.25 m."""
    return np.hypot(np.hypot(points[..., 0], points[..., 1]) - 0.7, points[..., 2]) < 0.25


def uniform_points(inside, count, seed=0):
    """Points (about count, 3) uniform in a solid within the cube from -1 to 1 m."""
    points = np.random.default_rng(seed).uniform(-1, 1, (4 * count, 3))
    return points[inside(points)][:count]


def voxels_of(inside, size):
    """Volume data whose occupied voxels are those with their centre in the solid."""
    cells = round(1 / size)
    centers = (np.arange(-cells, cells) + 0.5) * size
    occupied = inside(np.stack(np.meshgrid(centers, centers, centers, indexing="ij"), axis=-1))
    return VolumeData(size, (-cells,) * 3, occupied.astype(np.int64))
