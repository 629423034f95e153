"""How the values of each index are spread over the samples."""

import csv
from collections.abc import Iterable
from pathlib import Path
from typing import Any, TextIO

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, MaxNLocator

from wsrender.errors import InputError
from wsrender.results.drawing.cloud import checked_index
from wsrender.results.drawing.style import GREY, INK, Heading, color_map, new_figure, paper_style, quantity
from wsrender.results.drawing.whole import ticks
from wsrender.volume.distribution_map import DistributionMap

BINS = 50
FEWEST_BINS, PER_BIN = 5, 10  # bins of few samples, and samples for each of which there is one more
_MEAN: dict[str, Any] = {"color": INK, "lw": 0.9, "ls": (0, (4, 2))}
WIDTH = 36  # characters of a label below a panel
ROUNDING = 1e-9  # of the values: a spread below it is that of their computation, and too small for 50 intervals


@paper_style()
def histogram(samples: DistributionMap, index: str | None = None, *, title: Heading | str = "") -> Figure:
    """Share of the samples per interval of an index, one panel per index of the map by default.

    The dashed line marks the mean. Raises InputError for an unknown index, or a map without indices or rows.
    """
    if not samples.indices or len(samples) == 0:
        raise InputError("index", "the map holds no values of an index, so there is nothing to draw")
    names = list(samples.indices) if index is None else [checked_index(samples, index)]
    columns = min(len(names), 3)
    rows = -(-len(names) // columns)
    figure = new_figure(max(3.1 * columns, 4.6), max(2.3 * rows, 2.8) + 0.2, title)
    panels = figure.subplots(rows, columns, squeeze=False)
    for axes in panels.flat[len(names) :]:
        axes.set_visible(False)
    for axes, name in zip(panels.flat, names, strict=False):
        _draw(axes, samples.indices[name])
        axes.set_xlabel(_in_width(quantity(name, samples.units.get(name))))
    for axes in panels[:, 0]:
        axes.set_ylabel("Share of samples [%]")
    if any(axes.lines for axes in panels.flat):
        mean = Line2D([], [], **_MEAN, label="mean")
        figure.legend(handles=[mean], loc="outside lower right", frameon=False, fontsize=8)
    return figure


def _draw(axes: Axes, values: np.ndarray) -> None:
    """Bars and mean of the finite values; one bar with one number where they are the same."""
    if not len(values := finite(values)):
        axes.set(xticks=[], yticks=[])
        axes.text(0.5, 0.5, "no finite value", transform=axes.transAxes, ha="center", fontsize=8, color=GREY)
        return
    edges, share = histogram_data(values)
    low, high = float(edges[0]), float(edges[-1])
    mean = float(values.mean(dtype=np.float64))
    if len(share) > 1:
        axes.xaxis.set_major_locator(ticks(4, values))
    else:
        half = 0.5 * (abs(mean) or 1.0)
        edges = mean + half * np.array([-0.04, 0.04])
        axes.set_xlim(mean - half, mean + half)
        axes.set_xticks([mean], labels=[f"{mean:.4g}".replace("-", "−")])
        axes.text(0.97, 0.93, "the same in all samples", transform=axes.transAxes, ha="right", fontsize=8, color=GREY)
    axes.stairs(100 * share, edges, fill=True, color=color_map()(0.35), zorder=2)
    axes.set_ylim(bottom=0, top=None if len(share) > 1 else 125)
    if high > low:
        axes.axvline(mean, **_MEAN, zorder=3)
    # Above 100 % is room for words alone.
    axes.yaxis.set_major_locator(MaxNLocator(4) if len(share) > 1 else FixedLocator(range(0, 101, 25)))
    axes.grid(axis="y", zorder=0)


def _in_width(label: str) -> str:
    """The unit on a line of its own where the panel is too narrow for both."""
    return label.replace(" [", "\n[") if len(label) > WIDTH else label


def write_histogram_csv(samples: DistributionMap, path: str | Path) -> None:
    """Write what ``histogram`` shows: index, unit, lower and upper edge, share of the samples."""
    found = ((name, samples.units.get(name, ""), finite(values)) for name, values in samples.indices.items())
    with Path(path).open("w", newline="", encoding="utf-8") as file:
        write_histograms(file, ((name, unit, *histogram_data(values)) for name, unit, values in found if len(values)))


def write_histograms(file: TextIO, histograms: Iterable[tuple[str, str, np.ndarray, np.ndarray]]) -> None:
    """Write rows of index, unit, lower and upper edge, share; of each index its unit, edges (n+1,) and share (n,)."""
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(["index", "unit", "lower", "upper", "share"])
    for name, unit, edges, share in histograms:
        for low, high, part in zip(edges[:-1].tolist(), edges[1:].tolist(), share.tolist(), strict=True):
            writer.writerow([name, unit, low, high, part])


def finite(values: np.ndarray) -> np.ndarray:
    """Those of the values (N,) of an index that are finite, (M,): others, such as NaN, are in no interval."""
    return values[np.isfinite(values)]


def histogram_data(
    values: np.ndarray, bins: int | None = None, lower: float | None = None, upper: float | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Edges (51,) in the unit of the index and share of `finite` values (50,) in each interval; fewer of few values.

    ``bins``: how many intervals instead; ``lower`` and ``upper``: the first and last edge, by default the least and the
    largest value. Values that are the same but for rounding are one interval: (2,) and (1,). Shares are of all values.
    Raises InputError, naming the limit, where none can be between the edges.
    """
    low, high = (float(values.min()) if lower is None else lower), (float(values.max()) if upper is None else upper)
    if low > high:
        if lower is None:
            raise InputError("upper", f"must be at least {low:g}, the least value, not {high:g}")
        raise InputError(
            "lower", f"must be at most {high:g}, {'the largest value' if upper is None else 'upper'}, not {low:g}"
        )
    if high - low <= ROUNDING * max(abs(low), abs(high)):
        return np.array([low, high]), np.array([np.mean((values >= low) & (values <= high))])
    bins = bins or min(max(len(values) // PER_BIN, FEWEST_BINS), BINS)
    counts, edges = np.histogram(values.astype(np.float64), bins, (low, high))
    return edges, counts / len(values)
