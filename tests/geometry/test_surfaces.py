"""The surfaces of a result: volumes against closed forms, with the error of each kind stated."""

import numpy as np
import pytest

import wsrender as ws
from tests.geometry.solids import BALL, SHELL, TORUS, in_ball, in_shell, in_torus, uniform_points, voxels_of
from tests.run.simple_robots import PLANAR, gantry, planar_arm
from wsrender.documents.options import AlphaShapeSurface
from wsrender.geometry.surfaces import occupied_surface, surfaces
from wsrender.results.result import Result

ALL = ["marching_cubes", {"alpha_shape": 0.1}, "convex_hull", {"iso_surface": "manipulability", "fraction": 0.5}]
LINEAR = {"indices": ["manipulability", "inverse_condition_number"], "device": "cpu"}


@pytest.mark.parametrize(
    ("inside", "exact"), [(in_ball, BALL), (in_shell, SHELL), (in_torus, TORUS)], ids=["ball", "shell", "torus"]
)
def test_marching_cubes_of_solids(inside, exact):
    """Voxels of .02 m: within 1 %, and closed."""
    mesh = occupied_surface(voxels_of(inside, 0.02))
    assert mesh.is_volume
    assert mesh.volume == pytest.approx(exact, rel=0.01)


def test_hull_of_a_ball_of_points():
    """Too small by the share of a hull of N uniform points, about 3.4 N^(-1/2)."""
    points = uniform_points(in_ball, 10_000)
    meshes, entries = surfaces(["convex_hull"], voxels_of(in_ball, 0.1), points)
    assert meshes["convex_hull"].is_volume
    assert -0.05 * BALL < entries["convex_hull"]["volume_m3"] - BALL < 0
    assert entries["convex_hull"]["area_m2"] == pytest.approx(4 * np.pi, rel=0.03)
    assert entries["convex_hull"]["points"] == 10_000
    for half in ("one", "other"):
        too_small = BALL - entries["convex_hull"][f"volume_of_{half}_half_m3"]
        assert too_small == pytest.approx(np.sqrt(2) * (BALL - entries["convex_hull"]["volume_m3"]), rel=0.1)


def test_alpha_shapes_of_too_few_points_say_so():
    """Enough points for the radius: both halves agree with the whole; else they fall short with it."""
    points = uniform_points(in_ball, 20_000)
    for alpha, least, most in ((0.3, 0.0, 0.03), (0.05, 0.3, 1.0)):
        asked = AlphaShapeSurface(alpha_shape=alpha)
        entry = surfaces([asked], voxels_of(in_ball, 0.1), points)[1]["alpha_shape"]
        for half in ("one", "other"):
            assert least <= 1 - entry[f"volume_of_{half}_half_m3"] / entry["volume_m3"] <= most


def test_surfaces_of_a_job(tmp_path):
    """A gantry fills a box of .29 × .39 × .19 m, and every cell has the same manipulability."""
    result = ws.analyze(gantry(), ws.Grid([20, 40, 30]), voxel_size_m=0.01, surfaces=ALL, **LINEAR)
    entries = result.document["surfaces"]
    assert list(entries) == ["surface", "alpha_shape", "convex_hull", "iso_manipulability"]
    box = 0.29 * 0.39 * 0.19
    assert entries["alpha_shape"]["volume_m3"] == pytest.approx(box, rel=1e-5)
    assert entries["convex_hull"]["volume_m3"] == pytest.approx(box, rel=1e-5)
    assert entries["alpha_shape"]["alpha_m"] == 0.1
    assert entries["surface"]["volume_m3"] == entries["iso_manipulability"]["volume_m3"]
    assert entries["surface"]["volume_m3"] == pytest.approx(0.3 * 0.4 * 0.2, rel=0.02)
    assert all(entry["watertight"] for entry in entries.values())
    result.save(tmp_path / "out")
    again = Result.load(tmp_path / "out")
    for name, entry in entries.items():
        assert again.meshes[name].volume == pytest.approx(entry["volume_m3"], rel=1e-5)
    assert ws.execute(result.document["job"]).document["surfaces"] == entries


def test_a_planar_workspace_has_no_hull_and_says_so():
    options = {**PLANAR, "voxel_size_m": 0.05, "surfaces": ["convex_hull", {"alpha_shape": 0.1}]}
    result = ws.analyze(planar_arm(), ws.Grid(40), **options)
    assert result.meshes == {}
    for entry in result.document["surfaces"].values():
        assert entry["mesh"] is None
        assert "points in a plane" in entry["reason"]


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        (["cube"], r'surfaces: must be a list of "marching_cubes", .*, not \["cube"\]'),
        ("convex_hull", "surfaces: must be a list, not"),
        ([{"alpha_shape": 0}], r"surfaces.alpha_shape: must be greater than 0, not 0"),
        ([{"alpha_shape": 0.1, "iso_surface": "x"}], "surfaces: must be a list of"),
        ([{"iso_surface": "isotropy", "fraction": 2}], "surfaces.fraction: must be above 0, and at most 1, not 2"),
        ([{"iso_surface": "isotropy"}], "surfaces: 'isotropy' is not among the job's indices: manipulability"),
        (["convex_hull", "convex_hull"], "surfaces: must not ask for a surface twice"),
    ],
)
def test_surfaces_that_do_not_exist(asked, message):
    with pytest.raises(ws.InputError, match=message):
        ws.analyze(gantry(), ws.Grid(3), surfaces=asked, voxel_size_m=0.1, **LINEAR)


def test_surfaces_of_python_enter_documents():
    result = ws.analyze(gantry(), ws.Grid(5), surfaces=[AlphaShapeSurface(alpha_shape=0.2)], voxel_size_m=0.1, **LINEAR)
    assert result.document["job"]["surfaces"] == [{"alpha_shape": 0.2}]
    assert list(result.meshes) == ["alpha_shape"]
