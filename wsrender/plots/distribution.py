"""How the values of each index are spread over the samples."""

import csv
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from wsrender.errors import InputError
from wsrender.plots.space import checked_index
from wsrender.plots.style import INK, add_title, color_map, new_figure, paper_style, quantity
from wsrender.volume.distribution_map import DistributionMap

BINS = 50
WIDTH = 42  # characters of a label below a panel
ROUNDING = 1e-9  # of the values: a spread below it is that of their computation, and too small for 50 intervals


@paper_style()
def histogram(samples: DistributionMap, index: str | None = None, *, title: str = "") -> Figure:
    """Share of the samples per interval of an index, one panel per index of the map by default.

    The dashed line marks the mean. Raises InputError for an unknown index, or a map without indices or rows.
    """
    if not samples.indices or len(samples) == 0:
        raise InputError("index", "the map holds no values of an index, so there is nothing to draw")
    names = list(samples.indices) if index is None else [checked_index(samples, index)]
    columns = min(len(names), 3)
    rows = -(-len(names) // columns)
    figure = new_figure(max(3.1 * columns, 4.6), max(2.3 * rows, 2.8) + 0.3)
    panels = figure.subplots(rows, columns, squeeze=False)
    for axes in panels.flat[len(names) :]:
        axes.set_visible(False)
    for axes, name in zip(panels.flat, names, strict=False):
        values = samples.indices[name]
        edges, share = histogram_data(values)
        axes.stairs(100 * share, edges, fill=True, color=color_map()(0.35), zorder=2)
        axes.set_ylim(bottom=0)
        axes.axvline(values.mean(dtype=np.float64), color=INK, lw=0.9, ls=(0, (4, 2)), zorder=3, label="mean")
        axes.set_xlabel(_in_width(quantity(name, samples.units.get(name))))
        axes.xaxis.set_major_locator(MaxNLocator(4))
        axes.yaxis.set_major_locator(MaxNLocator(4))
        axes.grid(axis="y", zorder=0)
    for axes in panels[:, 0]:
        axes.set_ylabel("Share of samples [%]")
    panels.flat[0].legend(frameon=False, loc="upper right")
    add_title(figure, title)
    return figure


def _in_width(label: str) -> str:
    """The unit on a line of its own where the panel is too narrow for both."""
    return label.replace(" [", "\n[") if len(label) > WIDTH else label


def write_histogram_csv(samples: DistributionMap, path: str | Path) -> None:
    """Write what ``histogram`` shows: index, unit, lower and upper edge, share of the samples."""
    with Path(path).open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["index", "unit", "lower", "upper", "share"])
        for name, values in samples.indices.items():
            edges, share = histogram_data(values)
            unit = samples.units.get(name, "")
            for low, high, part in zip(edges[:-1].tolist(), edges[1:].tolist(), share.tolist(), strict=True):
                writer.writerow([name, unit, low, high, part])


def histogram_data(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Edges (51,) in the unit of the index and share of the values (50,) in each interval."""
    low, high = float(values.min()), float(values.max())
    if high - low <= ROUNDING * max(abs(low), abs(high)):
        low, high = (low - 0.5, low + 0.5)
    counts, edges = np.histogram(values.astype(np.float64), BINS, (low, high))
    return edges, counts / len(values)
