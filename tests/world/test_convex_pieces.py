"""Solids as convex pieces, against manifold3d's volumes and rays through the triangles."""

from collections import OrderedDict

import manifold3d
import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull

from wsrender.documents.shapes import Mesh
from wsrender.errors import InputError
from wsrender.world.convex_pieces import convex_pieces
from wsrender.world.meshes import convex_parts

cube, cylinder = manifold3d.Manifold.cube, manifold3d.Manifold.cylinder
LEG = (0.05, 0.05, 0.5)
SOLIDS = {
    "box": (cube((0.3, 0.2, 0.1)), 1),
    "L": (cube((0.3, 0.1, 0.1)) + cube((0.1, 0.3, 0.1)), 2),
    "bin": (cube((0.4, 0.3, 0.2)) - cube((0.36, 0.26, 0.2)).translate((0.02, 0.02, 0.02)), 5),
    "hollow": (cube((0.4, 0.4, 0.4)) - cube((0.2, 0.2, 0.2)).translate((0.1, 0.1, 0.1)), 6),
    "drilled": (cube((0.4, 0.4, 0.1)) - cylinder(0.3, 0.1, 0.1, 12).translate((0.2, 0.2, -0.1)), 12),
    "two": (cube((0.1, 0.1, 0.1)) + cube((0.1, 0.1, 0.1)).translate((0.5, 0, 0)), 2),
    "table": (
        manifold3d.Manifold.batch_boolean(
            [cube((1, 0.6, 0.05)).translate((0, 0, 0.5))]
            + [cube(LEG).translate((x, y, 0)) for x in (0, 0.95) for y in (0, 0.55)],
            manifold3d.OpType.Add,
        ),
        5,
    ),
}


def mesh_of(solid) -> tuple[np.ndarray, np.ndarray]:
    mesh = solid.to_mesh64()
    return np.array(mesh.vert_properties)[:, :3], np.array(mesh.tri_verts).astype(int)


def inside(solid, points: np.ndarray) -> np.ndarray:
    """By the winding number of the triangles (van Oosterom and Strackee 1983)."""
    vertices, faces = mesh_of(solid)
    a, b, c = (vertices[faces[:, k]][None] - points[:, None] for k in range(3))
    la, lb, lc = (np.linalg.norm(each, axis=-1) for each in (a, b, c))
    over = np.einsum("nfi,nfi->nf", a, np.cross(b, c))
    under = la * lb * lc + (a * b).sum(-1) * lc + (b * c).sum(-1) * la + (c * a).sum(-1) * lb
    return np.arctan2(over, under).sum(axis=1) > np.pi


def held(pieces: list[np.ndarray], points: np.ndarray, by: float = 0.0) -> np.ndarray:
    """Which points (N, 3) a piece holds, grown ``by`` [m]."""
    planes = [ConvexHull(piece).equations for piece in pieces]
    return np.any([(points @ each[:, :3].T + each[:, 3] <= by).all(axis=1) for each in planes], axis=0)


@pytest.mark.parametrize("name", SOLIDS)
def test_pieces_of_solids_with_flat_sides_are_the_solid(name):
    solid, count = SOLIDS[name]
    pieces = convex_pieces(*mesh_of(solid), 1e-3, "path")
    assert len(pieces) == count
    assert sum(ConvexHull(piece).volume for piece in pieces) == pytest.approx(solid.volume(), rel=1e-6)
    low, high = np.array(solid.bounding_box()[:3]), np.array(solid.bounding_box()[3:])
    points = low + (high - low) * np.random.default_rng(0).uniform(-0.1, 1.1, (3000, 3))
    assert np.array_equal(held(pieces, points, 1e-7), inside(solid, points))


@pytest.mark.parametrize("tolerance", [0.1, 0.15])
def test_pieces_of_a_shallow_bowl_hold_it_and_keep_to_the_tolerance(tolerance):
    solid = cube((0.4, 0.4, 0.1)) - manifold3d.Manifold.sphere(1.0, 64).translate((0.2, 0.2, 1.085))
    vertices, faces = mesh_of(solid)
    pieces = convex_pieces(vertices, faces, tolerance, "path")
    points = np.random.default_rng(0).uniform((0, 0, 0.06), (0.4, 0.4, 0.11), (4000, 3))
    within, around = inside(solid, points), held(pieces, points, 1e-7)
    assert (around | ~within).all()
    beyond = points[around & ~within]
    assert len(beyond)
    surface = trimesh.Trimesh(vertices, faces, process=False)
    nearest = trimesh.triangles.closest_point
    far = [np.linalg.norm(nearest(surface.triangles, np.tile(p, (len(faces), 1))) - p, axis=1).min() for p in beyond]
    assert max(far) <= tolerance


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda v, f: (v, f[1:]), "is not closed: 3 edges are not those of two triangles"),
        (lambda v, f: (v * [1, 1, 0], f), "encloses no volume"),
        (lambda v, f: (v * [1e4, 1e-4, 7e-5], f), "too thin for its size, 1000 m, to be cut"),
        (lambda v, f: (v, np.repeat(f, 2000, axis=0)), "has 24000 triangles; a solid may have 5000"),
    ],
)
def test_meshes_that_are_no_solids_are_refused(change, message):
    vertices, faces = change(*mesh_of(cube((0.1, 0.2, 0.3))))
    with pytest.raises(InputError, match=message) as caught:
        convex_pieces(vertices, faces, 1e-3, "path")
    assert caught.value.field == "path"


def test_solids_of_too_many_pieces_are_refused():
    bowl = manifold3d.Manifold.sphere(0.3, 24) - manifold3d.Manifold.sphere(0.25, 24).translate((0, 0, 0.2))
    with pytest.raises(InputError, match=r"takes more than 100 convex pieces that keep to tolerance_m, 0\.001"):
        convex_pieces(*mesh_of(bowl), 1e-3, "path")


def test_a_surface_that_is_inside_out_encloses_the_same():
    vertices, faces = mesh_of(SOLIDS["L"][0])
    pieces = convex_pieces(vertices, faces[:, ::-1], 1e-3, "path")
    assert sum(ConvexHull(piece).volume for piece in pieces) == pytest.approx(SOLIDS["L"][0].volume(), rel=1e-6)


@pytest.mark.parametrize("convex", [True, False])
@pytest.mark.parametrize("corner", [8, -1])
def test_triangles_of_corners_that_are_not_there_are_refused(tmp_path, corner, convex):
    path = tmp_path / "box.ply"
    trimesh.Trimesh(*mesh_of(cube((0.1, 0.2, 0.3)))).export(path, encoding="ascii")
    text = path.read_text().split()
    path.write_text(path.read_text().rstrip().removesuffix(text[-1]) + f"{corner}\n")
    with pytest.raises(InputError, match="names vertices that it does not have") as caught:
        convex_parts(Mesh(path, convex=convex))
    assert caught.value.field == "path"


def test_a_solid_is_cut_once(tmp_path, monkeypatch):
    vertices, faces = mesh_of(SOLIDS["L"][0])
    for name in ("a.stl", "b.stl"):
        trimesh.Trimesh(vertices, faces).export(tmp_path / name)
    calls = []
    monkeypatch.setattr(
        "wsrender.world.convex_pieces.convex_pieces", lambda *given: calls.append(given[2:]) or convex_pieces(*given)
    )
    monkeypatch.setattr("wsrender.world.meshes._PIECES", OrderedDict())
    first, other, coarser = (
        convex_parts(Mesh(tmp_path / name, convex=False, tolerance_m=tolerance))
        for name, tolerance in (("a.stl", None), ("b.stl", 0.001), ("b.stl", 0.002))
    )
    assert first is other
    assert len(first) == len(coarser) == 2
    assert calls == [(0.001, "path"), (0.002, "path")]
