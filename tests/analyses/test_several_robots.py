"""Several robots: gantries, whose unions and intersections are boxes; arms of one model; malformed jobs."""

import numpy as np
import pytest

import wsrender as ws
from tests.run.simple_robots import PlanarClass, gantry, planar_arm
from wsrender.analyses.volume_notices import MOST_HOLES
from wsrender.analyses.workspace.run import WorkspaceAnalysis
from wsrender.reach.holes import share_of_holes
from wsrender.results.result import Result
from wsrender.run import finish, plan, run_shard
from wsrender.run.partial_files import load_partial, save_partial

OPTIONS = {"indices": ["manipulability"], "device": "cpu", "voxel_size_m": 0.01, "refined_volume": None}
REFINED = {**OPTIONS, "refined_volume": 0.02}
FULL = ws.Grid([20, 40, 30])  # one sample at the centre of each voxel of .3 × .4 × .2 m
BOX = 0.3 * 0.4 * 0.2

TWO_ARMS = """
<mujoco><worldbody>
  <body name="torso">
    <body name="left0"><joint name="lx" type="slide" axis="1 0 0" range=".005 .295"/>
      <body name="left1"><joint name="ly" type="slide" axis="0 1 0" range=".005 .195"/>
        <body name="left2"><joint name="lz" type="slide" axis="0 0 1" range=".005 .095"/>
          <geom size=".01" mass="1"/><site name="left"/></body></body></body>
    <body name="right0"><joint name="rx" type="slide" axis="1 0 0" range=".105 .495"/>
      <body name="right1"><joint name="ry" type="slide" axis="0 1 0" range=".005 .195"/>
        <body name="right2"><joint name="rz" type="slide" axis="0 0 1" range=".005 .095"/>
          <geom size=".01" mass="1"/><site name="right"/></body></body></body>
  </body>
</worldbody></mujoco>
"""


def moved(*position):
    return gantry(placement=ws.Transform(position_m=position))


def test_two_boxes_share_a_box():
    result = ws.shared_workspace([gantry(), moved(0.1, 0.2, 0.05)], FULL, **OPTIONS)
    volume = result.document["volume_m3"]
    common = 0.2 * 0.2 * 0.15
    assert volume["shared"] == pytest.approx(common)
    assert volume["any"] == pytest.approx(2 * BOX - common)
    assert volume["exactly"] == {"1": pytest.approx(2 * (BOX - common)), "2": pytest.approx(common)}
    assert result.document["shared_ratio"] == pytest.approx(common / (2 * BOX - common))
    # Marching cubes cut the edges of the voxels.
    assert result.meshes["union"].volume == pytest.approx(2 * BOX - common, rel=0.02)
    assert result.meshes["intersection"].volume == pytest.approx(common, rel=0.02)
    assert result.meshes["intersection"].is_volume
    np.testing.assert_allclose(result.meshes["intersection"].bounds, [[0.1, -0.2, 0.05], [0.3, 0, 0.2]], atol=1e-9)
    # Every cell of a gantry has the same manipulability.
    assert result.document["quality"]["manipulability"] == {"maximum": pytest.approx(1.0), "mean": pytest.approx(1.0)}
    assert [robot["name"] for robot in result.document["robots"]] == ["gantry", "gantry_2"]


def test_three_boxes_and_those_that_do_not_meet():
    robots = [gantry(), moved(0.1, 0, 0), moved(0.2, 0, 0)]
    document = ws.shared_workspace(robots, FULL, names=["a", "b", "c"], **OPTIONS).document
    step = 0.1 * 0.4 * 0.2
    assert list(document["volume_m3"]["exactly"].values()) == pytest.approx([2 * step, 2 * step, step])
    assert document["volume_m3"]["shared"] == pytest.approx(3 * step)
    apart = ws.shared_workspace([gantry(), moved(1, 0, 0)], FULL, **OPTIONS)
    assert (apart.document["volume_m3"]["shared"], apart.document["shared_ratio"]) == (0.0, 0.0)
    assert set(apart.meshes) == {"union"}
    assert apart.document["quality"]["manipulability"] == {"maximum": None, "mean": None}


def test_scan_of_an_offset():
    values = [0.0, 0.1, 0.25, 0.4]
    result = ws.shared_workspace([gantry(), gantry()], FULL, scan={"axis": "x", "values": values}, **OPTIONS)
    table = result.tables["scan"]
    common = np.maximum(0.3 - np.array(values), 0) * 0.4 * 0.2
    assert table["x"].tolist() == values
    assert table["occupied_shared"] == pytest.approx(common)
    assert table["occupied_any"] == pytest.approx(2 * BOX - common)
    assert table.units == {"x": "m", "occupied_any": "m^3", "occupied_shared": "m^3"}


def test_no_robot_is_planned_twice_and_no_result_is_built_for_a_placement(monkeypatch):
    """Not for the voxel size that all share either; a scan reads where its sweeps have been."""
    plans, built = [], []
    planned, finished = WorkspaceAnalysis.__init__, WorkspaceAnalysis.finish
    monkeypatch.setattr(WorkspaceAnalysis, "__init__", lambda *a, **k: plans.append(a) or planned(*a, **k))
    monkeypatch.setattr(WorkspaceAnalysis, "finish", lambda *a: built.append(a) or finished(*a))
    scan = {"axis": "x", "values": [0.0, 0.1, 0.2]}
    options = {**OPTIONS, "voxel_size_m": None}
    result = ws.shared_workspace([gantry(), gantry()], ws.Sobol(4096), scan=scan, **options)
    assert (len(result.tables["scan"]), len(plans), len(built)) == (3, 2 + 3, 2)


def test_a_scan_of_three_robots_counts_those_who_stay():
    """Two of them stand together, so that at least two reach their box wherever the third is."""
    robots = [gantry(), gantry(), moved(5, 0, 0)]
    scan = {"axis": "x", "values": [0.0, 0.1, 5.0], "robot": 2}
    table = ws.shared_workspace(robots, FULL, scan=scan, **OPTIONS).tables["scan"]
    assert table["occupied_shared"] == pytest.approx(BOX)
    assert table["occupied_any"] == pytest.approx([BOX, BOX + 0.1 * 0.4 * 0.2, 2 * BOX])


@pytest.mark.parametrize(("robot", "shared"), [(0, 0.1), (1, 0.05)])
def test_the_scan_moves_the_robot_that_it_names(robot, shared):
    """Of boxes at x = 0 … .3 and .1 … .25 one is put at -.1: at -.1 … .2, or -.1 … .05; by voxels and refined."""
    short = gantry(x=(0.005, 0.145), placement=ws.Transform(position_m=(0.1, 0, 0)))
    scan = {"robot": robot, "axis": "x", "values": [-0.1]}
    table = ws.shared_workspace([gantry(), short], FULL, scan=scan, **REFINED).tables["scan"]
    assert table["occupied_shared"] == pytest.approx(shared * 0.4 * 0.2)
    assert table["shared"] == pytest.approx((shared - 0.01) * 0.39 * 0.19, rel=0.02)


def test_scan_of_an_angle():
    """Turned by 90° about z, .3 × .4 m lies beside itself; by 180° too, on the other side."""
    scan = {"robot": 0, "axis": "yaw", "values": [0, 90, 180]}
    result = ws.shared_workspace([gantry(), gantry()], FULL, scan=scan, **OPTIONS)
    # The box x 0….3, y -.4…0 turned by 90° is x 0….4, y 0….3.
    assert result.tables["scan"]["occupied_shared"] == pytest.approx([BOX, 0, 0])
    assert result.tables["scan"].units["yaw"] == "deg"


def test_refined_volumes_are_the_headline_at_every_value_of_a_scan():
    """The slides reach .29 × .39 × .19 m, which is less than the voxels that they touch."""
    values, area = [0.0, 0.1, 0.4], 0.39 * 0.19
    scan = {"axis": "x", "values": values}
    result = ws.shared_workspace([gantry(), moved(0.1, 0, 0)], ws.Random(5000), scan=scan, **REFINED)
    document, table = result.document, result.tables["scan"]
    assert document["headline"]["quantity"] == "volume" and document["headline"]["reason"] == ""
    low, high = document["headline"]["ci95"]
    assert low <= 0.19 * area <= high and high - low <= 2 * 0.02 * document["headline"]["value"]
    ratio = 0.19 / 0.39
    assert document["shared_ratio"] == pytest.approx(ratio, rel=0.04) and document["shared_ratio_volume"] == "refined"
    shared, any_ = (np.maximum(0.29 - np.array(values), 0) * area, (0.29 + np.minimum(values, 0.29)) * area)
    for name, exact in (("shared", shared), ("any", any_)):
        assert (table[f"{name}_low"] <= exact).all() and (exact <= table[f"{name}_high"]).all()
        assert table[name] == pytest.approx(exact, rel=0.02)
        assert (table[f"occupied_{name}"][:2] != table[name][:2]).all()
        assert table.units[name] == "m^3"


def test_occupied_voxels_far_from_the_volume_are_told():
    """5,000 random samples touch less than half of the 13,000 voxels of a box."""
    document = ws.shared_workspace([gantry(), gantry()], ws.Random(5000), **REFINED).document
    assert [(w["code"], w["message"].split()[8]) for w in document["warnings"] if w["code"] == "occupied_differs"]
    assert "of the shared volume" in " ".join(w["message"] for w in document["warnings"]).replace("from the", "of the")


def test_robots_that_fill_no_volume_share_an_area_or_nothing():
    flat = ws.shared_workspace([planar_arm(), planar_arm()], ws.Random(5000), **REFINED, task=["x", "y"]).document
    assert flat["headline"]["quantity"] == "area" and flat["volume_m3"]["refined"] is None
    low, high = flat["headline"]["ci95"]
    inner = np.sqrt(0.5**2 + 0.4**2 + 2 * 0.5 * 0.4 * np.cos(np.radians(150)))
    assert low <= np.pi * (0.9**2 - inner**2) <= high
    assert flat["area_m2"]["refined"]["shared"]["value"] == flat["headline"]["value"]
    other = planar_arm()
    tilted = ws.load_robot(other.spec.dh, placement=ws.Transform(rpy_deg=(30, 0, 0)))
    apart = ws.shared_workspace([other, tilted], ws.Random(5000), **REFINED, task=["x", "y"]).document
    assert apart["headline"]["value"] is None and "different planes" in apart["headline"]["reason"]
    assert apart["shared_ratio_volume"] == "occupied"


def test_an_arm_in_a_plane_shares_no_volume_and_the_headline_says_why():
    """Nothing of each robot alone is measured: the document says so, the summary has no line of it."""
    result = ws.shared_workspace([gantry(), planar_arm()], ws.Random(500), **REFINED)
    headline = result.document["headline"]
    assert (headline["value"], headline["ci95"]) == (0.0, [0.0, 0.0])
    assert "in a plane" in headline["reason"] and headline["reason"] in result.summary()
    for robot in result.document["robots"]:
        assert robot["headline"]["reason"] == robot["global"]["structural_length_reason"]
        assert robot["headline"]["reason"] not in result.summary() and "refined_volume" not in str(robot)


def test_compared_robots_have_a_headline_each():
    document = ws.robot_comparison([gantry(), planar_arm()], ws.Random(5000), **REFINED).document
    box, plane = (robot["headline"] for robot in document["robots"])
    assert (box["quantity"], plane["quantity"]) == ("volume", "area")
    assert box["ci95"][0] <= 0.29 * 0.39 * 0.19 <= box["ci95"][1]
    rows = {(row["quantity"], row["unit"]): row["values"] for row in document["comparison"]}
    assert rows["volume.refined", "m^3"] == [box["value"], None]
    assert rows["area.refined", "m^2"] == [None, plane["value"]]
    assert document["headline"]["value"] is None and "robots" in document["headline"]["reason"]
    assert {w["message"].split(":")[0] for w in document["warnings"]} >= {"gantry"}


def test_two_arms_of_one_model():
    arms = [{"robot": {"mjcf": TWO_ARMS}, "tip": tip, "name": tip} for tip in ("left", "right")]
    for arm, levels in zip(arms, ([30, 20, 10], [40, 20, 10]), strict=True):
        arm["sampling"] = {"method": "grid", "per_joint": levels}
    document = ws.execute({"analysis": "shared_workspace", "robots": arms, **OPTIONS}).document
    assert document["volume_m3"]["shared"] == pytest.approx(0.2 * 0.2 * 0.1)
    assert document["volume_m3"]["any"] == pytest.approx(0.5 * 0.2 * 0.1)
    assert [robot["robot"]["tip_frame"] for robot in document["robots"]] == ["left", "right"]
    assert ws.execute(document["job"]).document["volume_m3"] == document["volume_m3"]


def size_of_all(robots, sampling, analysis="robot_comparison"):
    """Default edge of the voxels of several robots, as planned."""
    arms = [{"robot": robot.spec, "sampling": sampling} for robot in robots]
    planned = plan({"analysis": analysis, "robots": arms, "indices": ["manipulability"], "device": "cpu"})
    (size,) = {each.voxel_size_m for each in planned.several.plans}
    return size


def size_of_one(robot, sampling):
    return plan({"analysis": "workspace", "robot": robot.spec, "sampling": sampling, "device": "cpu"}).voxel_size_m


@pytest.mark.parametrize("analysis", ["robot_comparison", "shared_workspace"])
def test_the_smallest_voxel_size_is_that_of_all_unless_it_leaves_holes(analysis):
    """Samples decide at 10⁴ and on coarse grids: the largest robot's size; at 10⁹ the workspace: the smallest's."""
    small = gantry(x=(0.005, 0.225), y=(0.005, 0.295), z=(0.005, 0.145))
    for sampling, chosen in (
        ({"method": "sobol", "count": 10**4}, max),
        ({"method": "grid", "per_joint": 2}, max),
        ({"method": "sobol", "count": 10**9}, min),
    ):
        sizes = [size_of_one(robot, sampling) for robot in (gantry(), small)]
        assert size_of_all([gantry(), small], sampling, analysis) == chosen(sizes) and min(sizes) < max(sizes)
        assert size_of_all([small, small], sampling, analysis) == min(sizes)


def test_robots_far_apart_in_size_share_voxels_without_holes():
    """A phantom_omni's own voxels would leave a UR5e's samples dust, at 10⁸ too."""
    robots = [ws.load_robot(name) for name in ("ur5e", "phantom_omni")]
    for sampling in ({"method": "sobol", "count": 2**20}, {"method": "sobol", "count": 10**8}):
        big, small = (size_of_one(robot, sampling) for robot in robots)
        assert small < size_of_all(robots, sampling) <= big
    result = ws.robot_comparison(robots, indices=["manipulability"], device="cpu", refined_volume=None)
    assert "few_samples" not in [warning["code"] for warning in result.document["warnings"]]
    for robot, volume in zip(robots, result.volumes.values(), strict=True):
        assert share_of_holes(robot.chain, volume, seed=7) < MOST_HOLES


def test_saved_shards_and_files_hold_everything(tmp_path):
    scan = {"axis": "x", "values": [0.0, 0.2]}
    whole = ws.shared_workspace([gantry(), moved(0.1, 0, 0)], ws.Random(5000), scan=scan, **REFINED)
    first = plan(whole.document["job"])
    assert first.shards == [(0, 20_000)]
    assert first.estimate["samples"] == 20_000
    save_partial(run_shard(first, 0), tmp_path / "0.npz")
    again = plan(whole.document["job"], resolved=first.resolved())
    result = finish(again, load_partial(tmp_path / "0.npz", again))
    assert result.document["volume_m3"] == whole.document["volume_m3"]
    for name, column in whole.tables["scan"].columns.items():
        np.testing.assert_array_equal(result.tables["scan"][name], column)
    result.save(tmp_path / "out")
    names = {record["name"] for record in result.document["artifacts"]}
    assert {"scan.parquet", "robot_gantry_2.vtkhdf", "union.glb", "plots/scan.png", "plots/product.png"} < names
    loaded = Result.load(tmp_path / "out")
    assert set(loaded.volumes) == {"robot_gantry", "robot_gantry_2"}
    assert "shared volume" in loaded.summary() and "gantry + gantry_2" in loaded.summary()


TABLE_5 = [
    ("articulated", [0.1, 0, 0.4], 0, 0.0542, 0.0128, 5e-5),
    # Spherical shells of .2….4 m: R and R / V_a from the closed-form volume of one, 2 V = V_a + V_s.
    ("spherical", [0.1, 0.4, 0], 90, None, None, None),
]


@pytest.mark.parametrize(("name", "position", "yaw", "any_m3", "shared_m3", "rounding"), TABLE_5)
def test_refined_volumes_of_the_published_pairs(name, position, yaw, any_m3, shared_m3, rounding):
    """DEFINITIONS 6: exact volumes inside the interval; for the spherical pair V_a + V_s is twice the volume of one."""
    turn = {"rpy_deg": (0, 0, yaw)}
    x, y, z = position
    pair = [ws.load_robot(name, placement=ws.Transform(position_m=(at, y, z), **turn)) for at in (-x, x)]
    options = {"indices": ["manipulability"], "device": "cpu", "voxel_size_m": 0.02, "refined_volume": 0.02}
    locked = {"joint4": 0.0, "joint5": np.pi / 2, "joint6": 0.0}
    result = ws.shared_workspace(pair, ws.Grid(30, locked=locked), **options)
    document = result.document
    assert "refined any volume" in result.summary() and "refined shared volume" not in result.summary()
    refined = document["volume_m3"]["refined"]
    both, shared = refined["any"], refined["shared"]
    assert both["met"] and shared["met"]
    if any_m3 is not None:
        for entry, exact in ((both, any_m3), (shared, shared_m3)):
            assert entry["ci95"][0] - rounding < exact < entry["ci95"][1] + rounding
    one = {"articulated": 0.03348, "spherical": np.pi / 2 * np.sqrt(2) * (0.4**3 - 0.2**3) / 3}[name]
    widths = sum((entry["ci95"][1] - entry["ci95"][0]) / 2 for entry in (both, shared))
    assert both["value"] + shared["value"] == pytest.approx(2 * one, abs=widths)


def test_a_comparison_lists_values_and_differences(tmp_path):
    small = gantry(x=(0.005, 0.195))
    samplings = [FULL, ws.Grid([20, 40, 20])]
    result = ws.robot_comparison([gantry(), small], samplings, names=["large", "small"], **OPTIONS)
    rows = {row["quantity"]: row for row in result.document["comparison"]}
    assert rows["volume.occupied"]["values"] == pytest.approx([BOX, BOX * 2 / 3])
    assert rows["volume.occupied"]["differences"] == pytest.approx([0, -BOX / 3])
    assert rows["extent.x"]["values"] == pytest.approx([0.29, 0.19], abs=1e-6)
    assert rows["manipulability.joint_mean"]["values"] == pytest.approx([1.0, 1.0])
    table = result.tables["comparison"]
    assert table["difference_small"][table["quantity"] == "extent.x"] == pytest.approx([-0.1], abs=1e-6)
    assert set(result.volumes) == {"robot_large", "robot_small"}
    figure = result.plot.side_by_side()
    panels = [axes for axes in figure.axes if axes.get_images()]
    assert len(panels) == 6
    assert len({axes.get_images()[0].norm.vmax for axes in panels}) == 1
    for axis in range(3):
        assert panels[axis].get_xlim() == panels[axis + 3].get_xlim()
    result.save(tmp_path / "out")
    assert "plots/comparison.png" in {record["name"] for record in result.document["artifacts"]}
    assert "large" in result.summary() and "volume.occupied" in result.summary()


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"robots": [{"robot": "scara"}]}, "robots: must have at least 2 items"),
        ({"robots": [{"robot": "scara"}, {"robot": "nobody"}]}, r'robots.1.robot.library: has no robot "nobody"'),
        ({"robots": [{"robot": "scara", "name": "../a"}] * 2}, "robots.0.name: must have 1 to 64 letters"),
        ({"robots": [{"robot": "scara", "name": "a"}] * 2}, "robots: must not give two robots the same name: a, a"),
        ({"scan": {"robot": 2, "values": [1]}}, r"scan: must name a robot by its place, 0 … 1, not 2"),
        ({"scan": {"axis": "w", "values": [1]}}, r'scan.axis: must be "x", "y"'),
        ({"scan": {"values": []}}, "scan.values: must not be empty"),
        ({"scan": {"values": [1, 1]}}, "scan.values: must not repeat"),
        ({"indices": ["speed"]}, "robots.0.indices: "),
        ({"robots": [{"robot": "scara"}, {"robot": "scara", "sampling": {"method": "grid", "per_joint": [2]}}]},
         r"robots.1.sampling.per_joint"),
    ],
)  # fmt: skip
def test_malformed_jobs(fields, message):
    job = {"analysis": "shared_workspace", "robots": [{"robot": "scara"}] * 2, "device": "cpu"}
    with pytest.raises(ws.InputError, match=message):
        ws.execute({**job, **fields})


def test_a_scanned_angle_needs_an_angle():
    placed = {"library": "scara", "placement": {"quat_wxyz": [1, 0, 0, 0]}}
    job = {"analysis": "shared_workspace", "robots": [{"robot": "scara"}, {"robot": placed}]}
    with pytest.raises(ws.DocumentError, match="scan: of yaw needs a placement without quat_wxyz"):
        ws.execute({**job, "scan": {"axis": "yaw", "values": [1]}})


def test_a_user_defined_robot_takes_part_and_is_scanned():
    options = {**OPTIONS, "task": ["x", "y"], "voxel_size_m": 0.05}
    result = ws.shared_workspace([PlanarClass(), PlanarClass()], ws.Grid(20), **options)
    volume = result.document["volume_m3"]
    assert volume["shared"] == volume["any"] > 0
    assert result.document["job"]["robots"][1]["robot"] == {"user_defined": "tests.run.simple_robots.PlanarClass"}
    scans = [
        ws.shared_workspace([one, one], ws.Random(2_000), scan={"values": [0.0, 0.1, 2.0]}, **options)
        .tables["scan"]
        .columns
        for one in (PlanarClass(), planar_arm())
    ]
    shared = [scan["occupied_shared"].tolist() for scan in scans]
    assert shared[0] == shared[1]
    assert shared[0][1] > shared[0][2] == 0
    with pytest.raises(ws.InputError, match="robots: there are 3 samplings and 2 names for 2 robots"):
        ws.shared_workspace([gantry()] * 2, [FULL] * 3, **options)


def test_planar_arms_share_an_area_and_none_in_different_planes():
    """Rings of .252 to .9 m, .9 m apart; raised, the second arm moves in another plane."""
    arms = [planar_arm(), planar_arm().placed(ws.Transform(position_m=(0.9, 0, 0)))]
    options = {"indices": ["manipulability"], "task": ["x", "y"], "device": "cpu", "refined_volume": 0.02}
    scan = {"axis": "z", "values": [0.0, 0.1]}
    result = ws.shared_workspace(arms, ws.Sobol(2_000), scan=scan, **options)
    # The discs share a lens; the edge of either goes through the centre of the hole of the other.
    outer = 2 * 0.9**2 * np.arccos(0.5) - 0.45 * np.sqrt(4 * 0.9**2 - 0.9**2)
    headline = result.document["headline"]
    assert (headline["quantity"], headline["unit"]) == ("area", "m2")
    hole = _half_discs_area(np.sqrt(0.5**2 + 0.4**2 - np.sqrt(3) * 0.5 * 0.4), 0.9)
    assert headline["ci95"][0] <= outer - 2 * hole <= headline["ci95"][1]
    shared = result.tables["scan"].columns["shared"]
    assert shared[0] == headline["value"]
    assert np.isnan(shared[1])


def _half_discs_area(small, large):
    """Area that a disc shares with one whose edge goes through its centre (circle–circle intersection)."""
    a, b = np.arccos(small / (2 * large)), np.arccos(1 - small**2 / (2 * large**2))
    return small**2 * a + large**2 * b - small * large * np.sin(a)
