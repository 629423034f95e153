"""What notebooks show of robots, results, volumes, tables, maps and boundaries: a card, and what can be turned."""

from dataclasses import replace
from typing import Any

from wsrender.results.cards.card_html import Card
from wsrender.results.cards.subjects import card_of
from wsrender.robot import Robot
from wsrender.window import in_widget

__all__ = ["Card", "card_of", "mime_bundle"]


def mime_bundle(what: Any) -> dict[str, Any]:
    """What a notebook shows: the card, and in that of a robot or a result the viewer.

    Where the widgets' package is missing, or the notebook is looked at without a kernel, there is the card alone.
    """
    card = card_of(what)
    bundle = card.bundle(repr(what))
    return bundle | _turned(what, card) if hasattr(what, "view") else bundle


def _turned(what: Any, card: Card) -> dict[str, Any]:
    """The widget: what the card says, the viewer, then pictures; nothing where there can be none."""
    try:
        from ipywidgets import HTML, VBox

        parts = [HTML(replace(card, pictures=()).html()), in_widget(what)]
    except ImportError:  # MissingExtraError is one
        return {}
    if not isinstance(what, Robot):  # whose picture is in the viewer
        parts.append(HTML(card.figures))
    bundle = VBox(parts)._repr_mimebundle_() or {}
    return {kind: data for kind, data in bundle.items() if kind not in ("text/plain", "text/html")}
