"""Jobs of robots whose joints have no usable limits, or whose lengths were probably millimetres."""

import json
import warnings
from typing import Any

import numpy as np
import pytest

import wsrender as ws
from wsrender.analyses.jobs import parse_job
from wsrender.analyses.registry import job_classes
from wsrender.errors import InputError, ResourceError
from wsrender.run import steps

LINK = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'


def arm(length=0.4, rail=""):
    """A slide "rail" and two hinges, with links of a length."""
    return f"""<mujoco model="r"><compiler angle="radian"/><worldbody>
      <body><joint name="rail" type="slide" {rail}/>{LINK}<body><joint name="a" axis="0 0 1" range="-2 2"/>{LINK}
      <body pos="{length} 0 0"><joint name="b" axis="0 0 1" range="0 2"/>{LINK}<site name="tool" pos="{length} 0 0"/>
      </body></body></body></worldbody></mujoco>"""


ENDLESS, LONG = arm(), arm(400.0, 'range="-1 1"')
GIVEN = {"limits": {"rail": [-0.5, 0.5]}}
GRID = {"method": "grid", "per_joint": 3}


def workspace(model, sampling=GRID, **robot):
    return {"analysis": "workspace", "robot": {"mjcf": model, **robot}, "sampling": sampling, "device": "cpu"}


def every_analysis(model, **robot):
    """A document of every analysis that takes arms, with that of its last one."""
    spec = {"mjcf": model, **robot}
    one, library = {"robot": spec}, {"robot": {"library": "scara"}}
    leg = {"type": "serial", **one, "attachment": {"position_m": [0.1, 0, 0]}}
    pus = {"type": "UPS", "base_m": [1, 0, 0], "platform_m": [0.2, 0, 0], "length_m": [0.5, 1]}
    return {
        "workspace": one,
        "indices_at": {**one, "configurations": [[0, 0, 0]]},
        "reachability": {**one, "points_m": [[0.1, 0, 0]]},
        "postures": {**one, "position_m": [[0.1, 0, 0]]},
        "base_placement": {**one, "points_m": [[0.1, 0, 0]], "over": {"x_m": [0, 1, 0.5]}},
        "inverse_reachability": {**one, "target": {"position_m": [0.1, 0, 0]}, "over": {"x_m": [0, 1, 0.5]}},
        "two_arm_placement": {
            "first": {**library, "over": {}},
            "second": {**one, "over": {}},
            "points_m": [[0.1, 0, 0]],
        },
        "capability": {**one, "voxel_size_m": 0.2},
        "shared_workspace": {"robots": [library, one], "voxel_size_m": 0.1},
        "robot_comparison": {"robots": [library, one]},
        "collaborative_volume": {"left": library, "right": one},
        "master_slave_mapping": {"master": library, "slave": one},
        "kinetostatic_field": one,
        "parallel_workspace": {"mechanism": {"legs": [pus, pus, leg]}, "voxel_size_m": 0.1},
        "design_optimization": {
            "design": {"analysis": "workspace", **one, "voxel_size_m": 0.1},
            "parameters": [{"name": "x", "pointers": ["/voxel_size_m"], "bounds": [0.1, 0.2]}],
            "objectives": [{"value": "/volume_m3/occupied"}],
        },
        "planar_boundary": one,
        "boundary_patches": one,
    }


PATHS = {
    "shared_workspace": "robots.1.", "robot_comparison": "robots.1.", "collaborative_volume": "right.",
    "two_arm_placement": "second.",
    "master_slave_mapping": "slave.", "parallel_workspace": "mechanism.legs.2.", "design_optimization": "design.",
}  # fmt: skip
TAKE_ARMS = [name for name in job_classes() if name not in ("five_bar", "method_comparison")]


plan: Any = steps.plan  # what it returns has more than a Plan


def quietly(act, *arguments, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ws.robots.ModelWarning)
        return act(*arguments, **options)


def refused(document, error):
    with pytest.raises(error) as caught:
        quietly(plan, document)
    return caught.value


@pytest.mark.parametrize("analysis", TAKE_ARMS)
def test_every_analysis_asks_for_ranges(analysis):
    document = {"analysis": analysis, **every_analysis(ENDLESS)[analysis]}
    if analysis == "indices_at":
        document["joint_limit_penalty"] = True  # it needs none otherwise
    error = refused(document, InputError)
    assert error.field == f"{PATHS.get(analysis, '')}robot.limits"
    assert error.message.startswith('must give the range of rail, such as {"rail": [lower, upper]}: the model of r has')
    assert error.message.endswith("or hold the joint (locked), or name a base beyond it")


@pytest.mark.parametrize("analysis", TAKE_ARMS)
def test_every_analysis_refuses_lengths_beyond_any_arm(analysis):
    error = refused({"analysis": analysis, **every_analysis(LONG)[analysis]}, ResourceError)
    assert error.field == f"{PATHS.get(analysis, '')}robot.length_unit_m"
    assert "the reach of 'r' is 800 m (the link before joint 'b' alone 400 m)" in error.message
    assert "0.001 converts millimetres, 1 confirms metres" in error.message


def test_the_refusal_says_what_the_job_would_take():
    message = refused(workspace(LONG) | {"voxel_size_m": 0.1}, ResourceError).message
    # The box of a slide along z, and of two hinges about it, ±2 and 0 … 2 rad.
    edges = np.array([float(word) for word in message.split("would span ")[1].split(" m,")[0].split(" × ")])
    assert (edges[0] <= 1600).all() and edges[2] == 2
    voxels = float(message.split(" voxels of 0.1 m")[0].rpartition(" m, ")[2])
    assert voxels == pytest.approx(edges.prod() / 0.1**3, rel=0.1)
    assert f"{voxels * 8 / 2**30:.2g} GiB at least" in message


@pytest.mark.parametrize("unit", [1, 0.001])
def test_a_confirmed_length_is_planned(unit):
    planned = plan(workspace(LONG, length_unit_m=unit))
    assert planned.notices == ()
    assert planned.robot.chain.reach == pytest.approx(800 * unit + (1 if unit == 1 else 0.001))


def test_a_range_given_or_a_joint_locked_is_enough():
    given = plan(workspace(ENDLESS, **GIVEN))
    assert (given.robot.lower_limits[0], given.robot.upper_limits[0], given.notices) == (-0.5, 0.5, ())
    in_degrees = plan(workspace(ENDLESS, **GIVEN, limits_deg={"a": [-45, 90]})).robot
    np.testing.assert_allclose([in_degrees.lower_limits[1], in_degrees.upper_limits[1]], np.radians([-45, 90]))
    locked = ws.execute(workspace(ENDLESS, GRID | {"locked": {"rail": 0.25}}))  # no warning: the job needs no range
    assert locked.document["robot"]["lower_limits"][0] == locked.document["robot"]["upper_limits"][0] == 0.25
    assert [entry["code"] for entry in locked.document["warnings"] if entry["code"] == "no_usable_limits"] == []
    held = plan(workspace(arm(rail='range="0 1"'), GRID | {"locked": {"rail": 0.25}}))
    assert locked.volume.count.sum() == 9
    assert held.robot.upper_limits[0] == 1


def test_of_joints_without_limits_only_those_are_warned_of_that_the_job_does_not_hold():
    two = arm().replace('name="a" axis="0 0 1" range="-2 2"', 'name="a" type="slide" axis="1 0 0"')
    with pytest.warns(ws.robots.ModelWarning, match="joint a has no usable limits"), pytest.raises(InputError):
        plan(workspace(two, GRID | {"locked": {"rail": 0.25}}))


@pytest.mark.parametrize(
    ("robot", "fields", "at"),
    [
        ({"library": "nobody"}, {}, "robot.library"),
        ({"path": "/nowhere/arm.urdf"}, {}, "robot.path"),
        ({"mjcf": "<mujoco>"}, {}, "robot.mjcf"),
        ({"library": "scara", "limits": {"what": [0, 1]}}, {}, "robot.limits.what"),
        ({"library": "scara"}, {"tip": "what"}, "tip"),
    ],
    ids=["library", "path", "mjcf", "limits", "tip"],
)
def test_refusals_of_models_name_where_in_the_document_they_are(robot, fields, at):
    arms = {"robot": robot, **fields}
    leg = {"type": "serial", **arms, "attachment": {"position_m": [0.1, 0, 0]}}
    pus = {"type": "UPS", "base_m": [1, 0, 0], "platform_m": [0.2, 0, 0], "length_m": [0.5, 1]}
    for document, path in (
        ({"analysis": "workspace", **arms}, ""),
        ({"analysis": "robot_comparison", "robots": [{"robot": "scara"}, arms]}, "robots.1."),
        ({"analysis": "parallel_workspace", "mechanism": {"legs": [pus, pus, leg]}}, "mechanism.legs.2."),
    ):
        with pytest.raises(InputError) as found:
            plan(document)
        assert found.value.field == path + at and str(found.value).startswith(f"{path}{at}: ")


def test_configurations_that_are_given_need_no_ranges():
    rows = [[3.0, 0.1, 0.2], [-40.0, -0.7, 1.0]]
    document = {"analysis": "indices_at", "robot": {"mjcf": ENDLESS}, "configurations": rows, "indices": "all"}
    found = quietly(ws.execute, document | {"task": "full", "device": "cpu"})
    assert json.loads(json.dumps(found.document, allow_nan=False))["robot"]["lower_limits"] == [None, -2, 0]
    told = [entry for entry in found.document["warnings"] if entry["code"] == "no_usable_limits"]
    assert [entry["field"] for entry in told] == ["robot.limits"]
    reference = ws.execute(
        document | {"robot": {"mjcf": ENDLESS, "limits": {"rail": [-50, 50]}}, "task": "full", "device": "cpu"}
    )
    for name, values in reference.tables.items():
        np.testing.assert_array_equal(found.tables[name], values)


def test_notices_of_several_robots_name_their_own():
    turning = LONG.replace('range="-2 2"', 'range="-90 90"')
    robots = [{"robot": "scara"}, {"robot": {"mjcf": turning, "length_unit_m": 1}}]
    document = {"analysis": "robot_comparison", "robots": robots}
    assert [notice.field for notice in quietly(plan, document).notices] == ["robots.1.robot.limits_deg"]


def test_what_a_robot_was_loaded_with_stands_in_its_jobs():
    robot = ws.load_robot(ENDLESS, limits={"rail": (-0.5, 0.5)}, limits_deg={"a": (-45, 45)}, length_unit_m=1)
    result = ws.analyze(robot, ws.Grid(3), device="cpu", indices=["manipulability"])
    again = parse_job(result.document["job"]).robot
    assert (again.limits, again.limits_deg, again.length_unit_m) == ({"rail": (-0.5, 0.5)}, {"a": (-45, 45)}, 1)
    assert plan(result.document["job"]).robot.chain.content_hash == robot.chain.content_hash


@pytest.mark.parametrize("act", [ws.force_field, ws.exact_boundary])
def test_functions_beside_jobs_ask_for_ranges_too(act):
    with pytest.raises(InputError, match=r"robot\.limits: must give the range of rail"):
        quietly(act, quietly(ws.load_robot, ENDLESS))


@pytest.mark.parametrize(
    ("robot", "field"),
    [
        ({"limits": {"rail": [1, 0]}}, "robot.limits.rail"),
        ({"limits": {"rail": None}}, "robot.limits.rail"),
        ({"limits": {"rail": [0, 1], "c": [0, 1]}}, "robot.limits.c"),
        ({"limits": {"a": [0, 1]}, "limits_deg": {"a": [0, 1]}}, "robot.limits_deg.a"),
        ({"limits_deg": {"rail": [0, 1]}}, "robot.limits_deg.rail"),
        ({"length_unit_m": 0}, "robot.length_unit_m"),
    ],
)
def test_wrong_corrections(robot, field):
    assert refused(workspace(ENDLESS, **robot), InputError).field == field
