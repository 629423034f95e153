"""The look that all pictures share, and how they are written."""

import textwrap
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any, Literal

import matplotlib as mpl
import matplotlib.style
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import Colormap
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from wsrender.errors import InputError
from wsrender.indices.units import pretty_unit
from wsrender.plots.shown_figure import ShownFigure

COLOR_MAP = "viridis"
INK = "#222222"
GREY = "#6b6b6b"
DPI = 200
WARNING = "#a33b00"
# Height of a line and width of a letter [in].
_TITLE, _NOTE = (0.2, 0.094), (0.135, 0.063)
_BORDER = 0.09  # above a title, above its warnings [in]

_PARAMETERS = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 9,
    "axes.labelsize": 9,
    "axes.titlesize": 10,
    "axes.edgecolor": "#888888",
    "axes.labelcolor": INK,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "text.color": INK,
    "text.parse_math": False,  # an index or robot may have any name, dollar signs included
    "grid.color": "#dddddd",
    "grid.linewidth": 0.5,
    "savefig.dpi": DPI,
    "svg.hashsalt": "wsrender",  # otherwise SVG identifiers are random
}
_LOCK = threading.RLock()


@contextmanager
def paper_style() -> Iterator[None]:
    """Matplotlib with the parameters of these pictures, whatever the user's own; also a decorator."""
    with _LOCK, matplotlib.style.context(["default", _PARAMETERS]):
        yield


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


def color_map() -> Colormap:
    """Viridis; colour-blind safe, and monotonous in print."""
    return mpl.colormaps[COLOR_MAP]


def quantity(name: str, unit: str | None) -> str:
    """Label of an axis or colour bar: ``Inverse condition number`` or ``Manipulability [m³]``."""
    text = name.replace("_", " ").strip()
    text = text[:1].upper() + text[1:]
    return text if unit in (None, "", "1", "-") else f"{text} [{pretty_unit(unit)}]"


def png(figure: Figure) -> bytes:
    """A figure as a PNG file; equal figures give equal bytes."""
    file = BytesIO()
    with paper_style():
        figure.savefig(file, format="png", metadata={"Software": None})
    return file.getvalue()


def save_figure(figure: Figure, path: str | Path) -> None:
    """Write PNG or SVG, by the name; equal figures give equal bytes. InputError for another ending."""
    path = Path(path)
    metadata = {".png": {"Software": None}, ".svg": {"Date": None, "Creator": None}}.get(path.suffix.lower())
    if metadata is None:
        raise InputError("path", f"{path.name} must end in .png or .svg")
    with paper_style():
        figure.savefig(path, metadata=metadata)
