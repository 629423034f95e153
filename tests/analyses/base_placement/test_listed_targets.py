"""Lists and tables of targets for base placement: kinds decided beside each other, weights, what is refused."""

import hashlib

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.analyses.base_placement.test_base_placement import DOWN, RING, bases_of, job, labels_of
from wsrender.reach import targets as kinds
from wsrender.robot.constraints import constraints_for
from wsrender.run import execute, plan

OVER = {"x_m": [-1.0, 1.0, 0.5], "y_m": [-0.9, 0.3, 0.6], "yaw_deg": [0, 180, 90]}
HEADER = "name,x_m,y_m,z_m,qw,qx,qy,qz,free_axis,weight,position_tolerance_m,angle_tolerance_rad"
TILTED = Rotation.from_euler("xyz", [150, 20, 40], degrees=True).as_quat(scalar_first=True).tolist()
MIXED = [  # in turn, so that their order is not that of their kinds
    ("whole", [0.3, 0.2, 0.3], TILTED, "", 1, None, None),
    ("about z", [0.3, 0.2, 0.3], TILTED, "z", 2, None, None),
    ("anyhow", [0.3, 0.2, 0.3], None, "", 3, None, None),
    ("about x", [0.3, 0.2, 0.3], TILTED, "x", 4, None, None),
    ("whole roughly", [0.3, 0.2, 0.3], TILTED, "", 5, 0.2, 0.5),
    ("whole far", [0.9, 0.4, 0.2], DOWN, "", 6, None, None),
    ("about z far", [0.9, 0.4, 0.2], DOWN, "z", 7, None, None),
    ("about y far", [0.9, 0.4, 0.2], DOWN, "y", 8, None, None),
]


def table_of(path, targets):
    """A table of such targets in a file."""
    rows = [
        ["" if cell is None else str(cell) for cell in (name, *position, *(quat or [None] * 4), *rest)]
        for name, position, quat, *rest in targets
    ]
    path.write_text("\n".join([HEADER, *map(",".join, rows)]) + "\n")
    return path


def on_table(path, robot: str | dict = "ur5e", **fields):
    document = job(robot, [], over=OVER) | {"targets": {"path": str(path)}}
    del document["points_m"]
    return document | fields


def labels_on(result):
    """As `labels_of`, of a job without points."""
    count = result.document["placements"]["targets"]
    result.document["job"]["points_m"] = [None] * count
    return labels_of(result)


def moved(target, base):
    """The same target seen from a base (4, 4)."""
    name, position, quat, *rest = target
    R, p = base[:3, :3], base[:3, 3]
    if quat is not None:
        turned = Rotation.from_matrix(R.T) * Rotation.from_quat(quat, scalar_first=True)
        quat = turned.as_quat(scalar_first=True).tolist()
    return name, (R.T @ (np.array(position) - p)).tolist(), quat, *rest


def test_a_table_is_the_points_it_lists(tmp_path):
    """Labels, the best placement and the map, whatever the door; names, weights and the file's hash beside them."""
    points, weights = [*RING, [1.6, 0.9, 0.3]], [1.0] * 6 + [0.5]
    path = table_of(tmp_path / "t.csv", [(f"hole {k}", p, DOWN, "", w, None, None)
                                         for k, (p, w) in enumerate(zip(points, weights, strict=True))])  # fmt: skip
    listed = execute(on_table(path, index="joint_limit_margin"))
    plain = execute(job("ur5e", points, [DOWN] * 7, over=OVER, weights=weights, index="joint_limit_margin"))
    assert (labels_on(listed) == labels_of(plain)).all() and listed.document["best"] == plain.document["best"]
    for name in ("placements", "placement_map"):
        for column, values in plain.tables[name].columns.items():
            assert np.array_equal(values, listed.tables[name][column], equal_nan=True), column
    table = listed.tables["targets"]
    assert table["name"].tolist() == [f"hole {k}" for k in range(7)] and table["weight"].tolist() == weights
    assert np.array_equal(table["q_joint3"], plain.tables["targets"]["q_joint3"])
    sha256 = hashlib.sha256(path.read_bytes()).hexdigest()
    assert listed.document["provenance"]["targets_sha256"] == sha256
    assert "targets_sha256" not in plain.document["provenance"]


def test_kinds_of_targets_are_decided_beside_each_other(tmp_path):
    """As `ws.reachable` labels the table seen from each base; the best placement's configurations hold the axes."""
    arm = {"library": "ur5e", "limits_deg": {"joint6": [-10, 10]}}
    document = on_table(table_of(tmp_path / "t.csv", MIXED), arm)
    result = execute(document)
    robot, bases, found = ws.load_robot("ur5e", limits_deg=arm["limits_deg"]), bases_of(document), labels_on(result)
    expected = []
    for base in bases:
        seen = table_of(tmp_path / "seen.csv", [moved(each, base) for each in MIXED])
        expected.append(ws.reachable(robot, ws.TargetTable(seen, length_unit_m=1), device="cpu").labels)
    expected = np.where(np.array(expected) == "reachable", "served", np.array(expected))
    assert (found == expected).all(), np.argwhere(found != expected)
    served = found == "served"
    for less, more in ((0, 1), (0, 3), (0, 4), (1, 2), (3, 2), (5, 6), (5, 7)):  # what asks for less is served as well
        assert (served[:, more] >= served[:, less]).all()
    assert (served[:, [1, 3, 4]] > served[:, [0]]).any(axis=0).all()
    table, weights = result.tables["targets"], np.arange(1, 9)
    assert result.document["best"]["weight"] == (served @ weights).max()
    assert (result.tables["placements"]["weight"] == served @ weights).all()
    assert table["free_axis"].tolist() == [each[3] for each in MIXED]
    placed = ws.load_robot("ur5e", placement=np.array(result.document["best"]["T_world_base"]))
    q = np.stack([table[f"q_{name}"] for name in placed.joint_names], axis=1)
    pose = placed.forward_kinematics(q, device="cpu")
    for k, (_, position, quat, axis, _, near, _) in enumerate(MIXED):
        if table["label"][k] != "reachable":
            continue
        assert np.linalg.norm(pose[k, :3, 3] - position) <= (near or 1e-5)
        if axis:
            wanted = Rotation.from_quat(quat, scalar_first=True).as_matrix()[:, "xyz".index(axis)]
            assert pose[k, :3, "xyz".index(axis)] @ wanted > 1 - 1e-9
    assert {table["label"][k] for k in (1, 3)} == {"reachable"}


def test_a_tip_turns_away_from_what_stands_around(tmp_path):
    """A finger that sticks out of the tool: where the tip may turn about z, as `ws.reachable` says of the arm there."""
    finger = {"shape": "box", "size_m": [0.25, 0.02, 0.02], "position_m": [0.125, 0, 0.02]}
    wall = ws.Box(name="wall", size_m=(0.04, 2.0, 0.8), position_m=(0.5, 0, 0.4))
    robot = {"library": "ur5e", "tool_shapes": [finger]}
    targets = [(name, [0.4, y, 0.3], DOWN, axis, None, None, None) for y in (-0.1, 0.2) for name, axis in
               (("whole", ""), ("about z", "z"))]  # fmt: skip
    path, around = table_of(tmp_path / "t.csv", targets), ws.Environment(items=[wall])
    over = {"x_m": [-0.4, 0.4, 0.4], "y_m": -0.3}
    document = on_table(path, robot, over=over, environment=around.model_dump(mode="json"), use_symmetry=False)
    found, expected = labels_on(execute(document)), []
    for base in bases_of(document):
        there = ws.load_robot("ur5e", tool_shapes=[finger], placement=base)
        limits = constraints_for(there, None, around)
        labels = ws.reachable(there, path, device="cpu", constraints=limits).labels.astype("<U20")
        expected.append(np.where(labels == "reachable", "served", np.where(labels == "blocked", "environment", labels)))
    assert (found == np.array(expected)).all()
    assert set(found[:, ::2].ravel()) == {"environment"} and set(found[:, 1::2].ravel()) == {"served"}


def test_weights_of_a_table_decide(tmp_path):
    points, best = [*RING, [2.0, 0.3, 0.3]], []  # the last one cannot be served with the others
    over = {"x_m": [-1.0, 1.5, 0.5], "y_m": [-0.6, 0.6, 0.6]}
    for last in (1, 100):
        rows = [(str(k), p, DOWN, "z", last if k == 6 else None, None, None) for k, p in enumerate(points)]
        result = execute(on_table(table_of(tmp_path / "t.csv", rows), over=over))
        served = labels_on(result) == "served"
        best.append(served[result.document["best"]["cell"]["placement"]].tolist())
        weight = served @ np.array([1] * 6 + [last])
        assert result.document["best"]["weight"] == weight.max()
        assert ("weight" in result.tables["placement_map"].columns) == (last == 100)  # else it says what served does
    assert best[0] == [True] * 6 + [False] and best[1][6]


def test_the_best_placement_is_refined_among_kinds(tmp_path):
    """It serves the same all over its tolerance, as `ws.reachable` says of bases at its edge."""
    targets = [(str(k), p, DOWN, "z" if k % 2 else "", None, None, None) for k, p in enumerate(RING[:4])]
    path = table_of(tmp_path / "t.csv", targets)
    best = execute(on_table(path, refine=True)).document["best"]
    base, shift = np.array(best["T_world_base"]), best["tolerance"]["translation_m"]
    assert best["served"] == best["cell"]["served"] == 4 and shift > 0.01
    by = np.random.default_rng(2).normal(size=(24, 3))
    by *= (shift - 1e-4) / np.linalg.norm(by, axis=1, keepdims=True)
    far = []
    for each in by:
        for times in (1.0, 4.0):
            there = base.copy()
            there[:3, 3] += times * each
            seen = table_of(tmp_path / "seen.csv", [moved(target, there) for target in targets])
            labels = ws.reachable("ur5e", seen, device="cpu").labels
            if times == 1:
                assert (labels == "reachable").all()
            else:
                far.append((labels == "reachable").all())
    assert not all(far)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("x_m,y_m,z_mm\n0,0,0\n", 'has the column "z_mm", which no table of targets has; in millimetres call it x_m'),
        ("x_m,y_m,z_m,free_axis\n0,0,0,z\n", "row 1, column free_axis: must be empty where there is no orientation"),
        ("x_m,y_m,z_m,weight\n0,0,0,1\n0,0,0,-1\n", "row 2, column weight: must be greater than 0, not -1"),
    ],
)
def test_wrong_tables_are_refused_as_elsewhere(content, message, tmp_path):
    (tmp_path / "t.csv").write_text(content)
    found = []
    for analysis in ("base_placement", "reachability"):
        document = on_table(tmp_path / "t.csv", analysis=analysis)
        if analysis == "reachability":
            document = {name: document[name] for name in ("analysis", "robot", "targets", "device")}
        with pytest.raises(ws.InputError) as refusal:
            plan(document)
        found.append((refusal.value.field, str(refusal.value)))
    assert found[0] == found[1] and found[0][0] == "targets.path" and message in found[0][1]


HERE = [{"position_m": [0.4, 0, 0.3]}]


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({}, 'points_m: must be given, or else "targets": one of the two'),
        ({"points_m": [[0, 0, 0]], "targets": HERE}, 'points_m: must be given, or else "targets"'),
        ({"targets": HERE, "weights": [2]}, 'weights: must not be given without "points_m": targets say their own'),
    ],
)
def test_wrong_documents(fields, message):
    with pytest.raises(ws.DocumentError, match=message):
        plan({"analysis": "base_placement", "robot": "ur5e", "over": OVER, "device": "cpu"} | fields)


def test_what_a_list_asks_for_is_checked_before_anything_runs(tmp_path, monkeypatch):
    rest = {"analysis": "base_placement", "robot": "ur5e", "over": OVER, "device": "cpu"}
    with pytest.raises(ws.InputError, match=r"position_tolerance_m: 1e-15 is not allowed"):
        plan(rest | {"targets": [*HERE, HERE[0] | {"position_tolerance_m": 1e-15}]})
    monkeypatch.setattr(kinds, "MOST_KINDS", 1)
    with pytest.raises(ws.InputError, match="targets: have 2 combinations of tolerances and free axes; allowed: 1"):
        plan(rest | {"targets": [*HERE, HERE[0] | {"position_tolerance_m": 1e-3}]})


def test_lengths_are_those_from_where_the_base_may_stand(tmp_path):
    """Far from the world's origin, bases stand there too; millimetres are refused."""
    far, over = [("far", [400.0, 0.2, 0.3], DOWN, "z", None, None, None)], {"x_m": [399, 400, 0.5]}
    path = table_of(tmp_path / "t.csv", far)
    assert execute(on_table(path, over=over)).document["best"]["served"] == 1
    with pytest.raises(
        ws.InputError, match=r"targets\.length_unit_m: half of the targets are 399 m away .*millimetres\?"
    ):
        plan(on_table(path))
