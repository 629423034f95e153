"""Boundaries of spatial arms in patches, against closed forms."""

from collections import Counter

import numpy as np
import pytest
import trimesh

import wsrender as ws
from tests.geometry.spatial_arms import (
    arm_of,
    boundary_of,
    box,
    elbow,
    general,
    lipped,
    robot,
    scara,
    spherical,
    turning,
)
from wsrender.geometry.spatial.cells import CellLattice
from wsrender.geometry.spatial.critical_sets import critical_sets

PI = np.pi


def kinds(found):
    return Counter(patch.kind for patch in found.patches)


def generator(patch):
    return " or ".join(", ".join(stop.text for stop in each.stops) or "singular" for each in patch.sets)


def areas(found):
    return {generator(patch): float(area) for patch, area in zip(found.patches, found.measures.areas, strict=True)}


@pytest.fixture(scope="module")
def spherical_boundary():
    return boundary_of(spherical(), 32)


def test_spherical_arm_has_two_spheres_two_cones_two_planes(spherical_boundary):
    found = spherical_boundary
    assert kinds(found) == {"sphere": 2, "cone": 2, "plane": 2}
    assert found.volume == pytest.approx(80.107913632, rel=1e-9)
    assert found.measures.volume == pytest.approx(found.volume, rel=1e-8)
    by = {generator(patch): patch.fit.primitive for patch in found.patches}
    assert by["joint3 upper"].radius == pytest.approx(4, rel=1e-12)
    assert by["joint3 lower"].radius == pytest.approx(2, rel=1e-12)
    assert by["joint2 lower"].half_angle == pytest.approx(PI / 3, rel=1e-12)
    assert by["joint2 lower"].axis == pytest.approx([0, 0, -1], abs=1e-12)
    assert by["joint2 upper"].half_angle == pytest.approx(PI / 6, rel=1e-12)
    for limit in ("lower", "upper"):
        assert np.abs(by[f"joint1 {limit}"].axis) == pytest.approx([1, 0, 0], abs=1e-12)
        assert by[f"joint1 {limit}"].point[0] == pytest.approx(0, abs=1e-12)
    for patch in found.patches:
        assert patch.method == "critical_set" and patch.fit.residual < 1e-12


def test_areas_of_the_spherical_arm(spherical_boundary):
    zone, sector = PI * (np.sin(PI / 3) + np.sin(PI / 6)), PI / 4 * (16 - 4)
    expected = {
        "joint3 upper": 16 * zone,
        "joint3 lower": 4 * zone,
        "joint2 lower": PI / 2 * np.sin(PI / 3) * (16 - 4),
        "joint2 upper": PI / 2 * np.sin(PI / 6) * (16 - 4),
        "joint1 lower": sector,
        "joint1 upper": sector,
    }
    assert areas(spherical_boundary) == pytest.approx(expected, rel=2e-6)


def test_edges_and_corners_of_the_spherical_arm(spherical_boundary):
    edges, corners = spherical_boundary.edges, spherical_boundary.corners
    assert Counter(edge.kind for edge in edges) == {"circle": 8, "line": 4}
    lengths = [2.0] * 4 + [R * PI / 2 for R in (2, 2, 4, 4)]
    lengths += [PI * R * cosine for R in (2, 4) for cosine in (np.cos(PI / 6), np.cos(PI / 3))]
    assert sorted(edge.length for edge in edges) == pytest.approx(sorted(lengths), rel=1e-9)
    assert all(edge.angle == pytest.approx((PI / 2, PI / 2), abs=1e-9) for edge in edges)
    assert {len(edge.corners) for edge in edges} == {2} and {len(corner.patches) for corner in corners} == {3}
    places = [
        (0, side * d * np.cos(elevation), d * np.sin(elevation))
        for side in (-1, 1)
        for d in (2, 4)
        for elevation in (-PI / 6, PI / 3)
    ]
    apart = np.linalg.norm(np.array([corner.point for corner in corners])[:, None] - np.array(places), axis=2)
    assert len(corners) == 8 and (apart.min(axis=0) < 1e-9).all()


def test_slides_bound_a_box():
    found = boundary_of(box())
    assert kinds(found) == {"plane": 6}
    assert found.volume == pytest.approx(0.084, rel=1e-12)
    assert found.measures.volume == pytest.approx(0.084, rel=1e-12)
    assert sorted(found.measures.areas) == pytest.approx([0.12, 0.12, 0.21, 0.21, 0.28, 0.28], rel=1e-12)
    assert sorted(edge.length for edge in found.edges) == pytest.approx([0.3] * 4 + [0.4] * 4 + [0.7] * 4, rel=1e-12)
    assert len(found.corners) == 8


def test_an_elbow_reaches_a_shell_bounded_by_its_singular_configurations():
    found = boundary_of(elbow())
    assert {generator(patch) for patch in found.patches} == {"singular"}
    assert [patch.fit.primitive.radius for patch in found.patches] == pytest.approx([1.6, 0.4], rel=1e-12)
    assert found.measures.areas == pytest.approx([4 * PI * 1.6**2, 4 * PI * 0.4**2], rel=1e-4)
    assert found.measures.volume == pytest.approx(4 * PI / 3 * (1.6**3 - 0.4**3), rel=1e-6)
    assert found.edges == [] and found.corners == []


def test_scara_is_bounded_by_planes_and_cylinders_to_the_ends_of_its_thin_parts():
    found = boundary_of(scara(), 32)
    assert kinds(found) == {"cylinder": 4, "plane": 2}
    cosines = np.cos(np.radians([20, 150]))
    radii = np.sqrt(0.3**2 + 0.2**2 + 2 * 0.06 * cosines)
    assert sorted({round(patch.fit.primitive.radius, 12) for patch in found.patches} - {0.0}) == pytest.approx(
        sorted([0.2, *radii])
    )
    base = 0.06 * np.radians(120) * (cosines[0] - cosines[1])
    expected = {
        "joint3 lower": base,
        "joint3 upper": base,
        "joint2 lower": 0.2 * radii[0] * np.radians(120),
        "joint2 upper": 0.2 * radii[1] * np.radians(120),
        "joint1 lower": 0.2 * 0.2 * np.radians(130),
        "joint1 upper": 0.2 * 0.2 * np.radians(130),
    }
    assert areas(found) == pytest.approx(expected, rel=1e-5)
    assert found.volume == pytest.approx(0.2 * base, rel=1e-9)
    assert found.measures.volume == pytest.approx(0.2 * base, rel=1e-6)
    assert (len(found.edges), len(found.corners)) == (12, 8)


def test_articulated_arm_of_the_library():
    """Where the stretched arm meets the shoulder's limit its sphere and torus touch: an edge of no angle."""
    found = boundary_of(ws.load_robot("articulated"), 48)
    assert set(kinds(found)) == {"sphere", "torus", "plane"}
    assert found.volume == pytest.approx(0.03348, abs=1e-5)  # DEFINITIONS 6, four digits
    assert found.measures.volume == pytest.approx(found.volume, rel=1e-4)
    tori = [patch.fit.primitive for patch in found.patches if patch.kind == "torus"]
    for torus in tori:
        assert (torus.radius, torus.tube_radius) == pytest.approx((0.2 * np.cos(PI / 4), 0.2), rel=1e-9)
    touching = [edge for edge in found.edges if edge.kind == "circle" and edge.angle[0] > PI - 1e-6]
    assert touching[0].radius == pytest.approx(0.4 * np.cos(PI / 4), rel=1e-9)
    assert touching[0].length == pytest.approx(0.4 * np.cos(PI / 4) * PI / 2, rel=1e-6)


def test_general_arm_is_free_form_and_no_primitive_is_forced():
    found = boundary_of(general(((-100, 100), (-60, 80), (20, 130))), 24)
    free = [patch for patch in found.patches if patch.kind == "free_form"]
    assert free and all(patch.fit.residual > 1e-6 for patch in free if patch.fit is not None)
    assert found.measures.volume == pytest.approx(found.volume, rel=1e-2)


def test_triangles_of_thin_parts_do_not_jump_to_another_sheet():
    """A long triangle across a fold met the sheet beyond it: a fourth of the volume was lost."""
    rows = [
        {"a": 0.149, "alpha_deg": 90, "d": 0.106, "limits_deg": (-121, 169)},
        {"joint": "prismatic", "a": 0.147, "alpha_deg": 60, "limits": (0.179, 0.424)},
        {"a": 0.286, "d": 0.1, "limits_deg": (-100, 138)},
    ]
    found = boundary_of(robot(rows, "RPR", "standard"), 24)
    assert found.measures.volume == pytest.approx(found.volume, rel=0.1)


def test_a_sheet_that_bends_back_does_not_end_in_the_curve_beyond():
    """The surface of the slide's stop crosses the lip's lower plane twice; its joints stop at one of both curves."""
    found = boundary_of(lipped(30), 48)
    assert found.measures.volume == pytest.approx(found.volume, rel=1e-5)


def test_planes_more_go_through_lips_thinner_than_a_cell():
    found = boundary_of(lipped(10), 48)  # 4.6 mm, an eighth of a cell
    assert found.volume == pytest.approx(0.403129, abs=1e-6) and found.width == pytest.approx(0.0354, abs=1e-4)
    assert found.measures.volume == pytest.approx(found.volume, rel=1e-4)
    mesh = trimesh.Trimesh(found.mesh.vertices, found.mesh.faces, process=False)
    assert mesh.is_watertight and mesh.volume == pytest.approx(found.volume, rel=1e-3)
    lips = {generator(patch): patch.kind for patch in found.patches if "joint3" in generator(patch)}
    assert lips == {"joint3 lower": "plane", "joint3 upper": "plane"}


def test_planes_more_bring_the_volume_nearer_where_cells_are_wide(monkeypatch):
    coarse = boundary_of(lipped(10), 12).measures.volume
    monkeypatch.setattr("wsrender.geometry.spatial.spatial_boundary._DIFFERS", np.inf)
    assert abs(boundary_of(lipped(10), 12).measures.volume - 0.403129) > 2 * abs(coarse - 0.403129)


def test_where_planes_more_make_it_worse_the_lattice_is_kept(monkeypatch):
    def coarser(lattice, planes, reaches, report):
        low, high = np.transpose([axis[[0, -1]] for axis in lattice.axes])
        return CellLattice.around(low, high, 6, reaches, report)

    monkeypatch.setattr(CellLattice, "divided", coarser)
    kept = boundary_of(lipped(30), 24)
    monkeypatch.setattr("wsrender.geometry.spatial.spatial_boundary._DIFFERS", np.inf)
    assert kept.measures.volume == boundary_of(lipped(30), 24).measures.volume


def test_crossings_that_no_critical_set_explains_are_kept_as_they_are(monkeypatch):
    """Without the sets of the singular configurations an elbow's shell is free form, from its points alone."""
    monkeypatch.setattr("wsrender.geometry.spatial.spatial_boundary.critical_sets", lambda arm: [])
    found = boundary_of(elbow(), 12)
    assert {patch.method for patch in found.patches} == {"fitted"}
    assert {patch.kind for patch in found.patches} == {"free_form"}
    assert found.measures.volume == pytest.approx(found.volume, rel=0.1)


def test_meetings_with_critical_sets_are_on_them():
    """Points found on lines: the Jacobian of the free joints has rank 2, and its normal is the one returned."""
    arm = arm_of(general(((-100, 100), (-60, 80), (20, 130))))
    rng = np.random.default_rng(4)
    for each in critical_sets(arm):
        start = arm.low + (arm.high - arm.low) * rng.random((200, 3))
        origin = arm.position(each.held(start))
        direction = rng.normal(size=(200, 3))
        found = each.meet(origin, direction, start)
        good = np.isfinite(found.s)
        assert good.mean() > 0.25
        p, J, _ = arm.motion(found.d[good])
        assert p == pytest.approx(origin[good] + found.s[good, None] * direction[good], abs=1e-9)
        flat = np.einsum("ni,nij->nj", found.normal[good], J[:, :, each.free])
        assert np.abs(flat).max() < 1e-8 * arm.size
        for stop in each.stops:
            assert (found.d[good, stop.joint] == stop.at).all()


@pytest.mark.parametrize(
    ("subject", "message"),
    [
        ("scara", "on a surface or curve only"),
        (robot([turning(a=1), turning(a=1, alpha_deg=90)], "two", "standard"), "2 joints move the end point"),
        (robot([turning(a=1)] * 3, "planar", "standard"), "it fills no volume"),
    ],
    ids=["fills no volume", "two joints", "planar"],
)
def test_other_arms_are_refused(subject, message):
    with pytest.raises(ws.ModelError, match=message):
        arm_of(ws.load_robot(subject) if isinstance(subject, str) else subject)
