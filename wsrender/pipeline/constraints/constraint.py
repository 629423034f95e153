"""What a constraint is: a name, a device function or an expression, and a float64 twin of it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, Protocol, runtime_checkable

import numpy as np

from wsrender.indices.expression import Expression, trace
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


class Frame(NamedTuple):
    """Where a joint stands in the world after its motion: x, y, z [m], and three axes of three numbers, z its own."""

    position: Any
    axes: Any


class JointLimits(NamedTuple):
    """Of n joints: of their values [rad or m], and of what they take [N m or N], infinite where there is none."""

    lower: Any
    upper: Any
    effort: Any


ASKED = ("frames", "J", "g", "limits")


@dataclass(frozen=True)
class Expressed:
    """A function of arithmetic and `wsrender.math` alone: a configuration is admitted where it is 0 or more.

    ``function(q, position, axes, **asks, **options)``: ``q``, joint values [rad or m]; ``position``, x, y, z of the tip
    in the world [m]; ``axes``, its three axes in the world, three numbers each; the named ``options``, whose values are
    the last numbers of `Constraint.pack`, after the origin. ``asks``, of ASKED: ``frames``, a `Frame` of each of the
    chain's joints; ``J``, six rows of n, linear then angular, at the tip in the world; ``g``, what the joints take to
    hold the arm against gravity, n [N m or N]; ``limits``, `JointLimits`.
    """

    function: Callable[..., Any]
    options: tuple[str, ...] = ()
    asks: tuple[str, ...] = ()

    def traced(self, n: int, joints: int) -> Expression | float:
        """The function for ``n`` joint values, of inputs q, position, axes, options, asks, one after the other.

        Raises InputError where it takes a joint beyond them, TypeError for what cannot be traced.
        """
        return trace(self._of, self.inputs(n, joints), n, joints)

    def inputs(self, n: int, joints: int) -> int:
        """How many inputs there are; a chain may have more joints than values."""
        return n + 12 + len(self.options) + sum(_sizes(n, joints)[name] for name in self.asks)

    def _of(self, inputs: tuple[Any, ...], n: int, joints: int) -> Any:
        axes = [inputs[n + 3 + 3 * k : n + 6 + 3 * k] for k in range(3)]
        at, sizes = n + 12 + len(self.options), _sizes(n, joints)
        options, more = dict(zip(self.options, inputs[n + 12 : at], strict=True)), dict[str, Any]()
        for name in self.asks:
            more[name] = _arranged(name, inputs[at : at + sizes[name]], n)
            at += sizes[name]
        return self.function(inputs[:n], inputs[n : n + 3], axes, **more, **options)


def _sizes(n: int, joints: int) -> dict[str, int]:
    return dict(zip(ASKED, (12 * joints, 6 * n, n, 3 * n), strict=True))


def _arranged(name: str, numbers: tuple[Any, ...], n: int) -> Any:
    """One of ASKED from its numbers."""
    if name == "g":
        return numbers
    width = 3 if name == "frames" else n
    rows = [numbers[k : k + width] for k in range(0, len(numbers), width)]
    if name == "frames":
        return [Frame(rows[k], rows[k + 1 : k + 4]) for k in range(0, len(rows), 4)]
    return rows if name == "J" else JointLimits(*rows)


def asks_for_chain(constraint: Constraint) -> bool:
    """Whether a constraint asks for more of the chain than where its tip is."""
    device = constraint.device
    return isinstance(device, OfChain) or (isinstance(device, Expressed) and bool(device.asks))


def in_order(constraints: "tuple[Constraint, ...]") -> "tuple[Constraint, ...]":
    """Constraints in the order in which they are asked, those of ORDER first, then by name."""
    return tuple(sorted(constraints, key=lambda each: (_place(each.name), each.name)))


def _place(name: str) -> int:
    return ORDER.index(name) if name in ORDER else len(ORDER)
