"""Names as people read them, without matplotlib."""

from wsrender.indices.units import pretty_unit


def said(*names: str) -> str:
    """Names in one line: ``Maximum manipulability``."""
    text = " ".join(name.replace("_", " ").strip() for name in names if name)
    return text[:1].upper() + text[1:]


def unit_said(unit: str | None) -> str:
    """A unit as people write it; nothing where there is none."""
    return "" if unit in (None, "", "1") else pretty_unit(str(unit))
