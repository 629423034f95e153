"""The analysis ``postures``: a job document in, tables of postures and poses out."""

import hashlib
from time import process_time

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.reach.test_postures import GENERAL, drawn
from tests.run.journeys import from_the_command_line
from wsrender.analyses.cost import LISTED_BYTES, LISTED_MEMORY
from wsrender.run import execute, merge, plan, run_shard

FLOOR = {"items": [{"shape": "half_space", "name": "floor"}]}
POSES = {
    "position_m": [[0.4, 0.2, 0.3], [1.5, 0, 0], [0.1, 0.4, 0.4]],
    "quat_wxyz": [[0, 1, 0, 0]] * 2 + [[1, 0, 0, 0]],
}
JOB = {"analysis": "postures", "robot": "ur5e", **POSES, "device": "cpu"}


def test_tables_say_what_python_says():
    result = execute(JOB | {"environment": FLOOR, "indices": ["manipulability", "clearance"], "windings": 3})
    robot = ws.load_robot("ur5e")
    found = ws.postures(robot, *POSES.values(), environment=FLOOR, device="cpu")
    table, poses = result.tables["postures"], result.tables["poses"]
    first = table["winding"] == 0
    q = np.stack([table[f"q_{name}"] for name in robot.joint_names], axis=1)
    assert (q[first] == found.configurations).all() and (table["pose"][first] == found.pose).all()
    assert (table["reason"][first] == found.reasons).all() and set(found.reasons) == {"", "environment"}
    assert (table["windings"][first] == found.windings).all() and np.bincount(table["winding"]).tolist() == [16, 16, 16]
    for k in np.unique(table["pose"]):
        assert table["posture"][first & (table["pose"] == k)].tolist() == list(range((found.pose == k).sum()))
        rows = np.flatnonzero(table["pose"] == k)[:3]
        turns = np.diff(q[rows], axis=0) / (2 * np.pi)
        assert turns == pytest.approx(np.round(turns), abs=1e-12) and np.abs(turns).sum(axis=1).min() > 0.9
    values = ws.evaluate_indices(robot, q, ["manipulability"])["manipulability"]
    assert table["manipulability"] == pytest.approx(values, rel=1e-12)
    assert ((table["clearance"] > 0) == (table["reason"] == "")).all()
    assert poses["postures"].tolist() == [8, 0, 8] and poses["configurations"].tolist() == [256, 0, 256]
    assert poses["free"].tolist() == [int(((found.pose == k) & (found.reasons == "")).sum()) for k in range(3)]
    assert poses["complete"].all() and poses["position"].tolist() == POSES["position_m"]
    entry = result.document["postures"]
    assert (entry["poses"], entry["reached"], entry["postures"], entry["configurations"]) == (3, 2, 16, 512)
    assert entry["free"] == poses["free"].sum() and entry["complete"] == 3 and entry["listed"] == 48
    assert entry["largest_residual_m"] <= 1e-9 and entry["evidence"].startswith("closed form (three parallel axes)")
    free = table["reason"] == ""
    assert result.document["indices"]["clearance"]["maximum"] == table["clearance"][free].max()


def test_one_pose_may_be_given_alone():
    one = execute(JOB | {"position_m": POSES["position_m"][0], "quat_wxyz": POSES["quat_wxyz"][0]})
    assert one.document["job"]["position_m"] == [POSES["position_m"][0]]
    assert (
        one.document["postures"]["postures"] == 8 and execute(one.document["job"]).document["postures"]["postures"] == 8
    )


def test_a_free_axis_in_a_document(tmp_path):
    job = JOB | {
        "free_axis": "z",
        "constraints": {"region": {"half_space": {"point_m": [0, 0, 0], "normal": [0, 0, 1]}}},
    }
    result = from_the_command_line(job, tmp_path)
    found, table = ws.postures("ur5e", *POSES.values(), free_axis="z", device="cpu"), result.tables["postures"]
    q = np.stack([table[f"q_joint{k}"] for k in range(1, 7)], axis=1)
    assert (q == found.configurations).all() and result.document["job"]["free_axis"] == "z"
    assert result.document["postures"]["self_motions"] == {"count": len(found), "closed": 0} and table["family"].all()
    assert result.document["postures"]["complete"] == 3 and (table["reason"] == "").all()
    other = execute(job | {"free_axis": "x", "starts": 16}).tables["postures"]
    assert len(other) and set(other["family"]) == {True} and not np.isin(other["q_joint1"], table["q_joint1"]).any()
    assert "free_axis" not in execute(JOB).document["job"]
    with pytest.raises(ws.InputError, match="aspects: must be false: 6 joints move, and the pose has 5 freedoms"):
        plan(job | {"aspects": True})


def test_from_the_command_line_and_back(tmp_path, capsys):
    result = from_the_command_line(JOB, tmp_path)
    assert len(result.tables["postures"]) == 16 and len(result.meshes["bodies"].faces) > 1000
    assert "16; 512 with windings" in capsys.readouterr().out
    assert result.plot.postures() is not None


def test_shards_in_any_order_are_one_run():
    job = JOB | {"robot": "franka_panda", "starts": 16}
    whole, plans = plan(job), plan(job).division(1, 3)
    divided = plan(job, resolved=plans.entry())
    parts = [run_shard(divided, k) for k in (2, 0, 1)]
    joined, alone = merge(divided, merge(divided, parts[0], parts[1]), parts[2]), run_shard(whole, 0)
    assert len(plans.shards) == 3 and len(alone["pose"]) > 3
    assert all((joined[name] == array).all() for name, array in alone.arrays.items())


def test_self_motions_are_a_table():
    poses = {"position_m": [[0.4, 0.2, 0.4]], "quat_wxyz": [[0, 1, 0, 0]]}
    result = execute(JOB | poses | {"robot": "franka_panda", "starts": 16, "curve_step": 0.1})
    found = ws.postures("franka_panda", *poses.values(), device="cpu", starts=16, curve_step=0.1)
    table = result.tables["self_motions"]
    q = np.stack([table[f"q_{name}"] for name in ws.load_robot("franka_panda").joint_names], axis=1)
    assert (q == np.concatenate([curve.configurations for curve in found.curves])).all()
    assert np.bincount(table["posture"]).tolist() == [len(curve) for curve in found.curves]
    assert result.document["postures"]["self_motions"] == {"count": len(found), "closed": 0}
    assert not table["closed"].any() and (np.diff(table["point"])[np.diff(table["posture"]) == 0] == 1).all()
    assert "self-motions" in result.summary() and "of a self-motion" in labels(result.plot.postures())


def labels(figure):
    return " ".join(text.get_text() for text in figure.legends[0].get_texts())


def test_pictures_and_summaries_say_that_they_show_some():
    """Of a continuum 16 postures are listed, of which 8 are drawn."""
    result = execute(JOB | {"position_m": [0.4, 0.2, 0.4], "quat_wxyz": None})
    figure = result.plot.postures()
    assert figure.legends[0].get_title().get_text() == "8 of 16 postures"
    assert labels(figure).startswith("posture 0 posture 1 ") and len(figure.legends[0].get_texts()) == 8
    assert "16, of which 16 stand for families" in result.summary()
    one = execute(JOB | {"position_m": POSES["position_m"][0], "quat_wxyz": POSES["quat_wxyz"][0]})
    assert one.plot.postures().legends[0].get_title().get_text() == "" and "families" not in one.summary()


def test_more_starts_find_more_and_seeds_matter():
    """Of an arm without a closed form."""
    rows = [{"a": 0.3, "alpha_deg": alpha, "d": 0.1, "limits_deg": [-170, 170]} for alpha in (80, 20, 70, -60, 50, 0)]
    dh = {"convention": "standard", "name": "general", "rows": rows}
    T = ws.load_robot(ws.DHTable(**dh)).chain.poses(np.array([[0.3, -0.4, 0.8, 1.0, 0.7, 0.2]]))[0]
    quat = Rotation.from_matrix(T[:3, :3]).as_quat(scalar_first=True)
    job = JOB | {"robot": {"dh": dh}, "position_m": T[:3, 3].tolist(), "quat_wxyz": quat.tolist()}
    few, many, other = (execute(job | change) for change in ({"starts": 4}, {}, {"starts": 4, "seed": 1}))
    q = [result.tables["postures"]["q_joint1"].tolist() for result in (few, many, other)]
    assert len(q[0]) < len(q[1]) and q[0] != q[2] and not many.tables["poses"]["complete"].any()
    assert few.document["provenance"]["seed"] == 0 and other.document["provenance"]["seed"] == 1


@pytest.mark.parametrize(
    ("change", "field", "message"),
    [
        ({"quat_wxyz": [[1, 1, 0, 0]] * 3}, "quat_wxyz", "must be of unit length: row 0 has length 1.41421"),
        ({"quat_wxyz": [[1, 0, 0, 0]] * 2}, "quat_wxyz", "must have as many rows as position_m, 3, not 2"),
        ({"position_m": [[0, 0]]}, "position_m", "rows of 3 numbers"),
        ({"position_m": []}, "position_m", "at least 1"),
        ({"free_axis": "z", "quat_wxyz": None}, "free_axis", 'must not be given without "quat_wxyz"'),
        ({"windings": 0}, "windings", "1"),
        ({"indices": ["no_such"]}, "indices", "no_such"),
    ],
)
def test_bad_jobs_are_refused_by_name(change, field, message):
    with pytest.raises((ws.DocumentError, ws.InputError), match=f"{field}.*{message}"):
        plan(JOB | change)


@pytest.mark.parametrize(("robot", "count"), [("ur5e", 2000), (GENERAL, 200)])
def test_estimated_seconds_are_those_of_closed_forms_and_searches(robot, count):
    chain = ws.load_robot(robot).chain
    T = chain.poses(drawn(chain, count))
    quat = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    named = robot if isinstance(robot, str) else {"dh": robot.model_dump(mode="json")}
    all_of_them = {"robot": named, "position_m": T[:, :3, 3].tolist(), "quat_wxyz": quat.tolist()}
    few = {key: value[:1] for key, value in all_of_them.items() if key != "robot"}
    one, whole = plan(JOB | all_of_them | few), plan(JOB | all_of_them)
    run_shard(one, 0)  # kernels are compiled
    took = []
    for _ in range(2):  # once garbage of all tests before may be collected meanwhile
        began = process_time()
        run_shard(whole, 0)
        took.append(process_time() - began)
    assert 0.25 < (whole.cost.seconds - one.cost.seconds) / min(took) < 4  # of CPU time


def written(folder, rows, header="x_m,y_m,z_m,qw,qx,qy,qz,name"):
    path = folder / "holes.csv"
    path.write_text("\n".join([header, *rows]))
    return path


def test_a_table_gives_what_the_lists_give(tmp_path):
    listed = execute(JOB)
    rows = [
        ",".join(map(str, (*position, *quat, f"hole {k}")))
        for k, (position, quat) in enumerate(zip(*POSES.values(), strict=True))
    ]
    path = written(tmp_path, rows)
    job = {name: value for name, value in JOB.items() if name not in POSES}
    found = execute(job | {"targets": {"path": str(path)}})
    assert found.tables["poses"]["name"].tolist() == ["hole 0", "hole 1", "hole 2"]
    for table in ("poses", "postures"):
        for name in listed.tables[table].columns:
            np.testing.assert_array_equal(found.tables[table][name], listed.tables[table][name])
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    assert found.document["provenance"]["targets_sha256"] == digest
    assert "targets_sha256" not in listed.document["provenance"]
    one_by_one = [{"position_m": p, "quat_wxyz": q} for p, q in zip(*POSES.values(), strict=True)]
    again = execute(job | {"targets": one_by_one})
    np.testing.assert_array_equal(again.tables["postures"]["pose"], listed.tables["postures"]["pose"])
    assert "name" not in again.tables["poses"].columns
    assert ws.all_postures("ur5e", targets=str(path), device="cpu").document["postures"] == found.document["postures"]


def test_an_axis_serves_all_targets(tmp_path):
    rows = ["0.4,0.2,0.3,0,1,0,0", "0.1,0.4,0.4,0,1,0,0"]
    path = {"path": str(written(tmp_path, rows, "x_m,y_m,z_m,qw,qx,qy,qz"))}
    job = {"analysis": "postures", "robot": "scara", "device": "cpu", "free_axis": "z"}
    listed = execute(job | {"position_m": [[0.4, 0.2, 0.3], [0.1, 0.4, 0.4]], "quat_wxyz": [0, 1, 0, 0]})
    found = execute(job | {"targets": path})
    assert found.document["postures"] == listed.document["postures"] and found.document["postures"]["evidence"]
    own = [{"position_m": [0.4, 0.2, 0.3], "quat_wxyz": [0, 1, 0, 0], "free_axis": "z"}]
    told = execute({**job, "free_axis": None, "targets": own}).document["postures"]
    assert told == execute(job | {"targets": [{**own[0], "free_axis": None}]}).document["postures"]


TURNED = {"position_m": [0.4, 0.2, 0.3], "quat_wxyz": [0, 1, 0, 0]}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"targets": [TURNED], "position_m": [[0, 0, 1]]}, 'position_m.*or else "targets": one of the two'),
        ({"targets": [TURNED], "quat_wxyz": [1, 0, 0, 0]}, 'quat_wxyz.*must not be given without "position_m"'),
        ({}, 'position_m.*must be given, or else "targets"'),
        ({"targets": [TURNED, {"position_m": [0, 0, 1]}]}, "target 1 and target 0 differ in their orientation"),
        ({"targets": [TURNED, TURNED | {"free_axis": "z"}]}, "target 1 and target 0 differ in their free axis"),
        ({"targets": [TURNED | {"free_axis": "z"}], "free_axis": "x"}, "free_axis.*target 0 has another one"),
        ({"targets": [TURNED, {"position_m": [0, 0, 1]}], "free_axis": "x"}, "free_axis.*target 1 says no orientation"),
        ({"targets": {"path": "none.csv"}}, "targets.path.*none.csv cannot be read"),
        ({"targets": [{"position_m": [400, 200]}]}, "targets.*position_m"),
    ],
)  # fmt: skip
def test_targets_that_do_not_go_together(change, message):
    with pytest.raises((ws.DocumentError, ws.InputError), match=message):
        plan({"analysis": "postures", "robot": "ur5e", "device": "cpu"} | change)


def test_a_table_in_millimetres_is_told(tmp_path):
    path = str(written(tmp_path, ["400,200,300", "500,200,300"], "x_m,y_m,z_m"))
    with pytest.raises(ws.InputError, match=r"targets.length_unit_m.*millimetres\?"):
        plan({"analysis": "postures", "robot": "ur5e", "targets": {"path": path}})


def test_a_table_is_not_counted_as_a_list(tmp_path):
    """What a document does not list is no part of its file, nor of memory as objects."""
    rows = [f"0.4,{0.001 * k:.3f},0.3,0,1,0,0" for k in range(200)]
    job = {"analysis": "postures", "robot": "ur5e", "device": "cpu"}
    table = plan(job | {"targets": {"path": str(written(tmp_path, rows, "x_m,y_m,z_m,qw,qx,qy,qz"))}}).cost
    points = [[0.4, 0.001 * k, 0.3] for k in range(200)]
    listed = plan(job | {"position_m": points, "quat_wxyz": [0, 1, 0, 0]}).cost
    assert listed.file_bytes - table.file_bytes == pytest.approx(7 * 200 * LISTED_BYTES)
    assert listed.memory_bytes - table.memory_bytes == pytest.approx(7 * 200 * LISTED_MEMORY)
    assert (table.samples, table.seconds) == (listed.samples, pytest.approx(listed.seconds, abs=0.01))
