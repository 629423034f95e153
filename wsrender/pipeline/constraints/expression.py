"""Constraints of users: an expression of the configuration, the tip's pose and the chain, traced by the engine."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.indices.chain_expression import Expressed, JointFrame, JointLimits
from wsrender.pipeline.constraints.constraint import Structure
from wsrender.pipeline.constraints.region import Point
from wsrender.robots.chain import Chain
from wsrender.robots.dynamics import gravity_torques, inertia_matrices
from wsrender.robots.kinematics import Kinematics
from wsrender.short_repr import short_repr


@dataclass(frozen=True)
class ExpressionConstraint:
    """Admits configurations where a function of them is 0 or more; see `Expressed`. ``options``: names and values.

    ``asks``: what more of the chain it takes; then ``chain``, the robot's `Chain.dynamic`, and ``gravity`` in the world
    [m/s²] are given.
    """

    name: str
    function: Callable[..., Any]
    options: tuple[tuple[str, float], ...] = ()
    keeps: frozenset[Structure] = frozenset()
    asks: tuple[str, ...] = ()
    chain: Chain | None = None
    gravity: Point = (0.0, 0.0, 0.0)

    __repr__ = short_repr

    @property
    def device(self) -> Expressed:
        """The function that the engine traces."""
        return Expressed(self.function, tuple(name for name, _ in self.options), self.asks)

    def pack(self, chain: Kinematics, origin: np.ndarray, precision: str) -> np.ndarray:
        """Where positions are counted from, for the function is given those in the world; and the options."""
        return np.array([*origin, *(value for _, value in self.options)], np.float64)

    @property
    def limits(self) -> JointLimits:
        """What is given as ``limits``: (n,) each."""
        assert self.chain is not None
        efforts = self.chain.effort_limits
        most = np.full(self.chain.n, np.inf) if efforts is None else efforts
        return JointLimits(self.chain.lower_limits, self.chain.upper_limits, most)

    def values(self, q: np.ndarray, frames: np.ndarray, moved: np.ndarray | None = None) -> np.ndarray:
        """The function at configurations (N, n) with tip poses (N, 4, 4), (N,); NumPy evaluates it itself.

        ``moved`` (N, 4, 4): by what motion of the world the arm stands elsewhere at each, as the tip poses say already.
        """
        asked = {name: self._asked(name, q, moved) for name in self.asks}
        found = self.function(list(q.T), *_pose(frames), **asked, **dict(self.options))
        return np.broadcast_to(np.asarray(found, np.float64), len(q))

    def host(self, q: np.ndarray, frames: np.ndarray, moved: np.ndarray | None = None) -> np.ndarray:
        """See `Constraint.host` and `values`."""
        return np.where(self.values(q, frames, moved) >= 0, 0, 1).astype(np.int8)

    def _asked(self, name: str, q: np.ndarray, moved: np.ndarray | None) -> Any:
        assert self.chain is not None
        if name == "frames":
            frames = self.chain.frames(q)[:, :-1]
            frames = frames if moved is None else moved[:, None] @ frames
            return [JointFrame(*_pose(T)) for T in frames.swapaxes(0, 1)]
        if name == "limits":
            return self.limits
        if name == "g":  # turned with the arm, gravity pulls along other axes of it
            gravity = np.array(self.gravity)
            gravity = gravity if moved is None else gravity @ moved[:, :3, :3]
            return list(gravity_torques(self.chain, q, gravity).T)
        if name == "M":
            return inertia_matrices(self.chain, q).transpose(1, 2, 0)
        J = self.chain.jacobians(q)
        if moved is not None:
            J = (moved[:, None, :3, :3] @ J.reshape(len(q), 2, 3, -1)).reshape(J.shape)
        return J.transpose(1, 2, 0)


def _pose(T: np.ndarray) -> tuple[list[Any], list[Any]]:
    """Position and axes of frames (N, 4, 4): numbers (N,) each."""
    return [T[:, row, 3] for row in range(3)], [[T[:, row, k] for row in range(3)] for k in range(3)]


@dataclass(frozen=True)
class ExpressionIndex(ExpressionConstraint):
    """An index of users: the value of such a function, with the same chain, gravity and options."""

    cut: float | None = None
