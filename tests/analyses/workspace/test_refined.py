"""The refined volume and the labelled voxels of a workspace job."""

import numpy as np
import pytest

import wsrender as ws
from tests.reference import closed_form_inverse as closed_form
from tests.run.simple_robots import PlanarClass
from wsrender.reach.voxel_labels import REASONS
from wsrender.robots.dh import structural_length

SURFACE = "the tip stays on a surface"
EXACT = np.pi / 2 * np.sqrt(2) * (0.4**3 - 0.2**3) / 3


@pytest.fixture(scope="module")
def result():
    return ws.analyze(
        ws.load_robot("spherical"),
        ws.Sobol(20_000),
        voxel_size_m=0.02,
        refined_volume=0.02,
        voxel_labels=True,
        device="cpu",
    )


def test_refined_volume_stands_beside_the_counts(result):
    refined = result.document["volume_m3"]["refined"]
    low, high = refined["ci95"]
    assert low <= EXACT <= high
    assert high - low <= 2 * 0.02 * refined["value"]
    assert (refined["met"], refined["tolerance"]) == (True, 0.02)
    assert result.document["headline"] == {
        "quantity": "volume",
        "value": refined["value"],
        "ci95": [low, high],
        "unit": "m3",
        "reason": "",
    }
    length = structural_length(ws.load_robot("spherical").chain)
    assert result.document["global"]["structural_length_index"] == pytest.approx(length / refined["value"] ** (1 / 3))
    assert "refined volume" not in result.summary()  # the headline says it


def test_every_voxel_near_the_workspace_has_its_label(result, tmp_path):
    labelled = result.volumes["reachability"]
    label, reason = (labelled.statistics["center"][name] for name in ("label", "reason"))
    centers = np.stack(np.meshgrid(*(labelled.centers(axis) for axis in range(3)), indexing="ij"), axis=-1)
    robot, decided = ws.load_robot("spherical"), ~np.isnan(label)
    arm = closed_form.spherical_arm(centers[decided])
    limits = robot.lower_limits[:3], robot.upper_limits[:3], robot.chain.revolute[:3]
    truth = closed_form.within_limits(arm, *limits).any(axis=1)
    assert (label[decided] == truth).all()
    # What its hinges could reach without limits lies in the shell of its slide.
    radius = np.linalg.norm(centers[decided], axis=1)
    expected = np.where(truth, "", "joint limits")
    assert (np.array(REASONS)[reason[decided].astype(int)] == expected).all()
    assert ((radius < 0.2) | (radius > 0.4)).any()
    voxels = result.document["voxel_labels"]
    assert voxels["labels"] == {"reachable": truth.sum(), "unreachable": (~truth).sum(), "undecided": 0}
    result.save(tmp_path)
    restored = ws.Result.load(tmp_path).volumes["reachability"]
    assert np.array_equal(restored.statistics["center"]["label"], label, equal_nan=True)


def test_voxels_of_an_arm_in_a_plane_beside_their_centres():
    """2R in a plane that is turned and lies off the lattice: reached is a ring, .15 … .45 m around the base."""
    rows = [ws.DHRow(a=0.3), ws.DHRow(a=0.15)]
    table = ws.DHTable(convention="standard", rows=rows)
    robot = ws.load_robot(table, placement=ws.Transform(position_m=(0.1, 0, 0.037), rpy_deg=(30, 0, 0)))
    options = {"voxel_size_m": 0.02, "refined_volume": 0.01, "voxel_labels": True, "device": "cpu"}
    result = ws.analyze(robot, ws.Sobol(200_000), **options)
    labelled = result.volumes["reachability"]
    label = labelled.statistics["center"]["label"]
    assert (label[labelled.occupied] == 1).all()
    local = np.argwhere(~np.isnan(label)) + labelled.first_voxel + 0.5
    local = (local * 0.02 - [0.1, 0, 0.037]) @ robot.chain.T_world_base[:3, :3]
    radius, height = np.hypot(*local[:, :2].T), np.abs(local[:, 2])
    found = label[~np.isnan(label)] == 1
    # The inscribed ball of a voxel is .01 m, the circumscribed one .0173 m.
    assert found[(height < 0.01) & (radius > 0.15) & (radius < 0.45)].all()
    assert not found[(height > 0.0174) | (radius < 0.13) | (radius > 0.47)].any()
    assert result.document["voxel_labels"]["labels"]["reachable"] == found.sum()
    document = result.document
    assert (document["volume_m3"]["refined"], document["headline"]["quantity"]) == (None, "area")
    assert document["area_m2"]["refined"]["ci95"] == document["headline"]["ci95"]
    low, high = document["headline"]["ci95"]
    assert low <= np.pi * (0.45**2 - 0.15**2) <= high
    reason = document["global"]["structural_length_reason"]
    assert document["global"]["structural_length_index"] is None and "area" in reason


def test_it_says_how_far_it_is():
    seen = []
    job = {"analysis": "workspace", "robot": "spherical", "voxel_size_m": 0.02, "device": "cpu"}
    asked = {"sampling": {"method": "sobol", "count": 20_000}, "refined_volume": 0.02, "voxel_labels": True}
    ws.execute({**job, **asked}, progress=lambda *report: seen.append(report))
    for message in ("refined volume", "labels of voxels"):
        done, total = zip(*(report[:2] for report in seen if report[2] == message), strict=True)
        assert done[0] > 0 and done[-1] <= total[-1] and list(done) == sorted(done)


def test_a_held_joint_holds_for_the_refined_volume_too():
    held = ws.Sobol(20_000, locked={"joint3": 0.3})
    result = ws.analyze(ws.load_robot("spherical"), held, voxel_size_m=0.02, refined_volume=0.02, device="cpu")
    assert result.document["volume_m3"]["refined"] is None
    assert (result.document["headline"]["value"], result.document["headline"]["reason"]) == (None, SURFACE)


def test_a_tip_that_stays_on_a_surface_has_no_volume():
    document = ws.analyze("slave_5r", ws.Sobol(20_000), device="cpu").document
    assert document["headline"] == {"quantity": "volume", "value": None, "ci95": None, "unit": "m3", "reason": SURFACE}
    assert document["volume_m3"]["refined"] is None
    values = document["global"]
    assert (values["structural_length_index"], values["structural_length_reason"]) == (None, SURFACE)


@pytest.mark.parametrize(
    ("asked", "made"),
    [({}, (True, False)), ({"voxel_labels": True}, (False, True)), ({"voxel_labels": False}, (False, False))],
    ids=["volume, by default", "labels", "neither"],
)
def test_volume_and_labels_are_made_when_each_is_asked_for(asked, made):
    options = {"voxel_size_m": 0.04, "device": "cpu", **({"refined_volume": None} if asked else {}), **asked}
    result = ws.analyze(ws.load_robot("spherical"), ws.Sobol(2_000), **options)
    document = result.document
    there = document["volume_m3"]["refined"] is not None, document["voxel_labels"] is not None
    assert there == made
    assert ("reachability" in result.volumes) == made[1]
    assert (document["headline"]["value"] is not None) == made[0]
    assert (document["global"]["structural_length_index"] is not None) == made[0]
    assert made[0] or "refined_volume is null" in document["headline"]["reason"]


def test_the_structural_length_index_is_that_of_the_refined_volume():
    """Σ(|a| + |d|) of the table, .1 + .3 + .25 + .05 m, over the cube root of the refined volume, not the voxels'."""
    rows = [
        ws.DHRow(d=0.1, alpha_deg=90),
        ws.DHRow(a=0.3, limits_deg=(0, 120)),
        ws.DHRow(a=-0.25, d=0.05, limits_deg=(10, 140)),
    ]
    robot = ws.load_robot(ws.DHTable(convention="standard", rows=rows))
    options = {"indices": ["manipulability"], "voxel_size_m": 0.05, "device": "cpu"}
    document = ws.analyze(robot, ws.Sobol(4_000), refined_volume=0.05, **options).document
    refined, occupied = document["volume_m3"]["refined"]["value"], document["volume_m3"]["occupied"]
    assert abs(occupied / refined - 1) > 0.1
    index = document["global"]
    assert index["structural_length_index"] == pytest.approx(0.7 / refined ** (1 / 3), rel=1e-9)
    assert index["structural_length_reason"] == ""
    without = ws.analyze(robot, ws.Sobol(4_000), refined_volume=None, **options).document["global"]
    assert without["structural_length_index"] is None
    assert without["structural_length_reason"] == "refined_volume is null: none was asked for"


def test_a_python_class_has_no_structural_length():
    found = ws.analyze(PlanarClass(), ws.Sobol(500), device="cpu", task=["x", "y"], refined_volume=0.1).document[
        "global"
    ]
    assert found["structural_length_index"] is None
    assert found["structural_length_reason"] == "a robot that is defined by a Python class has no lengths of links"
