"""Circles in which pairs of surfaces meet, and the points in which three do, for a batch of regions."""

from dataclasses import dataclass

import numpy as np

from wsrender.mechanisms.exact.surfaces import Surfaces

PARALLEL = 1e-26  # squared sine below which planes of circles are parallel: rounding of collinear centres


@dataclass(frozen=True, eq=False)
class Circles:
    """Circle of every pair of surfaces, Q to a region; all lines of pairs of planes are among them.

    ``axis`` (M, Q, 3): from the first centre to the second, or into the half space; a line's direction. ``height``
    (M, Q) is the distance of the circle's plane from the first centre along the axis, ``other_height`` that from the
    second centre against it. ``middle`` (M, Q, 3), a point of a line; ``radius`` (M, Q); ``exists`` (M, Q), false for
    lines; ``across``, ``up`` (M, Q, 3): with the axis a right-handed frame.
    """

    axis: np.ndarray
    height: np.ndarray
    other_height: np.ndarray
    middle: np.ndarray
    radius: np.ndarray
    exists: np.ndarray
    across: np.ndarray
    up: np.ndarray

    def point(self, angle: np.ndarray) -> np.ndarray:
        """Points (M, Q, 3) at angles (M, Q) about the axis."""
        turned = np.cos(angle)[..., None] * self.across + np.sin(angle)[..., None] * self.up
        return self.middle + self.radius[..., None] * turned


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Cross products along the last axis."""
    (a0, a1, a2), (b0, b1, b2) = np.moveaxis(a, -1, 0), np.moveaxis(b, -1, 0)
    return np.stack([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0], axis=-1)


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Scalar products along the last axis."""
    return (a * b).sum(axis=-1)


def circles(surfaces: Surfaces) -> Circles:
    """The circles of every pair."""
    first, second = surfaces.combinatorics.pairs.T
    spheres = surfaces.spheres
    of_two, of_plane = second < spheres, (first < spheres) & (second >= spheres)
    shape = (len(surfaces), len(first))
    axis, height, other = np.zeros((*shape, 3)), np.zeros(shape), np.zeros(shape)
    middle, radius, exists = np.zeros((*shape, 3)), np.zeros(shape), np.zeros(shape, bool)
    c, r = surfaces.centres, surfaces.radii
    i, j = first[of_two], second[of_two]
    between = c[:, j] - c[:, i]
    distance = np.sqrt(dot(between, between))
    apart = np.where(distance > 0, distance, 1.0)
    axis[:, of_two] = between / apart[..., None]
    height[:, of_two] = (distance + (r[:, i] - r[:, j]) * (r[:, i] + r[:, j]) / apart) / 2
    other[:, of_two] = distance - height[:, of_two]
    i, j = first[of_plane], second[of_plane] - spheres
    axis[:, of_plane] = -surfaces.normals[j]
    height[:, of_plane] = dot(c[:, i], surfaces.normals[j]) - surfaces.offsets[:, j]
    is_circle = of_two | of_plane
    i = first[is_circle]
    square = (r[:, i] - height[:, is_circle]) * (r[:, i] + height[:, is_circle])
    radius[:, is_circle] = np.sqrt(np.maximum(square, 0.0))
    exists[:, is_circle] = (square > 0) & (dot(axis[:, is_circle], axis[:, is_circle]) > 0)
    middle[:, is_circle] = c[:, i] + height[:, is_circle, None] * axis[:, is_circle]
    _lines(surfaces, axis, middle)
    across = _perpendicular(axis)
    return Circles(axis, height, other, middle, radius, exists, across, cross(axis, across))


def _lines(surfaces: Surfaces, axis: np.ndarray, middle: np.ndarray) -> None:
    """Directions and points of the lines of pairs of planes, whose normals are at right angles."""
    tables, n = surfaces.combinatorics, surfaces.normals
    p, q = (tables.pairs[tables.is_line] - surfaces.spheres).T
    axis[:, tables.is_line] = cross(n[p], n[q])
    middle[:, tables.is_line] = surfaces.offsets[:, p, None] * n[p] + surfaces.offsets[:, q, None] * n[q]


def _perpendicular(axis: np.ndarray) -> np.ndarray:
    """A unit vector at right angles to each."""
    least = np.abs(axis).argmin(axis=-1)
    found = cross(axis, np.eye(3)[least])
    length = np.sqrt(dot(found, found))
    return found / np.where(length > 0, length, 1.0)[..., None]


def candidates(surfaces: Surfaces, circles: Circles) -> tuple[np.ndarray, np.ndarray]:
    """Points (M, N, 3) in which three surfaces meet, and which of them are real (M, N); others are 0.

    With the first of the three a sphere, x = c + y, the circles with the second and the third lie in the planes
    a·y = h and b·y = k: y = h a + m e ± t n with n along a × b and e = n × a, which loses no digit more than the
    angle between a and b costs.
    """
    tables = surfaces.combinatorics
    ij, ik = tables.sphere_circles[:, 0], tables.sphere_circles[:, 1]
    a, b = circles.axis[:, ij], circles.axis[:, ik]
    h, k = circles.height[:, ij], circles.height[:, ik]
    w = cross(a, b)
    sine2 = dot(w, w)
    crossing = circles.exists[:, ij] & circles.exists[:, ik] & (sine2 > PARALLEL)
    sine = np.sqrt(np.where(crossing, sine2, 1.0))
    n = w / sine[..., None]
    m = (k - dot(a, b) * h) / sine
    square = circles.radius[:, ij] ** 2 - m**2
    real = crossing & (square > 0)
    t = np.sqrt(np.where(real, square, 0.0))[..., None] * n
    foot = circles.middle[:, ij] + m[..., None] * cross(n, a)
    points = np.concatenate([foot + t, foot - t], axis=1)
    real = np.concatenate([real, real], axis=1)
    at = tables.corners - surfaces.spheres
    corners = (surfaces.offsets[:, at, None] * surfaces.normals[at]).sum(axis=2)
    points = np.concatenate([np.where(real[..., None], points, 0.0), corners], axis=1)
    return points, np.concatenate([real, np.ones(corners.shape[:2], bool)], axis=1)
