"""Holes in volumes: voxels punched into a box that a gantry reaches, and voxels that no sample has found yet."""

import numpy as np
import pytest

from tests.run.simple_robots import gantry
from wsrender.reach.holes import share_of_holes, share_unseen
from wsrender.volume.volume_data import VolumeData

SIZE = 0.01
BOX = (28, 38, 18)  # voxels whose corners the slides reach, from (.01, -.39, .01) m on


def volume(punched):
    """The box, one sample a voxel, but for some places (N, 3)."""
    count = np.ones(BOX, np.int64)
    count[tuple(np.reshape(punched, (-1, 3)).T.astype(int))] = 0
    return VolumeData(SIZE, (1, -39, 1), count)


def test_a_box_without_holes_has_none():
    assert share_of_holes(gantry().chain, volume([])) == 0.0


@pytest.mark.parametrize("share", [0.005, 0.05])
def test_the_share_of_holes_is_that_of_the_punched_voxels(share):
    """Each of them is found by its own neighbours; 4,096 draws leave an error of a quarter of a share of .5 %."""
    random = np.random.default_rng(3)
    places = np.argwhere(np.ones(BOX))
    punched = places[random.choice(len(places), round(share * len(places)), replace=False)]
    exact = len(punched) / (len(places) - len(punched))
    found = share_of_holes(gantry().chain, volume(punched))
    assert found == pytest.approx(exact, rel=3 * (0.005 / share) ** 0.5 / 4)
    more = share_of_holes(gantry().chain, volume(punched), seed=1)
    assert more != found and more == pytest.approx(exact, rel=3 * (0.005 / share) ** 0.5 / 4)


def test_a_hole_that_many_occupied_voxels_surround_counts_no_more_than_one():
    """Single voxels have 26 occupied neighbours, the rims of an empty half of the box about 9."""
    half = np.argwhere(np.ones(BOX))
    half = half[half[:, 0] >= 14]
    found = share_of_holes(gantry().chain, volume(half))
    # Of the empty half only the layer beside the other is looked at.
    assert found == pytest.approx(1 / 14, rel=0.15)


def test_voxels_with_a_corner_out_of_reach_are_no_holes():
    """The slides end at .005 m: of the next layer of voxels centres are reached, outer corners are not."""
    count = np.ones((30, 40, 20), np.int64)
    count[0] = count[:, 0] = count[:, :, 0] = 0
    assert share_of_holes(gantry().chain, VolumeData(SIZE, (0, -40, 0), count)) == 0.0


def test_voxels_that_samples_have_not_found_yet():
    """As many independent samples as voxels leave e^-1 of them empty."""
    random = np.random.default_rng(5)
    cells = random.integers(20**3, size=20**3)
    count = np.bincount(cells, minlength=20**3).reshape(20, 20, 20)
    assert share_unseen(VolumeData(SIZE, (0, 0, 0), count)) == pytest.approx(1 / (np.e - 1), rel=0.05)
    assert share_unseen(VolumeData(SIZE, (0, 0, 0), np.full((4, 4, 4), 9))) == 0.0
