from dataclasses import replace

import numpy as np
import pytest
import trimesh

import wsrender as ws
from tests.mechanisms.ball_regions import region
from wsrender.analyses.boundary_patches.pictures import faces_of_patches
from wsrender.errors import InputError
from wsrender.mechanisms.ball_region import surface_table
from wsrender.mechanisms.exact import ExactWorkspace
from wsrender.results.drawing.camera import Camera
from wsrender.results.drawing.depth import DepthBuffer
from wsrender.results.drawing.faces import faces_of, leg_numbers
from wsrender.results.drawing.faces_of_surface import in_sight, shaded, surface_faces
from wsrender.volume.table import Table

LENS = region([(0, 0, 0, 1), (1, 0, 0, 1)])  # two unit balls: two caps that share one circle


@pytest.fixture(scope="module")
def published():
    """The 6-PUS of DEFINITIONS section 9: 18 vertices, 27 edges, 11 faces."""
    return ws.parallel_workspace("six_pus", method="exact", device="cpu")


def test_faces_and_corners_are_those_of_the_exact_topology(published):
    faces = faces_of(published.meshes["workspace"], published.tables["surfaces"])
    sides, corners = faces.borders()
    assert len(faces.labels) == 11 and len(corners) == 18
    vertices = published.tables["vertices"]["position"]
    nearest = np.linalg.norm(faces.vertices[corners][:, None] - vertices, axis=2).min(axis=1)
    assert nearest.max() < 1e-9
    assert len(set(faces.colors.values())) == 11
    # Where the two faces of an edge lie, both legs are at a limit: the ends of sides lie on both balls.
    table, number = published.tables["surfaces"], faces.number
    on = {k: set(faces.triangles[number == k].ravel().tolist()) for k in faces.labels}
    for k, vertices_of in on.items():
        points = faces.vertices[sorted(vertices_of & set(sides.ravel().tolist()))]
        distance = np.linalg.norm(points - table["center"][k], axis=1)
        np.testing.assert_allclose(distance, table["radius"][k], rtol=1e-9)


def test_the_edge_of_a_lens_is_its_circle_and_half_of_it_is_in_sight():
    exact = ExactWorkspace.of(LENS)
    faces = faces_of(exact.mesh, surface_table(LENS, exact.measures.area[0], np.eye(4)))
    sides, corners = faces.borders()
    middles = faces.vertices[sides].mean(axis=1)
    assert len(corners) == 0 and list(faces.labels.values()) == ["inside ball 0", "inside ball 1"]
    np.testing.assert_allclose(faces.vertices[sides][..., 0], 0.5, atol=1e-9)
    np.testing.assert_allclose(np.hypot(*faces.vertices[sides][:, 0, 1:].T), np.sqrt(0.75), atol=1e-9)
    above = in_sight(middles, faces, np.array([0.0, 0.0, 1.0]))
    np.testing.assert_array_equal(above[np.abs(middles[:, 2]) > 0.1], middles[np.abs(middles[:, 2]) > 0.1, 2] > 0)
    assert in_sight(middles, faces, np.array([1.0, 0.0, 0.0])).all()  # along the axis the whole rim


def test_a_picture_names_every_face_and_a_mesh_without_faces_has_one_colour(published):
    figure = published.plot.surface()
    texts = [text.get_text() for text in figure.legends[0].texts]
    assert len(texts) == 11 + 2 and {"leg 1 at its upper limit", "leg 6 at its lower limit", "edge", "vertex"} <= {
        *texts
    }
    for axes in figure.axes:
        assert {"x [m]", "y [m]", "z [m]"} <= {text.get_text() for text in axes.texts}
    plain = faces_of(trimesh.creation.box(), None)
    assert len(plain.borders()[0]) == 0 and not surface_faces(plain).legends[0].texts
    with pytest.raises(InputError, match="has no triangles"):
        surface_faces(faces_of(trimesh.Trimesh(), None))
    with pytest.raises(InputError, match="the result has no 'other'; it holds workspace"):
        published.plot.surface("other")


def slivers():
    """A part of a unit sphere around (1, 2, 3) whose triangles are long and thin, and the table that knows it."""
    angle = np.linspace(0.2, 1.3, 60)
    rim = [
        np.column_stack([np.sin(t) * np.cos(angle), np.sin(t) * np.sin(angle), np.full(60, np.cos(t))])
        for t in (0.5, 1)
    ]
    k = np.arange(59)
    triangles = np.concatenate([np.column_stack([k, k + 60, k + 1]), np.column_stack([k + 1, k + 60, k + 61])])
    mesh = trimesh.Trimesh(np.concatenate(rim) + np.array([1, 2, 3]), triangles, process=False)
    mesh.face_attributes["surface"] = np.zeros(len(triangles), np.int64)
    nan = np.array([np.nan])
    columns = {"kind": np.array(["sphere"]), "point": np.array([[1.0, 2, 3]]), "axis": np.full((1, 3), np.nan)}
    numbers = {"radius_m": np.array([1.0]), "tube_radius_m": nan, "half_angle_rad": nan}
    return mesh, Table(columns | numbers | {"generated_by": np.array(["joint1 upper"])})


def test_a_smooth_patch_is_lit_smoothly_however_its_triangles_lie():
    mesh, table = slivers()
    faces = faces_of_patches(mesh, table)
    np.testing.assert_allclose(faces.normals, faces.corners - [1, 2, 3], atol=1e-9)


def test_brightness_changes_smoothly_within_a_face():
    ball = trimesh.creation.icosphere(2, 1.0)
    ball.face_attributes["surface"] = np.zeros(len(ball.faces), np.int64)
    faces = replace(faces_of(ball, None), labels={0: "ball"})
    camera = Camera(np.zeros(3), np.array([0.0, 1, 0]), np.array([0.0, 0, 1]), 1.2)
    corners, colors = shaded(faces, camera)
    image = DepthBuffer.of(camera, (200, 200), corners).image(colors)
    bright = image[50:150, 50:150, 0]
    assert np.ptp(bright) > 0.1 and np.abs(np.diff(bright, axis=0)).max() < 0.02


def test_the_faces_of_a_saved_result_are_those_of_the_result(published, tmp_path):
    published.save(tmp_path)
    assert {path.name for path in (tmp_path / "plots").iterdir()} == {"surface.png", "robot.png"}
    again = ws.Result.load(tmp_path)
    found, expected = (result.meshes["workspace"].face_attributes["surface"] for result in (again, published))
    np.testing.assert_array_equal(found, expected)


def test_legs_are_counted_from_one(published):
    """Tables of version 0.1 counted from 0, with −1 for none: their pictures name the same legs as new ones."""
    assert sorted(set(published.tables["surfaces"]["leg"].tolist())) == [0, 1, 2, 3, 4, 5, 6]  # 0: the plane z = 0
    new = Table({"leg": np.array([1, 2, 1, 0]), "limit": np.array(["upper", "upper", "lower", ""])})
    old = Table({"leg": np.array([0, 1, 0, -1]), "limit": np.array(["upper", "upper", "lower", ""])})
    balls = Table({"leg": np.array([-1, -1]), "limit": np.array(["", ""])})
    assert leg_numbers(new).tolist() == leg_numbers(old).tolist() == [1, 2, 1, 0]
    assert leg_numbers(balls).tolist() == [0, 0]


OUTLINE = 2.9  # height (zorder) at which it is drawn


def test_the_outline_of_a_smooth_surface_is_whole():
    """No edge lies where a ball turns away from the eye: its outline is drawn all the same, as one closed line."""
    ball = trimesh.creation.icosphere(subdivisions=4, radius=0.5)
    figure = surface_faces(faces_of(ball, None))
    for axes in figure.axes:
        (outline,) = (each for each in axes.collections if each.get_zorder() == OUTLINE)
        (path,) = outline.get_paths()
        line = path.vertices
        np.testing.assert_array_equal(line[0], line[-1])
        radius = np.linalg.norm(line - (line.max(axis=0) + line.min(axis=0)) / 2, axis=1)
        assert np.ptp(radius) < 0.02 * radius.mean()
        around = np.sort(np.arctan2(*(line - line.mean(axis=0)).T))
        assert np.diff(around).max() < 0.1
