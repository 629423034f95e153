"""Shapes that a tip carries, against MuJoCo on the model with a body of them fixed to the tip's."""

import mujoco
import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull

import wsrender as ws
from tests.collision.robots import collides, drawn, random_text
from tests.collision.test_labels import AROUND, labels, nearest, wrong
from tests.world.test_convex_pieces import SOLIDS, mesh_of
from wsrender.documents.constraints import Constraints
from wsrender.errors import InputError
from wsrender.robot.constraints import constraints_for

CORNERS = [(0, 0, 0), (0.2, 0, 0), (0, 0.25, 0), (0, 0, 0.2)]
TOOL = [
    ws.Box(name="hand", size_m=(0.1, 0.2, 0.06), position_m=(0, 0.02, 0.05), rpy_deg=(10, 20, 30)),
    ws.Capsule(name="finger", radius_m=0.03, length_m=0.2, position_m=(0.1, 0, 0.1), quat_wxyz=(0.8, 0, 0.6, 0)),
    ws.Cylinder(radius_m=0.07, length_m=0.1, position_m=(0, -0.1, 0.1)),
    ws.Sphere(name="payload", radius_m=0.09, position_m=(0.05, 0, 0.25)),
    ws.Mesh(name="wedge", vertices_m=CORNERS, position_m=(0.05, 0.05, 0)),
    ws.Ellipsoid(name="drop", size_m=(0.1, 0.2, 0.3), position_m=(-0.15, 0, 0)),
]
BODY = """<body name="tool" pos="0 0 .1"><geom type="box" size=".05 .1 .03" pos="0 .02 .05" quat="{box}"/>
<geom type="capsule" size=".03 .1" pos=".1 0 .1" quat=".8 0 .6 0"/><geom type="cylinder" size=".07 .05" pos="0 -.1 .1"/>
<geom size=".09" pos=".05 0 .25"/><geom type="mesh" mesh="wedge" pos=".05 .05 0"/>
<geom type="ellipsoid" size=".05 .1 .15" pos="-.15 0 0"/></body><site name="tip\""""
WEDGE = '<asset><mesh name="wedge" vertex="0 0 0 .2 0 0 0 .25 0 0 0 .2"/></asset><worldbody>'


def with_body(text: str) -> ws.Robot:
    """The robot of a model that has the tool as a body of its own."""
    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, TOOL[0].matrix()[:3, :3].ravel())
    body = BODY.format(box=" ".join(f"{value:.17g}" for value in quat))
    text = text.replace('<site name="tip"', body).replace("<worldbody>", WEDGE)
    return ws.load_robot(text, tip="tip")


def named(robot: ws.Robot) -> set[frozenset[tuple]]:
    """Its pairs, each shape by its body, kind and size."""
    shapes = robot.bodies.shapes
    return {
        frozenset((shapes[k].body, shapes[k].kind, *np.round(shapes[k].size, 9)) for k in pair)
        for pair in robot.bodies.pairs
    }


@pytest.mark.parametrize("seed", [2, 6, 9])
def test_they_collide_as_a_body_fixed_to_the_tip_does(seed, device):
    text = random_text(seed, 4)
    robot, whole = ws.load_robot(text, tip="tip", tool_shapes=TOOL), with_body(text)
    assert len(robot.bodies.pairs) == len(whole.bodies.pairs) > len(ws.load_robot(text, tip="tip").bodies.pairs)
    assert named(robot) == named(whole)
    q = drawn(robot, 4000)
    constraints = constraints_for(robot, Constraints(self_collision=True))
    found, expected = labels(robot, q, constraints, device=device) > 0, collides(whole, q)
    differ = np.flatnonzero(found != expected)
    assert (np.abs(nearest(constraints[0], q[differ])) <= 1e-6).all()
    assert 0 < expected.sum() < len(q)


@pytest.mark.parametrize("margin", [0.0, 0.02])
def test_they_keep_out_of_what_stands_around(margin, device):
    text = random_text(2, 4)
    choice = Constraints(environment={"margin_m": margin})
    both = [
        constraints_for(robot, choice, ws.Environment(AROUND.items[1:]))
        for robot in (ws.load_robot(text, tip="tip", tool_shapes=TOOL), with_body(text), ws.load_robot(text, tip="tip"))
    ]
    robot = ws.load_robot(text, tip="tip", tool_shapes=TOOL)
    q = drawn(robot, 3000)
    least = nearest(both[1][0], q) - margin
    assert not wrong(labels(robot, q, both[0], device=device) > 0, least < 0, least).size
    assert (least < 0).sum() > (nearest(both[2][0], q) < margin).sum()


def test_they_move_with_the_tip_wherever_the_tool_point_is():
    bare = ws.load_robot("ur5e", tool=ws.Transform(position_m=(0, 0, 0.3)))
    robot = ws.load_robot("ur5e", tool=ws.Transform(position_m=(0, 0, 0.3)), tool_shapes=TOOL)
    q = drawn(robot, 3)
    poses = robot.bodies.poses(q)[:, -len(TOOL) :]
    T_tip = bare.forward_kinematics(q) @ np.linalg.inv(ws.Transform(position_m=(0, 0, 0.3)).matrix())
    assert np.allclose(poses[:, 0], T_tip @ TOOL[0].matrix(), atol=1e-12)
    assert robot.shapes["name"][-6:].tolist() == ["hand", "finger", "tool/2", "payload", "wedge", "drop"]
    assert set(robot.shapes["body"][-6:].tolist()) == {"tool"}
    assert np.array_equal(bare.forward_kinematics(q), robot.forward_kinematics(q))


def test_a_solid_that_is_not_convex_is_carried_in_pieces(tmp_path):
    solid, _ = SOLIDS["L"]
    trimesh.Trimesh(*mesh_of(solid)).export(tmp_path / "hook.stl")
    robot = ws.load_robot("ur5e", tool_shapes=[ws.Mesh(tmp_path / "hook.stl", name="hook", convex=False), TOOL[0]])
    assert robot.shapes["name"][-3:].tolist() == ["hook/0", "hook/1", "hand"]
    volumes = [ConvexHull(shape.vertices).volume for shape in robot.bodies.shapes[-3:-1]]
    assert sum(volumes) == pytest.approx(solid.volume(), rel=1e-5)


def test_pairs_with_them_may_be_let_off():
    exclude = [("tool", "link3"), ("hand", "link2")]
    whole = ws.load_robot("ur5e", tool_shapes=TOOL[:2])
    robot = ws.load_robot("ur5e", tool_shapes=TOOL[:2], exclude=exclude)
    dropped = set(zip(whole.pairs["first_body"], whole.pairs["second_body"], strict=True))
    kept = set(zip(robot.pairs["first_body"], robot.pairs["second_body"], strict=True))
    assert dropped - kept == {("link3", "tool")}
    assert len(whole.pairs["first"]) - len(robot.pairs["first"]) == 2 * 2 + 2


def test_a_document_says_the_same():
    shapes = [{"shape": "sphere", "name": "payload", "radius_m": 0.15, "position_m": [0, 0, 0.1]}]
    document = {"analysis": "workspace", "robot": {"library": "ur5e", "tool_shapes": shapes}}
    document |= {"constraints": {"self_collision": True}, "sampling": {"method": "sobol", "count": 4096}}
    result = ws.execute(document)
    python = ws.analyze(ws.load_robot("ur5e", tool_shapes=shapes), ws.Sobol(4096), constraints={"self_collision": True})
    assert result.document["job"]["robot"]["tool_shapes"] == python.document["job"]["robot"]["tool_shapes"]
    assert result.document["samples"] == python.document["samples"]
    document["robot"] = "ur5e"
    bare = ws.execute(document)
    assert "tool_shapes" not in bare.document["job"]["robot"]
    assert result.document["samples"]["admitted"] < bare.document["samples"]["admitted"]


@pytest.mark.parametrize(
    ("shape", "field", "message"),
    [
        ({"shape": "half_space"}, "shape", "must be one of .*, not"),
        ({"shape": "sphere"}, "radius_m", "is required"),
        (
            {"shape": "mesh", "vertices_m": [*CORNERS[:3], (1, 1, 0)]},
            "vertices_m",
            "enclose no volume",
        ),
        ({"shape": "mesh", "path": "nowhere.stl"}, "path", "cannot be read"),
        ({"shape": "sphere", "radius_m": 0.1, "name": "hand"}, "name", "another tool shape"),
        ({"shape": "sphere", "radius_m": 0.1, "name": "link3"}, "name", "a shape or body of the model"),
    ],
)
def test_tools_that_cannot_be_had_name_the_field(shape, field, message):
    robot = {"library": "ur5e", "tool_shapes": [TOOL[0].model_dump(exclude_none=True), shape]}
    document = {"analysis": "indices_at", "robot": robot, "configurations": [[0] * 6]}
    with pytest.raises(InputError, match=message) as caught:
        ws.execute(document | {"constraints": {"self_collision": True}})
    assert caught.value.field == f"robot.tool_shapes.1.{field}"


def test_a_shape_of_another_kind_is_refused_as_its_document_is():
    with pytest.raises(InputError, match=r'must be one of .*, not "half_space"') as caught:
        ws.load_robot("ur5e", tool_shapes=[ws.HalfSpace()])
    assert caught.value.field == "tool_shapes.0.shape"
