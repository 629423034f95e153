"""SRDF: which links of a robot need not be tested against each other."""

from xml.etree.ElementTree import Element

from wsrender.errors import ModelError
from wsrender.robots import xml_source

_FIELD = "srdf"


def disabled_pairs(text: str | bytes) -> tuple[tuple[str, str], ...]:
    """Pairs of links that ``<disable_collisions>`` names. Raises ModelError for text that is no SRDF, or says more."""
    root = xml_source.parse(text, _FIELD)
    if root.tag != "robot":
        raise ModelError(_FIELD, f"the root element is <{root.tag}>; <robot> is needed")
    if root.find("disable_default_collisions") is not None:
        raise ModelError(_FIELD, "<disable_default_collisions> is not supported: name the pairs, <disable_collisions>")
    return tuple(_pair(element) for element in root.findall("disable_collisions"))


def _pair(element: Element) -> tuple[str, str]:
    first, second = element.get("link1", ""), element.get("link2", "")
    if not (first and second):
        raise ModelError(_FIELD, "a <disable_collisions> has no link1 or no link2")
    return first, second
