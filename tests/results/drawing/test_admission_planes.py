"""Planes of what constraints leave: what is free, and by which constraint the rest is blocked."""

import numpy as np
import pytest

from wsrender.errors import InputError
from wsrender.reach.voxel_labels import REASONS
from wsrender.results.drawing import admission
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels

NAMED = (*REASONS, "region", "elbow_up")
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


@pytest.mark.parametrize(
    ("labels", "reasons", "codes", "names"),
    [
        ([1, 2, 2, -1, 0, 2], [0, 6, 5, 4, 2, 6], [0, 2, 1, 3, 4, 2], ("free", "region", "elbow up")),
        ([1, 0, -1, 1, 1, 1], [0, 1, 4, 0, 0, 0], [0, 2, 1, 0, 0, 0], ("reachable",)),
        ([2, 2, 1, 1, 1, 1], [6, 6, 0, 0, 0, 0], [1, 1, 0, 0, 0, 0], ("free", "elbow up")),
    ],
)
def test_a_voxel_is_shown_by_its_label_and_what_blocks_it(labels, reasons, codes, names, monkeypatch):
    drawn, draw = [], admission.draw_plane
    monkeypatch.setattr(
        admission, "draw_plane", lambda axes, of, field, *rest: (drawn.append(field), draw(axes, of, field, *rest))
    )
    arrays = {"label": np.array(labels, np.float32), "reason": np.array(reasons, np.float32)}
    places = np.array([[k, 0, 0] for k in range(6)])
    first, voxels = Voxels.at_places(places, np.full(6, 9), {"center": arrays})
    units = {"label": "", "reason": ", ".join(f"{k} {name or 'none'}" for k, name in enumerate(NAMED))}
    admission.label_planes(VolumeData.of_voxels(0.1, first, voxels, units))
    field = drawn[0]
    assert field.values.tolist() == codes
    first, *blocking = names
    told = (first, *(f"blocked by\n{name}" for name in blocking), "undecided", "unreachable")
    assert field.scale.names == told


def test_a_volume_without_labels_is_refused():
    with pytest.raises(InputError, match="does not hold labels"):
        admission.label_planes(volume(admitted=np.ones(3)))


def test_a_volume_without_samples_by_reason_is_refused():
    with pytest.raises(InputError, match="does not hold the samples"):
        admission.blocked_planes(volume(region=np.ones(3)))
