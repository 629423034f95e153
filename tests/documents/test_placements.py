"""Where a base may stand: how ranges read, and frames of coordinates."""

import numpy as np
import pytest
from pydantic import ValidationError

import wsrender as ws
from wsrender.documents.placements import COORDINATES, PlacementSpace, mounted, placed


def test_lengths_are_cells_and_no_angle_is_held_twice():
    space = PlacementSpace(x_m=[-1, 1, 0.02], y_m=[0, 1, 0.3], z_m=0.5, roll_deg=[-90, 90, 45], yaw_deg=[0, 360, 5])
    assert space.shape == (100, 3, 1, 5, 1, 72) and space.count == 108_000
    assert space.values("x_m")[[0, -1]] == pytest.approx([-0.99, 0.99])
    assert space.values("y_m") == pytest.approx([0.15, 0.45, 0.75])
    assert space.values("z_m").tolist() == [0.5] and space.values("roll_deg").tolist() == [-90, -45, 0, 45, 90]
    assert space.values("yaw_deg")[[0, -1]].tolist() == [0, 355]
    assert PlacementSpace(yaw_deg=[-180, 180, 90]).values("yaw_deg").tolist() == [-180, -90, 0, 90]
    assert PlacementSpace(yaw_deg=[0, 360, 100]).values("yaw_deg").tolist() == [0, 100, 200, 300]
    found = space.coordinates(np.array([0, 1, 71, 72, space.count - 1]))
    assert found[:, 5].tolist() == [0, 5, 355, 0, 355] and found[3, 3] == -45 and found[-1, 0] == pytest.approx(0.99)
    assert list(space.ranges) == ["x_m", "y_m", "roll_deg", "yaw_deg"] and PlacementSpace().count == 1


def test_frames_are_those_of_the_same_transform():
    coordinates = np.random.default_rng(0).uniform(-1, 1, (20, 6)) * ([2] * 3 + [400] * 3)
    for row, found in zip(coordinates, placed(coordinates), strict=True):
        expected = ws.Transform(position_m=row[:3].tolist(), rpy_deg=row[3:].tolist()).matrix()
        assert found == pytest.approx(expected, abs=1e-13)


def test_mountings():
    for name, z in (("floor", [0, 0, 1]), ("wall", [1, 0, 0]), ("ceiling", [0, 0, -1])):
        assert mounted(name)[:3, 2].tolist() == z


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("x_m", [0, 1], "must be a number, or [lower, upper, step]"),
        ("x_m", [1, 0, 0.1], "lower below upper and step above 0"),
        ("x_m", [0, 1, 0], "lower below upper and step above 0"),
        ("y_m", [0, 1, 2], "must have a step of at most its range, 1, not 2"),
        ("z_m", float("nan"), "must be a finite number"),
        ("z_m", 1e7, "must lie within"),
        ("z_m", "high", "must be a number"),
        ("yaw_deg", [0, 361, 1], "must hold at most one turn, not 361"),
    ],
)
def test_what_is_no_coordinate_is_refused(name, value, message):
    assert name in COORDINATES
    with pytest.raises((ws.DocumentError, ValidationError)) as refusal:
        PlacementSpace(**{name: value})
    assert name in str(refusal.value) and message in str(refusal.value)
