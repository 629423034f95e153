"""Constraints of users: an expression of the configuration and the tip's pose, traced by the engine."""

from dataclasses import dataclass

import numpy as np

from wsrender.pipeline.constraints.constraint import Expressed, Structure
from wsrender.robots.chain import Chain


@dataclass(frozen=True)
class ExpressionConstraint:
    """Admits configurations where a function of them is 0 or more; see `Expressed`."""

    name: str
    device: Expressed
    keeps: frozenset[Structure] = frozenset()

    def pack(self, chain: Chain, origin: np.ndarray) -> np.ndarray:
        """Where positions are counted from: the function is given those in the world."""
        return np.asarray(origin, np.float64)

    def host(self, q: np.ndarray, poses: np.ndarray) -> np.ndarray:
        """See `Constraint.host`; NumPy evaluates the function itself."""
        axes = [[poses[:, row, k] for row in range(3)] for k in range(3)]
        margin = self.device(list(q.T), [poses[:, row, 3] for row in range(3)], axes)
        return np.where(np.broadcast_to(margin, len(q)) >= 0, 0, 1).astype(np.int8)
