"""Hybrid mechanisms against the parallel one moved by hand."""

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.mechanisms.mechanisms import SPEC, mechanism, poses_of
from wsrender.mechanisms.hybrid import hybrid_at, middle, reached_by_any, serial_transform, variants, workspace_points
from wsrender.mechanisms.inverse_kinematics import inverse_kinematics
from wsrender.mechanisms.jacobians import CONDITION_NUMBERS, jacobians, platform_jacobian
from wsrender.mechanisms.mechanism import mechanism_of
from wsrender.run import execute, plan

LIFT = {"type": "prismatic", "limits_m": [0.0, 0.4], "levels": 5}
DELTA = {"analysis": "parallel_workspace", "voxel_size_m": 0.05, "device": "cpu", "refined_volume": None}


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


TABLE = {"limits_deg": [-40, 40], "levels": 3}
ARM = {"type": "prismatic", "axis": [1, 0, 0], "limits_m": [-0.05, 0.05], "levels": 2}
HEXAPOD = {"library": "stewart_gough", "before": [TABLE], "after": [ARM]}
TURNS = {"euler_xyz_deg": [[0, 0], [-15, 15], [-30, 30]], "per_angle": [1, 2, 3]}


def reached_at(positions, rotation):
    """Whether any of HEXAPOD's six variants reaches positions, world, at an orientation against the fixed base."""
    hexapod, found = mechanism("stewart_gough"), np.zeros(len(positions), bool)
    for degrees in (-40, 0, 40):
        for shift in (-0.05, 0.05):
            back = turned(2, -degrees)
            platform = positions - rotation @ [shift, 0, 0]
            found |= inverse_kinematics(hexapod, poses_of(platform @ back.T, back @ rotation)).feasible
    return found


def test_orientations_of_a_hybrid_are_those_of_any_variant():
    """At a point, and over positions: dexterous shares and total orientation."""
    job = {"analysis": "parallel_workspace", "mechanism": HEXAPOD, "orientations": TURNS, "device": "cpu"}
    at_point = execute({**job, "kind": "orientation", "position_m": [0.25, 0.1, 0.55]})
    rotations = [
        ws.Transform(quat_wxyz=tuple(q)).matrix()[:3, :3] for q in at_point.tables["orientations"]["quat_wxyz"]
    ]
    expected = [reached_at(np.array([[0.25, 0.1, 0.55]]), R)[0] for R in rotations]
    np.testing.assert_array_equal(at_point.tables["orientations"]["reached"], expected)
    assert 0 < sum(expected) < 6 and at_point.skeleton is not None
    results = [
        execute({**job, "kind": kind, "voxel_size_m": 0.05, "method": method})
        for kind, method in (("dexterous", "grid"), ("dexterous", "grid_by_subsystem"), ("total_orientation", "grid"))
    ]
    volume = results[0].volume
    positions = (np.argwhere(volume.count >= 0) + volume.first_voxel + 0.5) * 0.05
    count = np.sum([reached_at(positions, R) for R in rotations], axis=0)
    np.testing.assert_array_equal(volume.count.ravel(), count)
    np.testing.assert_array_equal(results[1].volume.count, volume.count)
    voxels = results[2].document["volume_m3"]["occupied"] / 0.05**3
    assert 0 < round(voxels) == (count == 6).sum() < (count > 0).sum()


def tool_motion(variants_at, q_parallel, start):
    """The tool's pose (4, 4), fixed base, near a start, at given serial and actuated values, by least squares."""
    variant, T_before = variants_at

    def pose_of(x):
        pose = start.copy()
        pose[:3, 3] += x[:3]
        if not variant.mechanism.translational:
            pose[:3, :3] = Rotation.from_rotvec(x[3:]).as_matrix() @ pose[:3, :3]
        return pose

    def residual(x):
        in_base = np.linalg.inv(T_before) @ pose_of(x)
        if variant.mechanism.translational:
            in_base[:3, :3] = np.eye(3)
        return inverse_kinematics(variant.mechanism, in_base[None]).values[0] - q_parallel

    size = 3 if variant.mechanism.translational else 6
    return least_squares(residual, np.zeros(size), xtol=1e-15, ftol=1e-15, gtol=1e-15).x


@pytest.mark.parametrize(("name", "position"), [("stewart_gough", [0.03, -0.02, 0.55]), ("delta", [0.1, -0.05, -0.7])])
def test_the_composite_jacobian_is_the_derivative_of_the_tool(name, position):
    """Columns before, actuated and after, by central differences: each joint is moved, the others held."""
    before = [{"limits_deg": [20, 50], "levels": 2, "position_m": [0.1, 0.2, 0], "axis": [1, 0.5, 2]},
              {"type": "prismatic", "axis": [0, 1, 1], "limits_m": [0.1, 0.2], "levels": 2}]  # fmt: skip
    after = [{"limits_deg": [10, 40], "levels": 2, "position_m": [0.05, 0, 0.02], "axis": [0, 1, 1]},
             {"type": "prismatic", "axis": [1, 0, 1], "limits_m": [0.03, 0.1], "levels": 2}]  # fmt: skip
    variant = variants(SPEC.validate_python({"library": name, "before": before, "after": after}))[0]
    mech, translational = variant.mechanism, variant.mechanism.translational
    R = np.eye(3) if translational else Rotation.from_rotvec([0.1, -0.05, 0.15]).as_matrix()
    pose = poses_of([position], R)
    legs = inverse_kinematics(mech, pose)
    assert not np.isnan(legs.values).any()
    J = variant.composed(platform_jacobian(jacobians(mech, legs, pose)), pose)[0]
    q, actuated, step = variant.q, legs.values[0], 1e-5
    start = serial_transform(variant.before, q) @ pose[0]
    columns = []
    for joint in range(len(q) + len(actuated)):
        ends = []
        for sign in (1, -1):
            serial, parallel = q.copy(), actuated.copy()
            if joint < 2:
                serial[joint] += sign * step
            elif joint < 2 + len(actuated):
                parallel[joint - 2] += sign * step
            else:
                serial[joint - len(actuated)] += sign * step
            there = at_values(name, before, after, serial)
            ends.append(tool_motion((there, serial_transform(variant.before, serial)), parallel, start))
        columns.append((ends[0] - ends[1]) / (2 * step))
    found = J[: 3 if translational else 6]
    np.testing.assert_allclose(found, np.stack(columns, axis=1), atol=2e-6)


def at_values(name, before, after, q):
    """The hybrid at any values of its four serial joints."""
    spec = SPEC.validate_python({"library": name, "before": before, "after": after})
    return hybrid_at(mechanism_of(spec), spec, q)


def test_indices_of_a_hybrid_are_the_best_of_its_variants():
    job = {"analysis": "parallel_workspace", "mechanism": HEXAPOD, "voxel_size_m": 0.06, "device": "cpu",
           "indices": ["manipulability"], "characteristic_length_m": 0.3, "refined_volume": None}  # fmt: skip
    result = execute(job)
    values = result.volume.statistics["maximum"]["manipulability"]
    cell = np.argwhere(result.volume.count == result.volume.count.max())[0]
    position = (cell + result.volume.first_voxel + 0.5) * 0.06
    best = 0.0
    for variant in variants(SPEC.validate_python(HEXAPOD)):
        mech = variant.mechanism
        there = np.linalg.inv(mech.T_world_base) @ np.append(position, 1)
        pose = poses_of([there[:3]], variant.rotations(np.eye(3)[None])[0])
        legs = inverse_kinematics(mech, pose)
        if legs.feasible[0]:
            J = variant.composed(platform_jacobian(jacobians(mech, legs, pose)), pose)[0]
            J[:3] /= 0.3
            best = max(best, np.sqrt(np.linalg.det(J @ J.T)))
    assert values[tuple(cell)] == pytest.approx(best, rel=1e-9) and best > 0
    assert set(result.volume.statistics["center"]) == set(CONDITION_NUMBERS)
    assert "conditioning" in result.document and "singularities" not in result.document
    linear = execute({**DELTA, "mechanism": "master_4dof", "voxel_size_m": 0.1, "indices": ["manipulability"]})
    alone = execute({**DELTA, "mechanism": "delta", "voxel_size_m": 0.1, "indices": ["manipulability"]})
    # Another joint adds to J Jᵀ: the best of the hybrid is above that of the delta.
    best_of = [each.document["indices"]["manipulability"]["maximum"] for each in (linear, alone)]
    assert best_of[0] > best_of[1]


@pytest.mark.parametrize(
    ("fields", "field", "message"),
    [
        (
            {"mechanism": "master_4dof", "kind": "orientation", "position_m": [0, 0, -0.7],
             "orientations": {"tilt_deg": 5}},
            "kind", "single orientations",
        ),
        (
            {"mechanism": "delta", "kind": "dexterous", "orientations": {"tilt_deg": 5}},
            "kind", "a delta's platform does not turn",
        ),
        ({"mechanism": HEXAPOD, "method": "exact"}, "method", "union over the values of the serial joints"),
    ],
)  # fmt: skip
def test_what_makes_no_sense_of_hybrids(fields, field, message):
    with pytest.raises(ws.InputError, match=message) as caught:
        plan({"analysis": "parallel_workspace", "device": "cpu", **fields})
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
