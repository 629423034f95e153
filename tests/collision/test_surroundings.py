"""Robots and scenes that stand around: labels against MuJoCo on a model of everything, made by MuJoCo itself."""

import mujoco
import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull

import wsrender as ws
from tests.collision.robots import drawn, nearest, random_text
from tests.collision.test_constraints_of_robots import arm
from tests.collision.test_labels import SELF, labels, wrong
from tests.world.test_convex_pieces import SOLIDS, inside, mesh_of
from wsrender.collision.solids import BASE, Pairs
from wsrender.collision.store import stored_program
from wsrender.documents.constraints import Constraints
from wsrender.errors import InputError, ResourceError
from wsrender.results.render.environment import items_of, surfaces
from wsrender.robot import collisions
from wsrender.robot.constraints import constraints_for
from wsrender.robot.surroundings import shapes_around

POSE = {"position_m": (0.25, -0.1, 0.2), "quat_wxyz": (0.9, 0.1, -0.3, 0.2)}
CELL = """<mujoco><asset><mesh name="wedge" vertex="0 0 0  .2 0 0  0 .3 0  0 0 .2"/></asset><worldbody>
<geom name="floor" type="plane" size="1 1 .1" pos="0 0 -.6"/><geom name="seen" size="9" contype="0" conaffinity="0"/>
<body name="bench" pos=".3 .1 -.2" euler="0 20 30"><geom name="top" type="box" size=".2 .1 .03"/>
<geom type="mesh" mesh="wedge"/><body pos="0 0 .1"><geom name="rail" type="ellipsoid" size=".05 .2 .03"/></body></body>
<body><freejoint/><geom name="thrown" size="3"/></body></worldbody></mujoco>"""

HILLS = """<mujoco><asset><hfield name="hills" nrow="2" ncol="2" size="1 1 1 .1"/></asset><worldbody>
<geom type="hfield" hfield="hills"/></worldbody></mujoco>"""


def together(robot: str, other: str, moves: bool = True) -> tuple[mujoco.MjModel, list[int], list[int]]:
    """A model of both, the other at POSE; geoms of the robot that its joints move, and of the other."""
    spec, child = mujoco.MjSpec.from_string(robot), mujoco.MjSpec.from_string(other)
    frame = spec.worldbody.add_frame(pos=POSE["position_m"], quat=POSE["quat_wxyz"])
    spec.attach(child, frame=frame, prefix="other/")
    model = spec.compile()
    bodies = [model.body(body).name for body in model.geom_bodyid]
    names = [model.geom(geom).name for geom in range(model.ngeom)]
    foreign = [body.startswith("other/") or name.startswith("other/") for body, name in zip(bodies, names, strict=True)]
    fixed = model.body_weldid[model.geom_bodyid] == 0
    own = [geom for geom in range(model.ngeom) if not foreign[geom] and not fixed[geom]]
    return model, own, [geom for geom in range(model.ngeom) if foreign[geom] and (moves or fixed[geom])]


def distances(model, own, around, qpos) -> np.ndarray:
    """Least signed distance (N,) [m] of the robot's geoms from the others."""
    data, found = mujoco.MjData(model), []
    for row in qpos:
        data.qpos[: len(row)] = row
        mujoco.mj_kinematics(model, data)
        found.append(min(mujoco.mj_geomDistance(model, data, a, b, 1.0, None) for a in own for b in around))
    return np.array(found)


@pytest.mark.parametrize(("seed", "other"), [(2, 6), (6, 1), (7, 2), (12, 6)])
def test_another_robot_at_a_configuration(seed, other, device):
    robot, text = ws.load_robot(random_text(seed, 3)), random_text(other, 3)
    stands = drawn(ws.load_robot(text), 1, other)[0]
    item = ws.OtherRobot(robot={"mjcf": text, "placement": POSE}, name="neighbour", configuration=stands)
    margin, q = (0.0, 0.03)[seed % 2], drawn(robot, 4000)
    constraints = constraints_for(robot, Constraints(environment={"margin_m": margin}), ws.Environment([item]))
    model, own, around = together(random_text(seed, 3), text)
    least = distances(model, own, around, np.hstack([q, np.tile(stands, (len(q), 1))])) - margin
    assert 0 < (least < 0).sum() < len(q)
    assert not wrong(labels(robot, q, constraints, device=device) > 0, least < 0, least).size
    assert {solid.name.split("/")[0] for solid in constraints[0].solids if solid.joint == BASE} >= {"neighbour"}


@pytest.mark.parametrize("seed", [2, 6, 7])
def test_what_stands_still_in_a_scene(seed, device):
    robot, q = ws.load_robot(random_text(seed, 4)), drawn(ws.load_robot(random_text(seed, 4)), 4000)
    cell = ws.Environment([ws.Scene(mjcf=CELL, name="cell", **POSE)])
    names = [each.name for each in shapes_around(cell.items)]
    assert names == ["cell/floor", "cell/top", "cell/bench/1", "cell/rail"]
    constraints = constraints_for(robot, None, cell)
    model, own, around = together(random_text(seed, 4), CELL, moves=False)
    around = [geom for geom in around if model.geom(geom).name != "other/seen"]
    least = distances(model, own, around, q)
    assert 0 < (least < 0).sum() < len(q)
    assert not wrong(labels(robot, q, constraints, device=device) > 0, least < 0, least).size


def test_the_world_of_the_robots_own_file_is_met_as_mujoco_does():
    """By contact bits, pairs and excludes; what the tip carries has MuJoCo's default bits."""
    sphere = '<geom name="{}" size=".1" contype="{}" conaffinity="{}"/>'
    away = sphere.replace("geom", 'geom pos="9 0 0"')
    world = "".join(away.format(*each) for each in (("wall", 1, 1), ("seen", 2, 2), ("paired", 4, 4)))
    text = f"""<mujoco><worldbody>{world}<body name="a"><joint range="-1 1" limited="true"/>{sphere.format("one", 2, 0)}
      <body name="b"><joint range="-1 1" limited="true"/>{sphere.format("two", 1, 1)}</body></body></worldbody>
      <contact><pair geom1="one" geom2="paired"/><exclude body1="b" body2="world"/></contact></mujoco>"""
    robot = ws.load_robot(text, tool_shapes=[ws.Sphere(name="grip", radius_m=0.1, position_m=(1, 0, 0))])
    (constraint,) = constraints_for(robot, Constraints(environment={"margin_m": 0.01}))
    own = [constraint.solids[k].name for k in constraint.pairs.ravel()]
    model = robot.bodies.model
    model.geom_margin[:] = model.pair_margin[:] = model.body_margin[:] = 100
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    contacts = [sorted(model.geom(geom).name for geom in contact.geom) for contact in data.contact]
    fixed = {"wall", "seen", "paired"}
    expected = sorted(pair for pair in contacts if len(fixed.intersection(pair)) == 1)
    found = sorted(sorted(pair) for pair in zip(own[::2], own[1::2], strict=True))
    assert found == sorted([*expected, ["grip", "wall"]]) and expected == [["one", "paired"], ["one", "seen"]]


def test_a_scene_of_files_is_the_scene_of_its_text(tmp_path):
    (tmp_path / "parts").mkdir()
    trimesh.creation.box((0.1, 0.2, 0.3)).export(tmp_path / "parts" / "box.stl")
    (tmp_path / "parts.xml").write_text(
        '<mujoco><compiler meshdir="parts"/><asset><mesh name="box" file="box.stl"/></asset></mujoco>'
    )
    (tmp_path / "scene.xml").write_text(
        '<mujoco><include file="parts.xml"/><worldbody><geom name="block" type="mesh" mesh="box" pos="1 2 3"/>'
        "</worldbody></mujoco>"
    )
    (found,) = shapes_around([ws.Scene(tmp_path / "scene.xml", name="cell")])
    assert found.name == "cell/block"
    corners = np.array(found.shape.vertices_m) @ found.shape.matrix()[:3, :3].T + found.shape.matrix()[:3, 3]
    assert np.allclose(corners.min(axis=0), [0.95, 1.9, 2.85], atol=1e-6)
    assert np.allclose(corners.max(axis=0), [1.05, 2.1, 3.15], atol=1e-6)


@pytest.mark.parametrize(
    ("item", "field", "message"),
    [
        ({"robot": "ur5e", "configuration": [0, 0]}, "configuration", r"has shape .*\(6,\) or"),
        ({"robot": "ur5e", "configuration": [0, 0, 90, 0, 0, 0]}, "configuration", "at 90, beyond its limits"),
        ({"robot": {"library": "ur7"}, "configuration": [0]}, "robot.library", "ur7"),
        ({"robot": {"mjcf": CELL}, "configuration": [0]}, "robot.mjcf", "is a free joint on the chain"),
        (
            {"robot": {"dh": {"convention": "standard", "rows": [{"a": 0.3}] * 2}}, "configuration": [0, 0]},
            "robot",
            "has no shapes that may collide",
        ),
        ({"shape": "scene", "path": "nowhere/scene.xml"}, "path", "nowhere"),
        ({"shape": "scene", "mjcf": "<robot/>"}, "mjcf", "<mujoco> is needed"),
        ({"shape": "scene", "mjcf": "<mujoco/>"}, "mjcf", "holds no shape that may collide and that no joint moves"),
        ({"shape": "scene", "mjcf": '<mujoco><include file="a.xml"/></mujoco>'}, "mjcf", "includes are refused"),
        ({"shape": "scene", "mjcf": HILLS}, "mjcf", "may collide, but heights are read from the attribute elevation"),
        ({"shape": "scene", "mjcf": HILLS.replace('nrow="2"', 'nrow="3" elevation="1 2"')}, "mjcf", "elevation"),
        ({"shape": "mesh", "model": "0" * 64}, "model", "is known to its server only"),
        ({"shape": "scene", "model": "0" * 64}, "model", "is known to its server only"),
    ],
)
def test_robots_and_scenes_that_cannot_be_had_name_the_field(item, field, message):
    with pytest.raises(InputError, match=message) as caught:
        constraints_for(ws.load_robot("ur5e"), None, ws.Environment([ws.HalfSpace(point_m=(0, 0, -1)), item]))
    assert caught.value.field == f"environment.items.1.{field}"


def test_too_many_pairs_to_look_at_are_refused(monkeypatch):
    """Before any is listed, or those that are excluded are left out."""
    balls = ws.Environment([ws.Sphere(radius_m=0.1, position_m=(9, 0, 0))] * 3)
    monkeypatch.setattr(collisions, "MOST_LISTED", 3 * moving_shapes(arm()) - 1)
    with pytest.raises(ResourceError, match=r"constraints\.environment: would look at \d+ pairs of shapes, more than"):
        constraints_for(arm(), None, balls)
    monkeypatch.setattr(collisions, "MOST_LISTED", 3 * moving_shapes(arm()))
    assert constraints_for(arm(), None, balls)


def moving_shapes(robot) -> int:
    return sum(shape.frame != BASE for shape in robot.bodies.shapes)


def test_all_of_an_item_may_be_let_off():
    robot = ws.load_robot("ur5e")
    around = ws.Environment([ws.OtherRobot(robot="ur5e", name="twin", configuration=[0] * 6), ws.Scene(mjcf=CELL)])
    hands = {shape.body for shape in robot.bodies.shapes}
    choice = Constraints(environment={"exclude": [(body, "twin") for body in hands]})
    (constraint,) = constraints_for(robot, choice, around)
    paired = [constraint.solids[k] for k in constraint.pairs.ravel()]
    assert {solid.name.split("/")[0] for solid in paired if solid.joint == BASE} == {"scene 2"}


def test_meshes_of_many_corners_are_simplified_outwards():
    """What 10,000 corners stand for is planned in seconds, and holds all of them."""
    points = np.random.default_rng(0).normal(size=(10_000, 3))
    points = points / np.linalg.norm(points, axis=1, keepdims=True) * [0.2, 0.1, 0.05]
    (standing,) = shapes_around((ws.Mesh(vertices_m=points.tolist()),))
    assert isinstance(standing.shape, ws.ConvexMesh)
    corners = np.array(standing.shape.vertices_m)
    planes = ConvexHull(corners).equations
    assert len(corners) <= 1000
    assert (points @ planes[:, :3].T + planes[:, 3]).max() < 1e-9
    assert (np.ptp(corners, axis=0) - np.ptp(points, axis=0)).max() < 2 * 0.005 * 0.4


def test_a_mesh_too_small_for_mujoco_is_refused():
    tiny = ws.Environment([ws.Mesh(vertices_m=(np.eye(4, 3) * 2e-5).tolist(), position_m=(0.4, 0, 0.4))])
    with pytest.raises(InputError, match="at least 1e-14 m³ are needed") as caught:
        constraints_for(ws.load_robot("ur5e"), None, tiny)
    assert caught.value.field == "environment.items.0.vertices_m"


def test_labels_do_not_depend_on_where_base_and_plane_are_said_to_be(device):
    far = np.array([1e5, -2e5, 3e3])
    q, found = drawn(ws.load_robot("ur5e"), 4000), []
    for base, along in ((0 * far, 0.0), (far, 0.0), (0 * far, 1e6)):
        floor = ws.HalfSpace(name="floor", point_m=tuple(np.add(base, (along, 0, -0.05))))
        box = ws.Box(name="box", size_m=(0.3, 0.3, 0.3), position_m=tuple(np.add(base, (0.4, 0, 0.4))))
        robot = ws.load_robot("ur5e", placement=ws.Transform(position_m=tuple(base)))
        constraints = constraints_for(robot, SELF, ws.Environment([floor, box]))
        least = np.min([nearest(each, q) for each in constraints], axis=0)
        found.append(labels(robot, q, constraints, device=device))
        assert not wrong(found[-1] > 0, least < 0, least).size
        clear = np.abs(least) > 1e-4
        assert np.array_equal(found[-1][clear], found[0][clear])
        assert stored(constraints).epsilon < 2e-5


def stored(constraints):
    """The program of constraints."""
    pairs = Pairs.of(constraints[0].solids, *(each.group for each in constraints))
    return stored_program(pairs, constraints[0].chain, constraints[0].distances)


@pytest.mark.parametrize("margin", [0.0, 0.02])
def test_a_solid_that_is_not_convex(tmp_path, margin, device):
    """A table whose legs the hand reaches between: the distance of the hand's ball by the triangles."""
    solid, _ = SOLIDS["table"]
    vertices, faces = mesh_of(solid)
    trimesh.Trimesh(vertices, faces).export(tmp_path / "table.stl")
    place = {"position_m": (-0.3, 0.3, -0.45), "rpy_deg": (0, 0, 20)}
    around = ws.Environment([ws.Mesh(tmp_path / "table.stl", convex=False, name="table", **place)])
    robot, choice = arm(), Constraints(environment={"margin_m": margin})
    constraints = constraints_for(robot, choice, around)
    assert [solid.name for solid in constraints[0].solids[-5:]] == [f"table/{k}" for k in range(5)]
    q = drawn(robot, 1500)
    hand = next(k for k, shape in enumerate(robot.bodies.shapes) if shape.name == "hand")
    T = np.linalg.inv(ws.Transform(**place).matrix())
    centers = robot.bodies.poses(q)[:, hand, :3, 3] @ T[:3, :3].T + T[:3, 3]
    corners = vertices[faces]
    near = [np.linalg.norm(trimesh.triangles.closest_point(corners, np.tile(p, (len(faces), 1))) - p, axis=1).min()
            for p in centers]  # fmt: skip
    least = np.where(inside(solid, centers), -1, 1) * near - 0.05 - margin
    assert 0 < (least < 0).sum() < len(q)
    assert not wrong(labels(robot, q, constraints, device=device) > 0, least < 0, least).size
    (hull,) = constraints_for(robot, choice, ws.Environment([ws.ConvexMesh(tmp_path / "table.stl", **place)]))
    assert (labels(robot, q, (hull,)) > 0).sum() > (least < 0).sum()
    items = items_of(around)
    assert len(surfaces(items[0], np.zeros(3), np.ones(3))) == 5
