"""What a constraint is: a name, a device function or an expression, and a float64 twin of it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, Protocol, runtime_checkable

import numpy as np

from wsrender.robots.kinematics import Kinematics

Structure = Literal["base_joint", "trailing_joints"]
"""What a grid repeats: every level of the first joint, and of last joints whose axes pass through the tip."""
STRUCTURES: tuple[Structure, ...] = ("base_joint", "trailing_joints")

ADMITTED, VIOLATED, OPEN = 0, 1, 2
ORDER = ("region", "leg_distance", "orientation", "environment", "self_collision", "torque")
"""The first that a configuration violates is the reason why it is rejected; others follow by name."""


@runtime_checkable
class Constraint(Protocol):
    """Which configurations of a chain are admitted. A constraint is frozen and hashable.

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

    def pack(self, chain: Kinematics, origin: np.ndarray) -> np.ndarray:
        """Its numbers (D,) float64, of positions counted from ``origin`` (3,) in the world [m]."""
        ...

    @property
    def device(self) -> "str | Expressed":
        """A module of ``wsrender_kernels.constraints``, or the function that the engine traces."""
        ...

    def host(self, q: np.ndarray, poses: np.ndarray) -> np.ndarray:
        """ADMITTED or VIOLATED of configurations (N, n) [rad or m] with tip poses (N, 4, 4) in the world, (N,) int8."""
        ...


@dataclass(frozen=True)
class Expressed:
    """A function of arithmetic and `wsrender.math` alone: a configuration is admitted where it is 0 or more.

    ``function(q, position, axes, **options)``: ``q``, joint values [rad or m]; ``position``, x, y, z of the tip in the
    world [m]; ``axes``, its three axes in the world, three numbers each; the named ``options``, whose values are the
    last numbers of `Constraint.pack`, after the origin.
    """

    function: Callable[..., Any]
    options: tuple[str, ...] = ()


def in_order(constraints: "tuple[Constraint, ...]") -> "tuple[Constraint, ...]":
    """Constraints in the order in which they are asked, those of ORDER first, then by name."""
    return tuple(sorted(constraints, key=lambda each: (_place(each.name), each.name)))


def _place(name: str) -> int:
    return ORDER.index(name) if name in ORDER else len(ORDER)
