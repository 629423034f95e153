"""Solids keep apart: those of the robot from each other, or from what stands around it."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wsrender.collision.distance import Distances, blocked_by
from wsrender.collision.solids import BASE, Pairs, Solid
from wsrender.pipeline.constraints.constraint import LABELLED, Structure
from wsrender.robots.chain import Chain
from wsrender.robots.kinematics import Kinematics


@dataclass(frozen=True, eq=False)
class CollisionConstraint:
    """``pairs`` (P, 2) of solids, in the frames of ``chain``, stay ``margin_m`` [m] apart by MuJoCo's signed distance.

    ``name``: "self_collision" or "environment". The chain has the robot's coordinates; it may have joints more.
    """

    name: str
    chain: Chain
    solids: tuple[Solid, ...]
    pairs: np.ndarray
    margin_m: float = 0.0
    device: str = LABELLED

    @property
    def keeps(self) -> frozenset[Structure]:
        """The base joint's, where nothing that stands still is in a pair."""
        still = any(self.solids[k].joint == BASE for k in self.pairs.ravel())
        return frozenset() if still else frozenset({"base_joint"})

    def pack(self, chain: Kinematics, origin: np.ndarray, precision: str) -> np.ndarray:
        """No numbers: samples are labelled before the sweep."""
        return np.zeros(0)

    @cached_property
    def own(self) -> Pairs:
        """The pairs by themselves."""
        return Pairs.of(self.solids, self.group)

    @property
    def group(self) -> tuple[np.ndarray, float, bool]:
        """As `Pairs.of` takes it."""
        return self.pairs, self.margin_m, self.name == "environment"

    @cached_property
    def distances(self) -> Distances:
        """MuJoCo's, of the solids."""
        return Distances(self.solids)

    def host(self, q: np.ndarray, frames: np.ndarray) -> np.ndarray:
        """See `Constraint.host`; by MuJoCo."""
        asked = np.ones((len(q), len(self.own.pairs)), bool)
        return blocked_by(self.own, self.distances, self.chain, q, asked)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, CollisionConstraint) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    @cached_property
    def _key(self) -> tuple[object, ...]:
        names = ("T_joint", "joint_is_revolute", "joint_source", "joint_scale", "joint_offset")
        chain = (np.ascontiguousarray(getattr(self.chain, name)).tobytes() for name in names)
        return self.name, self.own.digest, *chain


def labelling(constraints: Sequence[object]) -> tuple[CollisionConstraint, ...]:
    """The constraints that label samples before a sweep, in order; label k is that of the k-th, from 1."""
    return tuple(each for each in constraints if isinstance(each, CollisionConstraint))
