import numpy as np
import pytest

from wsrender.volume.neighbours import LAYERS, inner_and_outer, inner_and_outer_counts
from wsrender.volume.voxels import Voxels


@pytest.mark.parametrize("layers", [0, 1, 2, LAYERS - 2, LAYERS - 1, LAYERS, 2 * LAYERS + 3])
@pytest.mark.parametrize("share", [0.02, 0.97, 1.0])
def test_counts_in_parts_are_those_of_the_whole(layers, share):
    occupied = np.random.default_rng(layers).random((layers, 7, 5)) < share
    inner, outer = inner_and_outer(occupied)
    voxels = Voxels.of_arrays(occupied.astype(np.int64), {}, {})
    assert inner_and_outer_counts(voxels) == (inner.sum(), outer.sum())
