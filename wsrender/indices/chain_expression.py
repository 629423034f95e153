"""Functions of the whole chain in the restricted Python that is traced: constraints and indices of users."""

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from wsrender.errors import InputError
from wsrender.indices.expression import Expression, trace
from wsrender.short_repr import short_repr

MOST_JOINTS = 200  # that a function may ask for; whether a robot has them is seen when a job is planned


class JointFrame(NamedTuple):
    """Where a joint stands in the world after its motion: x, y, z [m], and three axes of three numbers, z its own."""

    position: Any
    axes: Any


class JointLimits(NamedTuple):
    """Of n joints: of their values [rad or m], and of what they take [N m or N], infinite where there is none."""

    lower: Any
    upper: Any
    effort: Any


ASKED = ("frames", "J", "g", "limits", "M")
TIP = ("q", "position", "axes")
NEEDED = {"q": "configuration", "position": "frames", "axes": "frames", "frames": "frames"}
NEEDED |= {"J": "jacobian", "g": "gravity", "limits": "limits", "M": "inertia"}
"""What an index needs that takes these by name."""


@dataclass(frozen=True)
class Expressed:
    """A function of arithmetic and `wsrender.math` alone, of a configuration and what follows from it.

    ``function(q, position, axes, **asks, **options)``: ``q``, joint values [rad or m]; ``position``, x, y, z of the tip
    in the world [m]; ``axes``, its three axes in the world, three numbers each; the named ``options``, whose values are
    the last numbers of `Constraint.pack`, after the origin. ``asks``, of ASKED: ``frames``, a `JointFrame` of each of
    the joints; ``J``, six rows of n, linear then angular, at the tip in the world; ``g``, what the joints take to
    hold the arm against gravity, n [N m or N]; ``limits``, `JointLimits`; ``M``, the joint-space inertia, n rows of n.
    """

    function: Callable[..., Any]
    options: tuple[str, ...] = ()
    asks: tuple[str, ...] = ()

    __repr__ = short_repr

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
    return dict(zip(ASKED, (12 * joints, 6 * n, n, 3 * n, n * n), strict=True))


def _arranged(name: str, numbers: tuple[Any, ...], n: int) -> Any:
    """One of ASKED from its numbers."""
    if name == "g":
        return numbers
    width = 3 if name == "frames" else n
    rows = [numbers[k : k + width] for k in range(0, len(numbers), width)]
    if name == "frames":
        return [JointFrame(rows[k], rows[k + 1 : k + 4]) for k in range(0, len(rows), 4)]
    return rows if name in ("J", "M") else JointLimits(*rows)


def taken(function: Callable[..., Any]) -> tuple[str, ...] | None:
    """What an index's function takes by name of the chain, with its options; None: it is one of singular values.

    So it is of the chain where its first parameter is one of TIP or ASKED.
    """
    try:
        names = tuple(inspect.signature(function).parameters)
    except (TypeError, ValueError):
        return None
    return names if names[:1] and names[0] in (*TIP, *ASKED) else None


def of_index(name: str, function: Callable[..., Any], options: tuple[str, ...]) -> Expressed:
    """The function of an index ``name`` as the engine traces it. Raises InputError for a parameter that is unknown."""
    names = taken(function) or ()
    if unknown := [each for each in names if each not in (*TIP, *ASKED, *options)]:
        allowed = ", ".join((*TIP, *ASKED))
        raise InputError(
            "function", f"{name} takes {unknown[0]}, which is no option of it; a function of {allowed} may"
        )

    def value(q: Any, position: Any, axes: Any, **more: Any) -> Any:
        given = {"q": q, "position": position, "axes": axes, **more}
        return function(**{each: given[each] for each in names})

    given = tuple(each for each in options if each in names)
    return Expressed(value, given, tuple(each for each in ASKED if each in names))
