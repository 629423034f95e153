"""Which colours stand for which values, and whether the bar says so."""

import numpy as np
import pytest
from matplotlib.colors import BoundaryNorm, ListedColormap

from wsrender.analyses.base_placement.pictures import placement_map, trade_off
from wsrender.results import drawing
from wsrender.results.drawing.color_scale import ColorScale, color_scale
from wsrender.results.drawing.style import new_figure
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import CellGrid, Table
from wsrender.volume.volume_data import VolumeData

VALUES = np.random.default_rng(0).uniform(2.0, 3.0, 1000)


def bar_of(values):
    figure = new_figure(2, 2)
    return color_scale(values, "value").add_bar(figure, ax=figure.add_subplot())


@pytest.mark.parametrize(("outlier", "extend"), [(1e6, "max"), (-1e6, "min"), (None, "neither")])
def test_one_outlier_does_not_scale_the_colours_and_the_bar_points_to_it(outlier, extend):
    values = VALUES if outlier is None else np.append(VALUES, outlier)
    scale = color_scale(np.abs(values) if extend == "max" else values, "value")
    low, high = scale.limits
    if extend == "min":  # of the other sign: 0 is in the middle
        assert scale.diverging and high == -low == VALUES.max() and scale.extend == "min"
        return
    assert (low, high) == (VALUES.min(), VALUES.max())
    bar = bar_of(values)
    assert bar.extend == scale.extend == extend
    assert bar.ax.get_title() == ("outliers\nabove" if outlier else "")


@pytest.mark.parametrize("count", [12, 50, 100_000])
def test_limits_hold_whatever_the_number_of_values(count):
    values = np.append(np.linspace(0.1, 0.9, count), 1e9)
    assert color_scale(values, "value").limits == (0.1, 0.9)


@pytest.mark.parametrize("count", [12, 50, 100_000])
def test_one_small_value_is_no_limit_either(count):
    scale = color_scale(np.append(np.linspace(100.1, 100.9, count), 1e-3), "value")
    assert scale.limits == (100.1, 100.9) and scale.extend == "min"


def test_values_that_are_missing_count_for_nothing():
    gaps = [np.nan, np.inf, -np.inf]
    for values in (VALUES, VALUES - 2.5, np.arange(5.0), np.arange(30.0), np.full(20, 0.25)):
        scale, expected = color_scale(np.append(values, gaps), "value"), color_scale(values, "value")
        assert (scale.limits, scale.extend, scale.diverging) == (expected.limits, "neither", expected.diverging)
        assert type(scale.norm) is type(expected.norm)
    assert color_scale(np.array(gaps), "value").limits == (-0.5, 1.5)


def test_values_that_are_no_outliers_are_all_told_apart():
    for values in (VALUES, VALUES**3, np.random.default_rng(1).normal(5, 1, 5000), np.linspace(0.5, 9.5, 7)):
        assert color_scale(values, "value").limits == (values.min(), values.max())
        assert color_scale(values, "value").extend == "neither"


def test_most_values_alike_are_no_reason_to_hide_the_others():
    values = np.append(np.full(1000, 0.5), [0.25, 0.75])
    assert color_scale(values, "value").limits == (0.25, 0.75)


def test_both_signs_have_zero_in_the_middle():
    scale = color_scale(np.linspace(-0.1, 0.7, 100), "determinant")
    assert scale.diverging and scale.limits == (-0.7, 0.7) and scale.places(0.0) == 0.5
    red, green, blue, _ = scale(0.0)
    assert max(red, green, blue) - min(red, green, blue) < 0.02 and red < 0.9  # grey: not the white of what is empty
    assert (scale(0.5)[0] > scale(0.5)[2]) and (scale(-0.5)[2] > scale(-0.5)[0])
    assert not color_scale(np.linspace(-1e-12, 1.0, 100), "rounding").diverging


def test_determinants_of_one_sign_are_drawn_around_zero_too():
    """In volumes and maps: which sign it is says on which side of a singularity a pose is."""
    values = np.linspace(-0.5, -0.1, 60)
    cells = values.reshape(5, 4, 3)
    names = {"center": {"determinant_A": cells, "width": -cells}}
    volume = VolumeData(0.1, (0, 0, 0), np.ones(cells.shape, int), names)
    samples = DistributionMap(
        np.random.default_rng(0).normal(size=(60, 3)), {"determinant_A": values, "width": -values}
    )
    for index, limits in (("determinant_A", (-0.5, 0.5)), ("width", (0.1, 0.5))):
        for figure in (drawing.slice_plane(volume, index=index), drawing.scatter(samples, index)):
            assert figure.axes[-1].get_ylim() == pytest.approx(limits)
    assert drawing.slice_plane(volume, index="determinant_A").axes[-1].get_ylabel() == "Determinant A"


@pytest.mark.parametrize("values", [[1, 2], [0, 1, 5, 9], [3]])
def test_counts_have_a_step_each(values):
    bar = bar_of(np.array(values, float))
    assert isinstance(bar.norm, BoundaryNorm)
    levels = np.arange(min(values), max(values) + 1)
    assert bar.get_ticks().tolist() == levels.tolist()
    if len(levels) > 1:
        np.testing.assert_array_equal(bar.norm.boundaries, np.append(levels - 0.5, levels[-1] + 0.5))
        assert len(np.unique(bar.cmap(bar.norm(levels)), axis=0)) == len(levels)


@pytest.mark.parametrize("height", [1, 2, 4, 8])
@pytest.mark.parametrize(("least", "most"), [(0, 13), (1, 20), (0, 1000), (-10, 8), (-30, 7), (-2, 3)])
def test_many_counts_have_whole_ticks(least, most, height):
    """Those of differences among them, which have both signs, on bars of any height."""
    figure, values = new_figure(2, height), np.arange(float(least), most + 1)
    scale = color_scale(values, "value", signed=least < 0)
    bar = scale.add_bar(figure, ax=figure.add_subplot())
    low, high = scale.limits
    ticks = [tick for tick in bar.get_ticks() if low <= tick <= high]
    np.testing.assert_array_equal(ticks, np.round(ticks))
    assert len(ticks) > 2


def test_a_line_marks_zero_between_the_signs():
    for values, lines in ((np.linspace(-0.1, 0.7, 100), 1), (np.linspace(0.1, 0.7, 100), 0)):
        drawn = [line for line in bar_of(values).ax.lines if np.allclose(line.get_ydata(), 0.0)]
        assert len(drawn) == lines


def test_names_stand_at_their_steps():
    norm, colors = BoundaryNorm([-0.5, 0.5, 1.5], 2), ListedColormap(["red", "blue"])
    figure = new_figure(2, 2)
    scale = ColorScale(norm, colors, "", ticks=[0, 1], names=["free", "blocked by\nself collision"])
    bar = scale.add_bar(figure, ax=figure.add_subplot())
    assert bar.get_ticks().tolist() == [0, 1]
    assert [text.get_text() for text in bar.ax.get_yticklabels()] == ["free", "blocked by\nself collision"]


@pytest.mark.parametrize("most", [1, 3, 12, 13, 20, 50])
def test_the_axes_of_counts_have_whole_ticks(most):
    """Of targets that placements serve, in a map and as a curve; of any table as a curve; of a histogram."""
    x = np.linspace(-0.5, 0.5, 5)
    counts = np.resize(np.arange(most + 1), 25)
    counts[-1] = most
    grid = CellGrid(("x_m", "y_m"), (-0.6, -0.6), (0.2, 0.2), (5, 5))
    units = {"x_m": "m", "y_m": "m"}
    whole = {"x_m": np.repeat(x, 5), "y_m": np.tile(x, 5), "served": counts}
    row = {"x_m": np.linspace(-0.5, 0.5, 25), "served": counts}
    line = Table(row, {"x_m": "m"}, grid=CellGrid(("x_m",), (-0.5,), (0.04,), (25,)))
    samples = DistributionMap(np.zeros((25, 3)), {"postures": counts.astype(float)})
    front = Table({"served": counts, "dexterity": np.arange(25.0)}, {"dexterity": "1"})
    found = [
        placement_map(Table(whole, units, grid=grid)).axes[-1].yaxis,
        placement_map(line).axes[0].yaxis,
        trade_off(front, {}, ["served", "dexterity"]).axes[0].xaxis,
        drawing.curves(Table({"round": np.arange(25), "found": counts.astype(float)})).axes[0].yaxis,
        drawing.histogram(samples).axes[0].xaxis,
    ]
    for axis in found:
        low, high = axis.get_view_interval()
        ticks = [tick for tick in axis.get_majorticklocs() if low <= tick <= high]
        np.testing.assert_array_equal(ticks, np.round(ticks))
        assert ticks


@pytest.mark.parametrize("value", [0.0, 0.25])
def test_one_value_has_one_colour_and_one_number(value):
    bar = bar_of(np.full(20, value))
    assert bar.get_ticks().tolist() == [value]
    assert len(bar.cmap.colors) == 1


def test_a_plane_of_determinants_has_its_zero_line():
    x = (np.arange(8) - 3.2)[:, None, None] * np.ones((8, 6, 5))
    for values, lines in ((x, 1), (x + 10, 0)):
        volume = VolumeData(0.1, (0, 0, 0), np.ones(x.shape, int), {"center": {"determinant_A": values}})
        axes = drawing.slice_plane(volume, z=0.2).axes[0]
        zero = [
            line
            for contour in axes.collections
            for path in contour.get_paths()
            for line in path.to_polygons(closed_only=False)
        ]
        assert len(zero) == lines
        for line in zero:
            np.testing.assert_allclose(line[:, 0], 0.05 + 0.32, atol=1e-9)
