"""Robots, DH tables and transforms of a job document: what they accept and what they say otherwise."""

import json
import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from wsrender.documents.constraints import Apart
from wsrender.documents.robot import DHRow, DHTable, RobotSpec, Transform
from wsrender.errors import DocumentError

ROW = {"a": 0.3}


def table(*rows, **fields):
    return DHTable(**{"convention": "modified", "rows": list(rows), **fields})


# --- DH tables ------------------------------------------------------------------------------------------


def test_degrees_and_radians_are_the_same_table():
    degrees = table({"alpha_deg": 90, "theta_deg": -45, "limits_deg": [-180, 30]})
    radians = table({"alpha": math.pi / 2, "theta": -math.pi / 4, "limits": [-math.pi, math.radians(30)]})
    assert degrees == radians
    assert degrees.rows[0].alpha_deg is None


def test_rows_are_objects_or_dicts_and_numbers_may_be_numpys():
    row = DHRow(a=np.float32(0.5), limits_deg=np.array([-90, 90]), mass=np.int64(2), inertia=np.ones(3))
    assert table(row) == table({"a": 0.5, "limits": (-math.pi / 2, math.pi / 2), "mass": 2, "inertia": [1, 1, 1]})


def test_a_table_survives_json():
    rows = [{"alpha_deg": 90, "limits_deg": [-45, 45]}, {"joint": "prismatic", "limits": [0, 1], "mass": 1}]
    written = table(*rows, name="arm").model_dump(mode="json")
    assert DHTable(**json.loads(json.dumps(written))) == table(*rows, name="arm")


def test_joints_are_named_by_their_place():
    assert table(ROW, {"name": "elbow"}, ROW).joint_names() == ("joint1", "elbow", "joint3")


def test_the_inertia_matrix_is_symmetric_in_the_stated_order():
    row = DHRow(mass=1, inertia=[1, 2, 3, 0.1, 0.2, 0.3])
    assert row.inertia_matrix().tolist() == [[1, 0.1, 0.2], [0.1, 2, 0.3], [0.2, 0.3, 3]]


BAD_ROWS = [
    ({"alpha": 1, "alpha_deg": 57}, "rows.0.alpha_deg", 'together with "alpha"'),
    ({"theta": 0, "theta_deg": 0}, "rows.0.theta_deg", 'together with "theta"'),
    ({"limits": [0, 1], "limits_deg": [0, 1]}, "rows.0.limits_deg", 'together with "limits"'),
    ({"joint": "prismatic"}, "rows.0.limits", "must be given for a prismatic joint"),
    ({"joint": "prismatic", "limits_deg": [0, 1]}, "rows.0.limits_deg", "in metres"),
    ({"joint": "ball"}, "rows.0.joint", 'must be "revolute" or "prismatic", not "ball"'),
    ({"limits": [1, -1]}, "rows.0.limits", r"lower limit below the upper one, not \[1, -1\]"),
    ({"limits_deg": [30, 30]}, "rows.0.limits_deg", r"lower limit below the upper one, not \[30, 30\]"),
    ({"limits": [0, math.inf]}, "rows.0.limits", r"\[lower, upper\], two finite numbers"),
    ({"limits": [1]}, "rows.0.limits", r"\[lower, upper\], two finite numbers"),
    ({"limits": "free"}, "rows.0.limits", r"\[lower, upper\], two finite numbers"),
    ({"limits": [0, 1e300]}, "rows.0.limits", r"must lie within ±1e\+06"),
    ({"d": 1e300}, "rows.0.d", "must be at most 1000000"),
    ({"a": math.nan}, "rows.0.a", "must be a finite number"),
    ({"a": "0.3"}, "rows.0.a", 'must be a number, not "0.3"'),
    ({"d": True}, "rows.0.d", "must be a number, not true"),
    ({"alpha_deg": "90"}, "rows.0.alpha_deg", "must be a number"),
    ({"alpha_deg": math.inf}, "rows.0.alpha_deg", "must be a finite number"),
    ({"mass": -1}, "rows.0.mass", "must be at least 0"),
    ({"inertia": [1, 1, 1]}, "rows.0.mass", 'together with "inertia"'),
    ({"mass": 1, "inertia": [1, 1]}, "rows.0.inertia", "list of 3 or 6 finite numbers"),
    ({"mass": 1, "inertia": [1, 1, 1, 0]}, "rows.0.inertia", "list of 3 or 6 finite numbers"),
    ({"mass": 1, "inertia": [1, 1, -1]}, "rows.0.inertia", "negative principal moment, here -1 kg m²"),
    ({"mass": 1, "inertia": [1, 1, 1, 2, 0, 0]}, "rows.0.inertia", "negative principal moment, here -1"),
    ({"mass": 1, "center_of_mass": [0, 0]}, "rows.0.center_of_mass", "list of 3 finite numbers"),
    ({"armature": -0.1}, "rows.0.armature", "must be at least 0"),
    ({"effort_limit": 0}, "rows.0.effort_limit", "must be greater than 0"),
    ({"name": ""}, "rows.0.name", "must not be empty"),
    ({"name": "a\x00b"}, "rows.0.name", "printable characters"),
    ({"length": 0.3}, "rows.0.length", "is not a known field"),
    (0.3, "rows.0", "must be an object"),
]


@pytest.mark.parametrize(("row", "field", "message"), BAD_ROWS)
def test_a_bad_row_is_refused_by_name(row, field, message):
    with pytest.raises(DocumentError, match=message) as refusal:
        table(row)
    assert [name for name, _ in refusal.value.problems] == [field]


@pytest.mark.parametrize(
    ("fields", "field", "message"),
    [
        ({"rows": []}, "rows", "at least one row"),
        ({"rows": "scara"}, "rows", "must be a list"),
        ({"convention": "craig"}, "convention", 'must be "modified" or "standard"'),
        ({"rows": [{"name": "a"}, {"name": "a"}]}, "rows", 'two joints the name "a"'),
        ({"rows": [{"name": "joint2"}, {}]}, "rows", 'two joints the name "joint2"'),
        ({"name": "a\nb"}, "name", "printable characters"),
        ({"units": "mm"}, "units", "is not a known field"),
    ],
)
def test_a_bad_table_is_refused_by_name(fields, field, message):
    with pytest.raises(DocumentError, match=message) as refusal:
        table(ROW, **fields)
    assert refusal.value.field == field


def test_the_convention_is_never_guessed():
    with pytest.raises(DocumentError, match="convention: is required"):
        DHTable(rows=[ROW])  # pyright: ignore[reportCallIssue]


# --- transforms -----------------------------------------------------------------------------------------


def test_angles_turn_as_the_conventions_say():
    angles = [17.0, -34.0, 123.0]
    rpy = Transform(rpy_deg=angles).matrix()[:3, :3]
    euler = Transform(euler_xyz_deg=angles).matrix()[:3, :3]
    np.testing.assert_allclose(rpy, Rotation.from_euler("xyz", angles, degrees=True).as_matrix(), atol=1e-15)
    np.testing.assert_allclose(euler, Rotation.from_euler("XYZ", angles, degrees=True).as_matrix(), atol=1e-15)


def test_a_quaternion_has_its_scalar_first_and_any_length():
    w, x, y, z = 0.4, -1.0, 2.5, 0.3
    expected = Rotation.from_quat([x, y, z, w]).as_matrix()
    np.testing.assert_allclose(Transform(quat_wxyz=[w, x, y, z]).matrix()[:3, :3], expected, atol=1e-15)


def test_quarter_turns_are_exact():
    T = Transform(position_m=[1, 2, 3], rpy_deg=[0, 0, 180]).matrix()
    assert T.tolist() == [[-1, 0, 0, 1], [0, -1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]
    assert Transform(euler_xyz_deg=[90, 0, -270]).matrix()[:3, :3].tolist() == [
        [0, -1, 0],
        [0, 0, -1],
        [1, 0, 0],
    ]


def test_no_transform_is_the_identity():
    assert Transform().matrix().tolist() == np.eye(4).tolist()


@pytest.mark.parametrize(
    ("fields", "field", "message"),
    [
        ({"quat_wxyz": [0, 0, 0, 0]}, "quat_wxyz", "must not have length 0"),
        ({"quat_wxyz": [1, 0, 0]}, "quat_wxyz", "list of 4 finite numbers"),
        ({"quat_wxyz": [1, 0, 0, math.nan]}, "quat_wxyz", "list of 4 finite numbers"),
        ({"rpy_deg": [0, 0, 0], "euler_xyz_deg": [0, 0, 0]}, "euler_xyz_deg", 'together with "rpy_deg"'),
        ({"quat_wxyz": [1, 0, 0, 0], "rpy_deg": [0, 0, 0]}, "rpy_deg", 'together with "quat_wxyz"'),
        ({"position_m": [1, 2]}, "position_m", "list of 3 finite numbers"),
        ({"position_m": "origin"}, "position_m", "list of 3 finite numbers"),
        ({"rpy": [0, 0, 0]}, "rpy", "did you mean rpy_deg"),
    ],
)
def test_a_bad_transform_is_refused_by_name(fields, field, message):
    with pytest.raises(DocumentError, match=message) as refusal:
        Transform(**fields)
    assert refusal.value.field == field


# --- sources of a robot ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("source", "value"),
    [
        ("library", "ur5e"),
        ("dh", {"convention": "standard", "rows": [ROW]}),
        ("mjcf", "<mujoco/>"),
        ("urdf", "<robot/>"),
        ("model", "0123456789abcdef" * 4),
        ("path", "arm.urdf"),
    ],
)
def test_each_source_is_told_apart(source, value):
    robot = RobotSpec(**{source: value}, placement={"position_m": [0, 0, 1]})
    assert robot.source == source
    assert robot.placement is not None and robot.placement.matrix()[2, 3] == 1.0
    assert RobotSpec(**json.loads(robot.model_dump_json())) == robot
    assert not {"srdf", "exclude", "reference", "link_radius"} & {
        *robot.model_dump(),
        *(robot.model_dump()["dh"] or {}),
    }


def test_what_a_robot_says_of_its_bodies_survives_json():
    dh = {"convention": "standard", "rows": [ROW], "link_radius": 0.05}
    robot = RobotSpec(dh=dh, srdf="<robot/>", reference={"j": 1}, exclude=(("link1", "base"), ["link1", "link3"]))
    assert RobotSpec(**json.loads(robot.model_dump_json())) == robot
    assert robot.model_dump(mode="json")["exclude"] == [["link1", "base"], ["link1", "link3"]]


def test_a_tip_carries_a_hundred_shapes_at_most():
    sphere = {"shape": "sphere", "radius_m": 1}
    assert len(RobotSpec(library="scara", tool_shapes=[sphere] * 100).tool_shapes) == 100
    with pytest.raises(DocumentError, match="must have at most 100 items"):
        RobotSpec(library="scara", tool_shapes=[sphere] * 101)
    for read in (lambda pairs: RobotSpec(library="scara", exclude=pairs), lambda pairs: Apart(exclude=pairs)):
        assert len(read([("a", "b")] * 10_000).exclude) == 10_000
        with pytest.raises(DocumentError, match="must have at most 10000 items"):
            read([("a", "b")] * 10_001)


@pytest.mark.parametrize(
    ("fields", "field", "message"),
    [
        ({}, "library", 'is required, or another source of the robot: one of "library", "dh"'),
        ({"placement": {}}, "library", "is required, or another source"),
        ({"library": "ur5e", "urdf": "<robot/>"}, "urdf", 'together with "library": a robot has one source'),
        ({"library": ""}, "library", "must not be empty"),
        ({"library": 5}, "library", "must be a string, not 5"),
        ({"mjcf": ""}, "mjcf", "must not be empty"),
        ({"model": "abc"}, "model", "must match"),
        ({"model": "G" * 64}, "model", "must match"),
        ({"dh": {"rows": [ROW]}}, "dh.convention", "is required"),
        ({"dh": {"convention": "modified", "rows": [{"d": "x"}]}}, "dh.rows.0.d", "must be a number"),
        ({"library": "ur5e", "tool": {"position_m": [0, 0]}}, "tool.position_m", "list of 3 finite numbers"),
        ({"name": "ur5e"}, "name", "is not a known field"),
        ({"library": "ur5e", "srdf": ""}, "srdf", "must not be empty"),
        ({"library": "ur5e", "exclude": [["a", "b"], ["a"]]}, "exclude.1", "must be a pair of names"),
        ({"library": "ur5e", "exclude": [["a", 5]]}, "exclude.0.1", "must be a string, not 5"),
        ({"library": "ur5e", "reference": {"j": "x"}}, "reference.j", "must be a number"),
        ({"library": "ur5e", "exclude": "ab"}, "exclude", "must be a list"),
        ({"dh": {"convention": "modified", "rows": [ROW], "link_radius": 0}}, "dh.link_radius", "greater than 0"),
    ],
)
def test_a_bad_robot_is_refused_by_name(fields, field, message):
    with pytest.raises(DocumentError, match=message) as refusal:
        RobotSpec(**fields)
    assert refusal.value.field == field
