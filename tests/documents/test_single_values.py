"""A single point, quaternion or name stands where a list of them does, and means the list of it."""

import numpy as np
import pytest

import wsrender as ws
from wsrender.analyses.jobs import parse_job

POINT, QUATERNION = [0.2, 0.1, 0.15], [1, 0, 0, 0]
FIELDS = {
    "reachability": {"points_m": POINT, "quats_wxyz": QUATERNION},
    "postures": {"position_m": POINT, "quat_wxyz": QUATERNION},
    "planar_boundary": {"points_m": [0.2, 0.1]},
    "indices_at": {"configurations": [0.2, 0.1]},
    "workspace": {"indices": "manipulability"},
}


def parsed(analysis, **fields):
    robot = {"dh": {"convention": "standard", "rows": [{"a": 0.3, "limits": [-1, 1]}, {"a": 0.2, "limits": [-1, 1]}]}}
    return parse_job({"analysis": analysis, "robot": robot, **fields})


@pytest.mark.parametrize("analysis", FIELDS)
def test_one_means_a_list_of_one(analysis):
    fields = FIELDS[analysis]
    one, listed = parsed(analysis, **fields), parsed(analysis, **{name: [value] for name, value in fields.items()})
    assert one == listed and one.model_dump_json() == listed.model_dump_json()
    for name, value in fields.items():
        assert getattr(one, name) == ((value,) if isinstance(value, str) else (tuple(value),))


@pytest.mark.parametrize(("analysis", "fields"), [(name, FIELDS[name]) for name in ("reachability", "postures")])
@pytest.mark.parametrize("given", [QUATERNION, [QUATERNION], np.array(QUATERNION)], ids=["one", "listed", "array"])
def test_one_quaternion_is_that_of_all_positions(analysis, fields, given):
    position, quat = fields
    one, each = (
        parsed(analysis, **{position: [POINT] * 3, quat: given}),
        {position: [POINT] * 3, quat: [QUATERNION] * 3},
    )
    assert one == parsed(analysis, **each) and len(getattr(one, quat)) == 3


def test_one_quaternion_of_jobs_of_bases():
    over = {"x_m": [0, 1, 0.5]}
    asked = {"analysis": "base_placement", "robot": {"library": "ur5e"}, "points_m": [POINT] * 2, "over": over}
    assert parse_job({**asked, "quats_wxyz": QUATERNION}) == parse_job({**asked, "quats_wxyz": [QUATERNION] * 2})
    arms = {name: {"robot": {"library": "ur5e"}, "over": {}} for name in ("first", "second")}
    asked = {"analysis": "two_arm_placement", "points_m": [POINT] * 2, **arms}
    assert parse_job({**asked, "quats_wxyz": QUATERNION}) == parse_job({**asked, "quats_wxyz": [QUATERNION] * 2})


def test_arrays_too():
    points = np.array(POINT)
    assert parsed("reachability", points_m=points) == parsed("reachability", points_m=points[None])


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ([0.1, 0.2], "must hold rows of 3 numbers; row 0 has 2"),
        ([0.1, [0.1, 0.2, 0.3]], "must be a number"),
        ([[0.1, 0.2, 0.3], 0.1], "must be a list"),
        (0.1, "must be a list"),
        ([], "must have at least 1 items"),
        (["0.1", "0.2", "0.3"], "must"),
    ],
)
def test_what_is_neither_is_refused(value, message):
    with pytest.raises(ws.DocumentError, match=f"points_m: {message}"):
        parsed("reachability", points_m=value)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ([0.1, [0.1, 0.2]], "must be a number"),
        ([[0.1, 0.2], 0.1], "must be a list"),
        (["0.1", "0.2"], "must be a list"),
        ([], "must have at least 1 items"),
        ([[]], "must hold rows of one length"),
    ],
)
def test_what_is_no_configuration_is_refused(value, message):
    with pytest.raises(ws.DocumentError, match=f"configurations: {message}"):
        parsed("indices_at", configurations=value)


def test_a_name_that_is_none():
    with pytest.raises(ws.DocumentError, match='the name of an index, or a list of such names, not ""'):
        parsed("workspace", indices="")
    with pytest.raises(ws.InputError, match="manip"):
        ws.analyze("scara", indices="manip", sampling=ws.Sobol(10))


def test_python_takes_one_too():
    found = ws.reachability("scara", POINT)
    assert found.document == ws.reachability("scara", [POINT]).document | {
        name: found.document[name] for name in ("timing_s", "provenance")
    }


def test_one_point_of_a_plane_a_set_and_an_offset():
    bar = {"analysis": "five_bar", "base_m": 1, "proximal_m": 1, "distal_m": 1}
    for name in ("points_m", "joint_angles_rad"):
        assert parse_job(bar | {name: [0.5, 0.9]}) == parse_job(bar | {name: [[0.5, 0.9]]})
    mapped = {"analysis": "master_slave_mapping", "master": {"robot": "scara"}}
    one = parse_job(mapped | {"slave": {"points": POINT}, "offsets_m": POINT})
    assert one == parse_job(mapped | {"slave": {"points": [POINT]}, "offsets_m": [POINT]})
    for wrong in ({"points_m": [0.5]}, {"points_m": [[0.5, 0.9, 1]]}, {"joint_angles_rad": 3}):
        with pytest.raises(ws.DocumentError, match=next(iter(wrong))):
            parse_job(bar | wrong)
    for wrong in ({"slave": {"points": [1, 2]}}, {"slave": {"points": POINT}, "offsets_m": [1, 2]}):
        with pytest.raises(ws.DocumentError, match=r"points|offsets_m"):
            parse_job(mapped | wrong)
