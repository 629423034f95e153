"""Signed distances of solids by MuJoCo, the reference; of surfaces by MuJoCo's from their triangles.

MuJoCo 4.0.0 takes some capsules whose axis passes through a box for free, `mj_geomDistance` and contacts alike: such a
pair touches here. What it says of depths is never more than they are, which proofs rest on.
"""

import copy
import threading
from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from wsrender.collision.covers import from_segment, outer_covers
from wsrender.collision.solids import Pairs, Solid
from wsrender.collision.supports import center_of
from wsrender.robots.chain import Chain
from wsrender.robots.triangles import winding_numbers

if TYPE_CHECKING:
    import mujoco

TYPES = {
    "sphere": "SPHERE",
    "capsule": "CAPSULE",
    "cylinder": "CYLINDER",
    "ellipsoid": "ELLIPSOID",
    "box": "BOX",
    "hull": "MESH",
    "half_space": "PLANE",
    "surface": "SPHERE",  # stands for nothing
}
PARALLEL = 1e-30  # half an axis across a face that counts as along it [m]

AT_A_TIME = 4096  # configurations whose frames are held


class Distances:
    """`mj_geomDistance` of solids that stand anywhere, mended; threads may call it side by side."""

    def __init__(self, solids: Sequence[Solid]):
        import mujoco

        spec = mujoco.MjSpec()
        for number, solid in enumerate(solids):
            geom = spec.worldbody.add_geom(
                type=getattr(mujoco.mjtGeom, f"mjGEOM_{TYPES[solid.kind]}"), size=_size(solid)
            )
            if solid.kind == "hull":
                mesh = spec.add_mesh(name=f"hull{number}", uservert=solid.points.ravel())
                mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
                geom.meshname = mesh.name
        if any(solid.kind == "surface" for solid in solids):
            spec.add_mesh(name="triangle", uservert=np.eye(4, 3).ravel())
            spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="triangle")
        self.solids, self.model = tuple(solids), spec.compile()
        # MuJoCo turns a mesh to its principal axes and moves it to its centre.
        self.own = np.tile(np.eye(4), (len(solids), 1, 1))
        for number, solid in enumerate(solids):
            if solid.kind == "hull":
                R = np.zeros(9)
                mesh = self.model.geom_dataid[number]
                mujoco.mju_quat2Mat(R, self.model.mesh_quat[mesh])
                self.own[number, :3, :3], self.own[number, :3, 3] = R.reshape(3, 3), self.model.mesh_pos[mesh]
        # Of balls around the frames that MuJoCo gives solids; it has 0 for half-spaces.
        boundless = [solid.kind in ("half_space", "surface") for solid in solids]
        self._radii = np.where(boundless, np.inf, self.model.geom_rbound[: len(solids)])
        self._local = threading.local()
        self._capsule = cache(lambda k: outer_covers([self.solids[k]])[0][0])
        self._triangles = cache(self._triangles_of)

    def between(self, a: int, b: int, T_a: np.ndarray, T_b: np.ndarray, limit: float) -> np.ndarray:
        """Signed distances (N,) [m] of two solids with frames (N, 4, 4) in one frame, cut at ``limit`` > 0.

        Where one overlaps a surface, what is said is negative, and its depth may be more.
        """
        if self.solids[a].kind == "surface":
            return self._from_surface(a, b, np.linalg.inv(T_a) @ T_b, limit)
        from mujoco import mj_geomDistance as distance

        data, model = self._data(), self.model
        stands = T_a.strides[0] == 0  # one frame for all
        T_a, T_b = np.broadcast_to(T_a[:1] @ self.own[a], T_a.shape) if stands else T_a @ self.own[a], T_b @ self.own[b]
        apart = np.linalg.norm(T_a[:, :3, 3] - T_b[:, :3, 3], axis=1) - self._radii[a] - self._radii[b]
        found, near = np.full(len(T_a), limit), np.flatnonzero(apart < limit)
        at_a, turned_a, at_b, turned_b = (own[k] for k in (a, b) for own in (data.geom_xpos, data.geom_xmat))
        positions_a, turns_a = _rows(T_a[near[:1] if stands else near])
        if stands and len(near):
            at_a[:], turned_a[:] = positions_a[0], turns_a[0]
        for k, (i, position_b, turn_b) in enumerate(zip(near.tolist(), *_rows(T_b[near]), strict=True)):
            if not stands:
                at_a[:], turned_a[:] = positions_a[k], turns_a[k]
            at_b[:], turned_b[:] = position_b, turn_b
            found[i] = distance(model, data, a, b, limit, None)
        return self._deep(a, b, T_a, T_b, found)

    def _from_surface(self, surface: int, b: int, T: np.ndarray, limit: float) -> np.ndarray:
        """Distances of solid ``b`` at frames (N, 4, 4) in that of a surface."""
        own, found = self.solids[surface], np.full(len(T), limit)
        corners, centers, radii = triangles = self._triangles(surface)
        low, *_, high = own.points
        beyond = np.linalg.norm(np.maximum(0, np.maximum(low - T[:, :3, 3], T[:, :3, 3] - high)), axis=1)
        near = np.flatnonzero(beyond - self.solids[b].bounding_radius < limit)
        capsule = self._capsule(b)
        for i in near:
            ends = [end @ T[i, :3, :3].T + T[i, :3, 3] for end in (capsule.a[0], capsule.b[0])]
            bounds = from_segment(centers, *ends) - capsule.radius[0] - radii
            found[i] = self._from_triangles(b, T[i], triangles, bounds, limit)
        apart = near[found[near] > 0]
        middles = T[apart, :3, :3] @ center_of(self.solids[b]) + T[apart, :3, 3]
        inside = apart[winding_numbers(corners, middles) > 0.5]
        found[inside] *= -1
        return found

    def _triangles_of(self, surface: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Corners (F, 3, 3) of a surface's triangles, with the middle (F, 3) and radius (F,) of a ball around each."""
        corners = self.solids[surface].corners
        centers = corners.mean(axis=1)
        return corners, centers, np.linalg.norm(corners - centers[:, None], axis=2).max(axis=1)

    def _from_triangles(
        self, b: int, T: np.ndarray, triangles: tuple[np.ndarray, ...], bounds: np.ndarray, limit: float
    ) -> float:
        """Least distance of a solid at ``T`` (4, 4) from triangles, which are no nearer than ``bounds`` (F,).

        Where it overlaps one, how deep.
        """
        import mujoco

        data, least, own = self._data(), limit, len(self.solids)
        model, T = self._local.model, T @ self.own[b]
        vertices = model.mesh_vert[model.mesh_vertadr[model.geom_dataid[own]] :][:4]
        data.geom_xpos[b], data.geom_xmat[b], data.geom_xmat[own] = T[:3, 3], T[:3, :3].ravel(), np.eye(3).ravel()
        near = np.flatnonzero(bounds < limit)
        for k in near[np.argsort(bounds[near])]:
            if least <= 0 or bounds[k] >= least:
                break
            corners, center, radius = (each[k] for each in triangles)
            vertices[:] = corners[[0, 1, 2, 2]] - center  # which are kept in float32
            model.geom_rbound[own], data.geom_xpos[own] = radius, center
            least = min(least, mujoco.mj_geomDistance(model, data, b, own, limit, None))
        return least

    def _deep(self, a: int, b: int, T_a: np.ndarray, T_b: np.ndarray, found: np.ndarray) -> np.ndarray:
        """The same, where a capsule's axis passes through a box at most minus its radius."""
        if {self.solids[a].kind, self.solids[b].kind} != {"capsule", "box"}:
            return found
        if self.solids[a].kind == "box":
            a, b, T_a, T_b = b, a, T_b, T_a
        T = np.linalg.inv(T_b) @ T_a
        middle, half, size = T[:, :3, 3], T[:, :3, 2] * self.solids[a].size[1], self.solids[b].size
        half = np.where(np.abs(half) < PARALLEL, PARALLEL, half)
        # Shares of the axis at which it meets the planes of two opposite faces (Kay and Kajiya 1986).
        sides = np.sort([(-size - middle) / half, (size - middle) / half], axis=0)
        through = np.maximum(sides[0].max(axis=1), -1) <= np.minimum(sides[1].min(axis=1), 1)
        return np.where(through, np.minimum(found, -self.solids[a].radius), found)

    def _data(self) -> "mujoco.MjData":
        if not hasattr(self._local, "data"):
            import mujoco

            # Triangles are written into the model.
            own = any(solid.kind == "surface" for solid in self.solids)
            self._local.model = copy.copy(self.model) if own else self.model
            self._local.data = mujoco.MjData(self.model)
        return self._local.data


def _rows(T: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions (N, 3) and rotations (N, 9) of frames (N, 4, 4), as MuJoCo keeps them."""
    return T[:, :3, 3].copy(), T[:, :3, :3].reshape(-1, 9)


def _size(solid: Solid) -> np.ndarray:
    if solid.kind in ("half_space", "hull", "surface"):
        return np.array([1.0, 1.0, 1.0])
    return np.asarray(solid.size, float)


def frames_of(chain: Chain, q: np.ndarray) -> np.ndarray:
    """Frames (N, L + 1, 4, 4) of the base, which comes first, and of all joints, in the base's frame."""
    in_world = chain.frames(q)[:, :-1]
    base = np.broadcast_to(np.eye(4), (len(q), 1, 4, 4))
    return np.concatenate([base, np.linalg.inv(chain.T_world_base) @ in_world], axis=1)


def blocked_by(pairs: Pairs, distances: Distances, chain: Chain, q: np.ndarray, asked: np.ndarray) -> np.ndarray:
    """Number, from 1, of the first constraint that configurations ``q`` (N, n) violate, or 0; (N,) int8.

    ``asked`` (N, P) bool: the pairs that are not known to be free. By MuJoCo in float64.
    """
    frames, found = frames_of(chain, q), np.zeros(len(q), np.int8)
    for pair in np.flatnonzero(asked.any(axis=0)).tolist():
        open_ = np.flatnonzero(asked[:, pair] & (found == 0))
        near = _near(pairs, distances, pair, *_placed(pairs, pair, frames[open_]))
        found[open_[near]] = pairs.reason[pair] + 1
    return found


def colliding(pairs: Pairs, distances: Distances, chain: Chain, q: np.ndarray) -> np.ndarray:
    """Which pairs are nearer than their margins at configurations ``q`` (N, n), (N, P) bool, by MuJoCo in float64.

    It is not asked of what balls around two solids keep apart.
    """
    found = np.zeros((len(q), len(pairs.pairs)), bool)
    for start in range(0, len(q), AT_A_TIME):
        frames = frames_of(chain, q[start : start + AT_A_TIME])
        for pair, solids in enumerate(pairs.pairs):
            T_a, T_b = _placed(pairs, pair, frames)
            far = pairs.margin(pair) + sum(pairs.solids[k].bounding_radius for k in solids)
            close = np.flatnonzero(np.linalg.norm(T_a[:, :3, 3] - T_b[:, :3, 3], axis=1) <= far)
            found[start + close, pair] = _near(pairs, distances, pair, T_a[close], T_b[close])
    return found


def _placed(pairs: Pairs, pair: int, frames: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frames (N, 4, 4) of both solids of a pair, of those (N, L + 1, 4, 4) of base and joints."""
    a, b = (frames[:, pairs.solids[k].joint + 1] @ pairs.solids[k].T for k in pairs.pairs[pair])
    return a, b


def _near(pairs: Pairs, distances: Distances, pair: int, T_a: np.ndarray, T_b: np.ndarray) -> np.ndarray:
    a, b = pairs.pairs[pair]
    margin = pairs.margin(pair)
    return distances.between(a, b, T_a, T_b, margin + 1e-3) < margin
