"""Closed meshes and height fields as the solids that they are, against their triangles and MuJoCo's height fields."""

import manifold3d
import mujoco
import numpy as np
import pytest
import trimesh

import wsrender as ws
from tests.collision.convex import touch
from tests.collision.robots import drawn, nearest, random_text
from tests.collision.test_constraints_of_robots import arm
from tests.collision.test_labels import labels, wrong
from tests.world.test_convex_pieces import SOLIDS, inside, mesh_of
from wsrender.collision import grids
from wsrender.collision.distance import Distances, frames_of
from wsrender.collision.program import lookups_of, program
from wsrender.collision.solids import BASE, Solid
from wsrender.documents.constraints import Constraints
from wsrender.errors import InputError
from wsrender.results.render.environment import items_of, surfaces
from wsrender.robot.constraints import constraints_for
from wsrender.robot.surroundings import shapes_around
from wsrender.robots.triangles import ground
from wsrender.world.surfaces import surface_of
from wsrender.world.triangles import triangles

ball, cube = manifold3d.Manifold.sphere, manifold3d.Manifold.cube
BOWL = ball(0.3, 32) - ball(0.28, 32) - cube((1, 1, 1)).translate((-0.5, -0.5, 0))
HEIGHTS = np.random.default_rng(0).uniform(0.05, 0.3, (7, 9))
PLACE = {"position_m": (0.8, 0.1, 0.1), "rpy_deg": (10, 20, 30)}
RANDOM = {"position_m": (0.1, 0.05, 0.1), "rpy_deg": (0, 30, 0)}


@pytest.fixture
def bowl(tmp_path):
    path = tmp_path / "bowl.stl"
    trimesh.Trimesh(*mesh_of(BOWL)).export(path)
    return path


def closest(vertices, faces, points) -> np.ndarray:
    """Distances (N,) of points from triangles, by trimesh."""
    feet = (trimesh.triangles.closest_point(vertices[faces], np.tile(p, (len(faces), 1))) for p in points)
    return np.array([np.linalg.norm(foot - p, axis=1).min() for foot, p in zip(feet, points, strict=True)])


def around(item, margin=0.0, robot=None):
    (constraint,) = constraints_for(robot, Constraints(environment={"margin_m": margin}), ws.Environment([item]))
    return constraint


@pytest.mark.parametrize("margin", [0.0, 0.02])
def test_a_hand_reaches_into_a_bowl(bowl, margin, device):
    """What 100 convex pieces cannot hold: the distance of the hand's ball by the triangles."""
    robot, item = arm(), ws.Mesh(bowl, name="bowl", **PLACE)
    constraint, q = around(item, margin, robot), drawn(robot, 2000)
    assert [(solid.name, solid.kind) for solid in constraint.solids if solid.joint == BASE][-1] == ("bowl", "surface")
    hand = next(k for k, shape in enumerate(robot.bodies.shapes) if shape.name == "hand")
    T = np.linalg.inv(item.matrix())
    centers = robot.bodies.poses(q)[:, hand, :3, 3] @ T[:3, :3].T + T[:3, 3]
    vertices, faces = mesh_of(BOWL)
    vertices = vertices.astype(np.float32).astype(float)  # as the file holds them
    least = np.where(inside(BOWL, centers), -1, 1) * closest(vertices, faces, centers) - 0.05 - margin
    assert 0.02 < (least < 0).mean() < 0.5
    pairs = constraint.pairs[[constraint.solids[k].name == "hand" for k in constraint.pairs[:, 0]]]
    alone = type(constraint)("environment", constraint.chain, constraint.solids, pairs, margin)
    found = labels(robot, q, (alone,), device=device) > 0
    assert not wrong(found, least < 0, least).size
    hull = around(ws.ConvexMesh(bowl, **PLACE), margin, robot)
    assert (labels(robot, q, (hull,), device=device) > 0).sum() > found.sum()


def test_a_bead_in_and_beside_a_hollow_block(tmp_path, precision, device):
    """Smaller than cells of the grid: near the surface its triangles say on which side it is."""
    slides = "".join(f'<joint type="slide" axis="{axis}" range="-1 1"/>' for axis in ("1 0 0", "0 1 0", "0 0 1"))
    inertial = '<inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>'
    robot = ws.load_robot(f"<mujoco><worldbody><body>{slides}{inertial}<geom size='.003'/></body></worldbody></mujoco>")
    solid, _ = SOLIDS["hollow"]
    vertices, faces = mesh_of(solid)
    trimesh.Trimesh(vertices, faces).export(tmp_path / "block.obj")
    constraint, random = around(ws.Mesh(tmp_path / "block.obj"), 0.001, robot), np.random.default_rng(0)
    a, b, c = vertices[faces[random.integers(len(faces), size=1500)]].transpose(1, 0, 2)
    share = np.sort(random.random((2, 1500, 1)), axis=0)
    q = a + (b - a) * share[0] + (c - a) * (1 - share[1]) + random.normal(size=(1500, 3)) * 0.01
    q = q.astype(np.float32).astype(float)
    least = np.where(inside(solid, q), -1, 1) * closest(vertices, faces, q) - 0.003 - 0.001
    assert 0.3 < (least < 0).mean() < 0.8
    assert not wrong(labels(robot, q, (constraint,), precision, device) > 0, least < 0, least).size


@pytest.mark.parametrize(("seed", "margin"), [(2, 0.0), (6, 0.02)])
def test_random_primitives_beside_a_bowl(bowl, seed, margin, device):
    robot = ws.load_robot(random_text(seed, 4))
    constraint, q = around(ws.Mesh(bowl, **RANDOM), margin, robot), drawn(robot, 700)
    least = nearest(constraint, q) - margin
    assert 0.02 < (least < 0).mean() < 0.6
    assert not wrong(labels(robot, q, (constraint,), device=device) > 0, least < 0, least).size


@pytest.mark.parametrize("kind", ["sphere", "capsule", "cylinder", "ellipsoid", "box", "hull"])
def test_distances_from_a_surface_are_those_of_its_triangles(kind):
    """MuJoCo's from triangles against points on the solid, and against convex optimisation where both are near."""
    random = np.random.default_rng(1)
    vertices, faces = mesh_of(ball(0.3, 8) - ball(0.2, 8) - cube((1, 1, 1)).translate((-0.5, -0.5, 0)))
    corners = random.normal(size=(12, 3)) * 0.04 if kind == "hull" else None
    surface = Solid("s", "surface", BASE, np.eye(4), np.zeros(3), vertices, faces)
    other = Solid("o", kind, 0, np.eye(4), np.array([0.03, 0.06, 0.04]), corners)
    T = np.tile(np.eye(4), (60, 1, 1))
    T[:, :3, :3] = np.linalg.qr(random.normal(size=(60, 3, 3)))[0]
    T[:, :3, 0] *= np.linalg.det(T[:, :3, :3])[:, None]
    T[:, :3, 3] = random.uniform(-0.35, 0.35, (60, 3))
    found = Distances([surface, other]).between(0, 1, np.tile(np.eye(4), (60, 1, 1)), T, 0.5)
    assert 3 < (found < 0).sum() < 57
    for triangle in vertices[faces]:
        flat = np.vstack([triangle, triangle.mean(axis=0)])
        flat[3] -= 1e-6 * np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])
        at = np.tile(np.eye(4), (60, 1, 1))
        at[:, :3, 3] = flat.mean(axis=0)
        hull = Solid("t", "hull", 0, np.eye(4), np.zeros(3), flat - flat.mean(axis=0))
        close = np.linalg.norm(T[:, :3, 3] - at[:, :3, 3], axis=1) < other.bounding_radius + hull.bounding_radius
        touching, _ = touch(hull, at[close], other, T[close]) if close.any() else (np.zeros(0, bool), None)
        assert (found[close][touching] < 1e-6).all()
    apart = found > 1e-6
    assert (found[apart] <= closest(vertices, faces, T[apart, :3, 3]) + 1e-9).all()


def test_a_hull_is_on_its_own_side_of_a_surface_wherever_its_origin_is():
    """As of a tool's mesh in the coordinates of its drawing: a closed form, for boxes."""
    block, part = trimesh.creation.box((1, 1, 1)), trimesh.creation.box((0.1, 0.1, 0.1))
    surface = Solid("s", "surface", BASE, np.eye(4), np.zeros(3), np.array(block.vertices), np.array(block.faces))
    for middle, expected in (((0.9, 0, 0), 0.35), ((0.2, 0, 0), -0.25)):
        hull = Solid("h", "hull", 0, np.eye(4), np.zeros(3), np.array(part.vertices) + middle)
        T = np.tile(np.eye(4), (2, 1, 1))
        T[1, :3, :3] = ws.Transform(rpy_deg=(0, 0, 90)).matrix()[:3, :3]
        found = Distances([surface, hull]).between(0, 1, np.tile(np.eye(4), (2, 1, 1)), T, 0.5)
        assert found == pytest.approx([expected] * 2, abs=1e-6)
        T[:, :3, 3] = -2 * (T[:, :3, :3] @ middle)  # the same beyond the block's middle, its origin outside
        found = Distances([surface, hull]).between(0, 1, np.tile(np.eye(4), (2, 1, 1)), T, 0.5)
        assert found == pytest.approx([expected] * 2, abs=1e-6)


def test_labels_of_a_height_field_are_those_of_mujocos(device):
    """MuJoCo's own pipeline: its contacts with prisms under the same triangles."""
    robot, text = ws.load_robot(random_text(6, 4)), random_text(6, 4)
    item = ws.HeightField(heights_m=HEIGHTS.tolist(), size_m=(0.8, 0.6), **RANDOM)
    constraint, q = around(item, 0.0, robot), drawn(robot, 3000)
    spec = mujoco.MjSpec.from_string(text)
    low, high = HEIGHTS.min(), HEIGHTS.max()
    field = spec.add_hfield(name="ground", nrow=7, ncol=9, size=[0.4, 0.3, high - low, low])
    field.userdata = ((HEIGHTS - low) / (high - low)).ravel().tolist()
    T = item.matrix()
    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, T[:3, :3].ravel())
    kind = mujoco.mjtGeom.mjGEOM_HFIELD
    spec.worldbody.add_geom(type=kind, hfieldname="ground", pos=T[:3, 3] + low * T[:3, 2], quat=quat, name="ground")
    model = spec.compile()
    data, geom, expected = mujoco.MjData(model), model.geom("ground").id, []
    fixed = np.flatnonzero(model.body_weldid[model.geom_bodyid] == 0)
    for row in q:
        data.qpos[:] = row
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        pairs = data.contact.geom[data.contact.dist < 0]
        expected.append(((pairs == geom).any(axis=1) & ~np.isin(pairs, fixed[fixed != geom]).any(axis=1)).any())
    found, expected = labels(robot, q, (constraint,), device=device) > 0, np.array(expected)
    differ = np.flatnonzero(found != expected)
    assert 0.02 < expected.mean() < 0.8
    assert np.abs(nearest(constraint, q[differ])).max(initial=0) < 1e-5  # of surfaces stored in float32


def test_the_ground_is_what_its_heights_say():
    vertices, faces = ground(HEIGHTS, (0.8, 0.6))
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    assert mesh.is_watertight
    steps = 0.8 / 8 * 0.6 / 6
    low, right, up, beyond = HEIGHTS[:-1, :-1], HEIGHTS[:-1, 1:], HEIGHTS[1:, :-1], HEIGHTS[1:, 1:]
    assert mesh.volume == pytest.approx(((low + right + beyond) / 6 + (low + beyond + up) / 6).sum() * steps)
    assert np.allclose(mesh.bounds, [[-0.4, -0.3, 0], [0.4, 0.3, HEIGHTS.max()]])


def test_grids_bound_the_distance_and_their_lookups_never_lie(bowl):
    vertices, faces = mesh_of(BOWL)
    grid = grids.surface_grid(vertices[faces], 0.1)
    random = np.random.default_rng(0)
    points = random.uniform(-0.5, 0.5, (1500, 3)) * [1, 1, 0.6]
    points[::3] = vertices[random.integers(len(vertices), size=500)] + random.normal(size=(500, 3)) * 0.01
    distance = np.where(inside(BOWL, points), -1, 1) * closest(vertices, faces, points)
    lower, upper = grid.bounds(points)
    within = (np.abs(points - [0, 0, -0.15]) < [0.4, 0.4, 0.25]).all(axis=1)
    assert (lower <= distance).all()
    assert (upper >= distance)[within].all()
    assert np.median((upper - lower)[within]) < 3 * grid.cell
    robot = ws.load_robot(random_text(6, 4))
    constraint, q = around(ws.Mesh(bowl, **RANDOM), 0.1, robot), drawn(robot, 300)
    pairs, frames = constraint.own, frames_of(constraint.chain, q)
    lookups = lookups_of(program(pairs, constraint.chain))
    assert lookups
    for pair, lookup in lookups.items():
        a, b = pairs.pairs[pair]
        T_a, T_b = (frames[:, pairs.solids[k].joint + 1] @ pairs.solids[k].T for k in (a, b))
        known = lookup.distance(frames[:, lookup.joint + 1])
        left = constraint.distances.between(a, b, T_a, T_b, 2.0) - 0.1
        assert (known <= np.maximum(left, 0) + 1e-6).all()
        assert (left[known < 0] < 0).all()
        assert (known != 0).mean() > 0.5


def test_ground_that_swallows_the_base_is_refused_by_proof():
    heights = np.full((3, 3), 5.0).tolist()
    item = ws.HeightField(name="hill", heights_m=heights, size_m=(9, 9), position_m=(0, 0, -2.5))
    with pytest.raises(InputError, match=r"hill and .* collide in every configuration"):
        around(item, 0.0, ws.load_robot("ur5e"))


def test_a_mesh_that_is_convex_is_its_hull(tmp_path):
    trimesh.creation.box((0.1, 0.2, 0.3)).export(tmp_path / "box.stl")
    solids = [around(shape(tmp_path / "box.stl"), 0.0, arm()).solids[-1] for shape in (ws.Mesh, ws.ConvexMesh)]
    assert [solid.kind for solid in solids] == ["hull", "hull"]
    assert np.array_equal(*(np.sort(solid.vertices, axis=0) for solid in solids))


def box_of(change) -> tuple[np.ndarray, np.ndarray]:
    vertices, faces = mesh_of(cube((0.1, 0.2, 0.3)) + cube((0.3, 0.1, 0.1)))
    return change(vertices, faces.copy())


def turned(vertices, faces):
    faces[3] = faces[3, ::-1]
    return vertices, faces


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda v, f: (v, f[1:]),
            'is not closed: 3 edges are not .*; mend it, or give it as a "convex_mesh"',
        ),
        (turned, "has 3 edges whose triangles do not turn alike"),
        (lambda v, f: (v * [1, 1, 0], f), "encloses 0 m³; at least 1e-14 m³ are needed"),
        (
            lambda v, f: (np.tile(v, (5000, 1)), np.concatenate([f + k * len(v) for k in range(5000)])),
            "may have 100000",
        ),
    ],
)
def test_meshes_that_enclose_nothing_name_the_field(tmp_path, change, message):
    vertices, faces = box_of(change)
    trimesh.Trimesh(vertices, faces, process=False).export(tmp_path / "part.ply")
    with pytest.raises(InputError, match=message) as caught:
        around(ws.Mesh(tmp_path / "part.ply"), 0.0, arm())
    assert caught.value.field == "environment.items.0.path"


@pytest.mark.parametrize(
    ("array", "message"),
    [
        (np.ones((3, 3, 3)), r"has the shape \(3, 3, 3\) of float64; it must hold at least 2 rows"),
        (np.ones((1, 3)), "at least 2 rows"),
        (np.ones((201, 200)), "at most 40000 in all"),
        (np.ones((640, 501)), "has 2565248 bytes; it must hold"),  # which are not read
        (np.array([[1.0, 1], [1, -1]]), "not positive"),
        (np.array([[1.0, 1], [1, np.nan]]), "not positive"),
        (np.array([[{}, 1], [1, 1]]), r"has the shape \(2, 2\) of object; it must hold"),
        (np.array([["a", "b"]] * 2), "it must hold"),
    ],
)
def test_files_that_hold_no_heights_name_the_field(tmp_path, array, message):
    np.save(tmp_path / "ground.npy", array)
    with pytest.raises(InputError, match=message) as caught:
        around(ws.HeightField(tmp_path / "ground.npy", size_m=(1, 1)), 0.0, arm())
    assert caught.value.field == "environment.items.0.path"


def test_heights_of_a_file_are_those_of_the_document(tmp_path):
    np.save(tmp_path / "ground.npy", HEIGHTS * 1000)
    file = ws.HeightField(tmp_path / "ground.npy", size_m=(0.8, 0.6), length_unit_m=0.001)
    said = ws.HeightField(heights_m=HEIGHTS.tolist(), size_m=(0.8, 0.6))
    assert np.allclose(surface_of(file).vertices, surface_of(said).vertices)


def test_the_ground_of_a_scene_is_the_item_of_its_heights():
    """In millimetres, at a place, with what MuJoCo makes of its heights: the lowest at the top of the base."""
    rise, base = HEIGHTS - HEIGHTS.min(), 0.04
    elevation = " ".join(f"{value:.9g}" for value in rise[::-1].ravel())  # as it is read, y upwards
    text = f"""<mujoco><asset><hfield name="hills" nrow="7" ncol="9" elevation="{elevation}"
        size="400 300 {1000 * rise.max():.9g} {1000 * base}"/></asset><worldbody>
        <geom name="ground" type="hfield" hfield="hills" pos="100 0 200" euler="0 0 90"/></worldbody></mujoco>"""
    (found,) = shapes_around([ws.Scene(mjcf=text, name="cell", length_unit_m=0.001, position_m=(0, 0, 1))])
    assert (found.name, found.item) == ("cell/ground", "cell")
    place = {"position_m": (0.1, 0, 1.2 - base), "rpy_deg": (0, 0, 90)}
    item = ws.HeightField(heights_m=(rise + base).tolist(), size_m=(0.8, 0.6), **place)
    vertices, faces = triangles(item)
    own, own_faces = triangles(found.shape)
    assert np.allclose(own, vertices, atol=1e-6)
    assert np.array_equal(own_faces, faces)
    assert len(surfaces(items_of([item])[0], np.zeros(3), np.ones(3))) == 1


def test_a_height_field_must_not_move():
    text = """<mujoco><asset><hfield name="hills" nrow="2" ncol="2" elevation="1 2 3 4" size="1 1 1 .1"/></asset>
        <worldbody><body><joint range="-1 1"/><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
        <geom type="hfield" hfield="hills"/><geom size=".1"/></body></worldbody></mujoco>"""
    with pytest.raises(InputError, match="must not move"):
        constraints_for(ws.load_robot(text), None, ws.Environment([ws.HalfSpace(point_m=(0, 0, -3))]))
