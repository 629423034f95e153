"""Distances of points to shapes, against closed forms."""

import manifold3d
import numpy as np
import pytest
import trimesh

import wsrender as ws
from tests.world.test_convex_pieces import inside, mesh_of
from wsrender.errors import InputError
from wsrender.robot.surroundings import shapes_around
from wsrender.world.distances import FAR, NearestShape

PLACE = {"position_m": (0.1, -0.2, 0.3), "rpy_deg": (10, 20, 30)}
RADIUS, LENGTH, SIZE = 0.15, 0.5, (0.2, 0.4, 0.3)


def local(point):
    T = ws.Transform(**PLACE).matrix()
    return T[:3, :3].T @ (point - T[:3, 3])


def to_box(size, p):
    """Signed distance to a box (Quílez, *Distance functions*), of any number of axes."""
    q = np.abs(p) - np.array(size) / 2
    return np.linalg.norm(np.maximum(q, 0)) + min(q.max(), 0)


def to_cylinder(p):
    """That to a box of two axes: radius, and along."""
    return to_box((2 * RADIUS, LENGTH), np.array([np.hypot(*p[:2]), p[2]]))


def to_capsule(p):
    along = np.clip(p[2], -LENGTH / 2, LENGTH / 2)
    return np.linalg.norm(p - [0, 0, along]) - RADIUS


CORNERS = [(x, y, z) for x in (-0.1, 0.1) for y in (-0.2, 0.2) for z in (-0.15, 0.15)]
SHAPES = {
    "sphere": (ws.Sphere(position_m=PLACE["position_m"], radius_m=RADIUS), lambda p: np.linalg.norm(p) - RADIUS),
    "box": (ws.Box(**PLACE, size_m=SIZE), lambda p: to_box(SIZE, p)),
    "mesh": (ws.Mesh(**PLACE, vertices_m=[*CORNERS, (0, 0, 0)]), lambda p: to_box(SIZE, p)),
    "cylinder": (ws.Cylinder(**PLACE, radius_m=RADIUS, length_m=LENGTH), to_cylinder),
    "capsule": (ws.Capsule(**PLACE, radius_m=RADIUS, length_m=LENGTH), to_capsule),
}


@pytest.mark.parametrize("name", SHAPES)
def test_distance_to_a_shape(name):
    shape, distance = SHAPES[name]
    nearest, inside = NearestShape([shape]), 0
    for point in np.random.default_rng(0).uniform(-0.5, 0.5, (300, 3)) * 0.6 + PLACE["position_m"]:
        found, gradient = nearest.at(point)
        assert found == pytest.approx(distance(local(point)), abs=1e-6)
        steps = 1e-4 * np.eye(3)
        slopes = [(distance(local(point + s)) - distance(local(point - s))) / 2e-4 for s in steps]
        if abs(np.linalg.norm(slopes) - 1) < 1e-6:  # on no ridge
            assert gradient == pytest.approx(slopes, abs=1e-3)
        inside += found < 0
    assert inside > 10


def test_a_half_space_is_solid_behind_its_plane():
    nearest = NearestShape([ws.HalfSpace(point_m=(0, 0, 0.5), normal=(0, 3, 4))])
    for point in np.random.default_rng(1).uniform(-1, 1, (20, 3)):
        distance, gradient = nearest.at(point)
        assert distance == pytest.approx(0.6 * point[1] + 0.8 * (point[2] - 0.5), abs=1e-12)
        assert gradient == pytest.approx([0, 0.6, 0.8])


def test_the_nearest_of_several_counts():
    nearest = NearestShape(
        [ws.HalfSpace(), ws.Sphere(position_m=(0, 0, 1), radius_m=0.2), ws.HalfSpace(normal=(1, 0, 0))]
    )
    for point, expected, direction in (
        ((0.5, 0, 0.1), 0.1, (0, 0, 1)),
        ((0.5, 0, 1.0), 0.3, (1, 0, 0)),
        ((0.1, 0, 0.5), 0.1, (1, 0, 0)),
    ):
        distance, gradient = nearest.at(np.array(point))
        assert distance == pytest.approx(expected, abs=1e-9) and gradient == pytest.approx(direction, abs=1e-6)


def test_far_from_all_is_far():
    for shapes in ([], [ws.Sphere(radius_m=1)]):
        distance, gradient = NearestShape(shapes).at(np.array([2 * FAR, 0, 0]))
        assert distance == FAR and not gradient.any()


def test_a_closed_mesh_pushes_as_the_solid_that_it_is(tmp_path):
    solid = manifold3d.Manifold.sphere(0.3, 24) - manifold3d.Manifold.sphere(0.25, 24).translate((0, 0, 0.1))
    vertices, faces = mesh_of(solid)
    vertices = vertices.astype(np.float32).astype(float)
    trimesh.Trimesh(vertices, faces).export(tmp_path / "bowl.stl")
    item = ws.Mesh(tmp_path / "bowl.stl", position_m=(1, 0, 0), rpy_deg=(30, 0, 0))
    shapes = [each.shape for each in shapes_around([item, ws.Sphere(radius_m=0.1, position_m=(2, 0, 0))])]
    nearest, T = NearestShape(shapes), item.matrix()
    points = np.random.default_rng(0).uniform(-0.4, 0.4, (60, 3))
    for point, within in zip(points, inside(solid, points), strict=True):
        feet = trimesh.triangles.closest_point(vertices[faces], np.tile(point, (len(faces), 1)))
        away = point - feet[np.linalg.norm(feet - point, axis=1).argmin()]
        side = -1 if within else 1
        distance, gradient = nearest.at(T[:3, :3] @ point + T[:3, 3])
        assert distance == pytest.approx(side * np.linalg.norm(away), abs=1e-9)
        assert np.allclose(gradient, T[:3, :3] @ away * side / np.linalg.norm(away), atol=1e-6)
    assert nearest.at(np.array([2, 0, 0.3]))[0] == pytest.approx(0.2, abs=1e-6)


def test_too_many_pieces_are_refused():
    with pytest.raises(InputError, match=r"^items: are 501 shapes and convex pieces; at most 500 may push"):
        NearestShape([ws.Sphere(radius_m=1)] * 501)


@pytest.mark.parametrize("ending", ["stl", "ply", "obj"])
def test_a_mesh_of_a_file_is_its_convex_hull(tmp_path, ending):
    """An L in millimetres; what is between its legs belongs to the hull."""
    parts = [trimesh.creation.box((300, 100, 100)), trimesh.creation.box((100, 300, 100))]
    parts[1].apply_translation((-100, 100, 0))
    trimesh.util.concatenate(parts).export(tmp_path / f"part.{ending}")
    nearest = NearestShape([ws.Mesh(tmp_path / f"part.{ending}", length_unit_m=0.001, position_m=(1, 0, 0))])
    assert nearest.at(np.array([1.25, 0, 0]))[0] == pytest.approx(0.1, abs=1e-6)
    between = np.array([1.1, 0.1, 0])  # 50 mm inside each of the hull's level faces, nearer to none
    assert nearest.at(between)[0] < 0


@pytest.mark.parametrize(
    ("write", "message"),
    [
        (None, r"items\.1\.path: .*part\.stl cannot be read: No such file"),
        (b"solid\nnothing", r"items\.1\.path: .*part\.stl cannot be read as a mesh"),
    ],
)
def test_files_that_are_no_mesh_are_refused(tmp_path, write, message):
    if write is not None:
        (tmp_path / "part.stl").write_bytes(write)
    with pytest.raises(InputError, match=message):
        NearestShape([ws.HalfSpace(), ws.Mesh(tmp_path / "part.stl")])


def test_a_flat_mesh_is_refused():
    flat = ws.Mesh(vertices_m=[(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)])
    with pytest.raises(InputError, match=r"^items\.0\.vertices_m: enclose no volume"):
        NearestShape([flat])
