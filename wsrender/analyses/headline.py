"""The one number that an analysis is asked for, with its interval; or why there is none."""

from collections.abc import Mapping, Sequence
from typing import Any

from wsrender.volume.measure import NOT_ASKED, UNITS


def headline_of(measure: Mapping[str, Any] | None) -> dict[str, Any]:
    """The headline of a `measure_entry`; None: none was asked for."""
    if measure is None:
        return no_headline(NOT_ASKED)
    if measure["value"] is None:
        return no_headline(measure["reason"], measure["quantity"])
    return headline(measure["quantity"], measure["value"], measure["ci95"], measure["reason"])


def headline(quantity: str, value: float, ci95: Sequence[float] | None, reason: str = "") -> dict[str, Any]:
    """A measure [m³, m² or m] with its 95 % interval, or the reason why it has none, as result documents hold it."""
    return {
        "quantity": quantity,
        "value": float(value),
        "ci95": None if ci95 is None else [float(end) for end in ci95],
        "unit": UNITS[quantity],
        "reason": reason,
    }


def no_headline(reason: str, quantity: str = "volume") -> dict[str, Any]:
    """No measure, for a reason."""
    return {"quantity": quantity, "value": None, "ci95": None, "unit": UNITS[quantity], "reason": reason}
