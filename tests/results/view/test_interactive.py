"""Answers to what is asked while looking, against the functions of the library and arithmetic of its own."""

import json
import struct
from itertools import islice

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.run.simple_robots import PLANAR, PlanarClass
from wsrender.errors import InputError
from wsrender.results.view import looked_at, view_of
from wsrender.results.view.container import message
from wsrender.results.view.interactive import Interactive, ReplacedError, choices_of
from wsrender.robot import evaluate_indices

TURN = 2 * np.pi
VOLUME = {"ask": "volume", "robot": 0, "index": "manipulability", "samples": 1 << 14, "voxel_size_m": 0.1}


@pytest.fixture(scope="module")
def ur5e():
    return ws.load_robot("ur5e")


@pytest.fixture(scope="module")
def looking(ur5e):
    return Interactive({}, [ur5e])


@pytest.fixture(scope="module")
def result():
    job = {"analysis": "workspace", "robot": "puma560", "sampling": {"method": "sobol", "count": 1 << 14, "seed": 3}}
    return ws.execute(job | {"indices": ["manipulability"], "voxel_size_m": 0.1, "refined_volume": None})


def pose_of(robot, q):
    T = robot.forward_kinematics(q)[0]
    quat = Rotation.from_matrix(T[:3, :3]).as_quat(scalar_first=True)
    return {"position_m": T[:3, 3].tolist(), "quat_wxyz": quat.tolist()}


def within(robot, seed, count=1):
    low, high = robot.lower_limits, robot.upper_limits
    return low + np.random.default_rng(seed).random((count, len(low))) * (high - low)


def test_indices_and_pose_of_a_configuration(ur5e, looking):
    (q,) = within(ur5e, 1)
    header, blobs = looking.answer({"ask": "indices_at", "robot": 0, "q": q.tolist()})
    expected = evaluate_indices(ur5e, q, device="cpu")
    assert {each["name"]: each["value"] for each in header["values"]} == {name: v[0] for name, v in expected.items()}
    assert header["values"][0]["unit"] == "m³"
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = Rotation.from_quat(header["quat_wxyz"], scalar_first=True).as_matrix(), header["position_m"]
    np.testing.assert_allclose(T, ur5e.forward_kinematics(q)[0], atol=1e-12)
    assert header["reason"] == ""
    assert not blobs


def test_a_moved_robot_is_asked_where_it_stands(ur5e, looking):
    (q,) = within(ur5e, 1)
    T = np.eye(4)
    T[:3, 3] = (1.0, 2.0, 3.0)
    at = [looking.answer({"ask": "indices_at", "q": q.tolist(), **more})[0]["position_m"]
          for more in ({}, {"placement": T.ravel().tolist()})]  # fmt: skip
    np.testing.assert_allclose(np.subtract(*at[::-1]), T[:3, 3], atol=1e-12)


def test_the_two_that_were_last_asked_about_are_kept(ur5e):
    looking, made = Interactive({}, [ur5e]), []
    for high in (1.0, 2.0, 1.0, 3.0, 1.0):
        looking.answer({"ask": "indices_at", "q": [0.0] * 6, "limits": {"joint1": [0.0, high]}})
        made += [each for each in looking._looked_at.values() if each not in made]
    assert [each.robot.upper_limits[0] for each in made] == [1.0, 2.0, 3.0]


def test_the_nearest_configuration_of_all_postures_and_windings(ur5e, looking):
    for seed in range(6):
        (q,), (near,) = within(ur5e, seed), within(ur5e, seed + 100)
        pose = pose_of(ur5e, q)
        found = looking.answer({"ask": "inverse", "near": near.tolist(), **pose})[0]
        every = np.array([*ws.postures(ur5e, **pose).wound()])
        assert found["label"] == "reachable"
        assert found["distance_m"] < 1e-5
        assert found["angle_rad"] < 1e-5
        best = np.sqrt(((every - near) ** 2).sum(axis=1)).min()
        assert np.linalg.norm(np.subtract(found["q"], near)) == pytest.approx(best, abs=1e-3)


def test_what_is_out_of_reach_and_what_limits_forbid(ur5e, looking):
    (q,) = within(ur5e, 4)
    far = looking.answer(
        {"ask": "inverse", "position_m": [0.0, 0.0, 2.0], "quat_wxyz": [1, 0, 0, 0], "near": q.tolist()}
    )[0]
    assert (far["label"], far["reason"]) == ("unreachable", "out of reach, proven")
    at = ur5e.forward_kinematics(far["q"])[0]
    assert far["distance_m"] == pytest.approx(np.linalg.norm(at[:3, 3] - [0, 0, 2]), abs=1e-9)
    every = np.array([*ws.postures(ur5e, **pose_of(ur5e, q)).wound()])[:, 0]
    gap = max(set(np.round(np.mod(every, TURN), 6)))  # a range of joint 1 that no posture has
    limits = {"joint1": [gap + 0.1, gap + 0.2]}
    held = looking.answer({"ask": "inverse", "near": q.tolist(), "limits": limits, **pose_of(ur5e, q)})[0]
    assert (held["label"], held["reason"]) == ("unreachable", "joint limits, proven")


def test_what_constraints_block(ur5e):
    job = {"analysis": "workspace", "robot": {"library": "ur5e"}, "constraints": {"self_collision": {}}}
    looking = Interactive(job, [ur5e])
    folded = np.array([0.0, -1.5, 2.75, 0.4, 1.5, 0.0])
    header = looking.answer({"ask": "indices_at", "q": folded.tolist()})[0]
    assert header["reason"].startswith("self_collision: ")
    assert " and " in header["reason"]
    free = looking.answer({"ask": "indices_at", "q": [0.0, -1.0, 0.5, 0.3, 0.2, 0.0]})[0]
    assert free["reason"] == ""
    pose = pose_of(ur5e, folded)
    found = looking.answer({"ask": "inverse", "near": folded.tolist(), **pose})[0]
    listed = looking.answer({"ask": "postures", **pose})[0]["postures"]
    said = [each["said"].rpartition(", ")[2] for each in listed]
    assert "blocked by self_collision" in said
    assert found["label"] == ("reachable" if "free" in said else "blocked")
    if "free" in said:
        assert looking.answer({"ask": "indices_at", "q": found["q"]})[0]["reason"] == ""


def test_all_postures_of_a_pose(ur5e, looking):
    (q,) = within(ur5e, 2)
    header = looking.answer({"ask": "postures", **pose_of(ur5e, q)})[0]
    expected = ws.postures(ur5e, **pose_of(ur5e, q))
    np.testing.assert_allclose([each["q"] for each in header["postures"]], np.asarray(expected), atol=1e-12)
    assert header["families"] == 0
    assert header["reason"].startswith("these are all: closed form")


def test_families_of_a_redundant_arm():
    arm = ws.load_robot("kuka_iiwa14")
    header = Interactive({}, [arm]).answer({"ask": "postures", **pose_of(arm, arm.chain.within(0.6))})[0]
    assert header["families"] == len(header["postures"]) > 0
    assert all(each["said"].startswith("of a self-motion") for each in header["postures"])


def test_a_self_motion_can_be_stepped_along():
    """The tip stands, the joints move in small steps from end to end, and what blocks a step is told."""
    arm = ws.load_robot("franka_panda")
    pose = pose_of(arm, q := arm.chain.within(0.45))
    job = {"robot": {"library": "franka_panda"}, "constraints": {"self_collision": {}}}
    listed = Interactive(job, [arm]).answer({"ask": "postures", **pose})[0]["postures"]
    assert listed
    for each in listed:
        along = np.array(each["curve"]["configurations"])
        T = arm.forward_kinematics(along)
        np.testing.assert_allclose(T, np.broadcast_to(arm.forward_kinematics(q), T.shape), atol=1e-8)
        assert 2 <= len(along) == len(each["curve"]["reasons"]) <= looked_at.MOST_STEPS
        steps = np.linalg.norm(np.diff(along, axis=0), axis=1)
        assert 0 < steps.max() < 0.5
        assert set(each["curve"]["reasons"]) <= {"", "self_collision"}
    expected = ws.postures(arm, **pose, constraints=job["constraints"])
    for each, curve in zip(listed, expected.curves, strict=True):
        ends = [each["curve"]["configurations"][k] for k in (0, -1)]
        np.testing.assert_array_equal(ends, curve.configurations[[0, -1]])


def test_the_bytes_of_a_volume(looking):
    limits = {"joint2": [-1.0, 0.0]}
    header, blobs = looking.answer(VOLUME | {"limits": limits})
    volume = header["volume"]
    (channel,) = volume["channels"]
    nx, ny, nz = volume["shape"]
    occupancy, values = (np.frombuffer(blobs[data["blob"]], np.uint8).reshape(nz, ny, nx)
                         for data in (volume["occupancy"], channel["data"]))  # fmt: skip
    job = {"analysis": "workspace", "robot": {"library": "ur5e", "limits": limits}, "refined_volume": None}
    sampling = {"method": "sobol", "count": VOLUME["samples"], "seed": 0}
    found = ws.execute(job | {"sampling": sampling, "indices": ["manipulability"], "voxel_size_m": 0.1}).volume
    x, y, z = found.voxels.at + np.subtract(found.first_voxel, volume["first_voxel"])[:, None]
    assert occupancy.sum() == len(x)
    assert occupancy[z, y, x].all()
    np.testing.assert_array_equal(occupancy == 0, values == 0)
    exact = found.voxels.statistics["maximum"]["manipulability"]
    assert (channel["minimum"], channel["maximum"]) == (exact.min(), exact.max())
    step = (channel["maximum"] - channel["minimum"]) / 254
    shown = channel["minimum"] + (values[z, y, x] - 1.0) * step
    assert np.abs(shown - exact).max() <= 0.5 * step * (1 + 1e-6)
    assert header["volume_m3"] == pytest.approx(found.n_occupied * 0.1**3)
    cell = [int(x[7]), int(y[7]), int(z[7])]
    voxel = looking.answer({"ask": "voxel", "volume": "live_0", "cell": cell})[0]
    assert voxel["count"] == found.voxels.count[7]
    assert [each["value"] for each in voxel["values"]] == [exact[7]]


def test_a_constant_channel_is_no_division_by_zero():
    header, blobs = Interactive({}, [ws.load_robot("scara")]).answer(VOLUME)
    (channel,) = header["volume"]["channels"]
    values = np.frombuffer(blobs[channel["data"]["blob"]], np.uint8)
    assert channel["minimum"] == channel["maximum"] == 0.0
    assert {*values.tolist()} == {0, 1}


def test_a_request_that_is_no_longer_wanted_ends(looking):
    asked = iter(range(1_000_000))
    with pytest.raises(ReplacedError):
        looking.answer(VOLUME | {"samples": 1 << 26}, lambda: next(asked) < 3)
    assert next(asked) == 4


def test_voxels_of_a_result_as_it_is_and_in_larger_ones(result):
    looking, volume = Interactive(result.document["job"], [ws.load_robot("puma560")], result), result.volume
    k = volume.voxels.count.argmax()
    cell = volume.voxels.at[:, k]
    found = looking.answer({"ask": "voxel", "volume": "volume", "cell": cell.tolist()})[0]
    assert found["count"] == volume.voxels.count[k]
    expected = {("manipulability", s): by["manipulability"][k] for s, by in volume.voxels.statistics.items()}
    assert {(each["name"], each["statistic"]): each["value"] for each in found["values"]} == expected
    np.testing.assert_allclose(found["center_m"], (volume.first_voxel + cell + 0.5) * 0.1)
    at = np.add(cell, volume.first_voxel) // 2
    first = np.array(volume.first_voxel) // 2
    larger = {"ask": "voxel", "volume": "volume", "cell": (at - first).tolist(), "voxel_size_m": 0.2}
    inside = (np.add(volume.voxels.at.T, volume.first_voxel) // 2 == at).all(axis=1)
    assert looking.answer(larger)[0]["count"] == volume.voxels.count[inside].sum()
    empty = np.argwhere(volume.count == 0)[0]
    assert looking.answer({"ask": "voxel", "volume": "volume", "cell": empty.tolist()})[0]["values"] == []


def test_the_best_configuration_of_a_voxel(ur5e, looking):
    header = looking.answer(VOLUME)[0]["volume"]
    sampling = {"method": "sobol", "count": VOLUME["samples"], "seed": 0}
    job = {"analysis": "workspace", "robot": {"library": "ur5e"}, "sampling": sampling, "refined_volume": None}
    job |= {"indices": ["manipulability"], "voxel_size_m": 0.1, "best_sample": "manipulability"}
    found = ws.execute(job)
    voxels, name = found.volume.voxels, "manipulability"
    served = Interactive(found.document["job"], [ur5e], found)
    (shown,) = view_of(found).manifest["volumes"]
    assert shown["best_sample"] == {"index": name}
    assert {each["statistic"] for each in shown["channels"]} == {"maximum", "count"}
    shift = np.subtract(found.volume.first_voxel, header["first_voxel"])
    for k in range(0, len(voxels.cells), 301):
        cell, sample = voxels.at[:, k], int(voxels.best[name][k])
        live = looking.answer({"ask": "voxel", "volume": "live_0", "cell": (cell + shift).tolist()})[0]
        kept = served.answer({"ask": "voxel", "volume": "volume", "cell": cell.tolist()})[0]
        assert live["sample"] == kept["sample"] == str(sample)
        assert live["q"] == kept["q"] == ws.configuration_of(found, sample).tolist()


def test_a_cell_of_a_placement_map_says_where_the_base_stands():
    over = {"x_m": [-0.6, 0.6, 0.3], "y_m": [-0.4, 0.4, 0.4], "yaw_deg": [0, 180, 90], "z_m": 0.2}
    robot = {"library": "puma560", "placement": {"position_m": [0.0, 0.1, 0.0]}}
    job = {"analysis": "base_placement", "robot": robot, "over": over, "mounting": "wall", "refine": False}
    found = ws.execute(job | {"targets": [{"position_m": [0.3, 0.1, 0.8]}]})
    looking = Interactive.of_result(found)
    best = np.array(found.document["best"]["T_world_base"])
    q = looking.robots[0].chain.within(0.4)
    at = looking.answer({"ask": "indices_at", "q": q.tolist()})[0]["position_m"]
    tip = np.linalg.inv(ws.load_robot("puma560").chain.T_world_base) @ ws.load_robot("puma560").forward_kinematics(q)[0]
    np.testing.assert_allclose(at, (best @ tip)[:3, 3], atol=1e-9)
    table = found.tables["placement_map"]
    (shown,) = view_of(found).manifest["maps"]
    assert [each["name"] for each in shown["channels"]] == ["served", "serving_all", "yaw_deg"]
    header = looking.answer({"ask": "placement", "map": "placement_map", "cell": [3, 1]})[0]
    row = 3 * 2 + 1
    np.testing.assert_allclose([header["at"][name] for name in ("x_m", "y_m", "z_m")], [0.45, 0.2, 0.2])
    yaw = np.radians(table["yaw_deg"][row])
    expected = np.eye(4)
    expected[:3, :3] = Rotation.from_euler("z", yaw).as_matrix() @ Rotation.from_euler("y", np.pi / 2).as_matrix()
    expected[:3, 3] = [0.45, 0.2, 0.2] + expected[:3, :3] @ [0.0, 0.1, 0.0]
    np.testing.assert_allclose(np.reshape(header["T_world_base"], (4, 4)), expected, atol=1e-12)
    assert {each["name"]: each["value"] for each in header["values"]}["served"] == table["served"][row]


SLIDE = """<mujoco><worldbody><body><joint name="lift" type="slide" range="0 1" limited="true"/>
    <geom type="box" size=".1 .1 .1"/><site name="tool" pos="0 0 .2"/></body></worldbody></mujoco>"""


def test_a_robot_beside_one_that_is_gone_keeps_what_the_job_says_of_it(tmp_path):
    file, sampling = tmp_path / "slide.xml", {"method": "sobol", "count": 1024}
    file.write_text(SLIDE)
    held = {"robot": "scara", "sampling": sampling | {"locked": {"joint1": 0.5}}}
    job = {"analysis": "shared_workspace", "robots": [{"robot": {"path": str(file)}, "sampling": sampling}, held]}
    found = ws.execute(job | {"indices": ["manipulability"], "voxel_size_m": 0.1, "refined_volume": None})
    file.unlink()
    assert [robot["name"] for robot in view_of(found).manifest["robots"]] == ["scara"]
    looking = Interactive.of_result(found)
    volume_m3 = looking.answer(VOLUME | {"samples": sampling["count"]})[0]["volume_m3"]
    assert volume_m3 == pytest.approx(found.document["robots"][1]["volume_m3"]["occupied"])


@pytest.mark.parametrize("beside_it", [True, False])
def test_held_joints_wherever_a_job_says_so(beside_it):
    held = {"locked": {"joint1": 0.5}}
    job = {"robot": {"library": "scara"}} | (held if beside_it else {"sampling": held})
    assert choices_of(job, 0).held_joints == held["locked"]


def test_of_designs_the_robots_of_the_best_one_are_asked():
    row = {"a": 0.3, "limits_deg": [-90, 90]}
    design = {"analysis": "workspace", "robot": {"dh": {"convention": "standard", "rows": [row, row]}}}
    design |= {"sampling": {"method": "grid", "per_joint": 20}, "voxel_size_m": 0.05, "indices": ["manipulability"]}
    length = {"name": "length", "pointers": ["/robot/dh/rows/0/a"], "bounds": [0.2, 0.4]}
    search = {"method": "sweep", "steps": [2]}
    found = ws.design_optimization(design, [length], [{"value": "/volume_m3/occupied"}], search=search)
    looking, (shown,) = Interactive.of_result(found), view_of(found).manifest["robots"]
    assert found.document["best"]["parameters"] == {"length": 0.4}
    assert looking.answer({"ask": "indices_at", "q": [0.0, 0.0]})[0]["position_m"] == pytest.approx([0.7, 0.0, 0.0])
    assert shown["chain"]["T_joint"] == looking.robots[0].chain.geometry.T_joint.reshape(-1, 16).tolist()


def test_the_best_sample_of_a_robot_that_cannot_be_had_is_its_number_alone():
    found = ws.analyze(PlanarClass(), ws.Grid(20), voxel_size_m=0.1, best_sample="manipulability", **PLANAR)
    voxels = found.volume.voxels
    asked = {"ask": "voxel", "volume": "volume", "cell": voxels.at[:, 3].tolist()}
    header = Interactive.of_result(found).answer(asked)[0]
    assert (header["q"], header["sample"]) == (None, str(voxels.best["manipulability"][3]))


@pytest.mark.parametrize(
    ("request_", "field"),
    [
        ({"ask": "nothing"}, "ask"),
        ({"ask": "indices_at", "q": [0.0]}, "q"),
        ({"ask": "indices_at", "robot": 1, "q": [0.0] * 6}, "robot"),
        ({"ask": "inverse", "position_m": [0, 0, 1], "quat_wxyz": [0, 0, 0, 0], "near": [0.0] * 6}, "quat_wxyz"),
        ({"ask": "voxel", "volume": "live_7", "cell": [0, 0, 0]}, "volume"),
        ({"ask": "placement", "map": "floor", "cell": [0, 0]}, "map"),
        (VOLUME | {"index": "beauty"}, "index"),
        (VOLUME | {"samples": 1 << 40}, "samples"),
        (VOLUME | {"voxel_size_m": 1e-4}, "voxel_size_m"),
        (VOLUME | {"limits": {"joint1": [1.0, 0.0]}}, "limits.joint1"),
        (VOLUME | {"limits": {"elbow": [0.0, 1.0]}}, "limits.elbow"),
        (VOLUME | {"tool": [1.0] * 16}, "tool"),
        (VOLUME | {"colour": "red"}, "colour"),
    ],
)
def test_what_is_wrong_is_named(looking, request_, field):
    with pytest.raises(InputError) as raised:
        looking.answer(request_)
    assert raised.value.field == field


def test_the_parts_of_a_message():
    text = message({"id": 3, "answer": {"a": 1}}, {"x": b"abc", "y": b"\0" * 5})
    (length,) = struct.unpack("<I", text[:4])
    assert length % 4 == 0
    header, blobs = json.loads(text[4 : 4 + length]), iter(text[4 + length :])
    assert {key: header[key] for key in ("id", "answer")} == {"id": 3, "answer": {"a": 1}}
    assert [bytes(islice(blobs, each["bytes"])) for each in header["blobs"]] == [b"abc", b"\0" * 5]
    assert not [*blobs]
