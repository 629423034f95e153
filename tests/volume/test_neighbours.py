import numpy as np
import pytest

from wsrender.volume.voxels import LAYERS, Voxels, inner_and_outer, inner_and_outer_counts, neighbours_and_itself


@pytest.mark.parametrize("layers", [0, 1, 2, LAYERS - 2, LAYERS - 1, LAYERS, 2 * LAYERS + 3])
@pytest.mark.parametrize("share", [0.02, 0.97, 1.0])
def test_counts_in_parts_are_those_of_the_whole(layers, share):
    occupied = np.random.default_rng(layers).random((layers, 7, 5)) < share
    inner, outer = inner_and_outer(occupied)
    voxels = Voxels.of_arrays(occupied.astype(np.int64), {}, {})
    assert inner_and_outer_counts(voxels) == (inner.sum(), outer.sum())


@pytest.mark.parametrize("shape", [(9,), (6, 7), (4, 5, 6)])
def test_how_many_neighbours_are_in_the_set(shape):
    from scipy.ndimage import convolve

    occupied = np.random.default_rng(3).random(shape) < 0.4
    expected = convolve(occupied.astype(int), np.ones((3,) * len(shape), int), mode="constant")
    assert (neighbours_and_itself(occupied) == expected).all()
    inner, outer = (part[(slice(1, -1),) * len(shape)] for part in inner_and_outer(occupied))
    assert (inner == (expected == 3 ** len(shape))).all()
    assert (outer == (expected > 0)).all()
