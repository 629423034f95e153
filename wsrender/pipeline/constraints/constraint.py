"""What a constraint is: a name, a device function or an expression, and a float64 twin of it."""

from dataclasses import dataclass
from typing import Any, Literal, Protocol, runtime_checkable

import numpy as np

from wsrender.indices.chain_expression import Expressed
from wsrender.robots.chain import Chain
from wsrender.robots.kinematics import Kinematics

Structure = Literal["base_joint", "trailing_joints"]
"""What a grid repeats: every level of the first joint, and of last joints whose axes pass through the tip."""
STRUCTURES: tuple[Structure, ...] = ("base_joint", "trailing_joints")

ORDER = ("region", "leg_distance", "orientation", "environment", "self_collision", "torque", "arms_collision")
"""The first that a configuration violates is the reason why it is rejected; others follow by name."""

LABELLED = "labelled"
"""Device side of constraints that label samples before the sweep."""


@runtime_checkable
class Constraint(Protocol):
    """Which configurations of a chain, or of a mechanism's legs, are admitted. A constraint is frozen and hashable.

    ``name`` is the reason in labels, tables and pictures; ``keeps`` the structure of a grid that survives: joints that
    change nothing in the answer.
    """

    @property
    def name(self) -> str:
        """The reason why it rejects."""
        ...

    @property
    def keeps(self) -> frozenset[Structure]:
        """Structure of a grid that survives it."""
        ...

    def pack(self, chain: Kinematics, origin: np.ndarray, precision: str) -> np.ndarray:
        """Its numbers (D,) float64, of positions in a ``precision`` counted from ``origin`` (3,) in the world [m]."""
        ...

    @property
    def device(self) -> "str | OfChain | Expressed":
        """A module of ``wsrender_kernels.constraints``, also of the whole chain, or the function that is traced."""
        ...

    def host(self, q: np.ndarray, frames: np.ndarray) -> np.ndarray:
        """Which configurations (N, n) [rad or m] violate it, (N,) int8: 0 or 1.

        ``frames``: tip poses (N, 4, 4) in the world; of a mechanism both ends of its links (N, n, 2, 3) [m].
        """
        ...


@dataclass(frozen=True)
class OfChain:
    """A module of ``wsrender_kernels.constraints`` that asks for the whole chain, and its choices.

    ``chain``: has the joints of the robot's `Chain.dynamic`; its bodies are the last numbers of the constraint.
    """

    module: str
    choices: tuple[Any, ...]
    chain: Chain


def asks_for_chain(constraint: Constraint) -> bool:
    """Whether a constraint asks for more of the chain than where its tip is."""
    device = constraint.device
    return isinstance(device, OfChain) or (isinstance(device, Expressed) and bool(device.asks))


def in_order(constraints: "tuple[Constraint, ...]") -> "tuple[Constraint, ...]":
    """Constraints in the order in which they are asked, those of ORDER first, then by name."""
    return tuple(sorted(constraints, key=lambda each: (_place(each.name), each.name)))


def _place(name: str) -> int:
    return ORDER.index(name) if name in ORDER else len(ORDER)
