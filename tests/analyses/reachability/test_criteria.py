"""Target lists as evidence: names, weights and hashes in the result, criteria that pass or fail, exit codes."""

import hashlib
import json

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.reference import closed_form_inverse as closed_form
from tests.run.journeys import from_a_partial_file
from wsrender.analyses.cost import DECIDED_PER_S
from wsrender.analyses.criteria import share_of, verdict
from wsrender.cli import main
from wsrender.run import execute, merge, plan
from wsrender.run.steps import finish, run_shard

NEAR, FAR = [-0.3, 0.0, 0.0], [2.0, 0.0, 0.0]  # of the arm `spherical`
JOB = {"analysis": "reachability", "robot": "spherical", "device": "cpu"}
MARGIN = {"joint_margin_deg": 10.0, "joint_margin_m": 0.02}


def forty(reached, folder):
    """A table of 40 targets, so many of which are reached."""
    rows = [f"hole {k},{','.join(map(str, NEAR if k < reached else FAR))}" for k in range(40)]
    (folder / "holes.csv").write_text("\n".join(["name,x_m,y_m,z_m", *rows]))
    return folder / "holes.csv"


@pytest.mark.parametrize(("reached", "said"), [(38, "pass"), (37, "fail")])
def test_a_share_at_its_boundary(reached, said, tmp_path, capsys):
    """95 % of 40 are 38: the result, the summary, the report and the exit code say so."""
    path = forty(reached, tmp_path)
    job = JOB | {"targets": {"path": str(path)}, "criteria": [{"least_share": 0.95}]}
    (tmp_path / "job.json").write_text(json.dumps(job))
    with pytest.raises(SystemExit) as ended:
        main(["run", str(tmp_path / "job.json"), "-o", str(tmp_path / "out")])
    assert ended.value.code == {"pass": 0, "fail": 3}[said]
    share = f"{reached / 0.4:g} %"
    assert f"criterion 1: {said}: {share}; 95 % reached needed" in capsys.readouterr().out
    result = ws.Result.load(tmp_path / "out")
    (criterion,) = result.document["criteria"]
    assert result.document["verdict"] == criterion["verdict"] == said
    assert (criterion["reached"], criterion["share"]) == (reached, reached / 40)
    assert result.document["provenance"]["targets_sha256"] == hashlib.sha256(path.read_bytes()).hexdigest()
    assert result.document["provenance"]["seed"] == 0
    assert result.tables["targets"]["name"].tolist()[:2] == ["hole 0", "hole 1"]
    result.report(tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text()
    assert f"<td>{said}</td>" in page and result.document["provenance"]["targets_sha256"] in page


def test_shares_are_those_of_weights():
    targets = [{"position_m": NEAR, "weight": 0.3, "name": "a"}, {"position_m": FAR, "weight": 0.1}]
    result = execute(JOB | {"targets": targets, "criteria": [{"least_share": 0.75}, {"least_share": 0.7500001}]})
    assert [each["verdict"] for each in result.document["criteria"]] == ["pass", "fail"]
    assert result.document["verdict"] == "fail"
    assert result.document["targets"]["share"] == {
        "reachable": pytest.approx(0.75, abs=1e-15), "unreachable": pytest.approx(0.25, abs=1e-15), "undecided": 0.0,
    }  # fmt: skip
    assert result.tables["targets"]["weight"].tolist() == [0.3, 0.1]


def test_verdicts():
    weight = np.array([0.1] * 10)
    reached, open_ = np.arange(10) < 8, np.arange(10) == 8
    assert share_of(weight, reached) == 0.8
    assert verdict(0.8, weight, reached, open_) == "pass"
    assert verdict(0.9, weight, reached, open_) == "undecided"
    assert verdict(0.91, weight, reached, open_) == verdict(0.8 + 1e-9, weight, reached, ~(open_ | ~open_)) == "fail"


def test_undecided_targets_leave_a_criterion_undecided():
    here = plan(JOB | {"targets": [{"position_m": NEAR}] * 2, "criteria": [{"least_share": 1}]})
    partial = run_shard(here, 0)
    partial.arrays["labels"][1] = "undecided"
    document = finish(here, partial).document
    assert document["verdict"] == document["criteria"][0]["verdict"] == "undecided"
    assert document["criteria"][0]["undecided_share"] == 0.5


def test_margins_against_all_postures(tmp_path):
    """Of a Puma's random poses: those that have a posture in closed form within limits that are narrower."""
    robot, random = ws.load_robot("puma560"), np.random.default_rng(2)
    points, turns = random.uniform(-0.75, 0.75, (300, 3)), Rotation.random(300, random_state=3)
    margin = np.deg2rad(30)
    with np.errstate(invalid="ignore"):
        arm = closed_form.puma560_arm(points)
        solutions = closed_form.with_spherical_wrist("puma560", arm, turns.as_matrix())
    lower, upper = robot.lower_limits, robot.upper_limits
    inside = [
        closed_form.within_limits(solutions, lower + by, upper - by, robot.chain.revolute).any(axis=1)
        for by in (0, margin)
    ]
    quats = turns.as_quat(scalar_first=True)
    targets = [{"position_m": p, "quat_wxyz": q} for p, q in zip(points.tolist(), quats.tolist(), strict=True)]
    job = JOB | {"robot": "puma560", "targets": targets}
    job["criteria"] = [{"least_share": 0.01, "joint_margin_deg": 30}, {"least_share": 0.2}]
    result = execute(job)
    table, (with_margin, without) = result.tables["targets"], result.document["criteria"]
    for name, expected in (("label", inside[0]), ("criterion_1", inside[1])):
        decided = table[name] != "undecided"
        assert decided.mean() > 0.98 and ((table[name] == "reachable") == expected)[decided].all(), name
    assert 10 < inside[1].sum() < inside[0].sum() - 10
    assert with_margin["reached"] == (table["criterion_1"] == "reachable").sum()
    assert without["reached"] == (table["label"] == "reachable").sum()
    # The configuration found keeps the margin, and reaches the target.
    kept = table["criterion_1"] == "reachable"
    q = np.stack([table[f"q_{name}"] for name in robot.joint_names], axis=1)[kept]
    assert np.minimum(q - lower, upper - q).min() >= margin - 1e-9
    assert robot.forward_kinematics(q)[:, :3, 3] == pytest.approx(points[kept], abs=1e-5)
    travelled = from_a_partial_file(job, tmp_path)
    assert travelled.document["criteria"] == result.document["criteria"]


def test_margins_of_slides_and_their_bounds():
    """A target at the end of the slide's range, and one in the middle of it."""
    robot = ws.load_robot("spherical")
    middle = (robot.lower_limits + robot.upper_limits) / 2
    ends = np.stack([middle, middle])
    ends[1, 2] = robot.upper_limits[2] - 0.01
    points = robot.forward_kinematics(ends)[:, :3, 3].tolist()
    job = JOB | {"points_m": points, "criteria": [{"least_share": 0.5, **MARGIN}, {"least_share": 0.6, **MARGIN}]}
    result = execute(job)
    assert result.tables["targets"]["label"].tolist() == ["reachable", "reachable"]
    assert result.tables["targets"]["criterion_2"].tolist() == ["reachable", "unreachable"]
    assert [each["verdict"] for each in result.document["criteria"]] == ["pass", "fail"]
    with pytest.raises(ws.InputError, match=r"criteria\.0\.joint_margin_m: must be at most .* m: joint3 has no more"):
        plan(job | {"criteria": [{"least_share": 0.5, "joint_margin_m": 10}]})
    with pytest.raises(ws.InputError, match=r"criteria\.0\.joint_margin_deg: must be at most .*°: joint"):
        plan(job | {"criteria": [{"least_share": 0.5, "joint_margin_deg": 179}]})


def test_each_margin_is_estimated_to_take_as_long_as_the_targets():
    """Beside what pictures and files take."""
    job = JOB | {"points_m": [[0.1, 0.1, 0.1 * k] for k in range(9)]}
    criteria = {"least_share": 0.5, "joint_margin_deg": 1}, {"least_share": 0.5}
    alone, once, twice = (
        plan(job | {"criteria": [criteria[k] for k in asked]}).cost.seconds for asked in ([1], [0, 1], [0, 0])
    )
    assert once - alone == pytest.approx(9 / DECIDED_PER_S, rel=1e-6)
    assert twice - once == pytest.approx(9 / DECIDED_PER_S, rel=1e-6)


def test_shards_of_a_table_change_no_bit(tmp_path):
    path = forty(20, tmp_path)
    path.write_text(path.read_text() + "\npost,-0.3,0.1,0.0\n")
    whole = plan(JOB | {"targets": str(path), "criteria": [{"least_share": 0.5, **MARGIN}]})
    parts = [whole.over(0, 7), whole.over(7, 34)]
    found = finish(whole, merge(whole, *(run_shard(part, 0) for part in parts)))
    alone = finish(whole, run_shard(whole, 0))
    for name, column in alone.tables["targets"].columns.items():
        assert np.array_equal(column, found.tables["targets"][name]), name
    assert found.document["criteria"] == alone.document["criteria"]


def test_constraints_block_targets_of_a_list():
    floor = {"items": [{"shape": "half_space", "point_m": [0, 0, -0.003]}]}
    targets = [{"position_m": [0.5, 0, -0.1]}, {"position_m": [0.4, 0.2, 0.5]}, {"position_m": [0.4, 0.2, 0.3]}]
    targets[2] |= {"rpy_deg": [180, 0, 0], "free_axis": "x"}
    job = JOB | {"robot": "ur5e", "targets": targets, "environment": floor}
    result = execute(job | {"criteria": [{"least_share": 0.6, "joint_margin_deg": 20}]})
    assert result.tables["targets"]["label"].tolist() == ["blocked", "reachable", "reachable"]
    assert result.tables["targets"]["criterion_1"].tolist() == ["blocked", "reachable", "reachable"]
    assert result.tables["targets"]["free_axis"].tolist() == ["", "", "x"]
    assert result.document["verdict"] == "pass"
    assert result.plot.targets() is not None  # though some have no orientation


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({}, 'points_m: must be given, or else "targets": one of the two'),
        ({"points_m": [NEAR], "targets": [{"position_m": NEAR}]}, 'points_m: must be given, or else "targets"'),
        ({"targets": [{"position_m": NEAR}], "quats_wxyz": [[1, 0, 0, 0]]}, 'quats_wxyz: must not be given without'),
        ({"targets": [{"position_m": NEAR, "free_axis": "z"}]}, r"targets\.0\.free_axis: must not be given without an"),
        ({"targets": {"path": "a.csv", "model": "0" * 64}}, r'targets\.path: must be given, or else "model"'),
        ({"targets": {"path": "a.xlsx"}}, r'targets\.path: must end in \.csv, \.parquet, \.npy, not "a\.xlsx"'),
        ({"points_m": [NEAR], "criteria": [{"least_share": 1.1}]}, r"criteria\.0\.least_share: must be above 0"),
        ({"points_m": [NEAR], "criteria": [{}]}, r"criteria\.0\.least_share: is required"),
        ({"points_m": [NEAR], "criteria": [{"least_share": 1, "joint_margin_deg": -1}]}, "margin_deg: must be at"),
    ],
)  # fmt: skip
def test_wrong_documents(fields, message):
    with pytest.raises(ws.DocumentError, match=message):
        plan(JOB | fields)


def test_room_to_the_limits_is_told_with_its_units():
    result = execute(JOB | {"points_m": [NEAR], "criteria": [{"least_share": 0.5, **MARGIN}]})
    assert "50 % reached with 10° and 0.02 m to the limits needed" in result.summary()
