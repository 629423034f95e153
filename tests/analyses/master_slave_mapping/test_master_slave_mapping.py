"""Mappings with known answers: boxes, balls, a turned ellipsoid; failures; the project's own pair."""

import hashlib

import numpy as np
import pytest

import wsrender as ws
from wsrender.mapping import VoxelSet
from wsrender.results.result import Result
from wsrender.run import finish, plan, run_shard
from wsrender.run.partial_files import load_partial, save_partial

UNIT = np.stack(np.meshgrid(*[np.linspace(-0.5, 0.5, 11)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
MASTER_BOX = UNIT * [1.0, 0.8, 0.6]
SLAVE_BOX = UNIT * 0.2
CPU = {"device": "cpu"}


def fibonacci_ball(count=1500):
    """Points even in the unit ball, and on its surface."""
    k = np.arange(count) + 0.5
    polar, turn = np.arccos(1 - 2 * k / count), np.pi * (1 + 5**0.5) * k
    surface = np.stack([np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)], axis=1)
    radii = np.random.default_rng(0).random(count) ** (1 / 3)
    return np.concatenate([surface, surface * radii[:, None]])


def mapped(master, slave, **fields):
    return ws.master_slave_mapping(master, slave, **CPU, **fields)


def test_a_box_in_a_box():
    """The largest uniform scale of a cube of .2 m in a box .6 m high is 3, whatever the offset along the others."""
    search = {"scale": [0.5, 5], "steps": 18}
    result = mapped(MASTER_BOX, SLAVE_BOX, search=search, offsets_m=[[0, 0, 0], [0.1, 0, 0.1]])
    centred, shifted = result.document["offsets"]
    assert centred["scale"] == pytest.approx([3, 3, 3], rel=1e-6)
    assert shifted["scale"] == pytest.approx([2, 2, 2], rel=1e-6)
    assert result.document["mapping"] == centred
    assert result.document["headline"]["value"] is None and result.document["headline"]["reason"]
    assert centred["succeeded"] and centred["failing_points"] == 0
    assert centred["volume_m3"] == pytest.approx(0.6**3, rel=1e-5)
    assert centred["efficiency"] == pytest.approx(0.6**3 / 0.48, rel=1e-5)
    curve = result.tables["scales"]
    assert curve["scale"] == pytest.approx(np.linspace(0.5, 5, 18))
    assert curve["volume"] == pytest.approx((0.2 * curve["scale"]) ** 3, rel=1e-5)
    assert (np.isfinite(curve["volume_inside"]) == (curve["scale"] <= 3 + 1e-9)).all()
    assert (np.diff(curve["share_inside"]) <= 0).all()


def test_what_the_search_found_goes_before_a_scale_beyond_its_bounds():
    """A small cube fits into the wall of a hollow box; in the middle the job's own scale does, which is larger."""
    cells = np.stack(np.meshgrid(*[np.linspace(-0.45, 0.45, 10)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    hollow = cells[np.abs(cells).max(axis=1) > 0.2]
    search = {"scale": [0.2, 0.4], "steps": 4}
    containment = {"kind": "voxels", "voxel_size_m": 0.1}
    offsets = [[0, 0, 0], [0.35, 0.35, 0.35]]
    found = mapped(
        hollow, SLAVE_BOX[[0, 10, 110, -1]], search=search, scale=3.25, offsets_m=offsets, containment=containment
    )
    middle, wall = found.document["offsets"]
    assert middle["succeeded"] and middle["scale"] == [3.25] * 3 and middle["volume_m3"] > wall["volume_m3"]
    assert wall["succeeded"] and found.document["mapping"] == wall and found.document["search"]["found"]


def test_three_scales_fill_the_box():
    result = mapped(MASTER_BOX, SLAVE_BOX, search={"scale": [0.5, 10], "uniform": False})
    assert result.document["mapping"]["scale"] == pytest.approx([5, 4, 3], rel=1e-6)
    assert result.document["mapping"]["efficiency"] == pytest.approx(1, rel=1e-5)


def test_a_scale_is_the_scale_itself_whatever_the_jobs_own_is():
    """Bounds, found scale, curve and table of a job with a scale of 2 are those of a job with a scale of 1."""
    search = {"scale": [0.5, 5], "steps": 10}
    one, two = (mapped(MASTER_BOX, SLAVE_BOX, search=search, scale=scale) for scale in (1, 2))
    assert two.document["mapping"]["scale"] == pytest.approx([3, 3, 3], rel=0.005)
    assert two.document["mapping"]["volume_m3"] == pytest.approx(0.6**3, rel=0.02)
    assert two.document["search"]["scale"] == [0.5, 5]
    for name in ("scale", "volume", "share_inside"):
        assert two.tables["scales"][name] == pytest.approx(one.tables["scales"][name], rel=1e-6)
    assert two.tables["scales"]["volume"] == pytest.approx((0.2 * two.tables["scales"]["scale"]) ** 3, rel=1e-5)
    assert [warning["code"] for warning in two.document["warnings"]] == ["scale_bounds"]
    assert one.document["warnings"] == []


def test_a_scale_of_three_keeps_its_proportions_and_is_their_geometric_mean():
    """In the proportions 2 : 2 : 1 the cube of .2 m touches the box of .8 m: 4, 4, 2, whose mean is ∛32."""
    search = {"scale": [1, 4], "steps": 10}
    result = mapped(MASTER_BOX, SLAVE_BOX, search=search, scale=[1, 1, 0.5])
    assert result.document["mapping"]["scale"] == pytest.approx([4, 4, 2], rel=1e-6)
    curve = result.tables["scales"]
    assert (np.isfinite(curve["volume_inside"]) == (curve["scale"] <= 32 ** (1 / 3))).all()
    three = mapped(MASTER_BOX, SLAVE_BOX, search={"scale": [0.5, 4.5], "uniform": False}, scale=[1, 1, 0.5])
    assert three.document["mapping"]["scale"] == pytest.approx([4.5, 4, 3], rel=1e-6)


def test_the_offset_is_found():
    away = SLAVE_BOX + np.array([0.7, -0.3, 0.2])
    search = {"scale": [0.5, 5], "offset_m": [[-3, 3]] * 3}
    found = mapped(MASTER_BOX, away, search=search, scale=0.5).document["mapping"]
    assert found["succeeded"]
    assert found["scale"][0] == pytest.approx(3, rel=0.005)
    center = np.array([0.7, -0.3, 0.2]) * found["scale"] + found["offset_m"]
    assert (np.abs(center) <= np.array([0.2, 0.1, 0.01])).all()
    assert found["efficiency"] == pytest.approx(0.45, rel=0.015)


def test_a_ball_in_a_ball():
    """Radius .3 m in radius 1 m: 10/3 at the same centre, (1 - .4)/.3 = 2 at an offset of .4 m."""
    ball = fibonacci_ball()
    offsets = [[0, 0, 0], [0.4, 0, 0]]
    entries = mapped(ball, 0.3 * ball, search={"scale": [0.5, 5]}, offsets_m=offsets).document["offsets"]
    assert entries[0]["scale"][0] == pytest.approx(10 / 3, rel=1e-4)
    # The surface between points lies inside the sphere by about (spacing)² / 8.
    assert entries[1]["scale"][0] == pytest.approx(2, rel=0.005)


def test_a_ball_anywhere_in_a_ball():
    """10/3 again, at an offset that brings the centres together."""
    ball = fibonacci_ball()
    search = {"scale": [0.5, 5], "offset_m": [[-1, 1]] * 3}
    found = mapped(ball, 0.3 * ball + np.array([0.1, 0.2, -0.1]), search=search).document["mapping"]
    assert found["scale"][0] == pytest.approx(10 / 3, rel=0.01)
    assert np.linalg.norm(np.array([0.1, 0.2, -0.1]) * found["scale"] + found["offset_m"]) < 0.02


def test_a_turned_ellipsoid():
    """Semi-axes (1, .5, .25) m of the master along x, y, z; half of them along z, y, x of the slave until turned."""
    ball = fibonacci_ball()
    master, slave = ball * [1, 0.5, 0.25], ball * [0.125, 0.25, 0.5]
    search = {"scale": [0.1, 5]}
    turned = mapped(master, slave, rotation={"rpy_deg": [0, 90, 0]}, search=search).document["mapping"]
    assert turned["scale"][0] == pytest.approx(2, rel=0.005)
    plain = mapped(master, slave, search=search).document["mapping"]
    assert plain["scale"][0] == pytest.approx(0.5, rel=0.01)


def test_points_that_fail_are_returned(tmp_path):
    """A cube of 1 m in a box of 1 × .8 × .6 m: the outer layers in y and z fail."""
    result = mapped(MASTER_BOX, UNIT * 0.999, scale=[1, 1, 1])
    failing = result.tables["failing"]
    outside = (np.abs(UNIT[:, 1]) > 0.41) | (np.abs(UNIT[:, 2]) > 0.31)
    assert result.document["mapping"]["failing_points"] == outside.sum() == len(failing)
    np.testing.assert_allclose(failing["position"], (UNIT * 0.999)[outside])
    np.testing.assert_array_equal(failing["slave_position"], (UNIT * 0.999)[outside])
    assert not result.document["mapping"]["succeeded"]
    result.save(tmp_path / "out")
    names = {record["name"] for record in result.document["artifacts"]}
    assert {"plots/mapping.png", "failing.parquet", "master.glb", "slave.glb"} < names
    assert len(Result.load(tmp_path / "out").tables["failing"]) == len(failing)
    drawn = [artist.get_facecolor() for artist in result.plot.mapping().axes[0].collections]
    colors = {tuple(faces[0][:3].round(2)) for faces in drawn if len(faces)}
    assert len(colors) == 3


def test_no_scale_succeeds_far_away():
    found = mapped(MASTER_BOX, SLAVE_BOX, offsets_m=[[9, 9, 9]], search={"scale": [0.5, 2]}).document["mapping"]
    assert (found["succeeded"], found["inside"], found["scale"]) == (False, 0.0, [1, 1, 1])
    everywhere = mapped(MASTER_BOX, SLAVE_BOX, scale=20, search={"scale": [20, 30], "offset_m": [[-1, 1]] * 3})
    assert not everywhere.document["mapping"]["succeeded"]


def test_scales_are_along_the_axes_of_the_master():
    """slave' = S R slave + offset: a bar along x, turned to y, is stretched by the scale of y."""
    bar = UNIT * [0.2, 0.1, 0.1]
    result = mapped(MASTER_BOX, bar, scale=[1, 3, 1], rotation={"rpy_deg": [0, 0, 90]}, offsets_m=[[0, 0.05, 0]])
    position = result.tables["mapping"]["position"][len(MASTER_BOX) :]
    np.testing.assert_allclose(np.ptp(position, axis=0), [0.1, 0.6, 0.1])
    np.testing.assert_allclose(position.mean(axis=0), [0, 0.05, 0], atol=1e-12)


def test_voxels_decide_too():
    containment = {"kind": "voxels", "voxel_size_m": 0.1}
    ring = UNIT[np.hypot(UNIT[:, 0], UNIT[:, 1]) > 0.3]
    found = mapped(ring, SLAVE_BOX, containment=containment).document["mapping"]
    assert not found["succeeded"]
    voxels = VoxelSet.of(ring, 0.1)
    probes = np.random.default_rng(0).uniform(-1, 1, (2000, 3))
    occupied = {tuple(cell) for cell in np.floor(ring / 0.1).astype(int)}
    expected = [tuple(cell) in occupied for cell in np.floor(probes / 0.1).astype(int)]
    np.testing.assert_array_equal(voxels.contains(probes), expected)
    assert voxels.volume_m3 == pytest.approx(len(occupied) * 1e-3)


def test_the_slave_of_the_project_in_a_haptic_device(tmp_path):
    """slave_5r in phantom_omni; the same after its partial result was kept in a file."""
    sampling = {"method": "sobol", "count": 3000}
    document = {
        "analysis": "master_slave_mapping",
        "master": {"robot": "phantom_omni", "sampling": sampling},
        "slave": {"robot": "slave_5r", "sampling": sampling},
        "search": {"scale": [0.05, 2.0], "offset_m": [[-0.3, 0.3]] * 3},
        **CPU,
    }
    planned = plan(document)
    assert planned.shards == [(0, 6000)]
    save_partial(run_shard(planned, 0), tmp_path / "0.npz")
    result = finish(planned, load_partial(tmp_path / "0.npz", planned))
    found = result.document["mapping"]
    assert found["succeeded"] and found["efficiency"] > 0
    assert result.tables["mapping"]["inside"].all()
    larger = {**document, "scale": 1.05 * found["scale"][0], "offsets_m": [found["offset_m"]], "search": None}
    assert not ws.execute(larger).document["mapping"]["succeeded"]


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"scale": 0}, "scale: must be a number above 0, or a list of three, not 0"),
        ({"scale": [1, 2]}, "scale: must be a number above 0"),
        ({"rotation": {"position_m": [1, 0, 0]}}, "rotation: must not shift"),
        ({"offsets_m": []}, r"offsets_m: must be a list of 1 … 100 offsets"),
        ({"search": {"scale": [2, 1]}}, r"search.scale: must be \[low, high\], low below high"),
        ({"search": {"scale": [-1, 1]}}, r"search.scale: must be \[low, high\], both above 0"),
        ({"search": {"offset_m": [[0, 1]] * 3}, "offsets_m": [[0, 0, 0], [1, 0, 0]]}, "offsets_m: must be one"),
        ({"containment": {"kind": "voxels"}}, "containment.voxel_size_m: must be given"),
        ({"containment": {"alpha_m": 1e-6}}, "alpha_shape: 1e-06 m is too small"),
        ({"slave": {"points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]}}, "points: are 4 points in a plane"),
        ({"slave": {"robot": "scara", "sampling": {"method": "converge"}}}, 'slave.sampling: must not be "converge"'),
        ({"slave": {"robot": "scara", "sampling": {"method": "sobol", "count": 2e6}}}, "slave: has 2e.06 points"),
        ({"slave": {"robot": "nobody"}}, 'slave.robot.library: has no robot "nobody"'),
    ],
)
def test_malformed_jobs(fields, message):
    job = {"analysis": "master_slave_mapping", "master": {"points": MASTER_BOX}, "slave": {"points": SLAVE_BOX}, **CPU}
    with pytest.raises(ws.InputError, match=message):
        ws.execute({**job, **fields})


def test_points_of_a_file_are_those_of_the_document(tmp_path):
    np.save(tmp_path / "box.npy", MASTER_BOX)
    listed, found = mapped(MASTER_BOX, SLAVE_BOX), mapped({"path": str(tmp_path / "box.npy")}, SLAVE_BOX)
    assert found.document["mapping"] == listed.document["mapping"]
    sha256 = hashlib.sha256((tmp_path / "box.npy").read_bytes()).hexdigest()
    said = [result.document["provenance"].get("master_sha256") for result in (listed, found)]
    assert said == [None, sha256] and "slave_sha256" not in found.document["provenance"]
    with pytest.raises(ws.InputError, match=r"slave\.path: .*none\.npy cannot be read"):
        mapped(MASTER_BOX, {"path": str(tmp_path / "none.npy")})


def test_a_search_that_finds_nothing_says_so():
    result = mapped(SLAVE_BOX, MASTER_BOX, search={"scale": [0.5, 5], "steps": 4})
    assert result.document["search"]["found"] is False and not result.document["mapping"]["succeeded"]
    assert result.document["search"]["most_inside"] < 1 and result.document["search"]["at_scale"] == 0.5
    assert "no scale fits; at most" in result.summary()
    (warning,) = result.document["warnings"]
    assert (warning["code"], warning["field"]) == ("no_scale_fits", "search.scale")
    result.document["search"]["at_factor"] = result.document["search"].pop("at_scale")  # of version 0.1
    assert "% are inside at 0.5" in result.summary()
    assert mapped(MASTER_BOX, SLAVE_BOX, search={"scale": [0.5, 5]}).document["search"]["found"] is True


@pytest.mark.parametrize("uniform", [True, False])
def test_a_search_beyond_what_fits_finds_nothing_though_the_jobs_own_scale_does(uniform):
    result = mapped(MASTER_BOX, SLAVE_BOX, search={"scale": [8, 9], "steps": 4, "uniform": uniform})
    assert result.document["mapping"]["succeeded"] and result.document["mapping"]["scale"] == [1, 1, 1]
    assert result.document["search"]["found"] is False and "no scale fits" in result.summary()
