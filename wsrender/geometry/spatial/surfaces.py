"""The surface of a patch and where lines meet it: a fitted primitive, a critical set, or nothing but its own points."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from scipy.spatial import KDTree

from wsrender.geometry.fits import fit_circle
from wsrender.geometry.spatial.critical_sets import CriticalSet, Meeting

# Below this, relative to the points' extent, a direction of motion leaves a surface of revolution in place.
_AXIAL = 1e-6
_LEAST_POINTS = 12
_ALIGNED = 1e-5  # normals of a singular Jacobian have half the digits
_ITERATIONS = 20
_CONVERGED = 1e-13  # relative to the size of the coordinates
_NEAR, _SMOOTH_ITERATIONS = 12, 3
_GRAZING = 0.1  # cosine between a line and a normal


@dataclass(frozen=True, eq=False)
class Primitive:
    """A surface by its ``kind`` and numbers; those that the kind does not have are 0.

    ``point`` (3,) [m]: a plane's point nearest to the fitted points' middle, the centre of a sphere or torus, the apex
    of a cone, a point of a cylinder's axis; ``axis`` (3,): unit normal of a plane, axis of a cylinder, torus or cone
    (into the cone); ``radius`` [m] of a sphere or cylinder, of a torus' centre circle; ``tube_radius`` [m] of a torus;
    ``half_angle`` [rad] of a cone.
    """

    kind: str
    point: np.ndarray
    axis: np.ndarray | None = None
    radius: float = 0.0
    tube_radius: float = 0.0
    half_angle: float = 0.0

    def distance(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Signed distance (N,) [m] of points (N, 3) near the surface and its gradient (N, 3) of unit length."""
        offset = x - self.point
        if self.axis is None:
            length = np.linalg.norm(offset, axis=1)
            return length - self.radius, offset / np.maximum(length, 1e-300)[:, None]
        z = offset @ self.axis
        if self.kind == "plane":
            return z, np.broadcast_to(self.axis, x.shape)
        across = offset - z[:, None] * self.axis
        rho = np.linalg.norm(across, axis=1)
        radial = across / np.maximum(rho, 1e-300)[:, None]
        if self.kind == "cylinder":
            return rho - self.radius, radial
        if self.kind == "cone":
            c, s = np.cos(self.half_angle), np.sin(self.half_angle)
            return rho * c - z * s, c * radial - s * self.axis
        ring = rho - self.radius
        if (
            self.tube_radius > self.radius
        ):  # the circles reach across the axis: the other side of the tube may be nearer
            off = [np.abs(np.hypot(each, z) - self.tube_radius) for each in (ring, rho + self.radius)]
            ring = np.where(off[0] <= off[1], ring, rho + self.radius)
        length = np.hypot(ring, z)
        gradient = (ring[:, None] * radial + z[:, None] * self.axis) / np.maximum(length, 1e-300)[:, None]
        return length - self.tube_radius, gradient

    def same_as(self, other: "Primitive", tolerance: float) -> bool:
        """Whether both are the same surface, numbers within ``tolerance`` [m] (angles and directions: of 1 m)."""
        if self.kind != other.kind:
            return False
        between = other.point - self.point
        if self.axis is None or other.axis is None:
            apart = np.linalg.norm(between)
        else:
            if np.linalg.norm(np.cross(self.axis, other.axis)) > tolerance or (
                self.kind == "cone" and self.axis @ other.axis < 0
            ):
                return False
            along = between @ self.axis
            apart = {"plane": abs(along), "cylinder": np.linalg.norm(between - along * self.axis)}.get(
                self.kind, np.linalg.norm(between)
            )
        names = ("radius", "tube_radius", "half_angle")
        sizes = [abs(getattr(self, name) - getattr(other, name)) for name in names]
        return bool(max(apart, *sizes) <= tolerance)


@dataclass(frozen=True, eq=False)
class Fit:
    """A primitive, the largest distance of the fitted points from it [m] and the largest sine between the normals."""

    primitive: Primitive
    residual: float
    misaligned: float

    def exact(self, tolerance: float) -> bool:
        """Whether the points and normals are the primitive's, but for rounding and ``tolerance`` [m]."""
        return self.residual <= tolerance and self.misaligned <= _ALIGNED


def best_fit(points: np.ndarray, normals: np.ndarray, tolerance: float) -> Fit | None:
    """The simplest primitive within ``tolerance`` [m] of all points (N, 3), else the nearest; None of few points.

    ``normals`` (N, 3) of unit length, of either sign, must be the primitive's too. They give axes: of revolution is
    what every normal's line meets the axis of (Pottmann & Randrup 1998).
    """
    fits = []
    for primitive in candidates(points, normals, (_AXIAL,)):
        fit = fit_of(primitive, points, normals)
        if fit.exact(tolerance):
            return fit
        fits.append(fit)
    return nearest(fits)


def candidates(points: np.ndarray, normals: np.ndarray, axial: tuple[float, ...]) -> Iterator[Primitive]:
    """Primitives through points (N, 3) with normals (N, 3), the simplest first; none through a few points.

    Below each of ``axial`` in turn, relative to the points' extent, a direction of motion leaves the surface in place.
    """
    if len(points) >= _LEAST_POINTS:
        yield from _plane(points)
        yield from _sphere(points)
        for direction in _left_in_place(points, normals, axial):
            yield from _revolved(points, *direction)


def fit_of(primitive: Primitive, points: np.ndarray, normals: np.ndarray) -> Fit:
    """How far points and normals (N, 3) are from a primitive and its own."""
    distance, gradient = primitive.distance(points)
    off = np.linalg.norm(np.cross(gradient, normals), axis=1)
    return Fit(primitive, float(np.abs(distance).max()), float(off.max()))


def nearest(fits: list[Fit]) -> Fit | None:
    """The fit with the least residual, of those whose normals are not across the points' if there are any."""
    return min(fits, key=lambda fit: (fit.misaligned > 0.5, fit.residual), default=None)


def _plane(points: np.ndarray) -> list[Primitive]:
    middle = points.mean(axis=0)
    normal = np.linalg.svd(points - middle, full_matrices=False)[2][2]
    return [Primitive("plane", middle, _positive(normal))]


def _sphere(points: np.ndarray) -> list[Primitive]:
    fit = fit_circle(points)
    return [Primitive("sphere", fit.center, radius=fit.radius)]


def _left_in_place(
    points: np.ndarray, normals: np.ndarray, axial: tuple[float, ...]
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """A point of the axis and its direction, (3,) each, about which a turn leaves the surface in place.

    One for each of ``axial`` that lets more motions through than those before it.
    """
    middle = points.mean(axis=0)
    local = points - middle
    size = np.linalg.norm(local, axis=1).max()
    # A turn c about a point and a shift leave the surface in place where the velocity has no part along the normal.
    motions = np.linalg.svd(np.column_stack([normals, np.cross(local / size, normals)]), full_matrices=False)
    counts = [int((motions[1] <= max(each * motions[1][0], motions[1][-1])).sum()) for each in axial]
    for count in dict.fromkeys(counts):
        still = motions[2][-count:]
        turning = np.linalg.svd(still[:, 3:].T, full_matrices=False)[2][0] @ still
        c = turning[3:]
        if np.linalg.norm(c) >= 1e-9:
            yield middle + size * np.cross(c, turning[:3]) / (c @ c), _positive(c / np.linalg.norm(c))


def _revolved(points: np.ndarray, foot: np.ndarray, axis: np.ndarray) -> list[Primitive]:
    """Cylinder, cone and torus about an axis, in that order."""
    offset = points - foot
    z = offset @ axis
    rho = np.linalg.norm(offset - z[:, None] * axis, axis=1)
    return [*_of_line(foot, axis, rho, z), *_of_circle(foot, axis, rho, z)]


def _of_line(foot: np.ndarray, axis: np.ndarray, rho: np.ndarray, z: np.ndarray) -> list[Primitive]:
    """A cylinder, and a cone, whose profile in (ρ, z) is the line that fits best."""
    middle = np.array([rho.mean(), z.mean()])
    along = np.linalg.svd(np.column_stack([rho, z]) - middle, full_matrices=False)[2][0]
    found = [Primitive("cylinder", foot + middle[1] * axis, axis, radius=float(middle[0]))]
    if abs(along[0]) > 1e-12:
        apex = middle[1] - middle[0] * along[1] / along[0]
        side = np.sign(middle[1] - apex) or 1.0
        angle = float(np.arctan2(abs(along[0]), abs(along[1])))
        found.append(Primitive("cone", foot + apex * axis, side * axis, half_angle=angle))
    return found


def _of_circle(foot: np.ndarray, axis: np.ndarray, rho: np.ndarray, z: np.ndarray) -> list[Primitive]:
    """Tori whose profile in (ρ, z) is the circle that fits best, on one side of the axis or on both."""
    profile = fit_circle(np.column_stack([rho, z]))
    found = [(abs(profile.center[0]), profile.center[1], profile.radius**2)]
    # (x − 2 z h + k)² = 4 R² ρ², where k = R² + h² − r² and ρ² = x − z².
    x, one = rho**2 + z**2, np.ones(len(z))
    a, b, g, _, _ = np.linalg.lstsq(np.column_stack([x * z, x, z**2, z, one]), x**2, rcond=None)[0]
    squared = -(a**2) / 4 - g
    k = (squared - b) / 2
    found.append((np.sqrt(max(squared, 0.0)) / 2, a / 4, squared / 4 + a**2 / 16 - k))
    return [
        Primitive("torus", foot + height * axis, axis, float(radius), float(np.sqrt(tube)))
        for radius, height, tube in found
        if tube > 0 and radius > 1e-12
    ]


def _positive(axis: np.ndarray) -> np.ndarray:
    """The direction with its first component that is not small positive."""
    return axis * np.sign(axis[np.abs(axis) > 1e-6][0])


class Surface(Protocol):
    """Something that lines meet."""

    def meet(self, origin: np.ndarray, direction: np.ndarray, start: np.ndarray) -> Meeting:
        """Where lines meet the surface, near ``origin`` (N, 3); ``start`` (N, n): displacements at points nearby."""
        ...


@dataclass(frozen=True, eq=False)
class PrimitiveSurface:
    """A plane, sphere, cylinder, cone or torus."""

    primitive: Primitive

    def meet(self, origin: np.ndarray, direction: np.ndarray, start: np.ndarray) -> Meeting:
        """By Newton's method on the distance along each line; NaN for one that runs along the surface."""
        s, x, near = np.zeros(len(origin)), origin, _CONVERGED * np.abs(origin).max(initial=1e-300)
        with np.errstate(divide="ignore", invalid="ignore"):
            for _ in range(_ITERATIONS):
                distance, gradient = self.primitive.distance(x)
                s = s - distance / (gradient * direction).sum(axis=1)
                x = origin + s[:, None] * direction
                if not (np.abs(distance) > near).any():
                    break
            distance, gradient = self.primitive.distance(x)
        good = np.abs(distance) <= 10 * _CONVERGED * np.maximum(np.abs(x).max(axis=1), 1e-300)
        gradient = gradient * np.sign((gradient * direction).sum(axis=1))[:, None]
        return Meeting(np.where(good, s, np.nan), np.where(good[:, None], gradient, np.nan), start)


@dataclass(frozen=True, eq=False)
class FoundPoints:
    """A surface of which single points are known only: a line meets it where it starts."""

    def meet(self, origin: np.ndarray, direction: np.ndarray, start: np.ndarray) -> Meeting:
        """At distance 0; the direction is the normal."""
        return Meeting(np.zeros(len(origin)), direction, start)


@dataclass(frozen=True, eq=False)
class SmoothPoints:
    """A smooth surface through points (K, 3) [m] with outward normals (K, 3), about ``width`` [m] apart.

    Points x of it are where the mean of ½ (n + nᵢ) · (x − pᵢ) over the points nearby is 0, n their mean normal: exact
    where a sphere or plane is seen from all sides.
    """

    points: np.ndarray
    normals: np.ndarray
    width: float

    def meet(self, origin: np.ndarray, direction: np.ndarray, start: np.ndarray) -> Meeting:
        """Where lines meet the surface within two cells; NaN where they hardly cross it."""
        s, n = np.zeros(len(origin)), np.full((len(origin), 3), np.nan)
        if not len(origin):
            return Meeting(s, n, start)
        # k as a list gives a column per neighbour.
        neighbours = list(range(1, min(_NEAR, len(self.points)) + 1))
        near = self._tree.query(origin, k=neighbours)[1]  # type: ignore[arg-type]
        p, normals = self.points[near], self.normals[near]
        facing = (normals * direction[:, None]).sum(axis=2)
        for _ in range(_SMOOTH_ITERATIONS):
            offset = origin[:, None] + s[:, None, None] * direction[:, None] - p
            squared = (offset**2).sum(axis=2) / self.width**2
            weight = np.exp(squared.min(axis=1, keepdims=True) - squared) * np.maximum(facing, 1e-9)
            n = (weight[:, :, None] * normals).sum(axis=1)
            n /= np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-300)
            off = (offset * (normals + n[:, None])).sum(axis=2) / 2
            value = (weight * off).sum(axis=1) / weight.sum(axis=1)
            s = s - value / np.maximum((n * direction).sum(axis=1), _GRAZING)
        good = (np.abs(s) <= 2 * self.width) & ((n * direction).sum(axis=1) > _GRAZING)
        return Meeting(np.where(good, s, np.nan), np.where(good[:, None], n, np.nan), start)

    @cached_property
    def _tree(self) -> KDTree:
        return KDTree(self.points)


def surface_of(primitive: Primitive | None, critical_set: CriticalSet | None, found: Surface) -> Surface:
    """The surface of a patch, by what is known of it."""
    if primitive is not None:
        return PrimitiveSurface(primitive)
    return critical_set if critical_set is not None else found
