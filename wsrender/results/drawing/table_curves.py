"""A table as curves: its first column across, the others upwards, one panel for each unit."""

import numpy as np
from matplotlib.figure import Figure

from wsrender.errors import InputError
from wsrender.results.drawing.style import Heading, color_map, new_figure, paper_style, quantity
from wsrender.results.drawing.whole import ticks
from wsrender.volume.table import Table

_BAND = ("_low", "_high")  # endings of the columns that bound another


@paper_style()
def curves(table: Table, *, title: Heading | str = "") -> Figure:
    """Every column of numbers against the first; ``<name>_low`` and ``<name>_high`` bound the band of ``<name>``.

    Raises InputError for a table without rows or with fewer than two columns of numbers.
    """
    numbers = {name: values for name, values in table.columns.items() if values.ndim == 1 and values.dtype.kind in "if"}
    if len(table) == 0 or len(numbers) < 2:
        raise InputError("table", "has no rows, or fewer than two columns of numbers: there is nothing to draw")
    across, *others = numbers
    drawn = [name for name in others if not name.endswith(_BAND)]
    drawn = [name for name in drawn if np.isfinite(numbers[name]).any()] or drawn  # none without values in a legend
    panels: dict[str, list[str]] = {}
    for name in drawn:
        panels.setdefault(table.units.get(name, "1"), []).append(name)
    figure = new_figure(5.6, 2.6 * len(panels) + 0.3, title)
    for axes, (unit, names) in zip(figure.subplots(len(panels), 1, squeeze=False).flat, panels.items(), strict=True):
        for name, color in zip(names, color_map()(np.linspace(0.1, 0.75, len(names))), strict=True):
            order = np.argsort(numbers[across], kind="stable")
            x, y = numbers[across][order], numbers[name][order]
            axes.plot(x, y, marker="o", ms=3.5, lw=1.4, color=color, label=quantity(name, None), zorder=3)
            low, high = (numbers.get(name + ending) for ending in _BAND)
            if low is not None and high is not None:
                axes.fill_between(x, low[order], high[order], color=color, alpha=0.25, linewidth=0, zorder=2)
        axes.set_xlabel(quantity(across, table.units.get(across)))
        axes.set_ylabel(quantity(names[0] if len(names) == 1 else _kind(unit), unit))
        axes.xaxis.set_major_locator(ticks(8, numbers[across]))
        axes.yaxis.set_major_locator(ticks(5, *(numbers[name] for name in names)))
        axes.grid(zorder=0)
        if len(names) > 1:
            axes.legend(frameon=False, fontsize=8)
    return figure


def _kind(unit: str) -> str:
    return {"m^3": "volume", "m": "length"}.get(unit, "value")
