"""Layout of pictures with several planes."""

from itertools import combinations

import numpy as np
import pytest

from tests.export.sample_data import random_volume
from wsrender import plots
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
    for figure in (plots.slices(random_volume(shape)), plots.side_by_side(several), plots.vector_planes(field)):
        figure.draw_without_rendering()
        lengths = [inches_of_a_metre(figure, axes) for axes in figure.axes if axes.images]
        assert len(lengths) >= 3
        np.testing.assert_allclose(lengths, np.full_like(lengths, lengths[0][0]), rtol=1e-9)


@pytest.mark.parametrize("shape", SHAPES, ids=str)
@pytest.mark.parametrize("name", ["ur5e", "a robot with quite a long name indeed"])
def test_names_of_robots_numbers_and_titles_do_not_overlap(shape, name):
    figure = plots.side_by_side({name: random_volume(shape), "b": random_volume(shape)}, title="two")
    figure.draw_without_rendering()
    names = [text for text in figure.texts if text.get_text() in (name, "b")]
    assert len(names) == 2
    boxes = [text.get_window_extent() for text in (*names, figure._suptitle)]
    boxes += [axes.get_tightbbox() for axes in figure.axes]
    assert not any(a.overlaps(b) for a, b in combinations(boxes, 2))
    assert all(figure.bbox.y0 <= box.y0 and box.y1 <= figure.bbox.y1 for box in boxes)
