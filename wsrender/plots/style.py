"""The look that all pictures share, and how they are written."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any, Literal

import matplotlib as mpl
import matplotlib.style
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, Normalize
from matplotlib.figure import Figure

from wsrender.errors import InputError
from wsrender.indices.units import pretty_unit
from wsrender.plots.shown_figure import ShownFigure

COLOR_MAP = "viridis"
INK = "#222222"
GREY = "#6b6b6b"
DPI = 200

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


def new_figure(width: float, height: float, layout: Literal["constrained"] | None = "constrained") -> Figure:
    """An empty figure of that size [in] which can be drawn without a display."""
    figure = ShownFigure(figsize=(width, height), layout=layout, dpi=100)
    FigureCanvasAgg(figure)
    return figure


def color_map() -> Colormap:
    """Viridis; colour-blind safe, and monotonous in print."""
    return mpl.colormaps[COLOR_MAP]


def quantity(name: str, unit: str | None) -> str:
    """Label of an axis or colour bar: ``Inverse condition number`` or ``Manipulability [m³]``."""
    text = name.replace("_", " ").strip()
    text = text[:1].upper() + text[1:]
    return text if unit in (None, "", "1", "-") else f"{text} [{pretty_unit(unit)}]"


def value_range(lowest: float, highest: float) -> Normalize:
    """Colours from the lowest to the highest value; widened where they are equal."""
    if highest > lowest:
        return Normalize(lowest, highest)
    return Normalize(lowest - 0.5, lowest + 0.5) if lowest else Normalize(0, 1)


def add_color_bar(figure: Figure, norm: Normalize, label: str, **place: Any) -> None:
    """A colour bar with its label and unit, placed by the arguments of ``Figure.colorbar``."""
    bar = figure.colorbar(ScalarMappable(norm, color_map()), **place)
    bar.set_label(label)
    bar.outline.set_visible(False)


def add_title(figure: Figure, title: str) -> None:
    """What robot and samples the figure shows, above all axes."""
    if title:
        figure.suptitle(title, fontsize=11, y=0.98 if figure.get_layout_engine() is None else None)


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
