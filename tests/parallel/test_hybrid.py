"""Hybrid mechanisms against the parallel one moved by hand."""

import numpy as np
import pytest

import wsrender as ws
from tests.parallel.mechanisms import SPEC, mechanism, poses_of
from wsrender.parallel.hybrid import middle, reached_by_any, variants
from wsrender.parallel.inverse_kinematics import inverse_kinematics
from wsrender.parallel.workspace_points import workspace_points
from wsrender.run import execute, plan

LIFT = {"type": "prismatic", "limits_m": [0.0, 0.4], "levels": 5}
DELTA = {"analysis": "parallel_workspace", "voxel_size_m": 0.05, "device": "cpu"}


def turned(axis, degrees):
    c, s = np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))
    j, k = (axis + 1) % 3, (axis + 2) % 3
    R = np.eye(3)
    R[j, j] = R[k, k] = c
    R[k, j], R[j, k] = s, -s
    return R


@pytest.mark.parametrize("side", ["before", "after"])
def test_a_lift_shifts_the_workspace(side):
    """Levels 0.1 m apart, two voxels: the union of five copies of the delta's voxels, whichever side the lift is on."""
    alone = execute({**DELTA, "mechanism": "delta"}).volume
    result = execute({**DELTA, "mechanism": {"library": "delta", side: [LIFT]}})
    expected = np.zeros(result.volume.count.shape, np.int64)
    x, y, z = np.subtract(alone.first_voxel, result.volume.first_voxel)
    nx, ny, nz = alone.count.shape
    for level in range(5):
        expected[x : x + nx, y : y + ny, z + 2 * level : z + 2 * level + nz] += alone.count
    np.testing.assert_array_equal(result.volume.count, expected)
    assert result.document["serial_configurations"] == 5


def test_master_4dof_is_a_delta_on_a_turning_base():
    """Random points against inverse kinematics of the delta in the turned frame, at every level."""
    found = variants(SPEC.validate_python("master_4dof"))
    assert len(found) == 25
    points = np.random.default_rng(0).uniform([-0.7, -1, -1.1], [0.7, 1, 0.3], (4000, 3))
    delta = mechanism("delta")
    expected = np.zeros(len(points), bool)
    for degrees in np.linspace(-60, 60, 25):
        expected |= inverse_kinematics(delta, poses_of(points @ turned(0, degrees))).feasible
    np.testing.assert_array_equal(reached_by_any(found, points, np.eye(3)[None], device="cpu"), expected)
    assert 0.1 < expected.mean() < 0.9
    assert middle(found).q.tolist() == [0.0]


def test_orientations_are_those_against_the_fixed_base():
    """A hexapod on a turntable: at a quarter turn its platform, level in the world, is turned back in its base."""
    table = {"limits_deg": [0, 90], "levels": 2}
    found = variants(SPEC.validate_python({"library": "stewart_gough", "before": [table]}))
    hexapod, points = (
        mechanism("stewart_gough"),
        np.random.default_rng(1).uniform([-0.3, -0.3, 0.3], [0.3, 0.3, 0.8], (3000, 3)),
    )
    asked = turned(2, 60)
    poses = [poses_of(points, asked), poses_of(points @ turned(2, 90), turned(2, 90).T @ asked)]
    expected = np.any([inverse_kinematics(hexapod, each).feasible for each in poses], axis=0)
    np.testing.assert_array_equal(reached_by_any(found, points, asked[None], device="cpu"), expected)
    assert expected.any()


def test_joints_after_the_platform_move_the_tool():
    """An arm of 0.2 m on the platform, at 0 and 90°: the platform stands where the tool's pose puts it."""
    arm = [
        {"limits_deg": [0, 90], "levels": 2},
        {"type": "prismatic", "axis": [1, 0, 0], "limits_m": [0.2, 0.3], "levels": 2},
    ]
    region = {"lower_m": [None, None, 0.3]}
    found = variants(SPEC.validate_python({"library": "stewart_gough", "after": arm, "region": region}))
    hexapod = mechanism({"library": "stewart_gough", "region": region})
    points = np.random.default_rng(1).uniform([-0.6, -0.6, 0.3], [0.6, 0.6, 0.8], (3000, 3))
    expected = np.zeros(len(points), bool)
    for degrees in (0, 90):
        for reach in (0.2, 0.3):
            platform = turned(2, degrees).T  # the tool is level in the world
            expected |= inverse_kinematics(hexapod, poses_of(points - [reach, 0, 0], platform)).feasible
    np.testing.assert_array_equal(reached_by_any(found, points, np.eye(3)[None], device="cpu"), expected)
    assert expected.any()


def test_the_volume_of_master_4dof_is_refined_over_its_joint():
    job = {**DELTA, "mechanism": "master_4dof", "refined_volume": 0.04}
    found = execute(job).document["volume_m3"]
    low, high = found["refined"]["ci95"]
    points = np.random.default_rng(5).uniform([-0.7, -1, -1.1], [0.7, 1, 0.3], (40_000, 3))
    hits = np.zeros(len(points), bool)
    for degrees in np.linspace(-60, 60, 25):
        hits |= inverse_kinematics(mechanism("delta"), poses_of(points @ turned(0, degrees))).feasible
    share = hits.mean()
    size = 1.4 * 2 * 1.4
    error = 3 * np.sqrt(share * (1 - share) / len(points)) * size
    assert low - error < share * size < high + error


@pytest.mark.parametrize(
    ("fields", "field"),
    [
        ({"kind": "orientation", "position_m": [0, 0, -0.7], "orientations": {"tilt_deg": 5}}, "kind"),
        ({"method": "exact"}, "method"),
        ({"indices": "kinematic"}, "indices"),
    ],
)
def test_what_hybrids_do_not_have(fields, field):
    table = {"limits_deg": [0, 90], "levels": 2}
    with pytest.raises(ws.InputError) as caught:
        plan({"analysis": "parallel_workspace", "mechanism": {"library": "stewart_gough", "before": [table]}, **fields})
    assert caught.value.field == field


def test_points_fill_the_workspace_evenly():
    points = workspace_points(SPEC.validate_python("delta"), 5000, device="cpu")
    assert points.shape == (5000, 3)
    assert inverse_kinematics(mechanism("delta"), poses_of(points)).feasible.all()
    volume = execute({**DELTA, "mechanism": "delta"}).volume
    middle = (volume.first_voxel + (np.argwhere(volume.occupied) + 0.5).mean(axis=0)) * 0.05
    np.testing.assert_allclose(points.mean(axis=0), middle, atol=0.01)
    with pytest.raises(ws.InputError, match="reaches no position"):
        workspace_points(SPEC.validate_python({"library": "stewart_gough", "length_m": [0.01, 0.1]}), 10, device="cpu")


def test_a_slave_maps_into_a_hybrid_master():
    """slave_5r into master_4dof: the scale that is found maps all points inside, and a larger one does not."""
    job = {
        "master": {"mechanism": "master_4dof", "count": 2000},
        "slave": "slave_5r",
        "sampling": ws.Sobol(500),
        "offsets_m": [[0.0, 0.0, -0.75]],
        "search": {"scale": [0.05, 2.0], "steps": 8},
        "device": "cpu",
    }
    found = ws.master_slave_mapping(**job)
    assert found.document["mapping"]["succeeded"]
    scale = found.document["mapping"]["scale"][0]
    larger = ws.master_slave_mapping(**{**job, "search": None, "scale": 1.2 * scale})
    assert not larger.document["mapping"]["succeeded"]
