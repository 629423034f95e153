"""The analysis five_bar: its document, tables and maps, from Python and from a job document."""

import json
import math

import numpy as np
import pytest

import wsrender as ws
from wsrender.analyses.five_bar.presentation import MODE_VOLUMES
from wsrender.mechanisms.five_bar import WORKING_MODES, conditioning
from wsrender.run import execute

SMALL = {"voxel_size_m": 0.4, "joint_steps": 40}
CB = {"analysis": "five_bar", "base_m": 6, "proximal_m": 8, "distal_m": 5, **SMALL}


@pytest.fixture(scope="module")
def result():
    return execute(
        {**CB, "points_m": [[5, 7], [50, 0]], "joint_angles_rad": [[math.pi / 2, math.pi / 2], [math.pi, 0]]}
    )


def by_mode(entries):
    return {entry["working_mode"]: entry for entry in entries}


def test_known_values(result):
    document = result.document
    headline = document["headline"]
    assert headline["value"] == pytest.approx(319.776382597, abs=5e-10) and headline["ci95"] == [headline["value"]] * 2
    assert (headline["quantity"], headline["unit"], headline["reason"]) == ("area", "m2", "")
    for mode, entry in by_mode(document["workspaces"]).items():
        assert entry["area_m2"] == pytest.approx(319.776382597, abs=5e-10)
        own = [each["area_m2"] for each in document["aspects"] if each["working_mode"] == mode]
        assert sum(own) == pytest.approx(entry["area_m2"], abs=1e-7)
    kappas = {mode: entry["kappa_a"] for mode, entry in by_mode(document["points"][:4]).items()}
    assert kappas == pytest.approx(
        {"++": 1.777380134, "+-": 1.265642333, "-+": 10.668177061, "--": 3.921855162}, abs=5e-10
    )
    assert [entry["reachable"] for entry in document["points"]] == [True] * 4 + [False] * 4
    assert [entry["position_m"] for entry in document["assemblies"][:2]] == [
        pytest.approx([3, 12]),
        pytest.approx([3, 4]),
    ]
    assert [entry["kappa_a"] for entry in document["assemblies"][:2]] == pytest.approx([4 / 3, 4 / 3])
    assert [entry["reachable"] for entry in document["assemblies"]] == [True, True, False, False]
    json.dumps(document, allow_nan=False)


def test_maps_hold_the_conditioning_at_the_centres_of_their_voxels(result):
    five_bar = ws.FiveBar.symmetric(6, 8, 5)
    for mode in WORKING_MODES:
        volume = result.volumes[MODE_VOLUMES[mode]]
        x, y = np.meshgrid(volume.centers(0), volume.centers(1), indexing="ij")
        angles = five_bar.inverse_kinematics(np.stack([x.ravel(), y.ravel()], axis=1), mode)
        expected = conditioning(five_bar, angles)
        values = volume.statistics["value"]
        for name in ("inverse_kappa_a", "inverse_kappa_b", "inverse_kappa_j", "det_a", "det_b"):
            np.testing.assert_array_equal(values[name].ravel(), getattr(expected, name))
        np.testing.assert_array_equal(volume.occupied.ravel(), ~np.isnan(angles[:, 0]))
        left, right = np.hypot(x, y), np.hypot(x - 6, y)
        near = (left >= 3) & (left <= 13) & (right >= 3) & (right <= 13)
        np.testing.assert_array_equal(volume.occupied[:, :, 0], near)


def test_joint_space_holds_every_posture_of_the_lattice_once(result):
    table, five_bar = result.tables["joint_space"], ws.FiveBar.symmetric(6, 8, 5)
    for assembly in "+-":
        rows = table["assembly_mode"] == assembly
        assert len(np.unique(table["cell"][rows], axis=0)) == np.count_nonzero(rows)
        again = five_bar.forward_kinematics(table["theta"][rows], assembly)
        np.testing.assert_array_equal(again, table["position"][rows])
    gap = five_bar.elbows(table["theta"])
    assert (np.hypot(*(gap[:, 0] - gap[:, 1]).T) <= 10 + 1e-12).all()
    for mode in WORKING_MODES:
        rows = table["working_mode"] == mode
        angles = five_bar.inverse_kinematics(table["position"][rows], mode)
        np.testing.assert_allclose(np.cos(angles[:, :2] - table["theta"][rows]), 1, atol=1e-9)
        values = conditioning(five_bar, angles)
        np.testing.assert_allclose(values.inverse_kappa_j, table["inverse_kappa_j"][rows], atol=1e-6)


def test_iso_curves_lie_on_their_levels(result):
    table, five_bar = result.tables["iso_curves"], ws.FiveBar.symmetric(6, 8, 5)
    assert set(table["level"]) == {1.25, 1.5, 2.0, 3.0, 5.0, 10.0}
    assert set(table["quantity"]) == {"kappa_a", "kappa_b", "kappa_j"}
    for mode in WORKING_MODES:
        for quantity in ("kappa_a", "kappa_b", "kappa_j"):
            rows = (table["working_mode"] == mode) & (table["quantity"] == quantity)
            found = conditioning(five_bar, five_bar.inverse_kinematics(table["position"][rows], mode))
            np.testing.assert_allclose(getattr(found, f"inverse_{quantity}") * table["level"][rows], 1, atol=2e-8)


def test_loci_have_their_determinants_and_conditions(result):
    table, five_bar = result.tables["loci"], ws.FiveBar.symmetric(6, 8, 5)
    assert set(table["kind"]) == {"type_1", "type_2", "least_kappa_a", "isotropic_b", "isotropic_j"}
    for mode in WORKING_MODES:
        rows = table["working_mode"] == mode
        values = conditioning(five_bar, five_bar.inverse_kinematics(table["position"][rows], mode))
        kinds = table["kind"][rows]
        assert np.abs(values.det_a[kinds == "type_2"] / 25).max() < 1e-6  # the mode ends in these curves' ends
        assert np.abs(values.det_b[kinds == "type_1"] / 1600).max() < 1e-6
        inside = np.abs(values.det_b / 1600) > 1e-6  # positions do not tell the postures at the boundary
        for kind in ("least_kappa_a", "isotropic_b", "isotropic_j"):
            found = getattr(values, f"inverse_kappa_{kind[-1]}")[(kinds == kind) & inside]
            assert np.abs(found - 1).max() < 1e-6


def test_a_saved_result_draws_the_same_pictures(result, tmp_path):
    result.save(tmp_path)
    names = {f"kappa_{matrix}_{space}.png" for matrix in "abj" for space in ("cartesian", "joint")}
    assert {path.name for path in (tmp_path / "plots").iterdir()} == {*names, "aspects.png"}
    again = ws.Result.load(tmp_path)
    figure = again.plot.conditioning("a")
    panels = [axes for axes in figure.axes if axes.get_title()]
    assert [axes.get_title() for axes in panels] == [f"working mode {s}" for s in ("++", "+−", "−+", "−−")]
    assert {axes.get_xlabel() for axes in panels} == {"x [m]"} and {axes.get_ylabel() for axes in panels} == {"y [m]"}
    assert figure.axes[-1].get_ylabel() == "Condition number κ(A)"
    assert "κ = 1.25, 1.5, 2, 3, 5, 10" in [text.get_text() for text in figure.legends[0].texts]
    (image,) = panels[1].images
    np.testing.assert_array_equal(
        np.ma.filled(image.get_array(), np.nan).T,
        result.volumes["plus_minus"].statistics["value"]["inverse_kappa_a"][:, :, 0],
    )
    joint = again.plot.conditioning("j", "joint")
    assert [axes.get_xlabel() for axes in joint.axes[4:8]] == ["θ1 [rad]"] * 4
    _check_aspects(again)
    for arguments in (("c", "cartesian"), ("a", "plane")):
        with pytest.raises(ws.InputError, match="is not allowed"):
            again.plot.conditioning(*arguments)


def test_nothing_reached_is_a_result(tmp_path):
    found = ws.five_bar(ws.FiveBar.symmetric(10, 1, 1), voxel_size_m=0.1, joint_steps=20, points_m=[[5, 0]])
    assert [entry["area_m2"] for entry in found.document["workspaces"]] == [0.0] * 4
    assert found.document["aspects"] == [] and not found.document["points"][0]["reachable"]
    found.save(tmp_path)
    assert (tmp_path / "plots" / "kappa_a_joint.png").exists()


def test_limits_and_modes_from_python():
    limited = ws.FiveBar(1.0, (0.7, 0.9), (1.2, 0.8), ((-1.0, 2.0), None))
    found = ws.five_bar(limited, working_modes=["-+"], voxel_size_m=0.05, joint_steps=36)
    assert [entry["working_mode"] for entry in found.document["workspaces"]] == ["-+"]
    assert list(found.volumes) == ["minus_plus"]
    assert "joint_limit" in set(found.tables["loci"]["kind"])
    theta = found.tables["joint_space"]["theta"]
    assert theta[:, 0].min() > -1 and theta[:, 0].max() < 2
    assert execute(found.document["job"]).document["aspects"] == found.document["aspects"]
    assert "working mode -+" in found.summary()
    assert found.document["headline"]["value"] == found.document["workspaces"][0]["area_m2"]
    several = ws.five_bar(limited, voxel_size_m=0.2, joint_steps=12).document
    assert len({entry["area_m2"] for entry in several["workspaces"]}) > 1
    assert several["headline"]["value"] is None and "working mode" in several["headline"]["reason"]


def test_progress_ends_at_all_cells():
    calls = []
    execute(CB, progress=lambda *call: calls.append(call))
    totals = {total for _, total, message in calls if message == "samples"}
    assert len(totals) == 1 and calls[-1][:2] == (totals.pop(),) * 2


def _check_aspects(result):
    """A colour is one assembly mode in every panel, named once, below all; panels list areas."""
    figure = result.plot.aspects()
    (legend,) = figure.legends
    named = {
        text.get_text(): patch.get_facecolor() for text, patch in zip(legend.texts, legend.get_patches(), strict=False)
    }
    assert set(named) == {"assembly mode +", "assembly mode −"} and len(set(named.values())) == 2
    outlines = result.tables["aspect_outlines"]
    for mode, axes in zip(("++", "+-", "-+", "--"), figure.axes, strict=True):
        own = outlines["working_mode"] == mode
        _, first = np.unique(outlines["aspect"][own], return_index=True)
        signs = outlines["assembly_mode"][own][first]
        expected = [named[f"assembly mode {'+' if sign == '+' else '−'}"] for sign in signs]
        assert [patch.get_facecolor() for patch in axes.patches] == expected
        listed = axes.get_legend()
        assert [text.get_text() for text in listed.texts] == [f"{a:.5g} m²" for a in outlines["area"][own][first]]
        assert [patch.get_facecolor() for patch in listed.get_patches()] == expected
