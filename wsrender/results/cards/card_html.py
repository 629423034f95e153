"""A card: what a notebook shows of an object where nothing can be turned, and above what can."""

import base64
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from html import escape
from typing import Any

from wsrender.errors import MissingExtraError
from wsrender.results.report import ShownPicture
from wsrender.short_repr import short_repr

# Every style stands with its element: pages that show notebooks leave style sheets out. Colours are the page's own.
_CARD = "max-width:60rem;line-height:1.4"
_TITLE = "font-weight:600"
_HEADLINE = "font-size:1.15em;font-weight:600;margin:.25em 0"
_WARNING = "border-left:.3em solid #e0a000;padding:.1em .7em;margin:.3em 0;background:rgba(224,160,0,.12)"
_NOTE = "opacity:.7;font-size:.9em"
_FIGURES = "display:flex;flex-wrap:wrap;gap:1em;align-items:flex-start;margin:.5em 0"
_FIGURE = ("margin:0;flex:1 1 18rem;max-width:28rem", "margin:0;flex:1 1 100%")  # and of a wide one
_IMAGE = "width:100%;height:auto;background:#fff"
_TABLES = "overflow-x:auto"


@dataclass(frozen=True)
class Card:
    """What is known of an object at a glance.

    ``headlines`` stand large, ``warnings`` marked; ``facts`` are lines, name and text; ``tables`` HTML that is safe;
    ``share`` is how much of something is done, 0 … 1. ``pictures`` are drawn when the card is shown; where what draws
    them is not installed a line says so.
    """

    title: str
    headlines: Sequence[str] = ()
    warnings: Sequence[str] = ()
    facts: Mapping[str, str] = field(default_factory=dict)
    tables: Sequence[str] = ()
    share: float | None = None
    pictures: Sequence[Callable[[], ShownPicture]] = ()

    __repr__ = short_repr

    def html(self) -> str:
        """The card as a piece of a page; everything is escaped, and nothing is fetched."""
        lines = [f'<div style="{_TITLE}">{escape(self.title)}</div>']
        lines += [f'<div style="{_HEADLINE}">{escape(text)}</div>' for text in self.headlines]
        lines += [f'<div style="{_WARNING}">{escape(text)}</div>' for text in self.warnings]
        if self.share is not None:
            lines.append(f'<progress max="1" value="{self.share:.4f}" style="width:20em"></progress>')
        if self.facts:
            rows = "".join(
                f'<tr><td style="text-align:left;{_NOTE}">{escape(name)}</td>'
                f'<td style="text-align:left">{escape(text)}</td></tr>'
                for name, text in self.facts.items()
            )
            lines.append(f'<table style="margin:.3em 0">{rows}</table>')
        lines += [f'<div style="{_TABLES}">{table}</div>' for table in self.tables]
        return f'<div class="wsrender-card" style="{_CARD}">{"".join(lines)}{self.figures}</div>'

    def bundle(self, text: str) -> dict[str, Any]:
        """As Jupyter takes it: the card, and ``text`` for a page without HTML."""
        return {"text/plain": text, "text/html": self.html()}

    @cached_property
    def figures(self) -> str:
        """Its pictures in HTML, drawn when they are first asked for."""
        drawn: list[str] = []
        try:
            drawn += [_figure(picture()) for picture in self.pictures]
        except MissingExtraError as error:
            return f'<div style="{_NOTE}">Pictures are left out: {escape(str(error))}</div>'
        return f'<div style="{_FIGURES}">{"".join(drawn)}</div>' if drawn else ""


def _figure(picture: ShownPicture) -> str:
    source = f"data:image/png;base64,{base64.b64encode(picture.png).decode()}"
    caption = escape(picture.caption)
    image = f'<img alt="{caption}" src="{source}" style="{_IMAGE}">'
    below = f'<figcaption style="{_NOTE}">{caption}</figcaption>'
    return f'<figure style="{_FIGURE[picture.is_wide]}">{image}{below}</figure>'
