"""Polytopes of a robot at a configuration: velocities, accelerations and forces of the tip that the joints allow.

Velocities J q̇ and accelerations J M⁻¹ (τ − g), at rest, of all joint velocities and torques within limits are images of
a box: zonotopes (Yoshikawa 1985; Bowling and Khatib 2005). Forces f are held where every joint can hold g + Jᵀ f
(Chiacchio et al. 1997): an intersection of slabs. Skuric et al. (2023) compare ways to enumerate their vertices.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, product
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import linprog
from scipy.spatial import ConvexHull, HalfspaceIntersection

from wsrender.documents.quantities import argument, positive
from wsrender.errors import InputError
from wsrender.keywords import keywords
from wsrender.notebook import mime_bundle
from wsrender.pipeline.constraints.region import Point
from wsrender.robot import Robot, as_robot
from wsrender.robot.chain_indices import ChainAsked
from wsrender.robot.gravity import GRAVITY
from wsrender.robot.indices import task_rows
from wsrender.robot.model_robot import configuration_rows
from wsrender.robots.dynamics import gravity_torques, inertia_matrices
from wsrender.short_repr import short_repr

if TYPE_CHECKING:
    import trimesh

UNITS = {"velocity": "m/s", "force": "N", "acceleration": "m/s^2"}
"""Kinds of polytopes, with the unit of their vertices."""
LIMIT_N = 10_000.0  # as the index force_radius has it
FLAT = 1e-12  # of the largest extent: what is thinner has no extent there
EDGE = 0.3  # of the arm's reach: largest distance from the tip to a vertex of a mesh
THIN = 1e-10  # of the largest extent: what Qhull takes for flat, with a margin
INSIDE = 1e-9  # of the nearest slab's distance from 0: smallest ball of a set of forces that is not empty


@dataclass(frozen=True, eq=False)
class Polytope:
    """A convex polytope of one ``kind`` about 0, in world axes.

    ``vertices`` (V, 3) [``unit``]; ``facets`` (F, 4): unit normals n and offsets b of all x with n · x ≤ b, within the
    space of its ``dimension`` (3, 2 of a polygon, 1, 0); ``triangles`` (T, 3): of its surface, outwards, or of the
    polygon; ``radius`` [``unit``]: of the largest ball about 0, in the ``rows`` of the task, inside it, as the index
    of that name has it. No vertices: nothing is allowed, not even 0. ``position`` (3,) [m]: where the tip is;
    ``reach`` [m]: of the arm.
    """

    kind: str
    vertices: np.ndarray
    facets: np.ndarray
    triangles: np.ndarray
    dimension: int
    rows: tuple[int, ...]
    position: np.ndarray
    reach: float

    __repr__ = short_repr
    _repr_mimebundle_ = mime_bundle

    @property
    def unit(self) -> str:
        """Unit of vertices, offsets and radius."""
        return UNITS[self.kind]

    @cached_property
    def radius(self) -> float:
        """Radius of the largest ball about 0, of the task's dimension, that it holds."""
        if self.dimension < len(self.rows) or not len(self.vertices):
            return 0.0
        return max(float(self.facets[:, 3].min()), 0.0)

    @cached_property
    def volume(self) -> float:
        """Volume, of polygons the area, of segments the length [its unit to the power of ``dimension``]."""
        corners = self.vertices[self.triangles]
        if self.dimension == 3:
            return float(np.linalg.det(corners).sum()) / 6
        if self.dimension == 2:
            across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            return float(np.linalg.norm(across, axis=1).sum()) / 2
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0))) if self.dimension else 0.0

    @property
    def fitting_scale(self) -> float:
        """Metres for each unit with which its farthest vertex is `EDGE` of the arm's reach from the tip."""
        farthest = np.linalg.norm(self.vertices, axis=1).max(initial=0.0)
        return EDGE * (self.reach or 1.0) / farthest if farthest else 1.0

    def mesh(self, scale: float | None = None, *, at_tip: bool = True) -> "trimesh.Trimesh":
        """Its surface; ``scale`` [m for each unit], None: such that it can be seen beside the arm.

        It stands at the tip in the world, or else about 0. Of a polygon it is flat. Raises InputError where there is
        no area.
        """
        import trimesh

        if self.dimension < 2:
            raise InputError("mesh", f"the polytope of {self.kind} has dimension {self.dimension} here, and no area")
        scale = self.fitting_scale if scale is None else argument("scale", positive, scale)
        return trimesh.Trimesh(scale * self.vertices + at_tip * self.position, self.triangles, process=False)


@keywords
def polytope(
    robot: Any,
    q: Any,
    kind: str = "velocity",
    task: Any = "linear",
    *,
    gravity_m_s2: Point = GRAVITY,
    limit_N: float = LIMIT_N,
) -> Polytope:
    """The polytope of a ``kind``, "velocity", "force" or "acceleration", at a configuration ``q`` (n,) [rad or m].

    Limits are those of the model, or `load_robot`'s. ``task``: rows of the Jacobian in base axes, of which the linear
    ones count. Forces are held at rest, moment 0, and cut to ± ``limit_N`` along the axes of the base. Raises
    InputError for limits that the robot lacks, MissingInertiaError, ModelError.

    >>> rows = [{"a": 0.3, "limits_deg": [-180, 180]}, {"a": 0.2, "limits_deg": [-180, 180]}]
    >>> speeds = {"joint1": 1.0, "joint2": 1.0}
    >>> arm = ws.load_robot(ws.DHTable(convention="standard", rows=rows), velocity_limits=speeds)
    >>> found = ws.polytope(arm, [0, np.pi / 2], "velocity", task=["x", "y"])
    >>> sorted(found.vertices[:, :2].round(9).tolist())  # ± the columns of the Jacobian
    [[-0.4, 0.3], [0.0, -0.3], [0.0, 0.3], [0.4, -0.3]]
    """
    subject = as_robot(robot)
    rows = configuration_rows(q, subject.chain.n)
    if len(rows) != 1:
        raise InputError("q", f"must be one configuration, not {len(rows)}")
    return polytopes(subject, rows, kind, task_rows(task), gravity_m_s2, limit_N)[0]


def polytopes(
    robot: Robot,
    q: np.ndarray,
    kind: str,
    rows: tuple[int, ...],
    gravity: Point = GRAVITY,
    limit_N: float = LIMIT_N,
    *,
    field: str = "kind",
) -> list[Polytope]:
    """Those of configurations (N, n), at a task's ``rows``. Raises as `polytope`, naming the ``field`` that asks."""
    if kind not in UNITS:
        raise InputError(field, f"{kind!r} is not allowed; {', '.join(UNITS)} are")
    asked = ChainAsked(f"the polytope of {kind}", robot, {}, rows, gravity, field=field)
    chain, linear = (asked.chain if kind == "velocity" else asked.weighing()), asked.linear()
    R = chain.T_world_base[:3, :3]
    base = R[:, list(linear)]  # the task's axes in the world
    J = np.einsum("wr,nwk->nrk", base, chain.jacobians(q)[:, :3])
    if kind == "velocity":
        speeds = asked.speeds()
        found = [_zonotope(each * speeds, np.zeros(len(linear))) for each in J]
    else:
        back, forth = asked.efforts().reshape(2, -1)
        g = gravity_torques(chain, q, np.array(gravity))
        if kind == "force":
            limit = argument("limit_N", positive, limit_N)
            found = [_slabs(each.T, -back - at, forth - at, limit) for each, at in zip(J, g, strict=True)]
        else:
            A = np.linalg.solve(inertia_matrices(chain, q), J.swapaxes(1, 2)).swapaxes(1, 2)
            middle = (forth - back) / 2 - g
            found = [_zonotope(each * ((back + forth) / 2), each @ m) for each, m in zip(A, middle, strict=True)]
    position = chain.poses(q)[:, :3, 3]
    return [
        Polytope(kind, *_hull(points, base), linear, at, chain.reach)
        for points, at in zip(found, position, strict=True)
    ]


def _zonotope(generators: np.ndarray, center: np.ndarray) -> np.ndarray:
    """Points (P, r), all vertices among them, of the sums center + Σ x_k generators[:, k] with -1 ≤ x_k ≤ 1.

    A vertex is where a normal of a facet, which r - 1 generators span, decides every x_k but those within the facet.
    """
    r = len(generators)
    size = np.linalg.norm(generators, axis=0)
    G = generators[:, size > FLAT * size.max(initial=0.0)].T
    if np.linalg.matrix_rank(G) < r or r == 1:
        basis = np.linalg.svd(G)[2][: max(np.linalg.matrix_rank(G), 0)] if len(G) else np.zeros((0, r))
        if len(basis) in (0, 1):
            reach = np.abs(G @ basis.T).sum(axis=0)
            return center + np.array([[-1.0], [1.0]]) * reach @ basis if len(basis) else center[None]
        return center + _zonotope(basis @ G.T, np.zeros(len(basis))) @ basis
    unit = G / np.linalg.norm(G, axis=1, keepdims=True)
    signs = []
    for spanning in combinations(range(len(G)), r - 1):
        normal = np.cross(*unit[list(spanning)]) if r == 3 else unit[spanning[0]] @ np.array([[0.0, 1.0], [-1.0, 0.0]])
        if not (length := np.linalg.norm(normal)) > FLAT:
            continue
        along = unit @ normal / length
        within = np.abs(along) <= FLAT
        for choice in product((-1.0, 1.0), repeat=int(within.sum())):
            sign = np.sign(along)
            sign[within] = choice
            signs += [sign, -sign]
    return center + np.unique(signs, axis=0) @ G


def _slabs(A: np.ndarray, low: np.ndarray, high: np.ndarray, limit: float) -> np.ndarray:
    """Vertices (P, r) of all x with low ≤ A x ≤ high and |x| ≤ limit; none where no x is inside."""
    r = A.shape[1]
    A, low, high = np.vstack([A, np.eye(r)]), np.append(low, np.full(r, -limit)), np.append(high, np.full(r, limit))
    size = np.linalg.norm(A, axis=1)
    counts = size > FLAT * size.max()
    if (low[~counts] > 0).any() or (high[~counts] < 0).any():
        return np.zeros((0, r))
    A, low, high = ((each[counts].T / size[counts]).T for each in (A, low, high))
    normals, offsets = np.vstack([A, -A]), np.append(high, -low)
    room = linprog(
        [*np.zeros(r), -1.0],
        A_ub=np.column_stack([normals, np.ones(len(normals))]),
        b_ub=offsets,
        bounds=[(None, None)] * (r + 1),
    )
    inside = room.x[:r]  # the middle of the largest ball
    if (offsets - normals @ inside).min() <= INSIDE * np.abs(offsets).min():
        return np.zeros((0, r))
    if r == 1:
        up = normals[:, 0] > 0
        return np.array([[-offsets[~up].min()], [offsets[up].min()]])
    return HalfspaceIntersection(np.column_stack([normals, -offsets]), inside).intersections


def _hull(points: np.ndarray, axes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """Vertices, facets, triangles and dimension, as `Polytope` has them, of points (P, r) along axes (3, r)."""
    if not len(points):
        return np.zeros((0, 3)), np.zeros((0, 4)), np.zeros((0, 3), int), 0
    middle = points.mean(axis=0)
    _, extent, basis = np.linalg.svd(points - middle, full_matrices=False)
    dimension = int((extent > THIN * max(extent.max(), np.abs(points).max())).sum())
    within = (points - middle) @ basis[:dimension].T
    world = axes @ basis[:dimension].T
    offset = axes @ middle
    if dimension == 0:
        return offset[None], np.zeros((0, 4)), np.zeros((0, 3), int), 0
    if dimension == 1:
        kept, normals = np.array([within.argmin(), within.argmax()]), np.array([[-1.0], [1.0]])
        bounds, triangles = np.array([-within.min(), within.max()]), np.zeros((0, 3), int)
    else:
        hull = ConvexHull(within)
        kept = hull.vertices
        number = np.full(len(points), -1)
        number[kept] = np.arange(len(kept))
        normals, bounds = hull.equations[:, :-1], -hull.equations[:, -1]
        if dimension == 2:  # counter-clockwise, as Qhull has them
            triangles = np.array([[0, k, k + 1] for k in range(1, len(kept) - 1)])
        else:
            triangles = number[hull.simplices]
            a, b, c = within[kept][triangles].transpose(1, 0, 2)
            inwards = (np.cross(b - a, c - a) * normals).sum(axis=1) * np.linalg.det(world) < 0
            triangles[inwards] = triangles[inwards, ::-1]
    n = normals @ world.T
    facets = np.unique(np.column_stack([n, bounds + n @ offset]), axis=0)
    return points[kept] @ axes.T, facets, triangles, dimension
