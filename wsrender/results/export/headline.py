"""The headline and the warnings of a result document in words, the same in every door."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.indices.units import pretty_unit
from wsrender.notices import Notice
from wsrender.results.presentation import REACHABLE, presentation_of
from wsrender.volume.measure import NOT_ASKED

ROUNDING = 1e-12  # width of an interval, relative to the value, that is but rounding
_SCIENTIFIC = 1e-4  # below: 1.23e-05 rather than 0.0000123


def headline_lines(document: Mapping[str, Any]) -> list[str]:
    """``reachable volume 3.80 m³ (95 %: 3.78 … 3.83)``, or why there is none, `headline_text`; none in results of 0.1.

    Of an analysis that measures no workspace its facts, such as ``reachable targets: 97``. Those of several robots
    follow under their names where they have one, or stand alone where each is measured.
    """
    presentation, found = presentation_of(document), document.get("headline")
    whose = presentation.measures(document)
    if not found:
        return []
    if not whose:
        return [f"{name}: {text}" for name, text in presentation.facts(document)]
    together = whose != REACHABLE
    robots = [robot for robot in document.get("robots") or () if robot.get("headline")]
    each = [robot for robot in robots if not together or robot["headline"]["value"] is not None]
    lines = [] if each and found["value"] is None else [headline_text(found, _free(document) or whose)]
    own = [headline_text(robot["headline"], _free(robot) or REACHABLE) for robot in each]
    return lines + [f"{robot.get('name')}: {text}" for robot, text in zip(each, own, strict=True)]


def _free(entries: Mapping[str, Any]) -> str:
    """What the headline of a robot measures under constraints that may block what it reaches; "" of any other."""
    headline = entries["headline"]
    return "free" if "free" in (entries.get(f"{headline['quantity']}_{headline['unit']}") or {}) else ""


def headline_text(headline: Mapping[str, Any], whose: str = REACHABLE) -> str:
    """One headline: three digits at least, and as many decimals as the half width of its interval starts with.

    Where it has no value, ``no volume: <reason>``; where it was not asked for, ``no refined reachable volume: …``.
    """
    quantity, value, interval = headline["quantity"], headline["value"], headline.get("ci95")
    if value is None and headline["reason"] == NOT_ASKED:
        return f"no refined {whose} {quantity}: none was asked for by refined_volume"
    if value is None:
        return f"no {quantity}: {headline['reason']}"
    unit, reason = pretty_unit(headline["unit"]), f"; {headline['reason']}" if headline.get("reason") else ""
    if not interval or interval[1] - interval[0] <= ROUNDING * abs(value):
        return f"{whose} {quantity} {value:.6g} {unit}{' (exact)' if interval else ''}{reason}"
    decimals = math.ceil(-math.log10((interval[1] - interval[0]) / 2))
    decimals = max(decimals, 2 - math.floor(math.log10(abs(value)))) if value else decimals
    low, high = (_rounded(end, decimals) for end in interval)
    return f"{whose} {quantity} {_rounded(value, decimals)} {unit} (95 %: {low} … {high}){reason}"


def warning_lines(document: Mapping[str, Any]) -> list[str]:
    """Every warning: what was found, what to do about it, and the field that decides it."""
    return [warning_text(entry) for entry in document.get("warnings") or ()]


def warning_text(entry: Mapping[str, Any]) -> str:
    """One entry of ``warnings``."""
    field = f" (field {entry['field']})" if entry.get("field") else ""
    return f"{Notice(entry['code'], entry['message'], entry.get('remedy') or '')}{field}"


def _rounded(value: float, decimals: int) -> str:
    """A number with that many decimals, at least none; small ones with a power of ten."""
    if 0 < abs(value) < _SCIENTIFIC:
        return f"{value:.{max(decimals + math.floor(math.log10(abs(value))), 0)}e}"
    return f"{value:.{max(decimals, 0)}f}"


def head_lines(document: Mapping[str, Any]) -> Iterator[str]:
    """Headline and warnings, one a line: what is read first."""
    yield from headline_lines(document)
    yield from (f"warning: {text}" for text in warning_lines(document))
