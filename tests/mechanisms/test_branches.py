"""Legs that may stand on either branch: decided branch by branch, then joined."""

from itertools import product

import numpy as np
import pytest

import wsrender as ws
from tests.mechanisms.mechanisms import SPEC, mechanism, poses_of
from wsrender.mechanisms.inverse_kinematics import inverse_kinematics
from wsrender.mechanisms.mechanism import legs_of
from wsrender.mechanisms.membership import count_at, poses_labelled
from wsrender.run import execute

JOB = {"analysis": "parallel_workspace", "device": "cpu", "refined_volume": None}
HEXAPOD = [leg.model_dump(mode="json") for leg in legs_of(SPEC.validate_python("stewart_gough"))]


def one_crank(branch):
    """Five UPS legs and one RUS, its crank from 20 to 160°."""
    x, y, _ = HEXAPOD[0]["base_m"]
    crank = {"type": "RUS", "base_m": [x, y, 0.0], "platform_m": HEXAPOD[0]["platform_m"], "axis": [x, y, 0.0],
             "zero": [-y, x, 0.0], "crank_m": 0.3, "link_m": 0.4, "angle_deg": [20, 160], "branch": branch}  # fmt: skip
    return {"legs": [crank, *HEXAPOD[1:]], "region": {"lower_m": [None, None, 0.0]}}


def six_cranks(branch, **fields):
    """Six RUS legs on the hexapod's circles; at 0° the cranks are level along them."""
    legs = []
    for leg in HEXAPOD:
        x, y, _ = leg["base_m"]
        legs.append({"type": "RUS", "base_m": leg["base_m"], "platform_m": leg["platform_m"], "axis": [x, y, 0.0],
                     "zero": [-y, x, 0.0], "crank_m": 0.25, "link_m": 0.6, "angle_deg": [-170, 170],
                     "branch": branch if isinstance(branch, str) else branch[len(legs)]})  # fmt: skip
    return {"legs": legs, "region": {"lower_m": [None, None, 0.0]}, **fields}


def rows(points):
    """Points [m] to the nanometre, in an order of their own."""
    return sorted(map(tuple, np.round(points, 9).tolist()))


def test_a_crank_on_another_branch_is_no_singularity():
    """ "plus" and "minus" alone have no change of sign of det B; "either" had hundreds, from one posture to another."""
    job = {**JOB, "voxel_size_m": 0.03, "indices": ["manipulability"], "characteristic_length_m": 0.3}
    either, plus, minus = (execute({**job, "mechanism": one_crank(b)}) for b in ("either", "plus", "minus"))
    entry = either.document["singularities"]
    alone = [each.document["singularities"] for each in (plus, minus)]
    assert entry["type_1"]["sign_changes"] == 0 == sum(each["type_1"]["sign_changes"] for each in alone)
    assert entry["type_2"]["sign_changes"] == sum(each["type_2"]["sign_changes"] for each in alone)
    assert entry["type_1"]["positive_voxels"] > 100 and entry["type_1"]["negative_voxels"] > 100
    assert entry["branches"] == 2 and "branch" in either.tables["singularities"].columns
    # An index is the best of the postures that reach a voxel.
    best = {}
    for result in (plus, minus):
        values = result.volume.voxels.statistics["maximum"]["manipulability"]
        for cell, value in zip(map(tuple, result.volume.voxels.at.T + result.volume.first_voxel), values, strict=True):
            best[cell] = max(best.get(cell, 0.0), value)
    cells = map(tuple, either.volume.voxels.at.T + either.volume.first_voxel)
    found = either.volume.voxels.statistics["maximum"]["manipulability"]
    assert dict(zip(cells, found, strict=True)) == pytest.approx(best, rel=1e-9)
    assert "determinant_B" not in either.volume.statistics["center"] and "determinant_B" in plus.volume.units


def test_both_branches_in_the_same_voxel_are_searched_apart():
    """det A of one branch changes sign where that of the other does not: the table says on which."""
    job = {**JOB, "voxel_size_m": 0.05, "indices": ["manipulability"], "characteristic_length_m": 0.3}
    mech = one_crank("either") | {"region": {"lower_m": [None, None, -0.6]}}
    mech["legs"] = [mech["legs"][0] | {"angle_deg": [-170, 170]}] + [
        {**leg, "length_m": [0.2, 0.9]} for leg in HEXAPOD[1:]
    ]
    table = execute({**job, "mechanism": mech}).tables["singularities"]
    for branch in ("plus", "minus"):
        alone = {**mech, "legs": [mech["legs"][0] | {"branch": branch}, *mech["legs"][1:]]}
        expected = execute({**job, "mechanism": alone}).tables["singularities"]["position"]
        sign = ("+" if branch == "plus" else "-") + "+" * 5
        found = table["position"][table["branch"] == sign]
        assert len(expected) > 0 and rows(found) == rows(expected)


def least_distance(mechanism, legs):
    (constraint,) = mechanism.constraints
    return constraint.distance(np.stack([legs.elbows, legs.joints], axis=2))


def test_legs_keep_their_distance_on_some_branches():
    """A pose is reached where any of the 64 combinations of branches reaches it."""
    points = np.random.default_rng(2).uniform([-0.25, -0.25, 0.2], [0.25, 0.25, 0.8], (600, 3))
    limited = {"minimum_leg_distance_m": 0.1}
    poses = poses_of(points)
    expected = np.zeros(len(points), bool)
    for branches in product(("plus", "minus"), repeat=6):
        legs = inverse_kinematics(mechanism(six_cranks(branches)), poses)
        far = least_distance(mechanism(six_cranks(branches, **limited)), legs) >= 0.1
        expected |= legs.feasible & far
    mech = mechanism(six_cranks("either", **limited))
    legs = inverse_kinematics(mech, poses)
    np.testing.assert_array_equal(legs.feasible, expected)
    np.testing.assert_array_equal(poses_labelled(mech, poses, device="cpu")[0] == 1, expected)
    counts = count_at(mech, points, np.eye(3)[None], device="cpu")
    np.testing.assert_array_equal(np.isin(np.arange(600), counts.cells[counts.reached > 0]), expected)
    # The elbows are those of a combination that keeps its distance.
    assert (least_distance(mech, legs)[expected] >= 0.1).all()
    first = inverse_kinematics(mechanism(six_cranks("either")), poses)
    kept = first.feasible & (least_distance(mech, first) >= 0.1)
    assert 0 < kept.sum() < 0.9 * expected.sum() < first.feasible.sum()


def test_voxels_of_legs_that_keep_their_distance():
    job = {**JOB, "voxel_size_m": 0.08, "mechanism": six_cranks("either", minimum_leg_distance_m=0.1)}
    result = execute(job)
    centres = (result.volume.voxels.at.T + result.volume.first_voxel + 0.5) * 0.08
    assert inverse_kinematics(mechanism(job["mechanism"]), poses_of(centres)).feasible.all()
    by_grid = execute({**job, "method": "grid"})
    np.testing.assert_array_equal(by_grid.volume.count, result.volume.count)
    assert result.skeleton is not None
    fixed = execute({**job, "mechanism": six_cranks("plus", minimum_leg_distance_m=0.1)})
    assert fixed.volume is None or fixed.volume.n_occupied < result.volume.n_occupied
    with pytest.raises(ws.InputError, match="leg_distance: two legs come closer"):
        home = {"position_m": [0.0, 0.0, 0.45]}
        execute({**job, "mechanism": six_cranks("either", minimum_leg_distance_m=0.35, home=home)})


@pytest.mark.parametrize("branch", ("plus", ("either", *["plus"] * 5)), ids=("plus", "first either"))
@pytest.mark.parametrize("method", ("grid", "grid_by_subsystem"))
def test_poses_at_which_legs_are_too_close_count_by_that_reason(method, branch):
    """Of what the same mechanism reaches where legs may cross, by kernels, and pose by pose where they choose."""
    job = {**JOB, "voxel_size_m": 0.06, "method": method}
    free = execute({**job, "mechanism": six_cranks(branch)})
    kept = execute({**job, "mechanism": six_cranks(branch, minimum_leg_distance_m=0.1)})
    drawn, admitted = (int(result.volume.count.sum()) for result in (free, kept))
    rejected = {"leg_distance": drawn - admitted}
    assert kept.document["samples"] == {"drawn": drawn, "admitted": admitted, "rejected": rejected}
    assert 0 < admitted < drawn and "samples" not in free.document
    assert f"{admitted:,} of {drawn:,}; rejected by leg_distance {drawn - admitted:,}" in kept.summary()


TILTS = {"euler_xyz_deg": [[-20, 20]] * 3, "per_angle": 3}


def test_rejected_poses_of_many_orientations_of_one_place_and_of_carried_bases():
    """All that is drawn is what is reached where legs may cross."""
    limited = {"minimum_leg_distance_m": 0.1}
    slide = {"type": "prismatic", "axis": [0, 0, 1], "limits_m": [0.0, 0.05], "levels": 2}
    carried = {"mechanism": six_cranks("plus", before=[slide]), "voxel_size_m": 0.08}
    point = {"kind": "orientation", "position_m": [0.0, 0.0, 0.5], "orientations": TILTS}
    lattice = {"kind": "dexterous", "voxel_size_m": 0.08, "orientations": TILTS}
    for kind in (point, lattice, carried):
        legs = kind.get("mechanism", six_cranks("plus"))
        free, kept = (execute({**JOB, **kind, "mechanism": {**legs, **more}}) for more in ({}, limited))
        drawn, admitted = (
            result.document["orientation_workspace"]["reached"] if kind is point else int(result.volume.count.sum())
            for result in (free, kept)
        )
        samples = {"drawn": drawn, "admitted": admitted, "rejected": {"leg_distance": drawn - admitted}}
        assert kept.document["samples"] == samples and 0 < admitted < drawn
