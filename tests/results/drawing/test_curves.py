"""Tables as curves, and points of a mapping."""

import numpy as np
import pytest
from matplotlib.collections import PathCollection

from wsrender.analyses.master_slave_mapping.pictures import mapped_points
from wsrender.errors import InputError
from wsrender.results.drawing import curves
from wsrender.volume.table import Table


def test_a_panel_for_each_unit_and_a_band_for_bounds():
    columns = {
        "offset": np.array([2.0, 0.0, 1.0]),
        "shared": np.array([3.0, 1.0, 2.0]),
        "shared_low": np.array([2.5, 0.5, 1.5]),
        "shared_high": np.array([3.5, 1.5, 2.5]),
        "share": np.array([0.3, 0.1, 0.2]),
        "label": np.array(list("abc")),
    }
    figure = curves(Table(columns, {"offset": "m", "shared": "m^3"}), title="two arms")
    first, second = figure.axes
    (line,) = first.get_lines()
    assert line.get_xydata().tolist() == [[0, 1], [1, 2], [2, 3]]
    assert len(first.collections) == 1
    assert (first.get_xlabel(), first.get_ylabel()) == ("Offset [m]", "Shared [m³]")
    assert second.get_lines()[0].get_ydata().tolist() == [0.1, 0.2, 0.3]
    assert figure.get_suptitle() == "two arms"


def test_tables_that_are_no_curves():
    for table in (Table({}), Table({"a": np.zeros(3)}), Table({"a": np.zeros(0), "b": np.zeros(0)})):
        with pytest.raises(InputError, match="there is nothing to draw"):
            curves(table)


def test_points_inside_are_green_and_points_outside_red():
    position = np.random.default_rng(0).random((6, 3))
    slave, inside = np.array([0, 0, 1, 1, 1, 1], bool), np.array([1, 1, 1, 0, 0, 0], bool)
    figure = mapped_points(Table({"position": position, "slave": slave, "inside": inside}))
    _, green, red = (dots for dots in figure.axes[0].collections if isinstance(dots, PathCollection))
    assert (len(green.get_offsets()), len(red.get_offsets())) == (1, 3)
    assert green.get_facecolor()[0][1] > green.get_facecolor()[0][0]
    assert red.get_facecolor()[0][0] > red.get_facecolor()[0][1]
    assert [text.get_text() for text in figure.axes[0].get_legend().get_texts()][2] == "slave, outside (3)"
    master, green, red = (dots.get_zorder() for dots in figure.axes[0].collections[-3:])
    assert master > red > green  # a slave around its master does not hide it
    with pytest.raises(InputError, match="position, slave and inside are needed"):
        mapped_points(Table({"a": np.zeros(3)}))
