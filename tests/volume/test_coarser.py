import numpy as np
import pytest

from tests.results.export.sample_data import random_volume
from wsrender.volume.volume_data import coarser


@pytest.mark.parametrize("factor", [1, 2, 3, 5])
def test_coarser_voxels_hold_what_their_parts_held(factor):
    fine = random_volume((7, 5, 9), kind=np.float64, statistics=("maximum", "minimum", "mean"), names=("w",))
    merged = coarser(fine, factor)
    assert merged.voxel_size_m == pytest.approx(fine.voxel_size_m * factor)
    parts: dict[tuple[int, ...], list[tuple[int, ...]]] = {}
    for cell in np.argwhere(fine.occupied):
        parts.setdefault(tuple((cell + fine.first_voxel) // factor), []).append(tuple(cell))
    assert np.count_nonzero(merged.count) == len(parts)
    reduce = {"maximum": np.max, "minimum": np.min}
    for voxel, cells in parts.items():
        place = tuple(np.array(voxel) - merged.first_voxel)
        counts = np.array([fine.count[cell] for cell in cells])
        assert merged.count[place] == counts.sum()
        for statistic, by_index in fine.statistics.items():
            values = np.array([by_index["w"][cell] for cell in cells])
            expected = np.average(values, weights=counts) if statistic == "mean" else reduce[statistic](values)
            assert merged.statistics[statistic]["w"][place] == pytest.approx(expected)
    assert np.isnan(merged.statistics["maximum"]["w"][merged.count == 0]).all()
