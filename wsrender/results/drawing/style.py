"""The figures that all pictures are drawn into, their headings and their words."""

import textwrap
from dataclasses import dataclass
from typing import Any, Literal

import matplotlib as mpl
import matplotlib.style
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import Colormap
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from wsrender.indices.units import pretty_unit
from wsrender.results.drawing.paper import DPI as DPI
from wsrender.results.drawing.paper import INK as INK
from wsrender.results.drawing.paper import paper_style as paper_style
from wsrender.results.drawing.shown_figure import ShownFigure

COLOR_MAP = "viridis"
GREY = "#6b6b6b"
WARNING = "#a33b00"
# Height of a line and width of a letter [in].
_TITLE, _NOTE = (0.2, 0.094), (0.135, 0.063)
_BORDER = 0.09  # above a title, above its warnings [in]


@dataclass(frozen=True)
class Heading:
    """What stands above a picture: its title, and the warnings that concern it, each a line or two below."""

    title: str = ""
    warnings: tuple[str, ...] = ()


def new_figure(
    width: float, height: float, heading: Heading | str = "", layout: Literal["constrained"] | None = "constrained"
) -> Figure:
    """A figure which can be drawn without a display, empty but for its heading.

    The axes have ``width`` and ``height`` [in] from its lower left; the heading stands above.
    """
    heading = Heading(heading) if isinstance(heading, str) else heading
    title = textwrap.wrap(heading.title, int(width / _TITLE[1])) if heading.title else []
    notes = [line for text in heading.warnings for line in _warning_lines(text, int(width / _NOTE[1]))]
    band = sum(_BORDER for lines in (title, notes) if lines) + _TITLE[0] * len(title) + _NOTE[0] * len(notes)
    figure = ShownFigure(figsize=(width, height + band), layout=layout, dpi=100)
    FigureCanvasAgg(figure)
    whole = height + band
    if title:
        # Not part of the layout, which would leave room for it a second time.
        figure.suptitle("\n".join(title), fontsize=11, y=1 - _BORDER / whole, va="top").set_in_layout(False)
    if notes:
        above = whole - (band - _NOTE[0] * len(notes) - _BORDER / 2)
        place: dict[str, Any] = {"ha": "center", "va": "top", "fontsize": 7.5, "color": WARNING, "linespacing": 1.25}
        figure.text(0.5, above / whole, "\n".join(notes), **place).set_in_layout(False)
    if isinstance(engine := figure.get_layout_engine(), ConstrainedLayoutEngine):
        engine.set(rect=(0, 0, 1, height / whole))
    return figure


def _warning_lines(text: str, letters: int) -> list[str]:
    """At most two lines of a warning."""
    return textwrap.wrap(f"Warning: {text}", letters, max_lines=2, placeholder=" …")


def three_digits(value: float) -> str:
    """A number with three significant digits, large ones with commas and without a power of ten."""
    return f"{float(f'{value:.3g}'):,.15g}".replace("-", "−")


def color_map() -> Colormap:
    """Viridis; colour-blind safe, and monotonous in print."""
    return mpl.colormaps[COLOR_MAP]


def quantity(name: str, unit: str | None) -> str:
    """Label of an axis or colour bar: ``Inverse condition number``, ``Manipulability [m³]``, or a symbol, ``x [m]``."""
    text = name.replace("_", " ").strip()
    text = text if len(text) == 1 else text[:1].upper() + text[1:]
    return text if unit in (None, "", "1", "-") else f"{text} [{pretty_unit(unit)}]"
