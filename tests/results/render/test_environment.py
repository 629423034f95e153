import numpy as np
import pytest
import trimesh

import wsrender as ws
from wsrender.errors import InputError
from wsrender.results.render import Box, Floor, Table
from wsrender.results.render.environment import color, corners, items_of, label, planes, surfaces

LOWER, UPPER = np.array([-1.0, -2.0, 0.0]), np.array([1.0, 2.0, 3.0])


def solids(item):
    return [trimesh.Trimesh(part.vertices, part.faces, process=False) for part in surfaces(item, LOWER, UPPER)]


def test_a_box_is_where_it_was_put():
    (box,) = solids(Box((0.1, 0.2, 0.3), (0.4, 0.6, 0.8)))
    assert box.is_watertight
    assert box.volume == pytest.approx(0.4 * 0.6 * 0.8)  # positive: faces outward
    np.testing.assert_allclose(box.bounds, [[-0.1, -0.1, -0.1], [0.3, 0.5, 0.7]])


def test_a_table_stands_on_its_floor():
    table = Table((0.5, 0.0, 0.75), (1.2, 0.8), floor_m=-0.1)
    parts = solids(table)
    assert all(part.is_watertight and part.volume > 0 for part in parts)
    low, high = np.min([p.bounds[0] for p in parts], axis=0), np.max([p.bounds[1] for p in parts], axis=0)
    np.testing.assert_allclose([low, high], [[-0.1, -0.4, -0.1], [1.1, 0.4, 0.75]])
    np.testing.assert_allclose([corners(table).min(axis=0), corners(table).max(axis=0)], [low, high])


def test_a_floor_covers_the_picture_and_its_top_is_the_height():
    (floor,) = solids(Floor(0.25))
    np.testing.assert_allclose(floor.bounds[:, :2], [LOWER[:2], UPPER[:2]])
    assert floor.bounds[1, 2] == pytest.approx(0.25)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Box((0, 0), (1, 1, 1)), r"box\.center_m: must be 3 finite numbers"),
        (lambda: Box((0, 0, 0), (1, 0, 1)), r"box\.size_m: must be 3 finite positive numbers"),
        (lambda: Floor(float("nan")), r"floor\.height_m"),
        (
            lambda: Table((0, 0, 0), (1, 1)),
            r"its top, z = 0 m, must be more than its thickness, 0.04 m, above the floor, z = 0 m",
        ),
    ],
)
def test_errors_name_the_field(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_short_names_are_shapes_of_the_world():
    assert Box((0.1, 0.2, 0.3), (0.4, 0.6, 0.8)).shapes() == [
        ws.Box(position_m=(0.1, 0.2, 0.3), size_m=(0.4, 0.6, 0.8))
    ]
    assert Floor(0.25).shapes() == [ws.HalfSpace(point_m=(0, 0, 0.25))]
    assert [shape.shape for shape in Table((0, 0, 1), (1, 1)).shapes()] == ["box"] * 5


def test_shapes_of_an_environment_are_drawn():
    ball = ws.Sphere(position_m=(0, 0, 1), radius_m=0.2)
    items = items_of(ws.Environment([ws.HalfSpace(), ball]))
    assert [label(item) for item in [*items, Floor(), Box((0, 0, 0), (1, 1, 1))]] == [
        "half space", "sphere", "floor", "box",
    ]  # fmt: skip
    assert color(items[0]) == color(Floor()) != color(items[1])
    assert planes([*items, Floor()]) == [ws.HalfSpace()] * 2
    assert len(corners(items[0])) == 0
    np.testing.assert_allclose(np.ptp(corners(ball), axis=0), 0.4, rtol=0.01)
    ((floor,), (drawn,)) = (solids(item) for item in items)
    np.testing.assert_allclose(floor.bounds, solids(Floor())[0].bounds)
    assert drawn.volume == pytest.approx(4 / 3 * np.pi * 0.2**3, rel=0.02)


def test_robots_and_scenes_are_drawn_shape_by_shape():
    ellipsoid = ws.Ellipsoid(size_m=(0.2, 0.4, 0.6), position_m=(0, 0, 1))
    (drawn,) = solids(ellipsoid)
    assert drawn.volume == pytest.approx(np.pi / 6 * 0.2 * 0.4 * 0.6, rel=0.02)
    place = {"position_m": (1, 2, 0)}
    other = ws.OtherRobot(robot={"library": "ur5e", "placement": place}, configuration=[0] * 6)
    cell = ws.Scene(mjcf='<mujoco><worldbody><geom type="plane" size="1 1 1"/><geom size=".1"/></worldbody></mujoco>')
    robot, scene = items_of([other, cell])
    assert [label(robot), label(scene)] == ["robot", "scene"]
    arm = ws.load_robot("ur5e", placement=ws.Transform(**place))
    assert len(surfaces(robot, LOWER, UPPER)) == len(arm.bodies.shapes)
    centers = arm.bodies.poses(np.zeros((1, 6)))[0, :, :3, 3]
    low, high = corners(robot).min(axis=0), corners(robot).max(axis=0)
    assert ((low < centers) & (centers < high)).all()
    assert planes([scene]) == [ws.HalfSpace()]
    with pytest.raises(InputError, match=r"environment\.1\.configuration: has shape"):
        items_of([Floor(), ws.OtherRobot(robot="ur5e", configuration=[0])])


def test_what_is_no_item_is_refused():
    with pytest.raises(InputError, match=r"environment\.1: must be a wsrender Environment's shape, .*, not 'table'"):
        items_of([Floor(), "table"])
