"""What jobs ask of a robot's shapes: refusals, margins, excludes and surroundings, in documents and results."""

from contextlib import nullcontext

import numpy as np
import pytest
import trimesh

import wsrender as ws
from tests.collision.robots import drawn, nearest
from tests.reference.class_robots import SphericalClass
from wsrender.collision.solids import BASE
from wsrender.documents.constraints import Constraints
from wsrender.errors import InputError, ResourceError
from wsrender.robot import as_robot, collisions
from wsrender.robot.constraints import constraints_for
from wsrender.robots.model_warning import ModelWarning

ARM = """<mujoco><compiler angle="radian" autolimits="true"/><worldbody>{world}<body name="base">{base}
<body name="one"><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/><joint name="a" axis="0 0 1" range="-3 3"/>{one}
<body name="two" pos="0.5 0 0"><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
<joint name="b" axis="0 1 0" range="-1 1"/><geom name="hand" type="sphere" size="0.05" pos="0.4 0 0"/>
<site name="tip" pos="0.5 0 0"/></body></body></body></worldbody></mujoco>"""


def arm(world="", base='<geom name="foot" type="sphere" size="0.1"/>', one=""):
    return ws.load_robot(ARM.format(world=world, base=base, one=one))


def refused(robot, field, message, **choice):
    with pytest.raises(InputError, match=message) as caught:
        constraints_for(robot, Constraints(**choice))
    assert caught.value.field == field


def test_robots_without_shapes_are_refused():
    rows = [{"a": 0.3, "limits": [-1, 1]}] * 2
    robot = ws.load_robot(ws.DHTable(convention="standard", rows=rows))
    refused(robot, "constraints.self_collision", "has no shapes that may collide", self_collision=True)
    floor = ws.Environment([ws.HalfSpace()])
    with pytest.raises(InputError, match="has no shapes") as caught:
        constraints_for(robot, None, floor)
    assert caught.value.field == "constraints.environment"


def test_pairs_that_always_collide_are_refused_by_name():
    robot = arm(
        one='<geom name="collar" type="sphere" size="0.1"/>', base='<geom name="foot" type="sphere" size="0.1"/>'
    )
    message = r"foot and collar collide in every configuration; .*exclude = \[\['foot', 'collar'\]\]"
    refused(robot, "constraints.self_collision", message, self_collision=True)
    choice = {"self_collision": {"exclude": [["foot", "collar"]]}}
    (constraint,) = constraints_for(robot, Constraints(**choice))
    assert len(constraint.pairs) < len(robot.bodies.pairs)


def test_surroundings_that_swallow_the_robot_are_refused():
    cube = ws.Environment([ws.Box(name="cube", size_m=(4, 4, 4))])
    with pytest.raises(InputError, match="cube and hand collide in every configuration") as caught:
        constraints_for(arm(), None, cube)
    assert caught.value.field == "constraints.environment"


@pytest.mark.parametrize(
    ("choice", "field", "message"),
    [
        ({"self_collision": {"margin_m": 5}}, "constraints.self_collision.margin_m", "at most the robot's size"),
        (
            {"self_collision": {"exclude": [["foot", "hond"]]}},
            "constraints.self_collision.exclude.0",
            "did you mean 'hand'",
        ),
        ({"environment": True}, "constraints.environment", "nothing stands around"),
    ],
)
def test_choices_that_are_refused(choice, field, message):
    refused(arm(), field, message, **choice)


@pytest.mark.parametrize(
    "item", [ws.Sphere(name="sun", radius_m=1e300), ws.Box(size_m=(1, 1, 1), position_m=(2e9, 0, 0))]
)
def test_numbers_that_single_precision_cannot_square_are_refused(item):
    with pytest.raises(InputError, match=r"has a shape '(sun|box 1)' of a place or size beyond 1e\+09 m") as caught:
        constraints_for(arm(), None, ws.Environment([item]))
    assert caught.value.field == "environment"


def test_an_environment_without_items_is_refused():
    with pytest.raises(InputError, match="must not be empty") as caught:
        constraints_for(arm(), None, ws.Environment([]))
    assert caught.value.field == "environment.items"


def test_results_warn_of_shapes_that_are_odd(tmp_path):
    trimesh.creation.box((300, 80, 80)).export(tmp_path / "beam.stl")
    joint = '<joint name="{0}" type="revolute"><parent link="{0}"/><child link="{1}"/><axis xyz="0 0 1"/>{2}</joint>'
    limit = '<origin xyz="0.3 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/>'
    beam = '<link name="beam"><collision><geometry><mesh filename="beam.stl"/></geometry></collision></link>'
    joints = joint.format("foot", "beam", limit) + joint.format("beam", "hand", limit)
    (tmp_path / "arm.urdf").write_text(
        f'<robot name="arm"><link name="foot"/>{beam}<link name="hand"/>{joints}</robot>'
    )
    document = {"analysis": "workspace", "robot": {"path": str(tmp_path / "arm.urdf")}, "refined_volume": None}
    document |= {"sampling": {"method": "sobol", "count": 64}}
    found = []
    for constraints in (None, {"self_collision": True}):
        with pytest.warns(ModelWarning) if constraints else nullcontext():
            result = ws.execute(document | {"constraints": constraints})
        found.append({(each["code"], each["field"]) for each in result.document["warnings"]})
    assert found[1] - found[0] == {("units_mesh", None), ("no_pairs", "constraints.self_collision")}


def test_too_many_pairs_are_refused_before_any_table_is_made(monkeypatch):
    monkeypatch.setattr(collisions, "MOST_PAIRS", 20)
    monkeypatch.setattr(collisions, "stored_program", None)
    with pytest.raises(ResourceError, match="would keep 21 pairs of shapes apart, more than 20") as caught:
        constraints_for(ws.load_robot("ur5e"), Constraints(self_collision=True))
    assert caught.value.field == "constraints.self_collision"


def test_far_too_many_pairs_are_refused_before_they_are_listed(monkeypatch):
    around = ws.Environment([ws.Sphere(radius_m=0.01, position_m=(9, 0, k)) for k in range(30)])
    robot = ws.load_robot("ur5e")
    moving = sum(shape.frame >= 0 for shape in robot.bodies.shapes)
    monkeypatch.setattr(collisions, "MOST_LISTED", 30 * moving)
    assert len(constraints_for(robot, None, around)[0].pairs) == 30 * moving
    monkeypatch.setattr(collisions, "MOST_LISTED", 30 * moving - 1)
    monkeypatch.setattr(collisions, "_pairs", None)
    with pytest.raises(ResourceError, match=f"would look at {30 * moving} pairs of shapes") as caught:
        constraints_for(robot, None, around)
    assert caught.value.field == "constraints.environment"


def test_python_robots_are_refused():
    refused(as_robot(SphericalClass()), "constraints.self_collision", "defined by a class", self_collision=True)


def test_what_stands_in_the_robots_own_file_is_around():
    robot = arm(world='<geom name="wall" type="box" size="0.1 1 1" pos="0.9 0 0"/>')
    (constraint,) = constraints_for(robot, Constraints(environment=True))
    assert sorted(solid.name for solid in constraint.solids) == ["foot", "hand", "wall"]
    assert {constraint.solids[k].name for k in constraint.pairs.ravel()} == {"hand", "wall"}


def test_a_margin_moves_the_boundary_by_itself():
    robot, floor = arm(), ws.Environment([ws.HalfSpace(name="floor", point_m=(0, 0, -0.2))])
    q = drawn(robot, 4000)
    (plain,) = constraints_for(robot, None, floor)
    (wide,) = constraints_for(robot, Constraints(environment={"margin_m": 0.03}), floor)
    distance = nearest(plain, q)
    assert np.array_equal(plain.host(q, None), distance < 0)
    assert np.array_equal(wide.host(q, None), distance < 0.03)
    assert 0 < plain.host(q, None).sum() < wide.host(q, None).sum()


def test_a_planar_link_over_a_floor_admits_what_the_closed_form_does():
    """The hand's ball of .05 m on .4 m past the second joint is free above -.2 m where .4 sin b <= .15."""
    floor = {"items": [{"shape": "half_space", "name": "floor", "point_m": [0, 0, -0.2]}]}
    document = {
        "analysis": "indices_at",
        "robot": {"mjcf": ARM.format(world="", base="", one="")},
        "environment": floor,
    }
    b = np.linspace(-1, 1, 401)
    document |= {"configurations": np.column_stack([np.zeros(401), b]).tolist(), "task": ["x", "y"]}
    result = ws.execute(document)
    expected = np.where(0.4 * np.sin(b) <= 0.15, "", "environment")
    clear = np.abs(0.4 * np.sin(b) - 0.15) > 1e-6
    assert np.array_equal(np.array(result.tables["admission"]["reason"])[clear], expected[clear])
    assert result.document["samples"]["rejected"] == {"environment": int((expected == "environment").sum())}


def test_an_environment_that_is_only_drawn_rejects_nothing():
    robot, q = ws.load_robot("ur5e"), np.zeros((1, 6))
    tip = robot.forward_kinematics(q)[0, :3, 3].tolist()
    ball = {"items": [{"shape": "sphere", "name": "ball", "radius_m": 0.1, "position_m": tip}]}
    document = {
        "analysis": "indices_at",
        "robot": {"library": "ur5e"},
        "environment": ball,
        "configurations": q.tolist(),
    }
    assert "samples" not in ws.execute(document | {"constraints": {"environment": False}}).document
    assert ws.execute(document).document["samples"]["rejected"] == {"environment": 1}


def test_every_pair_is_kept_apart_but_those_that_are_excluded():
    robot = ws.load_robot("ur5e")
    floor = ws.Environment([ws.HalfSpace(name="floor", point_m=(0, 0, -0.05)), ws.Sphere(name="ball", radius_m=0.1)])
    names = [shape.name for shape in robot.bodies.shapes]

    def kept(constraint):
        return {frozenset(constraint.solids[k].name for k in pair) for pair in constraint.pairs}

    own = {frozenset(names[k] for k in pair) for pair in robot.bodies.pairs}
    moved = {shape.name for shape in robot.bodies.shapes if shape.frame != BASE}
    around = {frozenset((name, item)) for name in moved for item in ("floor", "ball")}
    excluded = [sorted(pair) for pair in sorted(own, key=sorted)[:2]]
    near = [[sorted(moved)[0], "ball"], [sorted(moved)[1], "ball"]]
    choice = Constraints(self_collision={"exclude": excluded}, environment={"exclude": near})
    environment, self_collision = constraints_for(robot, choice, floor)
    assert kept(self_collision) == own - set(map(frozenset, excluded))
    assert kept(environment) == around - set(map(frozenset, near))
    (whole,) = constraints_for(robot, Constraints(self_collision=True))
    assert kept(whole) == own and len(whole.pairs) == len(own)
