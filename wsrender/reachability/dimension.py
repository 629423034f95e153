"""Whether the positions of a chain fill a volume, or a surface or line only."""

import numpy as np

from wsrender.engine import configurations, evaluate_kinematics
from wsrender.robots.chain import Chain
from wsrender.sampling import plan_sampling
from wsrender.spec.sampling import Sobol

SAMPLES = 1 << 10
# Thickness that counts as none, relative to the size: model files that mean a right angle say 1.5708.
FLAT = 1e-5


def fills_volume(chain: Chain) -> bool:
    """Whether three independent directions are open to the end effector anywhere (Sard 1942: else it has no volume).

    They are the left singular vectors of the linear Jacobian whose columns are multiplied by the joints' ranges.
    """
    if chain.n < 3:
        return False
    q = configurations(plan_sampling(chain, Sobol(SAMPLES)), np.arange(SAMPLES))
    J = evaluate_kinematics(chain, q, device="cpu").jacobian[:, :3] * (chain.upper_limits - chain.lower_limits)
    sigma = np.linalg.svd(J, compute_uv=False).max(axis=0)
    return bool(sigma[2] > FLAT * sigma[0])


def in_own_voxel(points: np.ndarray, cells: np.ndarray, voxel_size_m: float) -> np.ndarray:
    """Whether points (N, 3) [m] lie in the cells (N, 3) of the lattice, or on their faces, (N,) bool."""
    return np.all(np.abs(points / voxel_size_m - cells - 0.5) <= 0.5 * (1 + FLAT), axis=1)
