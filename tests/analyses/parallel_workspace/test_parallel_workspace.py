"""Workspaces of parallel mechanisms through the four steps, against the values of DEFINITIONS section 9."""

import numpy as np
import pytest

import wsrender as ws
from tests.mechanisms.mechanisms import known_ups, mechanism, poses_of, ups
from wsrender.mechanisms.ball_region import ball_region
from wsrender.mechanisms.exact import ExactWorkspace
from wsrender.mechanisms.inverse_kinematics import inverse_kinematics
from wsrender.mechanisms.jacobians import sign_changes
from wsrender.results.result import Result
from wsrender.run import execute, finish, merge, plan, run_shard
from wsrender.run.partial_files import load_partial, save_partial

SIX_PUS = {"analysis": "parallel_workspace", "mechanism": "six_pus", "voxel_size_m": 0.05, "device": "cpu"}
STEWART = {"analysis": "parallel_workspace", "mechanism": "stewart_gough", "voxel_size_m": 0.04, "device": "cpu"}
NOWHERE = {"library": "stewart_gough", "length_m": [0.01, 0.1]}
TILTS = {"tilt_deg": 15, "tilts": 3, "azimuths": 8}


@pytest.mark.parametrize("method", ["grid", "grid_by_subsystem"])
@pytest.mark.parametrize(
    ("document", "exact"),
    [
        ("six_pus", 0.717344315),
        ({"library": "six_pus", "link_m": 2.5}, 0.963565768),
        (known_ups(), 5.352588701),
        (ups([[0, 0, 0]] * 6, [[0, 0, 0]] * 6, [1.0, 1.5]), 9.948376737),
    ],
)
def test_known_volumes(document, exact, method):
    result = execute({**SIX_PUS, "mechanism": document, "method": method})
    assert result.document["volume_m3"]["occupied"] == pytest.approx(exact, rel=5e-3)
    assert result.volume.count.sum() * 0.05**3 == pytest.approx(exact, rel=5e-3)


@pytest.mark.parametrize(("method", "tolerance"), [("exact", 1e-8), ("solids", 1e-3)])
@pytest.mark.parametrize(("link", "exact"), [([2.5, 2.7, 2.6], 0.717344315), (2.5, 0.963565768)])
def test_methods_by_the_boundary_agree(method, tolerance, link, exact, tmp_path):
    mech = {"library": "six_pus", "link_m": link, "placement": {"position_m": [1, 0, 0], "rpy_deg": [90, 0, 0]}}
    job = {"analysis": "parallel_workspace", "mechanism": mech, "method": method, "device": "cpu"}
    result = execute(job)
    assert result.document["volume_m3"][method] == pytest.approx(exact, rel=tolerance)
    assert result.meshes["workspace"].is_watertight
    assert result.meshes["workspace"].volume == pytest.approx(exact, rel=2e-3)
    # The mechanism stands upright no more: its z points along -y, around x = 1.
    lower, upper = result.meshes["workspace"].bounds
    assert upper[1] < -0.9 and lower[0] > 0 and upper[0] < 2
    if method == "exact":  # x, y, z of the world are x, -z, y of the base
        upright = mechanism({"library": "six_pus", "link_m": link})
        low, high = ExactWorkspace.of(ball_region(upright, np.eye(3))).bounds_m
        bounds = result.document["bounds_m"]
        np.testing.assert_allclose(bounds["lower"], [1 + low[0], -high[2], low[1]], atol=1e-12)
        np.testing.assert_allclose(bounds["upper"], [1 + high[0], -low[2], high[1]], atol=1e-12)
    result.save(tmp_path / "out")
    assert (tmp_path / "out/workspace.glb").exists()


def test_topology_of_the_known_six_pus():
    topology = execute({**SIX_PUS, "voxel_size_m": None, "method": "exact"}).document["topology"]
    assert (topology["vertices"], topology["edges"], topology["faces"]) == (18, 27, 11)


def test_the_tilted_workspace_of_the_paper():
    """[SNK]: .126 at (30, 20, 0)°."""
    result = execute({**SIX_PUS, "orientation": {"euler_xyz_deg": [30, 20, 0]}})
    assert result.document["volume_m3"]["occupied"] == pytest.approx(0.126, abs=5e-4)


def test_the_interval_of_the_refined_volume_holds_the_exact_one():
    found = execute({**SIX_PUS, "voxel_size_m": 0.1, "refined_volume": 0.01}).document["volume_m3"]["refined"]
    low, high = found["ci95"]
    assert low < 0.717344315 < high and found["met"]
    assert (high - low) / 2 <= 0.01 * found["value"]


def test_bounds_of_the_workspace():
    """The exact bounds of DEFINITIONS section 12 lie within a voxel of those of the voxels."""
    document = execute({**SIX_PUS, "mechanism": {"library": "six_pus", "link_m": [2.6, 2.7, 2.5]}}).document
    np.testing.assert_allclose(document["bounds_m"]["lower"], [-0.875, -0.918, 1.333], atol=0.1)
    np.testing.assert_allclose(document["bounds_m"]["upper"], [0.797, 0.775, 2.420], atol=0.1)


def test_a_placed_mechanism_has_its_workspace_elsewhere():
    """A quarter turn and a shift by whole voxels map voxels to voxels."""
    here = execute(SIX_PUS)
    placement = {"position_m": [1.0, 2.0, -0.5], "rpy_deg": [0, 0, 90]}
    there = execute({**SIX_PUS, "mechanism": {"library": "six_pus", "placement": placement}})
    turned = np.rot90(here.volume.count, axes=(0, 1))
    np.testing.assert_array_equal(there.volume.count, turned)
    x, y, z = here.volume.first_voxel
    width = here.volume.count.shape[1]
    assert there.volume.first_voxel == (20 - y - width, 40 + x, z - 10)


def test_indices_and_singularities_of_the_stewart_platform():
    """Values at the voxels are those at the poses; det A changes sign where the platform passes its singular height."""
    mech = {"library": "stewart_gough", "length_m": [0.2, 0.9], "region": {"lower_m": [None, None, -0.3]}}
    result = execute({**STEWART, "mechanism": mech, "indices": "kinematic", "characteristic_length_m": 0.3})
    values = result.volume.statistics["maximum"]["inverse_condition_number"]
    occupied = result.volume.occupied
    assert np.isfinite(values[occupied]).all() and (values[occupied] >= 0).all() and (values[occupied] <= 1).all()
    assert np.isnan(values[~occupied]).all()
    assert result.document["indices"]["manipulability"]["maximum"] > 0
    conditioning = result.document["conditioning"]
    for matrix in "ABJ":  # the best κ, and the mean of 1/κ
        inverse = result.volume.statistics["center"][f"inverse_condition_number_{matrix}"][occupied]
        assert 1 <= conditioning[matrix]["least_condition_number"] == pytest.approx(1 / inverse.max())
        assert conditioning[matrix]["mean_inverse"] == pytest.approx(inverse.mean())
    np.testing.assert_array_equal(result.volume.statistics["center"]["inverse_condition_number_J"], values)
    assert result.plot.slice(z=0.4, index="inverse_condition_number_J", statistic="center").axes
    entry = result.document["singularities"]
    assert entry["type_1"]["sign_changes"] == 0  # lengths always act
    assert entry["type_2"]["sign_changes"] > 0 and entry["type_2"]["negative_voxels"] > 0
    # Base and platform are parallel and alike: the platform's plane meets the base's at z = 0, where A is singular.
    table = result.tables["singularities"]
    heights = table["position"][:, 2]
    assert np.abs(heights).min() < 1e-9
    changes = sign_changes(result.volume)[2]
    np.testing.assert_array_equal(changes, table["position"][table["type"] == 2])


def test_a_voxel_at_the_threshold_is_dexterous():
    """The threshold is a share that voxels have."""
    job = {**STEWART, "kind": "dexterous", "orientations": TILTS}
    shares = execute(job).volume.statistics["fraction"]["orientations"]
    shares = shares[np.isfinite(shares)]
    threshold = float(np.median(shares[shares < 1]))
    at = np.count_nonzero(shares == threshold)
    assert at > 0
    result = execute({**job, "dexterous_threshold": threshold})
    assert result.document["volume_m3"]["dexterous"] == pytest.approx(
        np.count_nonzero(shares >= threshold) * result.volume.voxel_size_m**3
    )


def test_the_dexterous_workspace_lies_in_that_of_each_orientation():
    result = execute({**STEWART, "kind": "dexterous", "orientations": TILTS})
    volume = result.volume
    share = volume.statistics["fraction"]["orientations"]
    assert volume.count.max() == 24 and np.nanmax(share) == 1
    np.testing.assert_array_equal(share == 1, volume.count == 24)
    entry = result.document["volume_m3"]
    assert 0 < entry["dexterous"] == entry["all_orientations"] < entry["occupied"]
    # The voxels reached at every orientation are those of the kind total_orientation.
    total = execute({**STEWART, "kind": "total_orientation", "orientations": TILTS, "refined_volume": 0.03})
    assert total.document["volume_m3"]["occupied"] == pytest.approx(entry["dexterous"])
    refined = total.document["volume_m3"]["refined"]
    assert refined["ci95"][0] < refined["value"] < refined["ci95"][1]
    # One of its voxels, by inverse kinematics at tilts in between.
    at = np.argwhere(volume.count == 24)[0]
    position = (at + volume.first_voxel + 0.5) * volume.voxel_size_m
    c, s = np.cos(np.deg2rad(15)), np.sin(np.deg2rad(15))
    assert inverse_kinematics(mechanism("stewart_gough"), poses_of([position])).feasible[0]
    tilted = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    assert inverse_kinematics(mechanism("stewart_gough"), poses_of([position], tilted)).feasible[0]


def test_a_lower_threshold_gives_a_larger_dexterous_volume():
    job = {**STEWART, "kind": "dexterous", "orientations": TILTS}
    all_of, half = (execute({**job, "dexterous_threshold": t}).document["volume_m3"] for t in (1.0, 0.5))
    assert all_of["dexterous"] < half["dexterous"] < half["occupied"]


def test_orientations_at_a_point_are_those_of_inverse_kinematics():
    job = {**STEWART, "voxel_size_m": None, "kind": "orientation", "position_m": [0.02, 0, 0.55]}
    result = execute({**job, "orientations": {"euler_xyz_deg": [[-50, 50]] * 3, "per_angle": 9}})
    table, mech = result.tables["orientations"], mechanism("stewart_gough")
    rotations = [ws.Transform(quat_wxyz=tuple(quat)).matrix()[:3, :3] for quat in table["quat_wxyz"]]
    expected = [inverse_kinematics(mech, poses_of([[0.02, 0, 0.55]], R)).feasible[0] for R in rotations]
    np.testing.assert_array_equal(table["reached"], expected)
    entry = result.document["orientation_workspace"]
    assert entry["reached"] == sum(expected) and 0 < entry["share"] < 1
    assert f"{sum(expected)} of 729, {100 * entry['share']:.3g} %" in result.summary()
    assert result.volume is None and result.skeleton.shape == (6, 4, 3)


def test_shards_merge_to_the_whole(tmp_path):
    whole = plan({**SIX_PUS, "voxel_size_m": 0.1, "indices": ["manipulability"]})
    resolved = whole.resolved()
    unit, total = resolved["shard_unit"], sum(count for _, count in resolved["shards"])
    resolved["shards"] = [[0, 5 * unit], [5 * unit, 20 * unit], [25 * unit, total - 25 * unit]]
    parts = plan(whole.job, resolved=resolved)
    partials = [run_shard(parts, k) for k in range(3)]
    save_partial(partials[1], tmp_path / "partial")
    partials[1] = load_partial(tmp_path / "partial", parts)
    one = merge(parts, merge(parts, partials[0], partials[1]), partials[2])
    other = merge(parts, partials[0], merge(parts, partials[2], partials[1]))
    expected = run_shard(whole, 0)
    for name, values in expected.arrays.items():
        np.testing.assert_array_equal(one[name], values)
        np.testing.assert_array_equal(other[name], values)
    assert finish(parts, one).document["volume_m3"] == finish(whole, expected).document["volume_m3"]


def test_a_default_voxel_size_is_a_hundredth_of_the_workspace():
    planned = plan({**SIX_PUS, "voxel_size_m": None})
    assert planned.block.voxel_size_m == pytest.approx(np.cbrt(0.717344) / 100, rel=0.06)


@pytest.mark.parametrize(
    ("fields", "reason"),
    [
        ({"mechanism": {"library": "stewart_gough", "length_m": [0.01, 0.1]}}, "no position is within the reach"),
        ({"mechanism": {"library": "stewart_gough", "region": {"lower_m": [None, None, 5]}}}, "no position is within"),
        (
            {
                "mechanism": {"library": "stewart_gough", "length_m": [0.45, 0.451]},
                "orientation": {"rpy_deg": [40, 0, 0]},
            },
            "no pose tested is reached; at",
        ),
        ({"kind": "orientation", "position_m": [0, 0, 3], "orientations": TILTS}, "leg 1 (UPS) at 3"),
        ({"kind": "total_orientation", "orientations": {"tilt_deg": 120}}, "no p"),
        ({"mechanism": NOWHERE, "method": "exact", "voxel_size_m": None}, "enclose none"),
        ({"mechanism": NOWHERE, "method": "solids", "voxel_size_m": None}, "enclose none"),
    ],
)
def test_an_empty_workspace_is_a_result(fields, reason, tmp_path):
    result = execute({**STEWART, **fields})
    assert reason in result.document["empty"]
    assert result.volume is None
    if "volume_m3" in result.document:
        assert next(iter(result.document["volume_m3"].values())) == 0
    result.save(tmp_path / "out")
    assert Result.load(tmp_path / "out").document["empty"] == result.document["empty"]


@pytest.mark.parametrize(
    ("fields", "field", "message"),
    [
        (
            {"mechanism": {"library": "delta", "home": {"position_m": [0, 0, -5]}}},
            "mechanism.home",
            "must be reached, but leg 1 (delta) is out of reach",
        ),
        (
            {"mechanism": {"library": "stewart_gough", "home": {"position_m": [0, 0, 0.9]}}},
            "mechanism.home",
            "is above its upper limit (limits 0.5 … 0.8 m)",
        ),
        ({"mechanism": "delta", "orientation": {"rpy_deg": [0, 5, 0]}}, "orientation", "do not let its platform turn"),
        ({"mechanism": "delta", "indices": "kinematic", "task": "full"}, "task", "the platform of a delta"),
        ({"indices": ["dynamic_manipulability"]}, "indices", "must be kinematic for a mechanism"),
        ({"indices": ["beauty"]}, "indices", "unknown index"),
        ({"mechanism": {"legs": known_ups()["legs"][:5]}, "indices": "kinematic"}, "mechanism.legs", "must be 6"),
        ({"voxel_size_m": 1e-10}, "voxel_size_m", "is too small"),
        ({"mechanism": "delta", "method": "exact", "voxel_size_m": None}, "mechanism.legs.0", 'use the method "grid"'),
        ({"max_poses": 100}, "max_poses", "the job has"),
    ],
)
def test_jobs_that_cannot_be_planned(fields, field, message):
    with pytest.raises(ws.InputError) as caught:
        plan({**STEWART, **fields})
    assert caught.value.field == field
    assert message in str(caught.value)


def test_a_result_survives_its_files(tmp_path):
    result = ws.parallel_workspace("delta", voxel_size_m=0.05, indices=["manipulability"], device="cpu")
    result.save(tmp_path / "out")
    back = Result.load(tmp_path / "out")
    np.testing.assert_array_equal(back.volume.count, result.volume.count)
    assert (tmp_path / "out/plots/robot.png").exists()
    assert "delta" in back.summary()
    assert len(back.plot.robot().axes) == 2


def test_the_headline_is_the_refined_volume_by_default():
    """Within 1 %, with the exact volume in its interval; null turns it off, and says so."""
    job = {**SIX_PUS, "voxel_size_m": 0.1}
    headline = execute(job).document["headline"]
    low, high = headline["ci95"]
    assert low < 0.717344315 < high and (high - low) / 2 <= 0.01 * headline["value"]
    assert (headline["quantity"], headline["unit"], headline["reason"]) == ("volume", "m3", "")
    off = execute({**job, "refined_volume": None}).document["headline"]
    assert off["value"] is None and off["ci95"] is None and "none was asked for" in off["reason"]
    exact = execute({**job, "voxel_size_m": None, "method": "exact"}).document["headline"]
    assert exact["ci95"] == [exact["value"]] * 2 and exact["value"] == pytest.approx(0.717344315, rel=1e-8)
    solids = execute({**job, "voxel_size_m": None, "method": "solids"}).document["headline"]
    assert solids["value"] == pytest.approx(0.717, rel=1e-3) and solids["ci95"] is None and "meshes" in solids["reason"]
    nowhere = execute({**STEWART, "mechanism": NOWHERE}).document["headline"]
    assert nowhere["value"] == 0 and nowhere["ci95"] == [0.0, 0.0]
    at_point = {**STEWART, "voxel_size_m": None, "kind": "orientation", "position_m": [0, 0, 0.55]}
    headline = execute({**at_point, "orientations": TILTS}).document["headline"]
    assert headline["value"] is None and "only the orientation varies" in headline["reason"]


def test_voxels_far_from_the_refined_volume_are_warned_of():
    found = execute({**SIX_PUS, "voxel_size_m": 0.7}).document["warnings"]
    assert [each["code"] for each in found] == ["occupied_differs"] and found[0]["field"] == "voxel_size_m"
    assert "m³" in found[0]["message"] and not execute(SIX_PUS).document["warnings"]


def test_a_tolerance_that_is_not_met_is_said(monkeypatch):
    monkeypatch.setattr("wsrender.analyses.parallel_workspace.refined.MOST_POINTS", 5000)
    document = execute({**SIX_PUS, "refined_volume": 0.001}).document
    low, high = document["headline"]["ci95"]
    assert low < 0.717344315 < high and not document["volume_m3"]["refined"]["met"]
    assert [each["code"] for each in document["warnings"]] == ["tolerance_not_met"]


def test_voxels_that_do_not_fit_in_memory_are_refused_while_planning(monkeypatch):
    """1.5e9 voxels were accepted, and ended in an ArrayMemoryError of 33 GiB in the refined volume."""
    monkeypatch.setattr("wsrender.analyses.cost.available_bytes", lambda: 2**30)
    plan({**STEWART, "voxel_size_m": 0.004})
    with pytest.raises(ws.ResourceError, match=r"GiB of memory; 1\.0 GiB are free: choose 0\.00\d+ or more") as caught:
        plan({**STEWART, "voxel_size_m": 0.001})
    assert caught.value.field == "voxel_size_m"


def test_strata_of_fine_voxels_stay_coarse(monkeypatch):
    """However many voxels there are, the refined volume holds no more than 64³ cells or so."""
    from wsrender.analyses.parallel_workspace import refined as parallel_refined

    seen = []
    strata = parallel_refined._strata
    monkeypatch.setattr(parallel_refined, "_strata", lambda *given: seen.append(strata(*given)) or seen[-1])
    execute({**STEWART, "voxel_size_m": 0.008})
    assert 0 < sum(map(len, seen[0])) < 2 * 64**3


def test_the_interval_of_all_orientations_covers_the_range_between_the_levels():
    """Shells about one point: turned about z, the joint at p is within them wherever a circle of radius |p| is.

    The total orientation workspace for all turns ±90° about z of a leg [0.2, 1] whose platform joint is 0.5 m off the
    tool: with two levels, ±90°, far too large; exact: positions whose whole half circle is inside.
    """
    leg = {"type": "UPS", "base_m": [0, 0, 0], "platform_m": [0.5, 0, 0], "length_m": [0.2, 1.0]}
    turns = {"euler_xyz_deg": [[0, 0], [0, 0], [-90, 90]], "per_angle": [1, 1, 3]}
    job = {**STEWART, "mechanism": {"legs": [leg]}, "kind": "total_orientation", "orientations": turns,
           "refined_volume": 0.02, "voxel_size_m": 0.08}  # fmt: skip
    refined = execute(job).document["volume_m3"]["refined"]
    random = np.random.default_rng(0)
    points = random.uniform(-1.6, 1.6, (50_000, 3))
    angle = np.deg2rad(np.linspace(-90, 90, 181))
    near, far = np.full(len(points), np.inf), np.zeros(len(points))
    for c, s in zip(np.cos(angle), np.sin(angle), strict=True):
        distance = np.linalg.norm(points + 0.5 * np.array([c, s, 0]), axis=1)
        near, far = np.minimum(near, distance), np.maximum(far, distance)
    share = ((near >= 0.2) & (far <= 1)).mean()
    exact, error = share * 3.2**3, 3 * np.sqrt(share / len(points)) * 3.2**3
    assert refined["ci95"][0] - error < exact < refined["ci95"][1] + error and refined["orientation_steps"] > 0
    three = execute({**job, "refined_volume": None}).document["volume_m3"]["occupied"]
    assert three > refined["value"]


def test_the_share_of_orientations_at_a_point_has_an_interval():
    """Random orientations of the ranges: a leg that reaches half of all tilts at a point, whatever the levels."""
    leg = {"type": "UPS", "base_m": [0, 0, 0], "platform_m": [0, 0, 0.5], "length_m": [0.0, 1.25**0.5]}
    job = {**STEWART, "voxel_size_m": None, "mechanism": {"legs": [leg]}, "kind": "orientation",
           "position_m": [0, 0, 1.0], "orientations": {"tilt_deg": 180, "tilts": 3, "azimuths": 4}}  # fmt: skip
    entry = execute(job).document["orientation_workspace"]
    low, high = entry["share_of_ranges_ci95"]
    assert low < 0.5 < high < low + 0.02 and entry["share"] != pytest.approx(0.5, abs=0.02)


def test_solids_of_thin_workspaces_are_warned_of():
    """Where six shells 1 mm thick cross, triangles of balls of 0.6 m are as thick; the exact volume is another."""
    thin = {"library": "stewart_gough", "length_m": [0.6, 0.601]}
    job = {**STEWART, "voxel_size_m": None, "mechanism": thin}
    solids = execute({**job, "method": "solids"}).document
    assert [each["code"] for each in solids["warnings"]] == ["coarse_meshes"]
    assert not execute({**job, "method": "exact"}).document["warnings"]
    thick = execute({**job, "mechanism": "stewart_gough", "method": "solids"}).document
    assert not thick["warnings"]
