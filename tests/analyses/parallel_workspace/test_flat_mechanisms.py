"""Mechanisms whose platform stays in a plane or on a line: their area or length, on a lattice there."""

import numpy as np
import pytest

from tests.mechanisms.planar import annuli_area, three_rrr
from wsrender.results.result import Result
from wsrender.run import execute, finish, plan, run_shard

JOB = {"analysis": "parallel_workspace", "device": "cpu", "refined_volume": 0.03}


@pytest.mark.parametrize(
    ("placement", "size"),
    [({}, 0.02), ({"position_m": [0.3, -0.2, 0.7], "rpy_deg": [90, 0, 0]}, 0.02), ({"rpy_deg": [25, -40, 10]}, 0.03)],
)
def test_the_area_of_a_planar_3_rrr_is_that_of_three_annuli(placement, size, tmp_path):
    """It was said to be empty: no voxel's centre lies in its plane, wherever that is."""
    exact = annuli_area(2001)
    result = execute({**JOB, "mechanism": three_rrr(placement=placement), "voxel_size_m": size})
    headline = result.document["headline"]
    low, high = headline["ci95"]
    assert low < exact < high and (headline["quantity"], headline["unit"]) == ("area", "m2")
    flat = result.document["flat"]
    assert flat["occupied"] == pytest.approx(exact, rel=0.02) and flat["refined"]["value"] == headline["value"]
    assert result.document["volume_m3"]["occupied"] == 0 and "empty" not in result.document
    # All voxels hold a piece of the plane.
    centres = (result.volume.voxels.at.T + result.volume.first_voxel + 0.5) * size
    axes = np.array(flat["axes"])
    across = np.abs((centres - flat["origin_m"]) @ np.cross(*axes)) / size
    assert across.max() <= np.abs(np.cross(*axes)).sum() / 2 + 1e-6
    assert result.volume.voxels.count.sum() * size**2 == pytest.approx(flat["occupied"])
    result.save(tmp_path / "out")
    assert Result.load(tmp_path / "out").document["headline"] == headline
    assert result.skeleton is not None and result.summary().count(f"{headline['value']:.3g}") == 1


def test_a_default_voxel_of_a_plane_is_a_hundredth_of_the_root_of_its_area():
    planned = plan({**JOB, "mechanism": three_rrr()})
    assert planned.block.voxel_size_m == pytest.approx(np.sqrt(annuli_area(501)) / 100, rel=0.15)


def test_a_settled_plane_is_the_same_plane():
    whole = plan({**JOB, "mechanism": three_rrr(placement={"rpy_deg": [25, -40, 10]}), "voxel_size_m": 0.1})
    again = plan(whole.job, resolved=whole.resolved())
    assert again.block == whole.block
    one, other = (finish(each, run_shard(each, 0)).document for each in (whole, again))
    assert one["flat"] == other["flat"] and one["headline"] == other["headline"]


def slide(limits, axis="1 0 0"):
    mjcf = (
        f'<mujoco><compiler autolimits="true"/><worldbody><body><joint name="s" type="slide" axis="{axis}" '
        f'range="{limits[0]} {limits[1]}"/><geom size=".01"/><site name="tool"/></body></worldbody></mujoco>'
    )
    return {"type": "serial", "robot": {"mjcf": mjcf}, "actuated": ["s"], "holds": "pose"}


def test_two_slides_on_one_line_leave_what_both_reach():
    legs = [slide([-0.4, 0.3]), slide([-0.1, 0.6])]
    result = execute({**JOB, "mechanism": {"legs": legs}, "voxel_size_m": 0.01})
    headline = result.document["headline"]
    assert headline["quantity"] == "length" and headline["unit"] == "m"
    assert headline["ci95"][0] < 0.4 < headline["ci95"][1]
    assert result.document["flat"]["occupied"] == pytest.approx(0.4, abs=0.011)


def test_slides_that_cross_leave_a_point():
    legs = [slide([-0.4, 0.3]), slide([-0.1, 0.6], "0 1 0")]
    result = execute({**JOB, "mechanism": {"legs": legs}})
    assert result.document["headline"]["value"] is None
    assert result.document["headline"]["reason"] == "the platform stays at a point"


def test_a_planar_mechanism_on_a_turntable_stays_in_its_plane():
    turn = {"limits_deg": [-30, 30], "levels": 3}
    planned = plan({**JOB, "mechanism": three_rrr(before=[turn]), "voxel_size_m": 0.05})
    assert planned.quantity == ("area", "m^2") and len(planned.variants) == 3
    lifted = {**JOB, "mechanism": three_rrr(before=[{"type": "prismatic", "limits_m": [0, 0.2], "levels": 2}])}
    result = execute({**lifted, "voxel_size_m": 0.2})
    assert result.document["headline"]["value"] is None
    assert "the serial joints leave" in result.document["headline"]["reason"]
