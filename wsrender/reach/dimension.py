"""What the positions of a chain fill: a volume, a surface, a curve, or one point; and whether that is flat."""

from dataclasses import dataclass

import numpy as np

from wsrender.documents.sampling import Sobol
from wsrender.engine import configurations, evaluate_kinematics
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.robots.kinematics import Kinematics
from wsrender.tolerances import FLAT

SAMPLES = 1 << 10
MARGIN = 2.0  # of the samples' thickness, for what they do not show


@dataclass(frozen=True, eq=False)
class TipSet:
    """The set of positions of a chain.

    ``dimension``: 3 a volume, 2 a surface, 1 a curve, 0 a point. ``span``: that of the smallest space that holds it, at
    least ``dimension``. ``T_world_own`` (4, 4): the frame at the middle of the set whose first axes span that space.
    ``positions`` (N, 3) [m] in the world: samples.
    """

    dimension: int
    span: int
    T_world_own: np.ndarray
    positions: np.ndarray

    @property
    def flat(self) -> bool:
        """Whether it fills the space that holds it: a volume, a part of a plane or of a line."""
        return self.span == self.dimension

    def thickness_m(self, T_world_own: np.ndarray, dimension: int) -> float:
        """How far positions lie beside the first ``dimension`` axes of a frame [m], with a margin."""
        beside = (self.positions - T_world_own[:3, 3]) @ T_world_own[:3, dimension:3]
        return MARGIN * float(np.linalg.norm(beside, axis=1).max())

    @property
    def extent_m(self) -> float:
        """Largest distance of a position from the middle [m]."""
        return float(np.linalg.norm(self.positions - self.T_world_own[:3, 3], axis=1).max())


def tip_set(chain: Kinematics, threads: int | None = None) -> TipSet:
    """What the positions of a chain fill, from samples.

    The dimension is the largest rank of the linear Jacobian (Sard 1942: where it is below 3 everywhere, the positions
    have no volume), whose columns are multiplied by the joints' ranges.
    """
    q = configurations(tip_pipeline(chain, Sobol(SAMPLES)))
    found = evaluate_kinematics(chain, q, device="cpu", threads=threads)
    ranges = chain.upper_limits - chain.lower_limits
    sigma = np.zeros(3)
    sigma[: min(3, chain.n)] = np.linalg.svd(found.jacobian[:, :3] * ranges, compute_uv=False).max(axis=0)
    moves = sigma > FLAT * max(sigma[0], FLAT * chain.reach)
    positions = found.pose[:, :3, 3]
    middle = positions.mean(axis=0)
    _, sizes, axes = np.linalg.svd(positions - middle, full_matrices=False)
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = axes.T, middle
    T[:3, 2] *= np.sign(np.linalg.det(T[:3, :3]))
    dimension = int(moves.sum())
    span = max(dimension, int((sizes > FLAT * sizes[0]).sum())) if dimension else 0
    return TipSet(dimension, span, T, positions)


def fills_volume(chain: Kinematics, threads: int | None = None) -> bool:
    """Whether the positions of a chain fill a volume."""
    return chain.n >= 3 and tip_set(chain, threads).dimension == 3


def in_own_voxel(points: np.ndarray, cells: np.ndarray, voxel_size_m: float) -> np.ndarray:
    """Whether points (N, 3) [m] lie in the cells (N, 3) of the lattice, or on their faces, (N,) bool."""
    return np.all(np.abs(points / voxel_size_m - cells - 0.5) <= 0.5 * (1 + FLAT), axis=1)
