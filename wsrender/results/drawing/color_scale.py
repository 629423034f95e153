"""Which colour stands for which value, and the bar that says so."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import matplotlib as mpl
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.colors import BoundaryNorm, Colormap, ListedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from wsrender.results.drawing.style import INK, color_map
from wsrender.results.drawing.whole import are_whole, whole_ticks

# Red and blue around grey (Moreland 2009): colour-blind safe, and 0 is told from the white of what is empty.
DIVERGING = "coolwarm"
SIGNED = "determinant"  # start of the names of indices whose sign says on which side of a singularity a pose is
MOST_STEPS = 12  # whole numbers that have a step of the bar each
_INNER = (2.0, 98.0)  # percentiles of the values that decide what an outlier is
_REACH = 1.0  # how far beyond them values are none, relative to what lies between them
_FEWEST = 10  # values among which there are outliers
_MOST_TICKS = 9
_ROUNDING = 1e-9  # of the largest value: one of the other sign below it is rounding

Extend = Literal["neither", "min", "max", "both"]


@dataclass(frozen=True, eq=False)
class ColorScale:
    """Colours of a quantity: ``norm`` and ``colors``, the bar's ``label``, its pointed ends and its ticks.

    Values beyond ``norm`` have the colour of the pointed end. ``ticks`` of None are left to matplotlib; ``names``
    stand at them instead of numbers.
    """

    norm: Normalize
    colors: Colormap
    label: str
    extend: Extend = "neither"
    ticks: Sequence[float] | MaxNLocator | None = None
    names: Sequence[str] | None = None

    @property
    def diverging(self) -> bool:
        """Whether the values have both signs: colours are those of the distance from 0 then."""
        return self.colors.name == DIVERGING

    @property
    def limits(self) -> tuple[float, float]:
        """Values at the ends of the bar."""
        low: Any = self.norm.vmin  # annotated as one number or several in matplotlib
        high: Any = self.norm.vmax
        return float(low), float(high)

    def __call__(self, values: Any) -> np.ndarray:
        """Colours (…, 4), RGBA 0 … 1, of values."""
        return np.asarray(self.colors(self.norm(values)))

    def places(self, values: Any) -> np.ndarray:
        """Where values stand along the colours, 0 … 1; those beyond an end stand at it."""
        found = np.asarray(self.norm(values), np.float64)
        return (found / max(self.colors.N - 1, 1) if isinstance(self.norm, BoundaryNorm) else found).clip(0, 1)

    def add_bar(self, figure: Figure, **place: Any) -> Colorbar:
        """The bar, placed by the arguments of ``Figure.colorbar``; a line marks 0 between the signs."""
        mappable = ScalarMappable(self.norm, self.colors)
        bar = figure.colorbar(mappable, extend=self.extend, extendfrac=0.04, ticks=self.ticks, **place)
        bar.set_label(self.label)
        if self.names is not None:
            bar.set_ticklabels(self.names)
        bar.outline.set_visible(False)
        bar.minorticks_off()
        if self.diverging:
            bar.ax.axhline(0.0, color=INK, lw=1.0)
        if self.extend != "neither":
            ends = {"min": "below", "max": "above", "both": "beyond"}
            bar.ax.set_title(f"outliers\n{ends[self.extend]}", fontsize=7, pad=4)
        return bar


def color_scale(values: np.ndarray, label: str, signed: bool = False) -> ColorScale:
    """The scale of values; NaN count for nothing. ``signed`` values have 0 in the middle even if all are of one sign.

    Whole numbers, up to twelve, have a step of the bar each. Values of both signs are drawn in two colours, equally far
    to either side of 0. Limits are the least and the largest value that is no outlier: that lies no further from the
    middle 96 % of the values than these are wide.
    """
    known = np.asarray(values, np.float64).ravel()
    known = known[np.isfinite(known)]
    low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 1.0)
    ticks = whole_ticks(_MOST_TICKS) if are_whole(known) else None
    if ticks and not signed and high - low < MOST_STEPS:
        return _steps(np.arange(low, high + 1), label)
    if high - low <= _ROUNDING * max(abs(low), abs(high)):
        return _steps(np.array([low]), label)
    lower, upper = _without_outliers(known)
    if signed or (low < -_ROUNDING * high and high > _ROUNDING * -low):
        size = max(-lower, upper)
        return ColorScale(
            Normalize(-size, size), mpl.colormaps[DIVERGING], label, _ends(low < -size, high > size), ticks
        )
    return ColorScale(Normalize(lower, upper), color_map(), label, _ends(low < lower, high > upper), ticks)


def _steps(levels: np.ndarray, label: str) -> ColorScale:
    """A step of the bar for each level; one alone is a bar of one colour."""
    half = 0.5 if len(levels) > 1 or levels[0] == 0 else 0.5 * abs(levels[0])
    edges = np.append(levels - half, levels[-1] + half)
    colors = ListedColormap(color_map()(np.linspace(0.1, 0.95, len(levels)) if len(levels) > 1 else [0.35]))
    return ColorScale(BoundaryNorm(edges.tolist(), len(levels)), colors, label, ticks=levels.tolist())


def _without_outliers(known: np.ndarray) -> tuple[float, float]:
    """The least and the largest of the sorted-out values."""
    if len(known) < _FEWEST:
        return float(known.min()), float(known.max())
    # At least one value lies beyond each percentile, however few there are.
    inner_low = float(np.percentile(known, _INNER[0], method="higher"))
    inner_high = float(np.percentile(known, _INNER[1], method="lower"))
    span = inner_high - inner_low
    if span <= 0:
        return float(known.min()), float(known.max())
    kept = known[(known >= inner_low - _REACH * span) & (known <= inner_high + _REACH * span)]
    return float(kept.min()), float(kept.max())


def _ends(below: bool, above: bool) -> Extend:
    return "both" if below and above else "min" if below else "max" if above else "neither"
