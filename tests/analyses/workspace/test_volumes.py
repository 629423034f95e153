"""Volumes, bounds and means of results against closed forms, SciPy and the map itself."""

import numpy as np
import pytest
from scipy import ndimage

import wsrender as ws
from tests.run.simple_robots import PLANAR, gantry, planar_arm
from wsrender.analyses.volume_notices import few_samples, occupied_differs

LINEAR = {"indices": ["manipulability", "inverse_condition_number"], "device": "cpu"}
UNREFINED = {**LINEAR, "refined_volume": None}


@pytest.fixture(scope="module")
def planar_result():
    return ws.analyze(
        planar_arm(),
        ws.Grid(90),
        voxel_size_m=0.03,
        voxel_statistics=("count", "maximum", "mean", "minimum"),
        keep_map=True,
        map_columns=("configuration", "orientation"),
        **PLANAR,
    )


def codes(result):
    return [warning["code"] for warning in result.document["warnings"]]


@pytest.mark.parametrize("options", [LINEAR, UNREFINED], ids=["by inverse kinematics", "by the samples"])
@pytest.mark.parametrize(("size", "told"), [(0.015, True), (None, False)])
def test_too_few_samples_are_told(size, told, options):
    """The UR5e reaches 3.80 m³ (see the refined volumes); in voxels of 15 mm a million samples find half of it."""
    result = ws.analyze("ur5e", ws.Sobol(10**6), voxel_size_m=size, **options)
    assert (result.document["volume_m3"]["occupied"] < 0.9 * 3.80) == told
    assert ("few_samples" in codes(result)) == told
    for warning in result.document["warnings"]:
        assert warning["field"] == "voxel_size_m" and warning["message"] and warning["remedy"]


def test_layers_that_a_grid_leaves_out_are_holes():
    """10 levels of 32 mm in voxels of 17.6 mm: whole layers of voxels within reach hold no sample."""
    result = ws.analyze(gantry(), ws.Grid([200, 200, 10]), voxel_size_m=0.0176, **LINEAR)
    (warning,) = (w for w in result.document["warnings"] if w["code"] == "few_samples")
    share = float(warning["message"].split(" about ")[1].split()[0])
    layers = np.floor(np.linspace(0.005, 0.295, 10) / 0.0176)
    assert share == pytest.approx(100 * (np.ptp(layers) + 1 - len(set(layers))) / len(set(layers)), rel=0.3)


@pytest.mark.parametrize(("scale", "told"), [(1.09, False), (1.11, True), (0.91, False), (0.89, True)])
def test_occupied_volumes_are_told_where_they_differ_by_more_than_a_tenth(scale, told):
    notices = list(occupied_differs(scale * 0.5, 0.5))
    assert [notice.code for notice in notices] == ["occupied_differs"] * told
    assert not list(occupied_differs(scale, None)) and not list(occupied_differs(scale, 0.0))


def test_a_large_difference_is_an_ordinary_percentage():
    (notice,) = occupied_differs(2.6, 1.0)
    assert "2.6 m³, +160 % from the reachable volume of 1 m³" in notice.message


def test_intervals_wider_than_asked_are_told():
    """A 3R twisted by 1e-3 rad: a slab of half a millimetre, for which the budget of points is too low."""
    limits = {"limits_deg": (-150, 150)}
    rows = [ws.DHRow(a=0.4, alpha_deg=0.06, **limits), ws.DHRow(a=0.3, alpha_deg=-0.06, **limits), ws.DHRow(a=0.1)]
    robot = ws.load_robot(ws.DHTable(convention="standard", rows=rows))
    result = ws.analyze(robot, ws.Sobol(10**4), voxel_size_m=0.05, **LINEAR)
    assert not result.document["volume_m3"]["refined"]["met"] and "tolerance_not_met" in codes(result)
    box = ws.analyze(gantry(), ws.Sobol(10**4), **LINEAR)
    assert box.document["volume_m3"]["refined"]["met"] and "tolerance_not_met" not in codes(box)


def test_shares_of_holes_and_of_unseen_voxels_that_are_told():
    told = [bool(list(few_samples(*shares))) for shares in ((0.0051, 0), (0.0049, 9), (None, 0.21), (None, 0.19))]
    assert told == [True, False, True, False]


def test_summaries_tell_of_a_task_that_the_arm_cannot_do():
    """A planar arm does not move along z: all indices of x, y, z are 0."""
    options = {"indices": "kinematic", "voxel_size_m": 0.05}
    flat, whole = (ws.analyze(planar_arm(), ws.Grid(20), task=task, **options) for task in ("linear", ["x", "y"]))
    assert "all indices and global isotropy are 0: the task has a direction" in flat.summary()
    assert [("task_without_motion" in codes(result)) for result in (flat, whole)] == [True, False]
    assert repr(whole).startswith("<Result workspace: ") and "400 samples (grid)" in repr(whole)


def test_a_gantry_fills_its_box():
    """One sample at the centre of each voxel of .3 × .4 × .2 m."""
    document = ws.analyze(gantry(), ws.Grid([20, 40, 30]), voxel_size_m=0.01, **LINEAR).document
    assert document["volume_m3"]["occupied"] == pytest.approx(0.3 * 0.4 * 0.2)
    assert document["volume_m3"]["inner"] == pytest.approx(0.28 * 0.38 * 0.18)
    assert document["volume_m3"]["outer"] == pytest.approx(0.32 * 0.42 * 0.22)
    assert document["bounds_m"]["lower"] == pytest.approx([0.005, -0.395, 0.005], abs=1e-6)
    assert document["bounds_m"]["upper"] == pytest.approx([0.295, -0.005, 0.195], abs=1e-6)
    assert document["global"]["global_isotropy"] == pytest.approx(1.0)
    # Waldron's length sum of three slides is the sum of their largest displacements.
    length, volume = 0.195 + 0.395 + 0.295, document["volume_m3"]["refined"]["value"]
    assert volume == pytest.approx(0.29 * 0.39 * 0.19, rel=0.01)
    assert document["global"]["structural_length_index"] == pytest.approx(length / volume ** (1 / 3))
    assert document["headline"] == {
        "quantity": "volume",
        "value": volume,
        "ci95": document["volume_m3"]["refined"]["ci95"],
        "unit": "m3",
        "reason": "",
    }
    for values in document["indices"].values():
        assert values["joint_mean"] == pytest.approx(1.0)
        assert values["workspace_mean"] == pytest.approx(1.0)


def test_a_placement_by_whole_voxels_moves_the_volume():
    here = ws.analyze(gantry(), ws.Grid([20, 40, 30]), voxel_size_m=0.01, **LINEAR)
    placing = {"placement": ws.Transform(position_m=(0.3, -0.2, 0.11))}
    there = ws.analyze(gantry(**placing), ws.Grid([20, 40, 30]), voxel_size_m=0.01, **LINEAR)
    moved = np.subtract(there.volume.first_voxel, here.volume.first_voxel)
    assert moved.tolist() == [30, -20, 11]
    assert np.array_equal(there.volume.count, here.volume.count)
    assert there.document["volume_m3"] == here.document["volume_m3"]
    assert there.document["job"]["robot"]["placement"]["position_m"] == [0.3, -0.2, 0.11]
    assert np.array(there.document["robot"]["T_world_base"])[:3, 3].tolist() == [0.3, -0.2, 0.11]


def test_a_tool_moves_the_tip():
    tool = ws.Transform(position_m=(0.0, 0.0, 0.1))
    q = [[0.1, 0.2, 0.15]]
    plain, tooled = (robot.forward_kinematics(q, device="cpu")[0] for robot in (gantry(), gantry(tool=tool)))
    assert tooled == pytest.approx(plain @ tool.matrix())
    # Slides translate whatever the tool: the box moves along the tool's z, the base's x.
    result = ws.analyze(gantry(tool=tool), ws.Grid([20, 40, 30]), voxel_size_m=0.01, **LINEAR)
    assert result.volume.first_voxel == (10, -40, 0)


def test_the_shell_of_a_spherical_arm():
    """±45° of azimuth, 45…135° of inclination, .2….4 m: (π/2) √2 (.4³ - .2³) / 3."""
    exact = np.pi / 2 * np.sqrt(2) * (0.4**3 - 0.2**3) / 3
    locked = {"joint4": 0.0, "joint5": np.pi / 2, "joint6": 0.0}
    result = ws.analyze("spherical", ws.Grid(100, locked=locked), voxel_size_m=0.01, **LINEAR)
    volume = result.document["volume_m3"]
    assert volume["inner"] < exact < volume["occupied"] < volume["outer"]
    # Inner leaves out more than the border voxels, occupied adds the unreached part of them.
    assert (volume["inner"] + volume["occupied"]) / 2 == pytest.approx(exact, rel=0.05)


def test_inner_and_outer_against_morphology():
    result = ws.analyze("spherical", ws.Random(40_000, seed=2), voxel_size_m=0.02, **LINEAR)
    occupied = np.pad(result.volume.occupied, 1)
    neighbours = np.ones((3, 3, 3))
    inner = ndimage.binary_erosion(occupied, neighbours).sum()
    outer = ndimage.binary_dilation(occupied, neighbours).sum()
    assert 0 < inner < occupied.sum() < outer
    volume, voxel = result.document["volume_m3"], 0.02**3
    found = [volume[name] / voxel for name in ("inner", "occupied", "outer")]
    assert found == pytest.approx([inner, occupied.sum(), outer])


def test_voxels_hold_the_statistics_of_their_samples(planar_result):
    samples, volume = planar_result.map, planar_result.volume
    # The lattice is anchored at the world origin.
    at = np.floor(samples.position / np.float32(0.03)).astype(int) - volume.first_voxel
    assert at.min() == 0
    flat = np.ravel_multi_index(at.T, volume.count.shape)
    assert np.array_equal(np.bincount(flat, minlength=volume.count.size), volume.count.ravel())
    values = samples.indices["manipulability"]
    largest = np.full(volume.count.size, -np.inf)
    np.maximum.at(largest, flat, values)
    smallest = np.full(volume.count.size, np.inf)
    np.minimum.at(smallest, flat, values)
    mean = np.bincount(flat, values, volume.count.size) / np.maximum(volume.count.ravel(), 1)
    occupied = volume.occupied.ravel()
    for statistic, expected in (("maximum", largest), ("minimum", smallest)):
        found = volume.statistics[statistic]["manipulability"].ravel()
        assert np.array_equal(found[occupied], expected[occupied])
        assert np.isnan(found[~occupied]).all()
    found = volume.statistics["mean"]["manipulability"].ravel()
    assert found[occupied] == pytest.approx(mean[occupied], rel=1e-5)


def test_means_over_samples_and_over_voxels_differ(planar_result):
    samples, volume = planar_result.map, planar_result.volume
    for name, entry in planar_result.document["indices"].items():
        values = samples.indices[name].astype(float)
        voxels = volume.statistics["maximum"][name][volume.occupied].astype(float)
        assert entry["joint_mean"] == pytest.approx(values.mean() / values.max(), rel=1e-5)
        assert entry["workspace_mean"] == pytest.approx(voxels.mean() / voxels.max(), rel=1e-6)
        assert entry["maximum"] == values.max()
        assert entry["minimum"] == values.min()
    assert abs(entry["joint_mean"] - entry["workspace_mean"]) > 0.05


def test_rows_of_the_map_are_the_samples_in_order(planar_result):
    samples = planar_result.map
    first, second = np.linspace(-np.pi, np.pi, 90), np.linspace(0, np.radians(150), 90)
    grid = np.stack(np.meshgrid(first, second, indexing="ij"), axis=-1).reshape(-1, 2)
    in_order = np.sort(samples.configuration, axis=0)
    assert in_order == pytest.approx(np.sort(grid, axis=0), abs=1e-6)
    elbow = samples.configuration.sum(axis=1)
    x = 0.5 * np.cos(samples.configuration[:, 0]) + 0.4 * np.cos(elbow)
    assert samples.position[:, 0] == pytest.approx(x, abs=1e-6)
    assert samples.indices["manipulability"] == pytest.approx(0.2 * np.sin(samples.configuration[:, 1]), abs=1e-6)
    assert np.abs(samples.quat_wxyz[:, 0]) == pytest.approx(np.abs(np.cos(elbow / 2)), abs=1e-6)
    assert samples.joint_names == ("joint1", "joint2")


def test_a_snake_is_told_that_its_samples_crowd_in_the_middle():
    """No voxel size mends that: the warning stays, and says that the headline is none of the voxels'."""
    rows = tuple(ws.DHRow(a=0.1, alpha_deg=90 * (-1) ** k) for k in range(12))
    snake = ws.load_robot(ws.DHTable(convention="standard", rows=rows))
    document = ws.analyze(snake, ws.Sobol(1 << 18), ["manipulability"], device="cpu", refined_volume=0.05).document
    (warning,) = (entry for entry in document["warnings"] if entry["code"] == "few_samples")
    assert "many joints" in warning["remedy"] and warning["field"] == "voxel_size_m"
    low, high = document["headline"]["ci95"]
    assert document["volume_m3"]["occupied"] < 0.6 * low and low <= 4 / 3 * np.pi * 1.2**3 <= high


def test_a_tip_that_does_not_move_needs_no_voxel_size():
    locked = {"joint1": 0.1, "joint2": 0.1, "joint3": 0.1}
    document = ws.analyze(gantry(), ws.Grid(3, locked=locked), **LINEAR).document
    assert document["voxel_size_m"] == 0.01
    assert document["sampling"] == {
        "method": "grid",
        "samples": 1,
        "seed": 0,
        "per_joint": [1, 1, 1],
        "locked": locked,
    }
    assert document["volume_m3"]["occupied"] == pytest.approx(1e-6)
