"""What stands around a robot: shapes in one vocabulary, and how it was said before."""

import json

import pytest

import wsrender as ws
from wsrender.analyses.jobs import canonical_json, parse_job
from wsrender.documents.environment import Bounds
from wsrender.documents.kinetostatics import ForceFieldChoice, ObstacleForce
from wsrender.documents.mechanism import Region
from wsrender.errors import DocumentError

TABLE = {"shape": "box", "name": "table", "size_m": [1, 0.6, 0.04], "position_m": [0.75, 0, 0.2]}
FLOOR = {"shape": "half_space", "name": "floor", "point_m": [0, 0, 0], "normal": [0, 0, 1]}
CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]


def test_documents_and_python_say_the_same():
    assert ws.Environment(items=[FLOOR, TABLE]) == ws.Environment(
        [
            ws.HalfSpace(name="floor"),
            ws.Box(name="table", size_m=(1, 0.6, 0.04), position_m=(0.75, 0, 0.2)),
        ]
    )
    assert ws.Mesh("fixture.stl", position_m=(0.4, 0, 0)) == ws.Mesh(path="fixture.stl", position_m=(0.4, 0, 0))


GROUND = {"shape": "height_field", "size_m": [1, 1]}


def test_an_environment_is_written_and_read():
    shapes = [
        ws.HalfSpace(normal=(1, 0, 1)),
        ws.Box(size_m=(1, 2, 3), rpy_deg=(0, 0, 90)),
        ws.Sphere(radius_m=0.1, position_m=(1, 2, 3)),
        ws.Cylinder(radius_m=0.1, length_m=2),
        ws.Capsule(radius_m=0.1, length_m=2, quat_wxyz=(1, 0, 0, 0)),
        ws.Ellipsoid(size_m=(1, 2, 3), rpy_deg=(0, 0, 90)),
        ws.Mesh(vertices_m=CORNERS),
        ws.Scene("cell.xml", position_m=(1, 0, 0)),
        ws.OtherRobot(robot={"library": "ur5e", "placement": {"position_m": (0, 1, 0)}}, configuration=[0] * 6),
        ws.Mesh("a.STL", length_unit_m=0.001),
        ws.Mesh("a.ply", convex=False, tolerance_m=0.01),
        ws.Mesh("a.ply", convex=True),
        ws.ConvexMesh("a.obj"),
        ws.HeightField(heights_m=[[1, 2, 3], [4, 5, 6]], size_m=(2, 1)),
        ws.HeightField("ground.npy", size_m=(2, 1), length_unit_m=0.001, rpy_deg=(0, 0, 90)),
    ]
    environment = ws.Environment(shapes)
    assert ws.Environment(**json.loads(environment.model_dump_json())) == environment


def test_an_item_with_a_robot_is_one_without_being_called_so():
    item = {"robot": {"library": "ur5e"}, "configuration": [0] * 6}
    assert ws.Environment([item]) == ws.Environment([{"shape": "robot", **item}])


def problems(**fields):
    with pytest.raises(DocumentError) as caught:
        ws.Environment(**fields)
    return caught.value.problems


@pytest.mark.parametrize(
    ("shape", "field", "message"),
    [
        (
            {"shape": "cone"},
            "shape",
            'must be one of "half_space", "box", "sphere", "cylinder", "capsule", "ellipsoid", ',
        ),
        ({"shape": "scene"}, "path", 'one of "path", "mjcf", "model"'),
        ({"shape": "scene", "path": "a.xml", "mjcf": "<mujoco/>"}, "mjcf", "another source of the scene"),
        ({"robot": "ur5e"}, "configuration", "is required"),
        ({"robot": "ur5e", "configuration": "home"}, "configuration", "must be a list of finite numbers"),
        ({"robot": {}, "configuration": [0]}, "robot.library", "is required, or another source"),
        ({}, "shape", "it is required"),
        ({"shape": "mesh", "vertices_m": CORNERS, "convex": False}, "convex", "must not be false with vertices_m"),
        ({"shape": "mesh", "path": "a.stl", "tolerance_m": 0.1}, "tolerance_m", 'but with "convex": false'),
        (GROUND | {"heights_m": [[1, 2], [3]]}, "heights_m", "at least 2 rows of as many numbers"),
        (GROUND | {"heights_m": [[1, 2]]}, "heights_m", "at least 2 rows of as many numbers"),
        (GROUND | {"heights_m": []}, "heights_m", "at least 2 rows of as many numbers"),
        (GROUND | {"heights_m": [[1] * 201] * 200}, "heights_m", "at most 40000 in all"),
        (GROUND | {"heights_m": [[1, 0], [1, 1]]}, "heights_m.0.1", "must be greater than 0, not 0"),
        (GROUND | {"size_m": [1]}, "size_m.1", "is required"),
        (GROUND, "heights_m", 'must be given, or else "path" or "model"'),
        (GROUND | {"path": "a.png"}, "path", 'must end in .npy, not "a.png"'),
        (GROUND | {"heights_m": [[1, 1]] * 2, "length_unit_m": 0.001}, "length_unit_m", "heights_m are in metres"),
        (TABLE | {"size_m": [1, 0, 1]}, "size_m.1", "must be greater than 0, not 0"),
        (TABLE | {"size_m": [1, 1, 1, 1]}, "size_m", "must have at most 3 items"),
        (TABLE | {"size_m": 1}, "size_m", "must be a list, not 1"),
        (TABLE | {"name": ""}, "name", "must not be empty"),
        (TABLE | {"rpy_deg": [0, 0, 0], "quat_wxyz": [1, 0, 0, 0]}, "rpy_deg", "must not be given together"),
        (FLOOR | {"normal": [0, 0, 0]}, "normal", "must not have length 0: it says no direction"),
        (FLOOR | {"position_m": [0, 0, 0]}, "position_m", "is not a known field; did you mean point_m?"),
        ({"shape": "sphere", "radius_m": -1}, "radius_m", "must be greater than 0, not -1"),
        ({"shape": "cylinder", "radius_m": 1}, "length_m", "is required"),
        ({"shape": "capsule", "radius_m": 1, "length_m": 0}, "length_m", "must be greater than 0, not 0"),
        ({"shape": "mesh"}, "vertices_m", 'must be given, or else "path" or "model"'),
        (
            {"shape": "mesh", "vertices_m": CORNERS, "path": "a.stl"},
            "vertices_m",
            'must be given, or else "path" or "model"',
        ),
        ({"shape": "mesh", "vertices_m": CORNERS[:3]}, "vertices_m", "must be a list of 4 … 10000 points [x, y, z]"),
        ({"shape": "mesh", "path": "a.dae"}, "path", 'must end in .obj, .ply, .stl, not "a.dae"'),
        ({"shape": "mesh", "vertices_m": CORNERS, "length_unit_m": 0.001}, "length_unit_m", 'must be 1 without "path"'),
        ({"shape": "mesh", "path": "a.stl", "model": "0" * 64}, "vertices_m", "one of them"),
        ({"shape": "mesh", "vertices_m": CORNERS, "convex": False}, "convex", "which say no triangles"),
        ({"shape": "mesh", "path": "a.stl", "tolerance_m": 0.01}, "tolerance_m", 'but with "convex": false'),
        ({"shape": "mesh", "path": "a.stl", "convex": False, "tolerance_m": 0}, "tolerance_m", "greater than 0"),
        ({"shape": "mesh", "model": "abc"}, "model", "must match"),
        (TABLE | {"pose": {"rpy_deg": [0, 0, 0]}, "rpy_deg": [0, 0, 0]}, "pose", "which says the same"),
        (TABLE | {"pose": {"yaw": 1}, "position_m": None}, "yaw", "is not a known field"),
        (
            {"shape": "sphere", "radius_m": 1, "center_m": [0, 0, 0], "position_m": [0, 0, 0]},
            "center_m",
            'must not be given together with "position_m"',
        ),
    ],
)
def test_malformed_shapes_name_the_field(shape, field, message):
    found = dict(problems(items=[shape]))
    assert message in found[f"items.0.{field}"]


def test_names_are_unique():
    ((field, message),) = problems(items=[TABLE, FLOOR, TABLE])
    assert (field, message) == ("items.2.name", 'must be another than that of items.0, "table"')
    unnamed = {name: value for name, value in TABLE.items() if name != "name"}
    assert len(ws.Environment([unnamed, unnamed]).items) == 2


def test_a_hundred_shapes_are_enough():
    sphere = {"shape": "sphere", "radius_m": 1}
    assert len(ws.Environment([sphere] * 100).items) == 100
    assert "must have at most 100 items" in problems(items=[sphere] * 101)[0][1]


EARLIER = [
    {"shape": "sphere", "center_m": [0.3, 0, 0], "radius_m": 0.1},
    {"shape": "box", "pose": {"position_m": [1, 2, 3], "rpy_deg": [0, 0, 90]}, "size_m": [1, 2, 3]},
    {"shape": "box", "pose": ws.Transform(position_m=(1, 2, 3)), "size_m": [1, 2, 3]},
    {
        "shape": "mesh",
        "pose": {"position_m": [0, 0, 1], "quat_wxyz": None, "rpy_deg": None, "euler_xyz_deg": None},
        "vertices_m": CORNERS,
    },
]
NOW = [
    {"shape": "sphere", "position_m": [0.3, 0, 0], "radius_m": 0.1},
    {"shape": "box", "position_m": [1, 2, 3], "rpy_deg": [0, 0, 90], "size_m": [1, 2, 3]},
    {"shape": "box", "position_m": [1, 2, 3], "size_m": [1, 2, 3]},
    {"shape": "mesh", "position_m": [0, 0, 1], "vertices_m": CORNERS},
]


def felt(items):
    return {"analysis": "kinetostatic_field", "robot": "scara", "field": {"obstacles": {"items": items}}}


@pytest.mark.parametrize(("earlier", "now"), [*zip(EARLIER, NOW, strict=True)])
def test_obstacles_of_earlier_documents_are_converted(earlier, now):
    assert parse_job(felt([earlier])) == parse_job(felt([now]))
    assert canonical_json(parse_job(felt([earlier]))) == canonical_json(parse_job(felt([now])))


def test_an_environment_is_one_of_obstacles():
    environment = ws.Environment([FLOOR, TABLE])
    found = ForceFieldChoice(obstacles=environment).obstacles
    assert found == ObstacleForce(items=[FLOOR, TABLE]) and found.margin_m == 0.02
    assert parse_job(felt([FLOOR, TABLE])).field.obstacles == found


def test_a_platform_region_is_a_box_of_the_same_vocabulary():
    assert issubclass(Region, Bounds)
    with pytest.raises(DocumentError, match="upper_m: must be above lower_m; along y it is 1, not above 1"):
        Bounds(lower_m=(None, 1, 0), upper_m=(0, 1, None))
