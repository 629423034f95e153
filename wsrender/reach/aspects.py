"""Aspects: which configurations connect within the limits without a singular one on the way.

After Borrel and Liégeois 1986; an arm two of whose postures connect is cuspidal (Wenger 1992).

The determinant of a Jacobian of as many rows as joints is continuous: where its sign differs, or that of a factor, a
singularity lies between. It factors where three hinges put a point in space, alone or before a spherical wrist: into
the determinant of these three, of joints 2 and 3 alone, and a sine of the wrist's middle joint. Of the first a grid of
cells says where it has which sign, up to bounds of its slopes: cells of a sign that are neighbours connect, and what
cells that may be of the sign do not join is apart. With three parallel axes it is a product of three simple factors.
Other arms, and slides, are told by samples.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.ndimage import label as components
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from wsrender.reach.posture_solver import PoseHolder
from wsrender.robots.closed_form import ClosedForm
from wsrender.robots.closed_form.axes import Axes, Axis
from wsrender.robots.closed_form.numbers import zeros

CELLS, ROWS = 1440, 64  # of a grid, along either joint, and rows of it that are computed at a time
WAYPOINTS, NEIGHBOURS, STEPS = 100, 8, 64  # of a search for ways of other arms, and points of each straight piece
CONNECTED, APART, OPEN = 1, 0, -1
WAYS_IN = 16  # cells that a configuration next to a singularity is led to


@dataclass(frozen=True, eq=False)
class AspectFinder:
    """Aspects of configurations that hold a pose; ``form``: the closed form of the arm, if it has one."""

    holder: PoseHolder
    form: ClosedForm | None

    @property
    def square(self) -> bool:
        """Whether as many joints move as the pose has freedoms, so that singular configurations are a surface."""
        return len(self.holder.moving) == self.holder.freedoms

    @cached_property
    def proof(self) -> str | None:
        """What factors; None where nothing is known to."""
        if self._parallel is not None:
            return "three parallel axes"
        if self._plane is None:
            return None
        return "three hinges" if self.holder.rows == 3 else "spherical wrist"

    @property
    def gridded(self) -> bool:
        """Whether a grid of cells is made."""
        return self._parallel is None and self._plane is not None

    @property
    def evidence(self) -> str:
        """What aspects rest on."""
        if self.proof:
            cells = "" if self._parallel else f", bounded on {CELLS} x {CELLS} cells"
            return f"singularities factor ({self.proof}){cells}"
        if not self.square:
            return "more joints than freedoms: none are told"
        return "signs of the determinant, and ways by samples, not proven"

    def numbered(self, q: np.ndarray) -> tuple[np.ndarray, bool]:
        """Of configurations (K, n) the number of the aspect of each, (K,), and whether that is proven.

        Those that may be connected or not have different numbers.
        """
        if not self.square or not len(q):
            return np.arange(len(q)), False
        pairs = self._by_factors(q) if self.proof else self._by_samples(q)
        of = connected_components(coo_array(pairs == CONNECTED), directed=False)[1]
        same = of[:, None] == of
        return of, bool(self.proof) and not ((pairs == OPEN) & ~same).any() and not (pairs[same] == APART).any()

    def _by_factors(self, q: np.ndarray) -> np.ndarray:
        """Whether pairs are CONNECTED, APART or OPEN, (K, K)."""
        if self._parallel is not None:
            return self._parallel.pairs(q)
        assert self._plane
        inner, outer = self._plane.places(q)
        near = (inner[:, None] == inner) & (inner > 0)
        apart = (outer[:, None] != outer) & (outer[:, None] > 0) & (outer > 0)
        found = np.where(near, CONNECTED, np.where(apart, APART, OPEN))
        for sine in (self._wrist, self._plane.elbow):
            if sine is not None:
                between = sine.between(q)
                found[between[:, None] != between] = APART
        np.fill_diagonal(found, CONNECTED)
        return found

    def _by_samples(self, q: np.ndarray) -> np.ndarray:
        """As `_by_factors`, where nothing factors: signs are a proof, ways are not."""
        signs, holder = np.sign(self._determinants(q)), self.holder
        found = np.where(signs[:, None] == signs, OPEN, APART)
        chain = holder.chain
        low, high = chain.lower_limits, chain.upper_limits
        random = low + np.random.default_rng(0).random((WAYPOINTS, chain.n)) * (high - low)
        for sign in (-1, 1):
            own = np.flatnonzero(signs == sign)
            if len(own) < 2:
                continue
            nodes = np.concatenate([q[own], random[np.sign(self._determinants(random)) == sign]])
            near: Any = KDTree(nodes / holder.scale).query(nodes / holder.scale, k=min(NEIGHBOURS, len(nodes)))[1]
            a = np.concatenate(
                [np.repeat(np.arange(len(nodes)), near.shape[1]), np.repeat(np.arange(len(own)), len(own))]
            )
            b = np.concatenate([near.ravel(), np.tile(np.arange(len(own)), len(own))])
            share = np.linspace(0, 1, STEPS)[:, None]
            ways = nodes[a, None] + share * (nodes[b] - nodes[a])[:, None]
            along = sign * self._determinants(ways.reshape(-1, chain.n)).reshape(-1, STEPS)
            clear = (along[:, 1:] > np.abs(np.diff(along, axis=1))).all(axis=1)  # no zeros hide between two samples
            joined = coo_array((np.ones(clear.sum()), (a[clear], b[clear])), shape=(len(nodes),) * 2)
            of = connected_components(joined, directed=False)[1][: len(own)]
            found[np.ix_(own, own)] = np.where(of[:, None] == of, CONNECTED, OPEN)
        np.fill_diagonal(found, CONNECTED)
        return found

    def _determinants(self, q: np.ndarray) -> np.ndarray:
        """Of the Jacobian in directions that the arm moves in, (M,)."""
        J = self.holder.jacobians(q)
        if J.shape[1] > J.shape[2]:
            return np.prod(np.linalg.svd(J, compute_uv=False), axis=1)  # a sign is not known of what is no square
        return np.linalg.det(J)

    @cached_property
    def _solved(self) -> tuple[Axes, np.ndarray] | None:
        """Axes of three hinges and what is behind, and the point that they move."""
        geometry = self.holder.chain.geometry
        axes = None if geometry is None else Axes.of(geometry)
        if axes is None or len(axes.axes) != self.holder.rows or self.holder.kind == "axis":
            return None
        solved = self.form and self.form.solved
        if solved and solved.arm in ("nested", "general") and (self.holder.rows == 6 or not solved.axes.reversed):
            found = solved.axes, solved.axes.axes[3].point
        elif self.holder.rows == 3:
            found = axes, axes.T_tip[:3, 3]
        else:
            return None
        return found if all(axis.revolute for axis in found[0].axes[:3]) else None

    @cached_property
    def _plane(self) -> "SignedPlane | None":
        if not self.square or self._solved is None:
            return None
        axes, point = self._solved
        solved, periodic = self.form and self.form.solved, self.holder.chain.periodic
        if solved is None or solved.arm != "nested" or solved.axes is not axes:
            return SignedPlane(axes.axes[:3], point, periodic)
        one, other = solved.equations
        first, third = (other, one) if solved.first == 3 else (one, other)
        turn, (c, s) = zeros(solved)[2], third.right
        elbow = Sine(solved.axes.axes[2], c * np.sin(turn) - s * np.cos(turn), c * np.cos(turn) + s * np.sin(turn))
        side = solved.links.base[:3, :3] @ [-first.left[1], first.left[0], 0.0]
        return SignedPlane(solved.axes.axes[:3], point, periodic, side / np.linalg.norm(side), elbow)

    @cached_property
    def _parallel(self) -> "ParallelAxes | None":
        solved = self.form and self.form.solved
        if not self.square or solved is None or solved.arm != "parallel" or self.holder.rows == 3:
            return None
        axes = solved.axes.axes
        whole = all(axis.revolute and axis.coordinate is not None for axis in axes)
        return ParallelAxes(axes) if whole else None

    @cached_property
    def _wrist(self) -> "Sine | None":
        if self.holder.rows == 3 or self._solved is None:
            return None
        fourth, fifth, sixth = (axis.direction for axis in self._solved[0].axes[3:])
        across = np.cross(fourth, fifth)
        return Sine(
            self._solved[0].axes[4], across @ sixth, across @ np.cross(self._solved[0].axes[4].direction, sixth)
        )


@dataclass(frozen=True, eq=False)
class Sine:
    """A factor cosine * cos d + sine * sin d of the displacement d of one hinge."""

    axis: Axis
    cosine: Any
    sine: Any

    def between(self, q: np.ndarray) -> np.ndarray:
        """Of configurations (K, n) between which zeros, by number, each stands, (K,) int.

        Of a hinge without limits numbers are those of one turn.
        """
        return self.number(displacements(self.axis, q))

    def number(self, displacement: np.ndarray) -> np.ndarray:
        """As `between`, of displacements (K,)."""
        number = np.floor((displacement - np.arctan2(-self.cosine, self.sine)) / np.pi).astype(int)
        endless = self.axis.upper - self.axis.lower == 2 * np.pi
        return number % 2 if endless else number


@dataclass(frozen=True, eq=False)
class ParallelAxes:
    """Six hinges, of which 2, 3 and 4 are parallel and 5 and 6 meet.

    The determinant is a product of sines of joints 3 and 5 and of how far the point where 5 and 6 meet stands from the
    plane of axis 1 and the common direction (Hawkins 2013).
    """

    axes: tuple[Axis, ...]

    def pairs(self, q: np.ndarray) -> np.ndarray:
        """Whether pairs of configurations (K, n) are CONNECTED, APART or OPEN, (K, K)."""
        x = np.stack([displacements(axis, q) for axis in self.axes[1:4]], axis=1)
        side = np.sign(self.offsets(x))
        kinds = np.stack([side, *(sine.between(q) for sine in self.sines)], axis=1)
        found = np.where((kinds[:, None] == kinds).all(axis=2), OPEN, APART)
        for a, b in np.argwhere(np.triu(found == OPEN, 1)):
            if certain(self.offsets, self._slopes, x[a], x[b], side[a]):
                found[a, b] = found[b, a] = CONNECTED
        np.fill_diagonal(found, CONNECTED)
        return found

    @cached_property
    def sines(self) -> "tuple[Sine, Sine]":
        """The factors of joints 3 and 5."""
        k, second, third, fourth, fifth, sixth = (self.axes[1].direction, *self.axes[1:])
        a, b = (_across(point, k) for point in (third.point - second.point, fourth.point - third.point))
        across = np.cross(k, fifth.direction)
        return (
            Sine(third, k @ np.cross(a, b), k @ np.cross(a, np.cross(third.direction, b))),
            Sine(fifth, across @ sixth.direction, across @ np.cross(fifth.direction, sixth.direction)),
        )

    def offsets(self, x: np.ndarray) -> np.ndarray:
        """How far (…,) [m] the point stands from the plane, at displacements (…, 3) of joints 2, 3 and 4."""
        point = self.axes[4].point
        for k in (3, 2, 1):
            point = _turned(self.axes[k], point, x[..., k - 1])
        side = np.cross(self.axes[0].direction, self.axes[1].direction)
        return (point - self.axes[0].point) @ side / np.linalg.norm(side)

    @cached_property
    def _slopes(self) -> np.ndarray:
        """Bounds (3,) of the slopes of `offsets`: distances of the point from the axes."""
        points = [axis.point for axis in self.axes[1:5]]
        between = [np.linalg.norm(b - a) for a, b in pairwise(points)]
        return np.cumsum(between[::-1])[::-1]


def certain(
    function: Callable[[np.ndarray], np.ndarray], slopes: np.ndarray, a: np.ndarray, b: np.ndarray, sign: Any
) -> bool:
    """Whether a function is certainly of a sign along the straight way from ``a`` to ``b`` (k,).

    ``slopes`` (k,) bound its derivatives.
    """
    slope, ends = float(slopes @ np.abs(b - a)), np.array([[0.0, 1.0]])
    for _ in range(24):
        middle = ends.mean(axis=1)
        value = sign * function(a + middle[:, None] * (b - a))
        if (value <= 0).any() or len(ends) > 4096:
            return False
        open_ = value <= slope * (ends[:, 1] - ends[:, 0]) / 2
        if not open_.any():
            return True
        low, high, middle = ends[open_, 0], ends[open_, 1], middle[open_]
        ends = np.concatenate([np.stack([low, middle], axis=1), np.stack([middle, high], axis=1)])
    return False


def _across(vector: np.ndarray, direction: np.ndarray) -> np.ndarray:
    return vector - direction * (direction @ vector)


@dataclass(frozen=True, eq=False)
class SignedPlane:
    """The determinant of three hinges (3,) that move a ``point`` (3,), by the displacements of the last two.

    It is det [h1 x (p - o1), h2 x (p - o2), h3 x (p - o3)], which hinge 1 turns as a whole. ``periodic`` (n,): the
    chain's hinges without limits. Of arms whose first three joints are solved one after the other it is a product of
    a sine of joint 3, the ``elbow``, and of how far the point stands to a ``side`` (3,) of axis 1, which is taken then
    (the square roots of Pieper 1968).
    """

    axes: tuple[Axis, ...]
    point: np.ndarray
    periodic: np.ndarray
    side: np.ndarray | None = None
    elbow: "Sine | None" = None

    def places(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Of configurations (K, n) where each stands: the component of cells that are certainly of its sign, (K,).

        And that of cells that may be of its sign; numbers from 1, 0: not known.
        """
        x = np.stack([displacements(axis, q) for axis in self.axes[1:]], axis=1)
        value, (inner, outer) = self.values(x), self._components
        cell = np.clip(((x - self._low) / self._width).astype(int), 0, CELLS - 1)
        sure, may = np.zeros(len(q), int), np.zeros(len(q), int)
        for k, (i, j) in enumerate(cell):
            side = int(value[k] > 0)
            found = inner[side][i, j] or self._way_in(x[k], np.sign(value[k]), inner[side])
            may[k], sure[k] = 2 * outer[side][i, j] + side, 2 * found + side if found else 0
        return sure, may

    def _way_in(self, x: np.ndarray, sign: float, inner: np.ndarray) -> int:
        """The component of the nearest cells to which a straight way is certainly of the sign, 0: none was found."""
        low = np.clip(((x - self._low) / self._width).astype(int) - WAYS_IN, 0, CELLS - 1)
        near = inner[low[0] : low[0] + 2 * WAYS_IN + 1, low[1] : low[1] + 2 * WAYS_IN + 1]
        at = np.argwhere(near > 0)
        centers = self._low + (at + low + 0.5) * self._width
        if self.elbow is not None:  # a way over its zero is none
            beside = self.elbow.number(centers[:, 1]) == self.elbow.number(x[1:])
            at, centers = at[beside], centers[beside]
        for k in np.argsort(np.linalg.norm(centers - x, axis=1))[: 4 * WAYS_IN : 4]:
            if certain(self.values, self._slopes, x, centers[k], sign):
                return int(near[tuple(at[k])])
        return 0

    def values(self, x: np.ndarray) -> np.ndarray:
        """The determinant, or side, at displacements (…, 2) of hinges 2 and 3, over what `_lengths` bound."""
        second, third = self.axes[1:]
        p = _turned(second, _turned(third, self.point, x[..., 1]), x[..., 0])
        if self.side is not None:
            return (p - self.axes[0].point) @ self.side / self._lengths[0]
        o = _turned(second, third.point, x[..., 0])
        h = _turned(second, third.point + third.direction, x[..., 0]) - o
        columns = [np.cross(axis.direction, p - axis.point) for axis in self.axes[:2]]
        columns.append(np.cross(h, p - o))
        return np.einsum("...i,...i", columns[0], np.cross(columns[1], columns[2])) / np.prod(self._lengths)

    @cached_property
    def _lengths(self) -> np.ndarray:
        """Bounds (3,) of the distance of the point from each axis's point."""
        between = [np.linalg.norm(b - a) for a, b in zip(self._points, (*self._points[1:], self.point), strict=True)]
        return np.cumsum(between[::-1])[::-1] + 1e-300

    @property
    def _points(self) -> tuple[np.ndarray, ...]:
        return tuple(axis.point for axis in self.axes)

    @cached_property
    def _slopes(self) -> np.ndarray:
        """Bounds (2,) of the slopes of `values`: a turn about axis j moves column i by what is behind both."""
        r1, r2, r3 = self._lengths
        if self.side is not None:
            return np.array([r2, r3]) / r1
        second = r2 / r1 + 1.0 + 1.0  # columns 1, 2, 3, the last two turned as they are
        third = r3 / r1 + r3 / r2 + 1.0
        return np.array([second, third])

    @property
    def _ends(self) -> np.ndarray:
        return np.array([(axis.lower, axis.upper) for axis in self.axes[1:]])

    @property
    def _low(self) -> np.ndarray:
        return self._ends[:, 0]

    @property
    def _width(self) -> np.ndarray:
        return np.maximum(self._ends[:, 1] - self._low, 1e-12) / CELLS

    @cached_property
    def _components(self) -> tuple[tuple[np.ndarray, ...], tuple[np.ndarray, ...]]:
        """Components of cells that are certainly, and that may be, negative and positive, each (CELLS, CELLS)."""
        centers = [self._low[k] + (np.arange(CELLS) + 0.5) * self._width[k] for k in (0, 1)]
        rows = np.array_split(centers[0], CELLS // ROWS)
        value = np.concatenate([self.values(np.stack(np.meshgrid(row, centers[1], indexing="ij"), -1)) for row in rows])
        off = float(self._slopes @ self._width) / 2
        wrapped = [bool(self.periodic[axis.coordinate]) for axis in self.axes[1:]]
        whole = np.ones(CELLS, bool)
        if self.elbow is not None:  # its zeros divide the plane: cells over one are of neither side
            edges = self.elbow.number(self._low[1] + np.arange(CELLS + 1) * self._width[1])
            whole = edges[1:] == edges[:-1]
        beside = np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]])
        sure = tuple(_components((sign * value > off) & whole, beside, wrapped) for sign in (-1, 1))
        may = tuple(_components(sign * value > -off, np.ones((3, 3)), wrapped) for sign in (-1, 1))
        return sure, may


def displacements(axis: Axis, q: np.ndarray) -> np.ndarray:
    """Those (K,) of a joint at configurations (K, n) [rad or m]."""
    return q[:, axis.coordinate] * axis.sign + axis.offset


def _components(cells: np.ndarray, neighbours: np.ndarray, wrapped: list[bool]) -> np.ndarray:
    """Number from 1 of the component of each cell, 0 of none; along ``wrapped`` axes the last is next to the first."""
    labelled: Any = components(cells, neighbours)
    found, count = labelled
    diagonal = bool(neighbours[0, 0])
    pairs = []
    for axis in (0, 1):
        first, last = np.take(found, 0, axis), np.take(found, -1, axis)
        for shift in ((-1, 0, 1) if diagonal else (0,)) if wrapped[axis] else ():
            other = np.roll(last, shift)
            both = (first > 0) & (other > 0)
            pairs.append(np.stack([first[both], other[both]]))
    a, b = np.concatenate(pairs, axis=1) if pairs else np.zeros((2, 0), int)
    joined = coo_array((np.ones(len(a)), (a, b)), shape=(count + 1,) * 2)
    of = connected_components(joined, directed=False)[1] + 1
    return np.where(found > 0, of[found], 0)


def _turned(axis: Axis, points: np.ndarray, by: np.ndarray) -> np.ndarray:
    """Points (…, 3) turned about an axis by angles (…,) [rad] (Rodrigues 1840)."""
    h, r = axis.direction, points - axis.point
    c, s = np.cos(by)[..., None], np.sin(by)[..., None]
    along = np.einsum("...i,i", r, h)[..., None] * h
    return axis.point + along + c * (r - along) + s * np.cross(h, r)
