"""Mechanisms whose platform stays in a plane, on a line or at a point, at one orientation.

Each leg that is solved numerically holds its tip in the plane or line that its chain moves in, if there is one; the
platform's origin stays in all of them at once.
"""

from dataclasses import dataclass

import numpy as np

from wsrender.documents.sampling import Sobol
from wsrender.engine import sampled_positions
from wsrender.mechanisms.mechanism import Mechanism
from wsrender.mechanisms.serial_leg import NumericLeg
from wsrender.pipeline.pipeline import tip_pipeline

SAMPLES = 512
FLAT = 1e-9  # thickness that counts as none, relative to the extent
CROSSED = 1e-7  # sine between normals that are told apart
MEASURES = {3: ("volume", "m^3"), 2: ("area", "m^2"), 1: ("length", "m")}


@dataclass(frozen=True, eq=False)
class Flat:
    """A plane, line or point of the world: ``origin`` (3,) [m], orthonormal ``axes`` (3, 3) in rows.

    The first ``dimension`` of the axes span it; where it can be they are axes of the world, in their order.
    """

    dimension: int
    origin: np.ndarray
    axes: np.ndarray

    def in_world(self, local: np.ndarray) -> np.ndarray:
        """Points (N, 3) of the world from coordinates (N, 3), of which those across count nothing."""
        return self.origin + local[:, : self.dimension] @ self.axes[: self.dimension]

    def local(self, points: np.ndarray) -> np.ndarray:
        """Coordinates (N, 3) of points of the world, 0 across."""
        found = (points - self.origin) @ self.axes.T
        found[:, self.dimension :] = 0.0
        return found

    def same(self, other: "Flat", size: float) -> bool:
        """Whether both are one, within 1e-9 of a size [m]."""
        if self.dimension != other.dimension:
            return False
        across = self.axes[self.dimension :]
        apart = np.abs(across @ (other.origin - self.origin)).max(initial=0.0)
        turned = np.abs(across @ other.axes[: self.dimension].T).max(initial=0.0)
        return bool(apart <= FLAT * size and turned <= CROSSED)


def flat_of(mechanism: Mechanism, rotation: np.ndarray) -> Flat | None:
    """Where a mechanism holds its platform's origin at an orientation (3, 3), base frame; None where it has a volume.

    None too where no place lies in what all its legs allow.
    """
    rows = [_equations(leg, rotation) for leg in mechanism.numeric]
    normals = np.concatenate([np.zeros((0, 3)), *(normals for normals, _ in rows)])
    offsets = np.concatenate([np.zeros(0), *(offsets for _, offsets in rows)])
    if not len(normals):
        return None
    _, sigma, turned = np.linalg.svd(normals)
    rank = int((sigma > CROSSED).sum())
    origin = np.linalg.pinv(normals, rcond=CROSSED) @ offsets
    size = max(leg.chain.reach for leg in mechanism.numeric) + np.linalg.norm(origin)
    if np.abs(normals @ origin - offsets).max() > 10 * FLAT * size:
        return None
    R, t = mechanism.T_world_base[:3, :3], mechanism.T_world_base[:3, 3]
    return _along_world(turned[:rank] @ R.T, R @ origin + t)


def _equations(leg: NumericLeg, rotation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unit normals (k, 3) and offsets (k,) of what holds the platform's origin in a leg's plane or line, base frame."""
    tips = sampled_positions(tip_pipeline(leg.chain, Sobol(SAMPLES)))
    middle = tips.mean(axis=0)
    _, sigma, axes = np.linalg.svd(tips - middle, full_matrices=False)
    thick = sigma > FLAT * max(sigma[0], leg.chain.reach * np.sqrt(SAMPLES) * FLAT)
    normals = axes[~thick]
    return normals, normals @ (middle - rotation @ leg.T_platform_tip[:3, 3])


def _along_world(normals: np.ndarray, origin: np.ndarray) -> Flat:
    """A flat across normals (k, 3), its axes those of the world where they lie in it."""
    across = np.linalg.svd(normals)[2][: len(normals)] if len(normals) else np.zeros((0, 3))
    inside = np.eye(3) - across.T @ across  # projects into the flat
    axes: list[np.ndarray] = []
    for axis in sorted(range(3), key=lambda k: -round(inside[k, k], 9)):
        left = inside[axis] - sum((row * (row @ inside[axis]) for row in axes), np.zeros(3))
        if len(axes) < 3 - len(normals) and np.linalg.norm(left) > CROSSED:
            axes.append(left / np.linalg.norm(left))
    spanning = np.array(axes).reshape(-1, 3)
    spanning = np.where(np.abs(spanning) < FLAT, 0.0, spanning)
    spanning = spanning[np.argsort(np.abs(spanning).argmax(axis=1), kind="stable")]
    foot = origin - spanning.T @ (spanning @ origin)  # nearest to the world's origin: lattices begin there
    return Flat(len(spanning), foot, np.vstack([spanning, across]))
