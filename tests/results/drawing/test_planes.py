"""Layout of pictures with several planes."""

from itertools import combinations

import numpy as np
import pytest

from tests.results.export.sample_data import random_volume
from wsrender.analyses.robot_comparison.pictures import side_by_side
from wsrender.results import drawing
from wsrender.volume.volume_data import VolumeData

SHAPES = [(5, 4, 3), (30, 20, 6), (10, 10, 1), (3, 40, 20)]


def inches_of_a_metre(figure, axes):
    size = axes.get_position().size * figure.get_size_inches()
    return size / np.ptp([axes.get_xlim(), axes.get_ylim()], axis=1)


@pytest.mark.parametrize("shape", SHAPES, ids=str)
def test_a_metre_is_equally_long_in_all_planes(shape):
    vectors = np.random.default_rng(0).normal(size=(*shape, 3))
    field = VolumeData(0.1, (0, 0, 0), np.ones(shape, int), vectors={"force": vectors})
    several = {"a": random_volume(shape), "b": random_volume(shape)}
    for figure in (drawing.slices(random_volume(shape)), side_by_side(several), drawing.vector_planes(field)):
        figure.draw_without_rendering()
        lengths = [inches_of_a_metre(figure, axes) for axes in figure.axes if axes.images]
        assert len(lengths) >= (3 if min(shape) > 1 else 1)
        np.testing.assert_allclose(lengths, np.full_like(lengths, lengths[0][0]), rtol=1e-9)


@pytest.mark.parametrize("shape", SHAPES, ids=str)
@pytest.mark.parametrize("name", ["ur5e", "a robot with quite a long name indeed"])
def test_names_of_robots_numbers_and_titles_do_not_overlap(shape, name):
    figure = side_by_side({name: random_volume(shape), "b": random_volume(shape)}, title="two")
    figure.draw_without_rendering()
    names = [text for text in figure.texts if text.get_text() in (name, "b")]
    assert len(names) == 2
    boxes = [text.get_window_extent() for text in (*names, figure._suptitle)]
    boxes += [axes.get_tightbbox() for axes in figure.axes]
    assert not any(a.overlaps(b) for a, b in combinations(boxes, 2))
    assert all(figure.bbox.y0 <= box.y0 and box.y1 <= figure.bbox.y1 for box in boxes)


def panels_of(figure):
    return [axes for axes in figure.axes if axes.images]


@pytest.mark.parametrize(
    ("shape", "labels"),
    [
        ((7, 6, 1), [("x [m]", "y [m]")]),
        ((1, 6, 7), [("y [m]", "z [m]")]),
        ((7, 1, 6), [("x [m]", "z [m]")]),
        ((1, 1, 9), [("y [m]", "z [m]")]),
        ((9, 1, 1), [("x [m]", "z [m]")]),
        ((2, 6, 7), [("y [m]", "z [m]"), ("x [m]", "z [m]"), ("x [m]", "y [m]")]),
    ],
    ids=str,
)
def test_sets_in_a_plane_or_on_a_line_are_not_drawn_edge_on(shape, labels):
    field = VolumeData(0.1, (0, 0, 0), np.ones(shape, int), vectors={"force": np.ones((*shape, 3))})
    for figure in (drawing.slices(field), drawing.vector_planes(field), side_by_side({"a": field, "b": field})):
        figure.draw_without_rendering()
        panels = panels_of(figure)
        rows = len(panels) // len(labels)
        assert [(axes.get_xlabel(), axes.get_ylabel()) for axes in panels] == labels * rows
        for axes in panels:
            # Numbers have room: no panel of a few pixels.
            assert min(axes.get_position().size * figure.get_size_inches()) > 0.7
    # A plane that is asked for is drawn, even edge-on.
    assert len(panels_of(drawing.slices(field, at=(0.05, 0.05, 0.05)))) == 3


def test_the_only_layer_is_told_by_its_ends():
    """Where in it samples lie is not known: those of a planar arm lie at 0, not in its middle."""
    flat = VolumeData(0.1, (0, 0, 0), np.ones((7, 6, 1), int))
    assert drawing.slices(flat).axes[0].get_title() == "z = 0 … 0.1 m (world)"


@pytest.mark.parametrize("robots", [2, 3, 6])
def test_a_picture_of_several_robots_fits_on_a_page(robots):
    volumes = {f"r{k}": random_volume((20, 20, 20)) for k in range(robots)}
    width, height = side_by_side(volumes).get_size_inches()
    assert width < 14 and height < 8.0 + 0.9 * robots


def box_at(low, high, shape=(12, 12, 12)):
    count = np.zeros(shape, int)
    count[tuple(slice(a, b) for a, b in zip(low, high, strict=True))] = 1
    return VolumeData(0.1, (-6, -6, -6), count)


@pytest.mark.parametrize(
    ("a", "b", "layer"),
    [
        (((2, 2, 2), (9, 9, 9)), ((0, 0, 0), (12, 12, 12)), 6),  # at 0, which cuts both
        (((0, 0, 0), (12, 12, 12)), ((8, 8, 8), (10, 10, 10)), 9),  # through the small one, that 0 misses
    ],
)
def test_planes_of_a_comparison_cut_every_robot(a, b, layer):
    volumes = {"a": box_at(*a), "b": box_at(*b)}
    panels = panels_of(side_by_side(volumes))
    middle = (layer - 6 + 0.5) * 0.1
    assert [axes.get_title() for axes in panels] == [f"{name} = {middle:.3g} m (world)" for name in "xyz"] * 2
    for axes in panels:
        assert np.ma.count(axes.images[0].get_array()) >= 4


def test_forces_are_drawn_by_their_mean_which_the_peak_of_the_device_does_not_cut():
    force = np.arange(1.0, 65.0).reshape(4, 4, 4)
    known = {"maximum": {"force": np.full_like(force, 7.0)}, "mean": {"force": force, "limit_nearness": force / 64}}
    figure = drawing.slices(VolumeData(0.1, (0, 0, 0), np.ones(force.shape, int), known, {"force": "N"}))
    assert figure.axes[-1].get_ylabel() == "Mean of force [N]" and figure.axes[0].images[0].get_clim() == (1.0, 64.0)
