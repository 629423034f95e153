"""Units of task matrices: of their rows, columns, singular values and volumes; and of indices, also for people."""

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import reduce
from operator import mul

import numpy as np

LINEAR_ROWS, ALL_ROWS = (0, 1, 2), (0, 1, 2, 3, 4, 5)


@dataclass(frozen=True)
class Dimension:
    """A product of powers of kilogram, metre and second; radians are left out."""

    kg: Fraction = Fraction(0)
    m: Fraction = Fraction(0)
    s: Fraction = Fraction(0)

    def __mul__(self, other: "Dimension") -> "Dimension":
        return Dimension(self.kg + other.kg, self.m + other.m, self.s + other.s)

    def __pow__(self, exponent: int | Fraction) -> "Dimension":
        return Dimension(self.kg * exponent, self.m * exponent, self.s * exponent)

    def __truediv__(self, other: "Dimension") -> "Dimension":
        return self * other**-1

    def __str__(self) -> str:
        """As results write it: ``m^3``, ``m^(2/3)``, ``1/(kg m)``, ``1``."""
        powers = {"kg": self.kg, "m": self.m, "s": self.s}
        above = [_power(unit, power) for unit, power in powers.items() if power > 0]
        below = [_power(unit, -power) for unit, power in powers.items() if power < 0]
        text = " ".join(above) or "1"
        if not below:
            return text
        return f"{text}/{below[0]}" if len(below) == 1 else f"{text}/({' '.join(below)})"


def _power(unit: str, power: Fraction) -> str:
    if power == 1:
        return unit
    return f"{unit}^{power}" if power.denominator == 1 else f"{unit}^({power})"


ONE, KILOGRAM = Dimension(), Dimension(kg=Fraction(1))
METRE, SECOND = Dimension(m=Fraction(1)), Dimension(s=Fraction(1))


class MixedUnitsError(Exception):
    """What is asked for has no unit: it mixes some, of which one says nothing of the other."""

    def __init__(self, units: Iterable[Dimension]):
        self.units = sorted(dict.fromkeys(units), key=lambda d: (d.kg, d.m, d.s), reverse=True)
        super().__init__(f"mixed ({', '.join(map(str, self.units))})")


@dataclass(frozen=True)
class TaskMatrix:
    """Units of the matrix whose singular values an index is a function of, and of √det H, in ``m`` rows of n joints.

    ``entries``: units of the entries that are not 0. An entry (i, j) of the matrix of √det H is in ``rows[i]
    columns[j]``; ``columns`` are those that are not 0.
    """

    m: int
    n: int
    entries: frozenset[Dimension]
    rows: tuple[Dimension, ...]
    columns: tuple[Dimension, ...]

    @property
    def value(self) -> Dimension:
        """Unit of a singular value; raises MixedUnitsError where entries have different ones."""
        if len(self.entries) > 1:
            raise MixedUnitsError(self.entries)
        return next(iter(self.entries))

    @property
    def ratio(self) -> Dimension:
        """Unit of a quotient of two singular values; raises MixedUnitsError. A single one has no other."""
        return ONE if self.m == 1 else self.value**0

    @property
    def volume(self) -> Dimension:
        """Unit of √det H, the product of the singular values; raises MixedUnitsError.

        By Cauchy and Binet det H is a sum over choices of m columns: their units must be equal, or the choice one.
        """
        if len(set(self.columns)) == 1:
            return reduce(mul, self.rows) * self.columns[0] ** len(self.rows)
        if len(self.columns) == len(self.rows):
            return reduce(mul, (*self.rows, *self.columns))
        raise MixedUnitsError(self.entries)


def task_matrix(
    rows: Sequence[int],
    revolute: Sequence[bool],
    *,
    dynamic: bool = False,
    convention: str = "standard",
    torque_scaling: bool = False,
    nonzero: np.ndarray | None = None,
) -> TaskMatrix:
    """Units of the matrix of task rows 0…5 (x y z rx ry rz) of an arm whose joints are ``revolute`` (n,), or slide.

    A task that mixes linear and angular rows has its linear ones divided by a length. ``nonzero`` (6, n) bool: the
    entries of J that have a value; None: all.
    """
    joints = [ONE if turns else METRE for turns in revolute]
    if convention == "wsrender_code":
        return _code_matrix(joints, dynamic, nonzero)
    divided = min(rows) < 3 <= max(rows)
    units = [METRE if row < 3 and not divided else ONE for row in rows]
    if not dynamic:
        return _matrix(units, [ONE / q for q in joints], _held(nonzero, rows, len(joints)))
    torques = [ONE if torque_scaling else KILOGRAM * METRE**2 / SECOND**2 / q for q in joints]
    return _matrix([unit / SECOND**2 for unit in units], [ONE / t for t in torques], _held(None, rows, len(joints)))


def _code_matrix(joints: list[Dimension], dynamic: bool, nonzero: np.ndarray | None) -> TaskMatrix:
    """All rows of J and the volume of its linear rows; dynamic: all rows of J M, M in kg m² over two joints' units."""
    units, n = [METRE] * 3 + [ONE] * 3, len(joints)
    if not dynamic:
        whole = _matrix(units, [ONE / q for q in joints], _held(nonzero, ALL_ROWS, n))
        linear = _matrix(units[:3], [ONE / q for q in joints], _held(nonzero, LINEAR_ROWS, n))
        return replace(whole, rows=linear.rows, columns=linear.columns)
    entries = {row * KILOGRAM * METRE**2 / (i**2 * j) for row in units for i in joints for j in joints}
    volume = _matrix(units, [KILOGRAM * METRE**2 / q**3 for q in joints], _held(None, ALL_ROWS, n))
    return replace(volume, entries=frozenset(entries))


def _held(nonzero: np.ndarray | None, rows: Sequence[int], n: int) -> np.ndarray:
    """Which entries (m, n) count: those that are not 0, or all where none is known."""
    found = np.ones((len(rows), n), bool) if nonzero is None else nonzero[list(rows)]
    return found if found.any() else np.ones_like(found)


def _matrix(rows: list[Dimension], columns: list[Dimension], held: np.ndarray) -> TaskMatrix:
    entries = frozenset(rows[i] * columns[j] for i, j in np.argwhere(held))
    kept = tuple(columns[j] for j in np.flatnonzero(held.any(axis=0)))
    return TaskMatrix(len(rows), len(columns), entries, tuple(rows), kept)


_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")
_EXPONENT = re.compile(r"\^(-?\d+)|(?<=\bm)(\d)\b")
_DEGREES = re.compile(r"\bdeg\b")
UnitRule = Callable[[TaskMatrix], Dimension]
"""An index's unit from those of the task matrix, such as ``lambda A: A.value``, that of a singular value."""


def unit_text(unit: str | UnitRule, matrix: TaskMatrix) -> str:
    """The unit of an index as results write it: ``m^3``, ``1/(kg m)``, ``1``.

    ``mixed (m, 1)`` where the index mixes entries of the matrix in these units, as those of joints that turn and of
    joints that slide: it has no unit, and its values change otherwise than by a factor with the unit of length.
    """
    if isinstance(unit, str):
        return unit
    try:
        return str(unit(matrix))
    except MixedUnitsError as mixed:
        return str(mixed)


def pretty_unit(unit: str) -> str:
    """A unit of a result as people write it, the same everywhere: ``m³`` for ``m^3``, ``°`` for ``deg``.

    Documents have the unit of a measure as in the names of their fields, ``m3`` as in ``volume_m3``: ``m³`` too.
    """
    return _DEGREES.sub("°", _EXPONENT.sub(lambda found: (found[1] or found[2]).translate(_RAISED), unit))
