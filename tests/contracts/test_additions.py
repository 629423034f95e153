"""What analyses add to the views of their results, against what their documents and tables say."""

from dataclasses import replace

import numpy as np
import pytest

from wsrender.results.view import parts, view_of


@pytest.mark.parametrize("name", ["master_slave_mapping", "master_slave_mapping.voxels"])
def test_the_slave_lands_in_the_masters_world_by_the_mapping_of_the_view(name, local):
    """By S R p + offset the voxels of the slave cover what the result has of it there."""
    result = local(name)
    view = view_of(result)
    mapping, volumes = view.manifest["mapping"], {each["name"]: each for each in view.manifest["volumes"]}
    assert mapping["volumes"] == {"master": "master", "slave": "slave"}
    scale, R = np.array(mapping["scale"]), np.reshape(mapping["R"], (3, 3))
    for side, mesh in (("master", result.meshes["master"]), ("slave", result.meshes["slave"])):
        entry = volumes[side]
        held = np.frombuffer(view.blobs[entry["occupancy"]["blob"]], np.uint8).reshape(entry["shape"], order="F")
        points = (np.argwhere(held) + entry["first_voxel"] + 0.5) * entry["voxel_size_m"]
        size = np.full(3, entry["voxel_size_m"])
        if side == "slave":
            points, size = (points @ R.T) * scale + mapping["offset_m"], size * scale
        assert np.abs(points.min(axis=0) - mesh.bounds[0]).max() < 1.01 * size.max()
        assert np.abs(points.max(axis=0) - mesh.bounds[1]).max() < 1.01 * size.max()
        assert 0.95 * mesh.volume < len(points) * size.prod() < mesh.volume + mesh.area * size.max()


def test_a_five_bar_stands_in_its_working_modes(local):
    result = local("five_bar")
    manifest = view_of(result).manifest
    job = result.document["job"]
    assert [each["name"] for each in manifest["skeletons"]] == ["working mode +-", "working mode -+"]
    for each in manifest["skeletons"]:
        (points,) = each["points"]
        lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
        assert lengths == pytest.approx([job["proximal_m"][0], *job["distal_m"], job["proximal_m"][1]])
    kinds = set(result.tables["loci"]["kind"].tolist())
    assert {each["name"] for each in manifest["curves"]} == kinds
    count = sum(len(line) for each in manifest["curves"] for line in each["points"])
    assert count == len(result.tables["loci"])


def test_a_planar_boundary_lies_in_its_plane(local):
    result = local("planar_boundary")
    (curve,) = view_of(result).manifest["curves"]
    points = np.concatenate(curve["points"])
    plane = result.document["plane"]
    assert curve["closed"] and np.abs((points - plane["origin_m"]) @ plane["normal"]).max() < 1e-12
    lengths = sum(np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in curve["points"])
    assert lengths == pytest.approx(result.document["exact"]["perimeter_m"], rel=1e-3)


def test_directions_of_approach_are_counted_by_the_map(local):
    result = local("capability")
    view = view_of(result)
    (arrows,) = view.manifest["glyphs"]
    cells, directions = result.tables["capability"], result.tables["directions"]["direction"]
    count = round(float((cells["reachability_index"] * len(directions)).sum()))
    vectors = np.frombuffer(view.blobs[arrows["vectors"]["blob"]], "<f4").reshape(-1, 3)
    assert len(vectors) == count
    which = np.linalg.norm(vectors[:, None] - directions[None], axis=2).argmin(axis=1)
    assert np.bincount(which, minlength=len(directions)).tolist() == result.tables["directions"]["voxels"].tolist()


def test_the_best_design_is_the_robot_that_is_shown(local):
    result = local("design_optimization")
    manifest = view_of(result).manifest
    (robot,) = manifest["robots"]
    assert np.reshape(robot["chain"]["T_tip"], (4, 4))[0, 3] == result.document["best"]["parameters"]["forearm"]
    (plot,) = manifest["plots"]
    assert plot["x"]["values"] == sorted(result.tables["sweep"]["forearm"].tolist())


def test_how_a_sampling_has_settled_is_a_curve(local):
    """Of the robot of its samples; of other samplings there is none."""
    result = local("workspace.converged")
    (plot,) = (each for each in view_of(result).manifest["plots"] if each["kind"] == "curve")
    grids = result.document["convergence"]
    assert plot["x"]["values"] == [each["samples"] for each in grids] == [64, 216]
    assert plot["y"][0]["values"] == [each["value"] for each in grids]
    assert (plot["y"][0]["label"], plot["y"][0]["unit"]) == ("Joint mean of manipulability", "")
    assert (plot["sets"], plot["robot"]) == ("samples", 0)
    named = {**result.document, "name": "gantry"}
    both = parts.convergence({"job": {"robots": [named["job"]] * 2}, "robots": [{**named, "convergence": None}, named]})
    assert [(each["name"], each["robot"]) for each in both] == [("convergence of gantry", 1)]
    unknown = parts.convergence({**result.document, "job": None})
    assert unknown[0]["y"][0]["label"] == "Global value"
    assert parts.convergence(local("workspace").document) == []


def test_the_curve_over_scales_sets_that_of_the_mapping(local):
    plots = view_of(local("master_slave_mapping")).manifest["plots"]
    assert [each.get("sets") for each in plots if each["kind"] == "curve"] == ["scale"]


def test_the_pareto_set_of_placements_is_a_curve(local):
    result = local("base_placement.pareto")
    (plot,) = view_of(result).manifest["plots"]
    assert [plot["x"]["label"], plot["y"][0]["label"]] == ["Weight", "Manipulability"]
    assert plot["x"]["values"] == sorted(result.tables["pareto"]["weight"].tolist())


def test_robots_stand_on_their_best_bases(local):
    for name in ("base_placement", "base_placement.arms", "two_arm_placement", "inverse_reachability"):
        result = local(name)
        document, robots = result.document, view_of(result).manifest["robots"]
        best = document["best"]
        told = [each["best"] for each in document.get("robots", []) if "best" in each] or (
            [best] if "T_world_base" in best else [best["first"], best["second"]]
        )
        assert len(robots) == len(told)
        for robot, each in zip(robots, told, strict=True):
            assert np.reshape(robot["chain"]["T_base"], (4, 4)).tolist() == each["T_world_base"]


def test_maps_lie_where_the_bases_stand(local):
    result = local("base_placement")
    view = view_of(result)
    (shown,) = view.manifest["maps"]
    table = result.tables["placement_map"]
    channel = next(each for each in shown["channels"] if each["name"] == "weight")
    held = np.frombuffer(view.blobs[channel["data"]["blob"]], f"<f{4 if channel['data']['type'] == 'float32' else 2}")
    nx, ny = shown["shape"]
    for i in range(nx):
        for j in range(ny):
            center = np.array(shown["origin_m"]) + (np.array((i, j)) + 0.5) * shown["cell_m"]
            row = np.flatnonzero(np.isclose(table["x_m"], center[0]) & np.isclose(table["y_m"], center[1]))
            assert held[i + nx * j] == np.float16(table["weight"][row[0]])
    assert np.reshape(shown["T_world"], (4, 4))[:3, :3].tolist() == np.eye(3).tolist()


def test_a_robot_of_another_model_is_not_shown(local):
    """The arm's lines stand in its place, and why is told; the same chain of another text is the same arm."""
    result = local("reachability")
    robot = result.document["robot"]
    for hashes, shown in (
        ({"model_hash": "0" * 64}, 1),
        ({"model_hash": "0" * 64, "chain_hash": "0" * 64}, 0),
    ):
        changed = replace(result, document=result.document | {"robot": robot | hashes})
        manifest = view_of(changed).manifest
        assert len(manifest["robots"]) == shown and len(manifest["skeletons"]) == 1 - shown
        assert manifest["omitted"] == ["robot ur5e: its model is another than that of the result"] * (1 - shown)
