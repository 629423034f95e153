"""Planes of what constraints leave: what is free, and by which constraint the rest is blocked."""

import numpy as np
import pytest

from wsrender.errors import InputError
from wsrender.results.drawing import admission
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels

CELLS = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0]])


def volume(**samples):
    first, voxels = Voxels.at_places(CELLS, np.full(3, 9), {"samples": samples})
    return VolumeData.of_voxels(0.1, first, voxels, dict.fromkeys(samples, "samples"))


def test_a_voxel_is_free_or_blocked_by_the_reason_of_most_samples(monkeypatch):
    drawn, draw = [], admission.draw_plane
    monkeypatch.setattr(
        admission, "draw_plane", lambda axes, of, field, *rest: (drawn.append(field), draw(axes, of, field, *rest))
    )
    counts = volume(admitted=np.array([1.0, 0, 0]), region=np.array([5.0, 6, 1]), environment=np.array([3.0, 3, 8]))
    admission.blocked_planes(counts)
    field = drawn[0]
    assert field.values.tolist() == [0, 1, 2]
    assert field.scale.names == ("free", "blocked by\nregion", "blocked by\nenvironment")


def test_a_volume_without_samples_by_reason_is_refused():
    with pytest.raises(InputError, match="does not hold the samples"):
        admission.blocked_planes(volume(region=np.ones(3)))
