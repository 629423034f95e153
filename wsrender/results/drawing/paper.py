"""The look that all pictures share, and how they are written."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path

import matplotlib.style
from matplotlib.figure import Figure

from wsrender.errors import InputError

INK = "#222222"
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


def png(figure: Figure, dpi: float = DPI) -> bytes:
    """A figure as a PNG file of so many dots an inch; equal figures give equal bytes."""
    file = BytesIO()
    with paper_style():
        figure.savefig(file, format="png", dpi=dpi, metadata={"Software": None})
    return file.getvalue()


def save_figure(figure: Figure, path: str | Path) -> None:
    """Write PNG or SVG, by the name; equal figures give equal bytes. InputError for another ending."""
    path = Path(path)
    metadata = {".png": {"Software": None}, ".svg": {"Date": None, "Creator": None}}.get(path.suffix.lower())
    if metadata is None:
        raise InputError("path", f"{path.name} must end in .png or .svg")
    with paper_style():
        figure.savefig(path, metadata=metadata)
