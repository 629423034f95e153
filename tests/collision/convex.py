"""Whether two convex solids touch, without MuJoCo: a convex function over space by the ellipsoid method."""

from collections.abc import Callable

import numpy as np
from scipy.spatial import ConvexHull

from wsrender.collision.solids import Solid

Levels = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
ROUNDS = 400
FOUND = 1e-10  # [m]


def level(solid: Solid, T: np.ndarray) -> Levels:
    """Of a solid at frames (N, 4, 4): values (N,) [m] at points (N, 3), negative inside and convex, and gradients."""
    R, p, size = T[:, :3, :3], T[:, :3, 3], solid.size
    planes = ConvexHull(solid.points).equations if solid.kind == "hull" else np.zeros((0, 4))

    def local(y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        match solid.kind:
            case "half_space":
                return y[:, 2], np.tile([0.0, 0.0, 1.0], (len(y), 1))
            case "sphere" | "capsule":
                half = size[1] if solid.kind == "capsule" else 0.0
                away = y - np.clip(y[:, 2:], -half, half) * [0, 0, 1]
                distance = np.maximum(np.linalg.norm(away, axis=1), 1e-300)
                return distance - size[0], away / distance[:, None]
            case "ellipsoid":
                share = np.maximum(np.linalg.norm(y / size, axis=1), 1e-300)
                return (share - 1) * size.min(), y / size**2 / share[:, None] * size.min()
            case "cylinder":
                across = np.maximum(np.hypot(y[:, 0], y[:, 1]), 1e-300)
                values = np.stack([across - size[0], y[:, 2] - size[1], -y[:, 2] - size[1]])
                gradients = np.zeros((3, len(y), 3))
                gradients[0, :, :2] = y[:, :2] / across[:, None]
                gradients[1, :, 2], gradients[2, :, 2] = 1, -1
            case _:
                of = planes if len(planes) else np.column_stack([np.r_[np.eye(3), -np.eye(3)], -np.r_[size, size]])
                values = of[:, :3] @ y.T + of[:, 3:]
                gradients = np.repeat(of[:, None, :3], len(y), axis=1)
        most = values.argmax(axis=0), np.arange(len(y))
        return values[most], gradients[most]

    def at(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        values, gradients = local(np.einsum("nij,ni->nj", R, x - p))
        return values, np.einsum("nij,nj->ni", R, gradients)

    return at


def touch(a: Solid, T_a: np.ndarray, b: Solid, T_b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Whether (N,) two solids touch by a point that both hold, and whether they are apart by a bound below it.

    The greater of both levels has a least value, which the ellipsoid method (Yudin and Nemirovski 1976; Shor 1977)
    brackets over a ball that holds ``b``. Neither is said of solids that barely touch.
    """
    levels, x = (level(a, T_a), level(b, T_b)), T_b[:, :3, 3].copy()
    P = np.tile(np.eye(3) * b.bounding_radius**2, (len(x), 1, 1))
    least, bound = np.full(len(x), np.inf), np.full(len(x), -np.inf)
    for _ in range(ROUNDS):
        (v_a, g_a), (v_b, g_b) = (each(x) for each in levels)
        value, gradient = np.maximum(v_a, v_b), np.where((v_a > v_b)[:, None], g_a, g_b)
        step = np.einsum("nij,nj->ni", P, gradient)
        width = np.sqrt(np.maximum((step * gradient).sum(axis=1), FOUND**2))
        least, bound = np.minimum(least, value), np.maximum(bound, value - width)
        step = np.where(width > FOUND, 1 / width, 0.0)[:, None] * step
        x -= step / 4
        P = np.where(width > FOUND, 9 / 8, 1.0)[:, None, None] * (P - step[:, :, None] * step[:, None] / 2)
    return least < 0, bound > 0


def depth_along(a: Solid, T_a: np.ndarray, b: Solid, T_b: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """How far (N,) [m] ``b`` must at most be moved to leave ``a``, by the best of directions (D, 3)."""

    def support(solid: Solid, T: np.ndarray, along: np.ndarray) -> np.ndarray:
        own = along @ T[:, :3, :3]
        if solid.kind == "ellipsoid":
            far = np.linalg.norm(own * solid.size, axis=2)
        else:
            far = (own @ solid.points.T).max(axis=2) + solid.radius + solid.disc * np.hypot(own[..., 0], own[..., 1])
        return far + np.einsum("di,ni->nd", along, T[:, :3, 3])

    return (support(b, T_b, directions) + support(a, T_a, -directions)).min(axis=1)
