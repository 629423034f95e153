import pickle

import numpy as np
import pytest

from tests.results.export.sample_data import assert_same_volume, random_volume
from wsrender.volume import volume_data
from wsrender.volume.volume_data import VolumeData, registered
from wsrender.volume.voxels import Voxels


@pytest.mark.parametrize("kept", [0, 1 << 26])
@pytest.mark.parametrize("shape", [(5, 4, 3), (1, 7, 1), (0, 0, 0)], ids=str)
def test_arrays_and_voxels_hold_the_same(shape, kept, monkeypatch):
    monkeypatch.setattr(volume_data, "KEPT", kept)
    bare = random_volume(shape) if np.prod(shape) else VolumeData(0.05, (0, 0, 0), np.zeros(shape, np.int64))
    vectors = np.where(bare.count[..., None] > 1, np.random.default_rng(0).normal(size=(*shape, 3)), np.nan)
    whole = VolumeData(bare.voxel_size_m, bare.first_voxel, bare.count, bare.statistics, bare.units, {"force": vectors})
    found = VolumeData.of_voxels(whole.voxel_size_m, whole.first_voxel, whole.voxels, whole.units)
    assert_same_volume(whole, found)
    np.testing.assert_array_equal(found.vectors["force"], vectors)
    np.testing.assert_array_equal(found.occupied, whole.count > 0)
    assert found.n_occupied == np.count_nonzero(whole.count)
    for axis in range(3):
        for layer in range(shape[axis]):
            plane = whole.voxels.plane(whole.voxels.count, axis, layer)
            np.testing.assert_array_equal(plane, whole.count.take(layer, axis))


def of_voxels(whole):
    return VolumeData.of_voxels(whole.voxel_size_m, whole.first_voxel, whole.voxels, whole.units)


def test_asking_for_a_name_makes_no_array(monkeypatch):
    volume = of_voxels(random_volume((5, 4, 3)))
    monkeypatch.setattr(Voxels, "dense", lambda *_: pytest.fail("an array was made"))
    assert "x" in volume.statistics["mean"] and "y?" not in volume.statistics["mean"]
    assert list(volume.statistics["mean"]) and len(volume.statistics["mean"]) and "force" not in volume.vectors


def test_arrays_are_kept_up_to_a_limit_for_all_of_them(monkeypatch):
    volume = of_voxels(random_volume((5, 4, 3), statistics=("minimum", "maximum", "mean")))
    monkeypatch.setattr(volume_data, "KEPT", 2 * 60)
    first, second, third = (volume.statistics[s]["x"] for s in ("minimum", "maximum", "mean"))
    assert volume.statistics["minimum"]["x"] is first and volume.statistics["maximum"]["x"] is second
    assert volume.statistics["mean"]["x"] is not third


def test_a_copy_makes_its_own_arrays():
    """Through pickle, as to another process: what was kept stays that of its name."""
    volume = of_voxels(random_volume((5, 4, 3)))
    _ = volume.count, volume.statistics["mean"]["x"]
    copy = pickle.loads(pickle.dumps(volume))
    assert_same_volume(volume, copy)
    assert copy.count is copy.count and len(copy._count._made) == 2 * len(volume.statistics["mean"]) + 1


@pytest.mark.parametrize("made", [lambda whole: whole, of_voxels], ids=["arrays", "voxels"])
def test_arrays_are_read_only(made):
    """What is written to them would not reach the voxels."""
    volume = made(random_volume((5, 4, 3)))
    for array in (volume.count, volume.statistics["mean"]["x"]):
        with pytest.raises(ValueError, match="read-only"):
            array[:] = 0


def test_values_of_voxels_without_samples_stay():
    label = np.array([[[np.nan, 1.0, 0.0]]], np.float32)
    volume = VolumeData(0.1, (0, 0, 0), np.array([[[0, 2, 0]]]), {"center": {"label": label}})
    (other, again) = registered([VolumeData(0.1, (-1, 0, 1), np.array([[[1]]])), volume])
    assert again.shape == (2, 1, 3) and again.first_voxel == (-1, 0, 0)
    np.testing.assert_array_equal(again.statistics["center"]["label"][1:], label)
    np.testing.assert_array_equal(again.count[1:], volume.count)
    assert other.count[0, 0, 1] == 1 and other.count.sum() == 1
