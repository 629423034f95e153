"""The constraint on the tip's orientation against angles that SciPy and closed forms give."""

import json

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from wsrender import cli
from wsrender.documents.constraints import Constraints
from wsrender.engine import SweepPlan, configurations, devices_of, sweep
from wsrender.errors import DocumentError
from wsrender.pipeline.constraints.registry import constraints_of
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import plan_sampling

COUNT = 1 << 15
PLACED = ws.Transform(position_m=(0.2, 0.1, 0.0), rpy_deg=(20, -35, 70))
AXIS, TOWARD = (0.2, -0.4, 0.8), (1.0, 0.5, -2.0)
TURN = {"rpy_deg": [100, 20, -50]}
NEAR = {"float32": 1e-5, "float64": 1e-11}  # rad: to the border, where rounding decides


def labels(robot, choice, precision, device, sampling=None, names=()):
    """The configurations of a sweep, and which of them it rejects."""
    pipeline = Pipeline(
        Evaluation(robot.chain, names, (0, 1, 2) if names else ()),
        plan_sampling(robot.chain, sampling or ws.Sobol(COUNT)),
        constraints_of(Constraints(orientation=choice)),
        kept_rows=frozenset(),
        precision=precision,
    )
    found = sweep(pipeline, 0, pipeline.sampling.count, devices_of(device))
    rows = np.concatenate([found.rows[first] for first in sorted(found.rows)], axis=1)
    assert found.rejected.tolist() == [np.count_nonzero(rows[-1])]
    return configurations(pipeline), rows[-1] != 0


def to_direction(R):
    """Angle of the tip's AXIS from TOWARD, (N,) [rad]: of sine and cosine, right near 0 and near a half turn."""
    axis, toward = R @ AXIS / np.linalg.norm(AXIS), np.array(TOWARD) / np.linalg.norm(TOWARD)
    return np.arctan2(np.linalg.norm(np.cross(axis, toward), axis=1), axis @ toward)


def to_rotation(R):
    """Angle of the rotation from TURN to R, (N,) [rad]."""
    target = Rotation.from_euler("xyz", TURN["rpy_deg"], degrees=True)
    return (target.inv() * Rotation.from_matrix(R)).magnitude()


@pytest.mark.parametrize("within", (5.0, 60.0, 90.0, 150.0))
@pytest.mark.parametrize("names", ((), ("manipulability",)), ids=len)
@pytest.mark.parametrize(
    ("choice", "angle"),
    [({"axis": list(AXIS), "toward": list(TOWARD)}, to_direction), (TURN, to_rotation)],
    ids=("axis", "rotation"),
)
def test_labels_are_those_of_the_angle(choice, angle, names, within, precision, device):
    robot = ws.load_robot("ur5e", placement=PLACED, tool=ws.Transform(position_m=(0, 0, 0.1), rpy_deg=(0, 30, 0)))
    choice = choice | {"within_deg": within}
    q, rejected = labels(robot, choice, precision, device, names=names)
    R = robot.chain.poses(q)[:, :3, :3]
    angles = angle(R)
    sure = np.abs(angles - np.radians(within)) > NEAR[precision]
    np.testing.assert_array_equal(rejected[sure], (angles > np.radians(within))[sure])
    assert sure.mean() > 0.99 and 0 < rejected.sum() < COUNT
    (twin,) = constraints_of(Constraints(orientation=choice))
    np.testing.assert_array_equal(twin.host(q, robot.chain.poses(q))[sure] > 0, rejected[sure])


def test_both_precisions_say_the_same_away_from_the_border(device):
    robot = ws.load_robot("franka_panda")
    choice = {"toward": [0, 0, -1], "within_deg": 30}
    q, narrow = labels(robot, choice, "float32", device)
    _, wide = labels(robot, choice, "float64", device)
    z = robot.chain.poses(q)[:, :3, 2]
    angles = np.arctan2(np.hypot(z[:, 0], z[:, 1]), -z[:, 2])
    sure = np.abs(angles - np.pi / 6) > NEAR["float32"]
    np.testing.assert_array_equal(narrow[sure], wide[sure])
    assert 0 < wide.sum() < COUNT


def test_a_tool_whose_axis_never_turns_is_in_a_cone_of_no_width(precision, device):
    """Of an arm whose slide leaves its plane, askew in the world: rounding turns half of its tools out."""
    turn, slide = {"limits": [-np.pi, np.pi]}, {"joint": "prismatic", "limits": [0, 0.2]}
    rows = [turn | {"a": 0.4, "alpha": 0.7}, slide | {"alpha": -0.7}, turn | {"a": 0.3}]
    robot = ws.load_robot(ws.DHTable(convention="standard", rows=rows), placement=PLACED)
    up = PLACED.matrix()[:3, 2]
    for toward, within, share in ((up, 0, 0), (up, 180, 0), (-up, 179.9, 1), (-up, 180, 0)):
        choice = {"axis": [0, 0, 2], "toward": toward.tolist(), "within_deg": within}
        assert labels(robot, choice, precision, device)[1].mean() == share


def test_every_door_admits_the_same(tmp_path):
    """Of a grid too, whose structure the constraint does not survive: the tip turns with every joint."""
    robot = ws.load_robot("ur5e")
    job = {
        "analysis": "workspace",
        "robot": {"library": "ur5e"},
        "sampling": {"method": "grid", "per_joint": 4},
        "constraints": {"orientation": {"toward": [1, 0, 0], "within_deg": 80}},
        "refined_volume": 0.3,
        "device": "cpu",
    }
    result = ws.execute(job)
    ends = zip(robot.chain.lower_limits, robot.chain.upper_limits, strict=True)
    q = np.stack(np.meshgrid(*(np.linspace(*each, 4) for each in ends)), -1).reshape(-1, 6)
    x = robot.chain.poses(q)[:, 0, 2]
    assert np.abs(x - np.cos(np.radians(80))).min() > 1e-5
    samples = {"drawn": 4**6, "admitted": int((x > np.cos(np.radians(80))).sum())}
    samples["rejected"] = {"orientation": 4**6 - samples["admitted"]}
    assert result.document["samples"] == samples
    assert result.document["headline"]["value"] > 0
    (tmp_path / "job.json").write_text(json.dumps(job))
    with pytest.raises(SystemExit) as ended:
        cli.main(["run", str(tmp_path / "job.json"), "-o", str(tmp_path / "out")])
    assert ended.value.code == 0
    assert ws.Result.load(tmp_path / "out").document["samples"] == samples
    given = {"analysis": "indices_at", "robot": {"library": "ur5e"}, "configurations": q[:50].tolist()}
    listed = ws.execute(given | {"constraints": job["constraints"]})
    expected = np.where(x[:50] < np.cos(np.radians(80)), "orientation", "")
    np.testing.assert_array_equal(listed.tables["admission"].columns["reason"], expected)


@pytest.mark.parametrize("analysis", ("shared_workspace", "robot_comparison"))
def test_several_robots_keep_an_orientation(analysis):
    arm = {"robot": {"library": "ur5e"}, "sampling": {"method": "sobol", "count": 4096}}
    choice = {"orientation": {"toward": [0, 0, -1], "within_deg": 40}}
    result = ws.execute({"analysis": analysis, "robots": [arm, arm], "constraints": choice, "device": "cpu"})
    alone = ws.analyze("ur5e", ws.Sobol(4096), constraints=choice, refined_volume=None, device="cpu")
    assert alone.document["samples"]["rejected"]["orientation"] > 2048
    for robot in result.document["robots"]:
        assert robot["samples"] == alone.document["samples"]


def test_a_robot_of_a_class_is_refused():
    class Crank:
        limits = ((-1.0, 2.0),)

        def forward_kinematics(self, q):
            return np.tile(np.eye(4), (len(q), 1, 1))

    with pytest.raises(ws.InputError, match=r"constraints\.orientation: is not available .* a class"):
        ws.analyze(Crank(), ws.Grid(3), constraints={"orientation": {"toward": [0, 0, 1], "within_deg": 1}})


def test_options_are_numbers_of_the_kernel():
    robot = ws.load_robot("ur5e")
    shapes = []
    for choice in ({"toward": [0, 0, 1], "within_deg": 10}, TURN | {"within_deg": 20}):
        constraints = constraints_of(Constraints(orientation=choice))
        sampling = plan_sampling(robot.chain, ws.Sobol(1024))
        shapes.append(SweepPlan(Pipeline(Evaluation(robot.chain), sampling, constraints)).shape)
    assert shapes[0] == shapes[1]


@pytest.mark.parametrize(
    ("choice", "message"),
    [
        ({"within_deg": 10}, r"orientation.toward: must be given, or one of"),
        ({"toward": [0, 0, 1]}, r"orientation.within_deg: "),
        ({"toward": [0, 0, 1], "within_deg": 181}, r"orientation.within_deg: must be .*180"),
        ({"toward": [0, 0, 1], "within_deg": -1}, r"orientation.within_deg: must be .*0"),
        ({"toward": [0, 0, 0], "within_deg": 1}, r"orientation.toward: must not have length 0"),
        ({"toward": [0, 0, 1], "axis": [0, 0, 0], "within_deg": 1}, r"orientation.axis: must not have length 0"),
        ({"toward": [0, 0, 1], **TURN, "within_deg": 1}, r'orientation.toward: .* together with "rpy_deg"'),
        ({"axis": [0, 0, 1], **TURN, "within_deg": 1}, r'orientation.axis: .* together with "rpy_deg"'),
        ({"quat_wxyz": [0, 0, 0, 0], "within_deg": 1}, r"orientation.quat_wxyz: must not have length 0"),
        ({"quat_wxyz": [1, 0, 0, 0], **TURN, "within_deg": 1}, r'orientation.rpy_deg: .* together with "quat_wxyz"'),
    ],
)
def test_malformed_orientations(choice, message):
    with pytest.raises(DocumentError, match=message):
        ws.analyze("ur5e", constraints={"orientation": choice})
