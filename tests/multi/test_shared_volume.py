"""Voxel sets combined on one lattice, against NumPy's sets of voxels."""

import numpy as np
import pytest

from tests.results.export.sample_data import random_volume
from wsrender.errors import InputError
from wsrender.multi import reached_by, shared_volume, volume_by_number
from wsrender.volume.volume_data import VolumeData, registered


def scattered(seed, first, shape):
    rng = np.random.default_rng(seed)
    count = rng.integers(0, 2, shape) * rng.integers(1, 9, shape)
    values = np.where(count > 0, rng.random(shape), np.nan)
    return VolumeData(0.1, first, count, {"maximum": {"w": values}})


VOLUMES = [
    scattered(1, (0, 0, 0), (5, 6, 7)),
    scattered(2, (-3, 2, 4), (6, 6, 6)),
    scattered(3, (1, 1, 5), (4, 3, 3)),
]


def voxels(volume):
    """Voxel → (count, share of the largest value)."""
    values = volume.statistics["maximum"]["w"] / np.nanmax(volume.statistics["maximum"]["w"])
    at = np.argwhere(volume.occupied)
    return {tuple(a + volume.first_voxel): (volume.count[tuple(a)], values[tuple(a)]) for a in at}


def test_every_voxel_against_sets():
    shared = shared_volume(VOLUMES)
    sets = [voxels(volume) for volume in VOLUMES]
    found = set()
    for at in np.ndindex(shared.count.shape):
        voxel = tuple(np.add(at, shared.first_voxel))
        held = [each[voxel] for each in sets if voxel in each]
        assert shared.count[at] == sum(count for count, _ in held)
        number, product = shared.statistics["number"]["robots"][at], shared.statistics["product"]["w"][at]
        if held:
            found.add(voxel)
            assert number == len(held)
        else:
            assert np.isnan(number)
        if len(held) > 1:
            assert product == pytest.approx(np.prod([share for _, share in held]), rel=1e-6)
        else:
            assert np.isnan(product)
    assert found == set().union(*sets)


def test_volumes_by_number_add_up():
    by_number = volume_by_number(shared_volume(VOLUMES), 3)
    assert len(by_number) == 4
    assert by_number[0] == 0
    assert by_number @ np.arange(4) == pytest.approx(sum(volume.occupied.sum() for volume in VOLUMES) * 1e-3)
    for least in (1, 2, 3):
        assert reached_by(shared_volume(VOLUMES), least).occupied.sum() * 1e-3 == pytest.approx(by_number[least:].sum())


def test_registered_volumes_keep_their_voxels():
    for volume, placed in zip(VOLUMES, registered(VOLUMES), strict=True):
        assert placed.count.shape == (8, 8, 10)
        assert placed.first_voxel == (-3, 0, 0)
        assert voxels(placed) == voxels(volume)


def test_voxels_of_different_sizes_are_refused():
    with pytest.raises(InputError, match=r"voxel_size_m: must be the same for all volumes, not 0.1, 0.05"):
        shared_volume([VOLUMES[0], random_volume((2, 2, 2))])
