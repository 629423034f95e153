"""Bits of many placements, whose bases are made on the device, say what is decided pair by pair."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from wsrender.documents.placements import IN_DEGREES, PlacementSpace, placed
from wsrender.reach import InverseSolver
from wsrender.reach import placements as module
from wsrender.reach.evidence import REACHABLE, UNDECIDED
from wsrender.reach.placements import Placements, PlacementsOfKinds
from wsrender.robots.moving_base import MovingBase

SPACE = PlacementSpace(x_m=(0.9, 1.9, 0.1), y_m=(-0.4, 0.4, 0.2), z_m=0.1, pitch_deg=(0, 30, 15), yaw_deg=(0, 360, 40))
NUMBERS = [range(0, 9), range(5, SPACE.count, 9), range(1, SPACE.count)]


def placements(name, at):
    """What decides targets of an arm that hangs a little aslant; poses at the numbers ``at`` first, positions else."""
    chain, random = ws.load_robot(name).chain, np.random.default_rng(3)
    lower, upper = SPACE.limits
    T_frame_base, T = np.eye(4), np.tile(np.eye(4), (sum(map(len, at)), 1, 1))
    T_frame_base[:3] = np.hstack([Rotation.from_euler("xyz", [0.3, 0.1, 0.2]).as_matrix(), [[0.02], [0.03], [0.05]]])
    T[:, :3, :3] = Rotation.random(len(T), random_state=1).as_matrix()
    T[:, :3, 3] = random.uniform([1.0, -0.4, 0.1], [1.8, 0.4, 0.9], (len(T), 3))
    base = MovingBase(lower * IN_DEGREES, upper * IN_DEGREES, T_frame_base)
    kinds = zip(("pose", "position"), at, strict=False)
    parts = [
        Placements(InverseSolver(chain, kind=kind, position_m=1e-5, angle_rad=1e-5, threads=2), base, T[of], None)
        for kind, of in kinds
    ]
    return PlacementsOfKinds(parts, at)


@pytest.mark.parametrize("numbers", NUMBERS, ids=["few", "one of each position", "all but one"])
@pytest.mark.parametrize(
    ("name", "at"),
    [
        ("ur5e", [np.arange(10)]),
        ("puma560", [np.array([0, 3, 8, 9, 16]), np.array([1, 2, 4, 5, 6, 7, 10, 11, 12, 13, 14, 15])]),
        ("franka_panda", [np.arange(10)]),
    ],
)
def test_bits_are_the_labels(name, at, numbers):
    search = placements(name, at)
    assert search.by_bits
    coordinates = SPACE.coordinates(np.array(numbers))
    found = search.decide(coordinates * IN_DEGREES, placed(coordinates))
    masks = found.label == REACHABLE, found.label == UNDECIDED, found.proven
    for got, mask in zip(search.bits(SPACE, numbers), masks, strict=True):
        np.testing.assert_array_equal(got, np.packbits(mask, axis=1, bitorder="little"))
    assert len(numbers) < 100 or (masks[0].any() and masks[2].any())


@pytest.mark.parametrize(("told", "batch"), [(1 << 22, 1 << 16), (300, 1 << 16), (1 << 22, 37)])
def test_pairs_that_closed_forms_leave_open_are_decided(monkeypatch, told, batch):
    """With a margin so wide that many are left; at once, or in parts."""
    monkeypatch.setattr(module, "PAIRS_TOLD", told)
    monkeypatch.setattr(module, "BATCH", batch)
    search = placements("ur5e", [np.arange(10)])
    coordinates = SPACE.coordinates(np.arange(0, SPACE.count, 5))
    monkeypatch.setattr(type(search.parts[0].solver.closed), "margin", 0.5)
    found = search.decide(coordinates * IN_DEGREES, placed(coordinates))
    tried = []
    decided = Placements._decided
    monkeypatch.setattr(Placements, "_decided", lambda *asked: tried.append(asked[1]) or decided(*asked))
    masks = found.label == REACHABLE, found.label == UNDECIDED, found.proven
    for got, mask in zip(search.bits(SPACE, range(0, SPACE.count, 5)), masks, strict=True):
        np.testing.assert_array_equal(got, np.packbits(mask, axis=1, bitorder="little"))
    assert sum(map(len, tried)) > 100


def test_a_column_holds_a_coordinate_of_all_placements():
    coordinates = SPACE.coordinates(np.arange(SPACE.count))
    for k, name in enumerate(("x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg")):
        np.testing.assert_array_equal(SPACE.column(name), coordinates[:, k])
    assert (coordinates[1] - coordinates[0]).tolist() == [0, 0, 0, 0, 0, 40]
