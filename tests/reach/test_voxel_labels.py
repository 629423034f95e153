"""Labels of voxels under constraints, against closed forms."""

import numpy as np
import pytest

import wsrender as ws
from tests.reach import guarded_arms as arms
from wsrender.reach.voxel_labels import REASONS

FREE, BLOCKED, NONE = 1, 2, 0


def labelled(robot, sampling, around, voxel_size_m, **constraints):
    options = {"voxel_labels": True, "refined_volume": None, "device": "cpu", "precision": "float64"}
    result = ws.analyze(
        robot, sampling, environment=around, voxel_size_m=voxel_size_m, constraints=constraints or None, **options
    )
    volume = result.volumes["reachability"]
    label, reason = (volume.statistics["center"][name] for name in ("label", "reason"))
    there = ~np.isnan(label)
    points = (np.argwhere(there) + volume.first_voxel + 0.5) * voxel_size_m
    return result, points, label[there], reason[there]


def test_voxels_around_a_column(tmp_path):
    """Of the voxels that are decided at most .1 % are wrong, and at most 1 % are undecided."""
    column = ws.Cylinder(name="column", position_m=(*arms.COLUMN, 0), radius_m=arms.ROUND, length_m=2.0)
    result, points, label, reason = labelled(
        arms.scara().robot, ws.Sobol(1 << 17), ws.Environment([column]), 0.03, environment=True
    )
    reach, free, margin = arms.scara_labels(points)
    expected = np.select([free, reach], [FREE, BLOCKED], NONE)
    clear = margin > 1e-5
    assert (expected == BLOCKED).sum() > 100 and (expected == NONE).sum() > 100
    assert (clear & (label != -1) & (label != expected)).sum() <= 1e-3 * len(label)
    assert (label == -1).mean() <= 0.01
    blocked = label == BLOCKED
    assert (reason[blocked] == len(REASONS)).all() and not (reason[~blocked] >= len(REASONS)).any()
    counted = result.document["voxel_labels"]
    names = {"reachable": FREE, "unreachable": NONE, "blocked": BLOCKED, "undecided": -1}
    assert counted["labels"] == {name: (label == code).sum() for name, code in names.items()}
    assert counted["reasons"]["environment"] == blocked.sum()
    result.save(tmp_path)
    loaded = ws.Result.load(tmp_path).volumes["reachability"]
    assert loaded.units["label"].endswith("2 blocked") and loaded.units["reason"].endswith("5 environment")


@pytest.mark.parametrize("end", [None, 0.3], ids=["floor", "floor and region"])
def test_voxels_of_an_arm_in_a_plane_over_a_floor(end):
    """Equal links reach what is above the floor with the elbow up; what is beyond a region is blocked by that."""
    region = {} if end is None else {"region": {"box": {"upper_m": [end, None, None]}}}
    floor = ws.Environment([ws.HalfSpace(name="floor", point_m=(0, 0, arms.FLOOR))])
    _, points, label, reason = labelled(arms.two_links().robot, ws.Sobol(1 << 17), floor, 0.02, **region)
    off = 0.0174  # half a voxel's diagonal, and what rounding adds
    (x, y, z), height = points.T, points[:, 2] - arms.FLOOR - arms.RADIUS
    disc = (np.abs(y) < 0.0101) & (np.hypot(x, z) < 2 * arms.LINK - off)
    beyond = np.zeros(len(x), bool) if end is None else x > end + off
    within = np.ones(len(x), bool) if end is None else x < end - off
    # Label and reason of what is clearly one or the other; of voxels without a sample the solver misses a few.
    environment = len(REASONS) + len(region)
    for where, code, why in (
        (disc & within & (height > off), FREE, 0),
        (disc & within & (height < -off), BLOCKED, environment),
        (disc & beyond, BLOCKED, len(REASONS)),
        (np.abs(y) > 0.0101, NONE, 2),
    ):
        right = (label[where] == code) & (reason[where] == why)
        assert (where.any() or end is None) and (~right).sum() <= 1e-3 * where.sum()
