"""Whole numbers, such as counts: beside them stand whole ticks."""

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.ticker import MaxNLocator


def are_whole(values: Any) -> bool:
    """Whether all finite ones of some values are whole numbers."""
    known = np.asarray(values, np.float64)
    known = known[np.isfinite(known)]
    return np.array_equal(known, np.round(known))


def whole_ticks(most: int) -> "MaxNLocator":
    """At most so many ticks, at whole numbers however few of these there are: one at least."""
    from matplotlib.ticker import MaxNLocator

    return MaxNLocator(most, steps=[1, 2, 5, 10], integer=True, min_n_ticks=1)


def ticks(most: int, *values: Any) -> "MaxNLocator":
    """At most so many ticks of an axis that has these values, whole where all are."""
    from matplotlib.ticker import MaxNLocator

    return whole_ticks(most) if all(map(are_whole, values)) else MaxNLocator(most)
