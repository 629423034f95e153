"""Constraints of users: an expression of the configuration and the tip's pose, traced by the engine."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.pipeline.constraints.constraint import Expressed, Structure
from wsrender.robots.kinematics import Kinematics


@dataclass(frozen=True)
class ExpressionConstraint:
    """Admits configurations where a function of them is 0 or more; see `Expressed`. ``options``: names and values."""

    name: str
    function: Callable[..., Any]
    options: tuple[tuple[str, float], ...] = ()
    keeps: frozenset[Structure] = frozenset()

    @property
    def device(self) -> Expressed:
        """The function that the engine traces."""
        return Expressed(self.function, tuple(name for name, _ in self.options))

    def pack(self, chain: Kinematics, origin: np.ndarray, precision: str) -> np.ndarray:
        """Where positions are counted from, for the function is given those in the world; and the options."""
        return np.array([*origin, *(value for _, value in self.options)], np.float64)

    def host(self, q: np.ndarray, frames: np.ndarray) -> np.ndarray:
        """See `Constraint.host`; NumPy evaluates the function itself."""
        axes = [[frames[:, row, k] for row in range(3)] for k in range(3)]
        margin = self.function(list(q.T), [frames[:, row, 3] for row in range(3)], axes, **dict(self.options))
        return np.where(np.broadcast_to(margin, len(q)) >= 0, 0, 1).astype(np.int8)
