"""What of a result document two equal runs on one host have in common."""

from collections.abc import Mapping
from typing import Any


def lasting(document: Mapping[str, Any]) -> dict[str, Any]:
    """A document without its seconds, date and command."""
    origin = {name: value for name, value in document["provenance"].items() if name != "run"}
    return {name: value for name, value in document.items() if name != "timing_s"} | {"provenance": origin}
