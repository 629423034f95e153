"""Methods A and B on every device: the same voxels, those of float64 inverse kinematics."""

import numpy as np
import pytest
import warp as wp
from scipy.spatial.transform import Rotation

from tests.mechanisms.mechanisms import known_ups, mechanism, poses_of
from wsrender.engine import count_orientations, count_orientations_at, poses_reached
from wsrender.engine.membership import survivors
from wsrender.mechanisms.inverse_kinematics import inverse_kinematics
from wsrender.mechanisms.membership import leg_test, placed_box, reachable_box
from wsrender.volume.lattice import block_around

CONE = {"axis": [0, 0, 1], "half_angle_deg": 50}
UPS = {"type": "UPS", "platform_m": [0.1, 0, 0], "length_m": [0.5, 1.2], "base_cone": CONE, "platform_cone": CONE}
MIXED = {
    "legs": [
        {**UPS, "base_m": [0.4, 0, 0]},
        {"type": "PUS", "base_m": [-0.4, 0, 0], "platform_m": [-0.1, 0, 0], "axis": [0, 1, 1], "slide_m": [-0.3, 0.4],
         "link_m": 0.9, "branch": "minus"},
        {"type": "PUS", "base_m": [0, -0.4, 0], "platform_m": [0, -0.1, 0], "axis": [1, 0, 0], "slide_m": [-0.3, 0.4],
         "link_m": 0.9},
        {"type": "RUS", "base_m": [0, 0.4, 0], "platform_m": [0, 0.1, 0], "axis": [1, 0, 0], "zero": [0, 1, 0],
         "crank_m": 0.3, "link_m": 0.9, "angle_deg": [-60, 120],
         "base_cone": {"axis": [0, 0, 1], "half_angle_deg": 80}},
    ],
    "minimum_leg_distance_m": 0.12,
    "placement": {"position_m": [0.3, -0.2, 0.1], "rpy_deg": [20, 10, 30]},
}  # fmt: skip
DOCUMENTS = {
    "six_pus": ("six_pus", 0.06),
    "stewart_gough": ("stewart_gough", 0.02),
    "delta": ("delta", 0.025),
    "known_ups": (known_ups(), 0.09),
    "mixed": (MIXED, 0.05),
}


def block_of(mech, rotations, size):
    box = placed_box(mech, reachable_box(mech, rotations))
    return block_around(box.lower, box.upper, size)


def twin(mech, block, rotation):
    """Of every voxel centre, by float64 inverse kinematics: whether it is reached."""
    cells = np.stack(np.unravel_index(np.arange(block.size), block.shape), axis=1)
    world = (cells + block.first_voxel + 0.5) * block.voxel_size_m
    T = mech.T_world_base
    return inverse_kinematics(mech, poses_of((world - T[:3, 3]) @ T[:3, :3], rotation)).feasible


def dense(found, count):
    """Orientations reached of every voxel of a range that begins at 0."""
    assert (np.diff(found.cells) > 0).all() and (found.reached > 0).all()
    reached = np.zeros(count, np.int64)
    reached[found.cells] = found.reached
    return reached


@pytest.mark.parametrize("name", DOCUMENTS)
def test_both_methods_give_the_voxels_of_inverse_kinematics(name, precision, device):
    document, size = DOCUMENTS[name]
    mech = mechanism(document)
    rotations = np.eye(3)[None]
    if not mech.translational:  # small tilts, so that something is reached at each
        turns = np.random.default_rng(4).normal(scale=0.15, size=(3, 3))
        rotations = np.concatenate([rotations, Rotation.from_rotvec(turns).as_matrix()])
    block, test = block_of(mech, rotations, size), leg_test(mech, precision)
    every, survivors = (
        count_orientations(test, block, rotations, 0, block.size, by_subsystem=by_subsystem, device=device)
        for by_subsystem in (False, True)
    )
    np.testing.assert_array_equal(every.cells, survivors.cells)
    np.testing.assert_array_equal(every.reached, survivors.reached)
    np.testing.assert_array_equal(every.weights, every.reached)
    assert survivors.asked < every.asked == block.size * len(rotations) * len(mech.kinds)
    expected = np.sum([twin(mech, block, rotation) for rotation in rotations], axis=0)
    assert 0 < np.count_nonzero(expected) < block.size
    # Only a centre within rounding of a boundary may differ; in float32 some may be.
    differing = np.count_nonzero(dense(every, block.size) != expected)
    assert differing <= (0 if precision == "float64" else 1e-4 * np.count_nonzero(expected))


def test_ranges_and_chunks_change_nothing(device):
    mech = mechanism("six_pus")
    rotations = np.eye(3)[None]
    block, test = block_of(mech, rotations, 0.1), leg_test(mech)
    whole = count_orientations(test, block, rotations, 0, block.size, device=device)
    parts = [(0, 512), (512, 2560), (3072, block.size - 3072)]
    found = [
        count_orientations(test, block, rotations, first, count, device=device, threads=2, chunk_size=700)
        for first, count in parts
    ]
    for name in ("cells", "reached", "weights"):
        np.testing.assert_array_equal(np.concatenate([getattr(part, name) for part in found]), getattr(whole, name))


def test_weights_add_up_per_position(device):
    """Positions given one by one: counts and weights of the orientations that each pose test finds."""
    mech, random = mechanism("stewart_gough"), np.random.default_rng(8)
    rotations = Rotation.from_euler("xyz", random.uniform(-30, 30, (5, 3)), degrees=True).as_matrix()
    positions = random.uniform([-0.2, -0.2, 0.4], [0.2, 0.2, 0.7], (777, 3))
    weights = np.array([1, 20, 300, 4000, 50000], np.int32)
    test = leg_test(mech)
    found = count_orientations_at(test, positions, rotations, weights=weights, device=device)
    each = np.stack([poses_reached(test, poses_of(positions, R), device=device) for R in rotations], axis=1)
    twins = np.stack([inverse_kinematics(mech, poses_of(positions, R)).feasible for R in rotations], axis=1)
    np.testing.assert_array_equal(each, twins)
    np.testing.assert_array_equal(found.reached, each.sum(axis=1))
    np.testing.assert_array_equal(found.weights, each @ weights)
    assert 0 < each.sum() < each.size


@pytest.mark.parametrize("name", ["six_pus", "stewart_gough", "delta", "mixed"])
def test_the_box_holds_everything_that_is_reached(name):
    """Random points outside the box, up to twice its size, are not reached."""
    mech, random = mechanism(DOCUMENTS[name][0]), np.random.default_rng(6)
    box = reachable_box(mech, np.eye(3)[None])
    middle, half = (box.lower + box.upper) / 2, (box.upper - box.lower) / 2
    points = middle + half * random.uniform(-2, 2, (20_000, 3))
    outside = ((points < box.lower) | (points > box.upper)).any(axis=1)
    assert not inverse_kinematics(mech, poses_of(points[outside])).feasible.any()


def test_method_b_evaluates_far_fewer_legs(device):
    """Of six legs fewer than half: those of the parts of 32 voxels in which the last subsystem leaves a survivor."""
    mech = mechanism("six_pus")
    rotations = np.eye(3)[None]
    block = block_of(mech, rotations, 0.03)
    found = count_orientations(leg_test(mech), block, rotations, 0, block.size, device=device)
    assert found.asked < 2.8 * block.size


def test_survivors_leave_the_device_in_order(device):
    """Also where the last block is not full, and where nothing survives."""
    random = np.random.default_rng(0)
    for count, share in ((100_001, 0.1), (1000, 0.0), (0, 0.0)):
        reached = np.where(random.random(count) < share, random.integers(1, 9, count), 0).astype(np.int32)
        arrays = [wp.array(values, dtype=wp.int32, device=device) for values in (reached, 7 * reached)]
        cells, counts, sums = survivors(*arrays, count)
        np.testing.assert_array_equal(cells, np.flatnonzero(reached))
        np.testing.assert_array_equal(counts, reached[cells])
        np.testing.assert_array_equal(sums, 7 * counts)


def test_nothing_to_test():
    test = leg_test(mechanism("delta"))
    assert poses_reached(test, np.zeros((0, 4, 4)), device="cpu").shape == (0,)
    assert count_orientations_at(test, np.zeros((0, 3)), np.eye(3)[None], device="cpu").reached.shape == (0,)
