"""How collaborative volumes are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.results.presentation import Presentation


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """The biased volume, where no true one was asked for."""
    if document["volume_m3"].get("true") is None:
        volume = f"{document['volume_m3']['body_elemental']:.4g} m³"
        yield "body-elemental volume", f"{volume}, biased: refined_volume gives the true one of two robots"


def measured(document: Mapping[str, Any]) -> str:
    """The true volume, where it was asked for."""
    return "collaborative" if document["volume_m3"].get("true") is not None else ""


PRESENTATION = Presentation(facts=facts, measured=measured)
