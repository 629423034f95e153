"""A base far from the world's origin, as in map coordinates, changes nothing but the positions."""

import numpy as np
import pytest

import wsrender as ws
from tests.mechanisms.mechanisms import known_ups
from tests.reference.class_robots import SphericalClass
from tests.robots.test_cases import FOLDER
from wsrender.engine import evaluate_kinematics
from wsrender.errors import InputError
from wsrender.robot import as_robot
from wsrender.volume.lattice import block_around

CASE = FOLDER / "19-georeferenced-base"
OFFSETS = [(500000.0, 4649776.0, 120.0), (1e5, 0.0, 0.0), (-1e6, 1e6, 1e6)]  # whole voxels
VOXEL = 0.05
ROUNDING = 2e-9  # m, of float64 at 5e6 m


def at(offset):
    return ws.Transform(position_m=offset)


def analyzed(robot, **options):
    options = {"voxel_size_m": VOXEL, "refined_volume": None, "device": "cpu"} | options
    return ws.analyze(robot, ws.Sobol(1 << 14), **options)


def robots(offset):
    """The same arm far away and at the origin: by a fixed joint of its own, or placed there."""
    near = ws.load_robot(CASE / "origin.urdf")
    return (ws.load_robot(CASE / "m.urdf") if offset == OFFSETS[0] else near.placed(at(offset))), near


@pytest.mark.parametrize("offset", OFFSETS)
@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_the_same_voxels_as_at_the_origin(offset, precision):
    far, near = (analyzed(robot, precision=precision, keep_map=True) for robot in robots(offset))
    for field in ("volume_m3", "indices", "global"):
        assert far.document[field] == near.document[field]
    np.testing.assert_array_equal(far.volume.count, near.volume.count)
    shift = np.subtract(far.volume.first_voxel, near.volume.first_voxel)
    assert tuple(shift) == tuple(round(length / VOXEL) for length in offset)
    for name, values in near.volume.statistics["maximum"].items():
        np.testing.assert_array_equal(far.volume.statistics["maximum"][name], values)
    error = 1e-6 if precision == "float32" else ROUNDING
    for positions in ("map", "sample"):
        moved = getattr(far, positions).position - offset
        np.testing.assert_allclose(moved, getattr(near, positions).position, atol=error)
    assert np.hypot(*(far.map.position - offset)[:, :2].T).max() <= 0.7 + 1e-6
    for end in ("lower", "upper"):
        np.testing.assert_allclose(
            np.subtract(far.document["bounds_m"][end], offset), near.document["bounds_m"][end], atol=1e-6
        )


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_grids_move_the_base_joint_where_it_stands(precision):
    far, near = robots(OFFSETS[0])
    options = {"voxel_size_m": VOXEL, "refined_volume": None, "precision": precision, "device": "cpu"}
    found, right = (ws.analyze(robot, ws.Grid(12), **options) for robot in (far, near))
    assert right.document["provenance"]["sampling_path"] == "collapsed"
    np.testing.assert_array_equal(found.volume.count, right.volume.count)


def test_capability():
    found = []
    for robot in robots(OFFSETS[0]):
        spec = robot.spec.model_dump(mode="json", exclude_none=True)
        document = {"analysis": "capability", "robot": spec, "voxel_size_m": 0.2, "directions": 12, "device": "cpu"}
        found.append(ws.execute(document).document["capability"])
    assert found[0] == found[1]
    assert found[0]["voxels"] > 50


def test_links_keep_their_digits():
    """Lengths are no differences of map coordinates."""
    far, near = (robot.chain for robot in robots(OFFSETS[0]))
    np.testing.assert_allclose(far.T_joint[1:], near.T_joint[1:], rtol=0, atol=1e-15)
    np.testing.assert_allclose(far.T_tip, near.T_tip, rtol=0, atol=1e-15)
    np.testing.assert_array_equal(far.T_joint[0, :3, 3], OFFSETS[0])
    assert far.base_frame == "world"


def test_a_base_below_the_far_joint_stands_at_the_origin():
    robot = ws.load_robot(CASE / "m.urdf", base="base")
    np.testing.assert_allclose(robot.chain.T_joint, robots(OFFSETS[0])[1].chain.T_joint, rtol=0, atol=1e-15)


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_kinematics_in_any_precision(precision):
    far, near = robots(OFFSETS[0])
    q = np.random.default_rng(1).uniform(near.lower_limits, near.upper_limits, (50, 3))
    found, right = (evaluate_kinematics(robot.chain, q, precision=precision, device="cpu") for robot in (far, near))
    assert found.pose.dtype == np.float64
    np.testing.assert_allclose(found.pose[:, :3, 3] - OFFSETS[0], right.pose[:, :3, 3], atol=ROUNDING)
    np.testing.assert_array_equal(found.pose[:, :3, :3], right.pose[:, :3, :3])
    np.testing.assert_array_equal(found.jacobian, right.jacobian)


@pytest.mark.parametrize("offset", OFFSETS)
def test_positions_in_float32_keep_every_bit(offset):
    """Counted from elsewhere than the base, those of a Panda moved by 1e-7 m, and a sample in a million its voxel."""
    near = ws.load_robot("franka_panda")
    options = {"indices": ["manipulability"], "keep_map": True}
    found, right = (analyzed(robot, **options) for robot in (near.placed(at(offset)), near))
    np.testing.assert_allclose(found.map.position - offset, right.map.position, rtol=0, atol=ROUNDING)
    np.testing.assert_array_equal(found.volume.count, right.volume.count)


def test_robots_near_the_origin_are_not_touched():
    """Every bit of theirs stays: the device counts from the world's origin."""
    near = ws.load_robot("ur5e").placed(at((2.0, -1.0, 0.5)))
    assert near.chain.relative_to(near.chain.origin) is near.chain
    assert not near.chain.origin.any()
    far = ws.load_robot("ur5e").placed(at((20.0, 0.0, 0.0)))
    np.testing.assert_array_equal(far.chain.origin, far.chain.center)
    assert block_around(np.array([3.0, 0, 0]), np.array([4.0, 1, 1]), 0.01).origin_voxel == (0, 0, 0)
    low, high = np.array([6.0, 0, 0]), np.array([7.0, 1, 1])
    assert block_around(low, high, 0.01).origin_voxel == (650, 50, 50)
    assert block_around(low, high, 0.01, about=np.array([6.2, 0.5, 0])).origin_voxel == (620, 50, 0)
    assert block_around(low, high, 0.01, about=np.array([0.2, 0.5, 0])).origin_voxel == (650, 50, 50)


def test_targets_and_the_refined_volume():
    far, near = robots(OFFSETS[0])
    targets = np.array([[0.5, 0.1, 0.4], [0.0, 0.2, 0.9], [2.0, 0.0, 0.0], [0.05, 0.0, 0.35], [0.7, 0.0, 0.3]])
    found, right = ws.reachable(far, targets + OFFSETS[0]), ws.reachable(near, targets)
    assert list(found.labels) == list(right.labels) == [*["reachable"] * 2, *["unreachable"] * 2, "reachable"]
    there = right.labels == "reachable"
    np.testing.assert_allclose(found.configurations[there], right.configurations[there], atol=1e-6)
    volumes = [analyzed(robot, refined_volume=0.1).document["headline"] for robot in (far, near)]
    assert volumes[0] == volumes[1]


def test_a_base_in_map_coordinates_is_no_link():
    far, near = robots(OFFSETS[0])
    index = [analyzed(robot, refined_volume=0.1).document["global"]["structural_length_index"] for robot in (far, near)]
    assert index[0] == pytest.approx(index[1], rel=1e-12)


def test_arms_beside_each_other_share_the_same_volume():
    shared = []
    for offset in ((0.0, 0.0, 0.0), OFFSETS[0]):
        arms = [robots(OFFSETS[2])[1].placed(at(np.add(offset, [x, 0, 0]))) for x in (0.0, 0.5)]
        result = ws.shared_workspace(arms, sampling=ws.Sobol(1 << 13), voxel_size_m=VOXEL, device="cpu")
        shared.append(result.document["volume_m3"])
    assert shared[0] == shared[1]


def test_a_robot_that_is_a_python_class():
    near = as_robot(SphericalClass())
    far = near.placed(at(OFFSETS[0]))
    results = [analyzed(robot, indices=["manipulability"]) for robot in (far, near)]
    np.testing.assert_array_equal(results[0].volume.count, results[1].volume.count)


def test_a_lattice_finer_than_the_digits_of_its_place():
    with pytest.raises(InputError, match=r"voxel_size_m: 1e-09 is too small 5e\+06 m from the world's origin"):
        block_around(np.full(3, 5e6), np.full(3, 5e6 + 0.1), 1e-9)


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_a_parallel_mechanism(precision):
    found = []
    for offset in ((0.0, 0.0, 0.0), OFFSETS[0]):
        mechanism = known_ups() | {"placement": {"position_m": offset}}
        options = {"voxel_size_m": VOXEL, "refined_volume": None, "precision": precision, "device": "cpu"}
        found.append(ws.parallel_workspace(mechanism, kind="constant_orientation", **options))
    near, far = found
    assert near.volume.n_occupied > 1000
    np.testing.assert_array_equal(far.volume.count, near.volume.count)
    assert far.document["volume_m3"] == near.document["volume_m3"]


def test_pictures_show_the_arm_where_it_stands():
    far, near = robots(OFFSETS[0])
    points = far.skeleton(np.zeros(3))[0]
    np.testing.assert_allclose(points - OFFSETS[0], near.skeleton(np.zeros(3))[0], atol=ROUNDING)
    placed = near.placed(at(OFFSETS[1])).skeleton(np.zeros(3))[0]
    np.testing.assert_array_equal(placed[0], OFFSETS[1])
    for k, axes in enumerate(analyzed(far).plot.slices().axes[:3]):
        name, value = axes.get_title().removesuffix(" m (world)").split(" = ")
        assert name == "xyz"[k]
        assert abs(float(value) - OFFSETS[0][k]) < 0.8
