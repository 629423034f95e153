"""Units for people."""

_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def pretty_unit(unit: str) -> str:
    """A unit of a result as people write it: ``m³`` for ``m^3``, ``1/(kg m²)`` for ``1/(kg m^2)``."""
    first, *rest = unit.split("^")
    return first + "".join(part[:1].translate(_RAISED) + part[1:] for part in rest)
