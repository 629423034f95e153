"""Units of indices, and units for people."""

import re
from collections.abc import Callable

from wsrender.indices.dimensions import Dimension, MixedUnitsError, TaskMatrix

_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")
_EXPONENT = re.compile(r"\^(-?\d+)")
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
    """A unit of a result as people write it: ``m³`` for ``m^3``, ``1/(kg m²)`` for ``1/(kg m^2)``."""
    return _EXPONENT.sub(lambda found: found[1].translate(_RAISED), unit)
