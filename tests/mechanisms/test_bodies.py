"""Solids of mechanisms that keep apart, against MuJoCo's distances of a scene made anew for every pose."""

import mujoco
import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

import wsrender as ws
from wsrender.analyses.cost import refined_seconds
from wsrender.analyses.parallel_workspace.run import APART_PER_S
from wsrender.collision.solids import BASE, Solid
from wsrender.documents.legs import DeltaLeg
from wsrender.documents.mechanism import Delta, LegsMechanism, StewartGough
from wsrender.errors import DocumentError, InputError
from wsrender.mechanisms.bodies import PAIRS, TRIANGLES, Solids
from wsrender.mechanisms.five_bar.region import workspace
from wsrender.mechanisms.inverse_kinematics import inverse_kinematics
from wsrender.mechanisms.mechanism import mechanism_of
from wsrender.mechanisms.membership import fault_at, poses_labelled
from wsrender.mechanisms.surfaces import between_surfaces, from_surface
from wsrender.run import finish, plan, run_shard

PLACED = {"position_m": [1.0, -2.0, 0.5], "rpy_deg": [10, -5, 30]}
POST = {"shape": "box", "name": "post", "size_m": [0.1, 0.1, 2], "position_m": [0.45, 0.25, 0.5]}
PLATE = {"shape": "cylinder", "name": "plate", "radius_m": 0.3, "length_m": 0.04, "position_m": [0, 0, 0.06]}
THIN, ENDLESS = {"bodies": {"link_radius_m": 0.01}}, {"items": [{"shape": "half_space"}]}
RADIUS, GAP, MARGIN = 0.02, 0.06, 0.01


def placed(shape):
    """A shape of the base frame in the world."""
    T = ws.Transform(**PLACED).matrix()
    quat = Rotation.from_matrix(T[:3, :3]).as_quat(scalar_first=True).tolist()
    return shape | {"position_m": (T[:3, :3] @ shape["position_m"] + T[:3, 3]).tolist(), "quat_wxyz": quat}


def least_distance(capsules, solids):
    """Of all pairs (name a, name b) that are asked: solids as (group, geom arguments), capsules (group, ends, r)."""
    spec = mujoco.MjSpec()
    groups = []
    for group, ends in capsules:
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_CAPSULE, size=[RADIUS, 0, 0], fromto=np.ravel(ends))
        groups.append(group)
    for group, geom in solids:
        spec.worldbody.add_geom(**geom)
        groups.append(group)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    pairs = [(a, b) for a in range(len(groups)) for b in range(a) if groups[a] != groups[b]]
    return min(mujoco.mj_geomDistance(model, data, a, b, 1.0, None) for a, b in pairs)


def geom(kind, size, T):
    quat = Rotation.from_matrix(T[:3, :3]).as_quat(scalar_first=True)
    return {"type": getattr(mujoco.mjtGeom, f"mjGEOM_{kind}"), "size": size, "pos": T[:3, 3], "quat": quat}


def random_poses(count, low, high, turn, seed=0):
    rng = np.random.default_rng(seed)
    poses = np.tile(np.eye(4), (count, 1, 1))
    poses[:, :3, 3] = rng.uniform(low, high, (count, 3))
    poses[:, :3, :3] = Rotation.from_rotvec(rng.uniform(-turn, turn, (count, 3))).as_matrix()
    return poses


def at(position):
    T = np.eye(4)
    T[:3, 3] = position
    return T


def compared(mechanism, poses, distances):
    """Labels against least distances (N,), none of them near the margin; how many are blocked."""
    labels = poses_labelled(mechanism, poses, device="cpu")[0] == 1
    assert np.abs(distances - MARGIN).min() > 1e-7
    np.testing.assert_array_equal(labels, distances > MARGIN)
    return int((~labels).sum())


def test_a_stewart_platform_with_a_plate_beside_a_post():
    bodies = {
        "link_radius_m": RADIUS,
        "platform": {"items": [PLATE]},
        "platform_gap_m": GAP,
        "environment": {"items": [placed(POST)]},
        "margin_m": MARGIN,
    }
    spec = StewartGough(length_m=(0.45, 0.9), placement=PLACED, bodies=bodies)
    mechanism = mechanism_of(spec)
    poses = random_poses(1500, [-0.25, -0.25, 0.4], [0.25, 0.25, 0.7], 0.6)
    alone = mechanism_of(StewartGough(length_m=(0.45, 0.9)))
    poses = poses[poses_labelled(alone, poses, device="cpu")[0] == 1][:250]
    distances = np.full(len(poses), np.inf)
    for n, T in enumerate(poses):
        ends = np.stack([mechanism.base, mechanism.platform @ T[:3, :3].T + T[:3, 3]], axis=1)
        post, plate = (
            geom("BOX", [0.05, 0.05, 1], at(POST["position_m"])),
            geom("CYLINDER", [0.3, 0.02, 0], T @ at([0, 0, 0.06])),
        )
        legs = [(k, line) for k, line in enumerate(ends)]
        distances[n] = min(
            least_distance(legs, [("post", post)]), least_distance([], [("post", post), ("plate", plate)])
        )
        for k, (base, joint) in legs:
            short = joint - GAP * (joint - base) / np.linalg.norm(joint - base)
            distances[n] = min(distances[n], least_distance([(k, (base, short))], [("plate", plate)]))
    assert 40 < compared(mechanism, poses, distances) < len(poses) - 40


def test_cranks_and_links_of_a_delta():
    """With a ball below and one beside a crank; at the angles that inverse kinematics has."""
    balls = [{"shape": "sphere", "radius_m": 0.1, "position_m": p} for p in ([0.15, 0.1, -0.55], [0.3, 0.13, -0.1])]
    spec = Delta(bodies={"link_radius_m": RADIUS, "environment": {"items": balls}, "margin_m": MARGIN})
    mechanism = mechanism_of(spec)
    poses = random_poses(900, [-0.3, -0.3, -0.9], [0.3, 0.3, -0.5], 0.0)
    poses = poses[poses_labelled(mechanism_of(Delta()), poses, device="cpu")[0] == 1][:150]
    angles, distances = inverse_kinematics(mechanism_of(Delta()), poses).values, []
    for T, turned in zip(poses, angles, strict=True):
        capsules = []
        for k, angle in enumerate(turned):
            out = np.array([np.cos(2 * np.pi * k / 3), np.sin(2 * np.pi * k / 3), 0])
            elbow = 0.2 * out + 0.235 * (np.cos(angle) * out - np.sin(angle) * np.array([0, 0, 1]))
            capsules += [(k, (0.2 * out, elbow)), (k, (elbow, T[:3, 3] + 0.05 * out))]
        distances.append(
            least_distance(capsules, [("ball", geom("SPHERE", [0.1, 0, 0], at(b["position_m"]))) for b in balls[:1]])
        )
        distances[-1] = min(
            distances[-1], least_distance(capsules, [("ball", geom("SPHERE", [0.1, 0, 0], at(balls[1]["position_m"])))])
        )
    assert 20 < compared(mechanism, poses, np.array(distances)) < len(poses) - 20


def delta_legs(branch):
    """Legs of a delta whose cranks turn all the way, the first on a branch."""
    azimuth = 2 * np.pi * np.arange(3) / 3
    directions = np.stack([np.cos(azimuth), np.sin(azimuth), np.zeros(3)], axis=1)
    lengths = {"crank_m": 0.235, "link_m": 0.8, "angle_deg": [-180, 179]}
    return [
        DeltaLeg(
            base_m=0.2 * n,
            platform_m=0.05 * n,
            axis=[-n[1], n[0], 0],
            zero=n,
            branch="minus" if k else branch,
            **lengths,
        )
        for k, n in enumerate(directions)
    ]


FAR_LINE, AWAY, CRANK = [[5, 0, 0], [6, 0, 0]], [[0, -3, -1], [0, -3, 1]], [[0, 0, -1], [0, 1, -1]]
TOUCHING = {  # legs, gap, balls (radius .1) of the platform and around: what collides where the number is a bit less
    "the link of leg 1 and the link of leg 2": lambda d: ([AWAY, [[d, -3, 0], [d, -3, 1]]], None, [], []),
    "the link of leg 1 and own": lambda d: ([[[0, 0, -1], [0, 0, 0]], FAR_LINE], d + 0.08, [[0, 0, 0]], []),
    "own and other": lambda d: ([FAR_LINE, FAR_LINE], None, [[0, 0, 0]], [[d + 0.16, 0, 0]]),
    "the link of leg 1 and other": lambda d: ([[[0, 0, -1], [0, 0, 1]], FAR_LINE], None, [], [[d + 0.08, 0, 0]]),
    "the crank of leg 2 and other": lambda d: ([FAR_LINE, FAR_LINE], None, [], [[0, 0.5, -1.08 - d]]),
}  # fmt: skip


@pytest.mark.parametrize("pair", TOUCHING)
def test_each_kind_of_pair_touches_where_it_does(pair):
    """Two capsules of .02 m at a margin of .01 m from .05 m on; the others have one, or none, and balls of .1 m."""
    for d, expected in ((0.05 - 1e-6, pair), (0.05 + 1e-6, "")):
        links, gap, own, other = TOUCHING[pair](d)
        ball = np.array([0.1, 0, 0])
        solids = [
            tuple(Solid(name, "sphere", BASE, at(place), ball) for place in places)
            for name, places in (("own", own), ("other", other))
        ]
        bodies = Solids(0.02, 0.01, gap, *solids, ((0, 1),) if pair.endswith("leg 2") else ())
        legs = [{"link": np.array([line], float)} for line in links]
        legs[1]["crank"] = np.array([CRANK], float)
        found, names = bodies.collisions(legs, np.eye(4)[None])
        assert (names[found[0] - 1] if found[0] else "") == expected


def test_legs_on_either_branch_take_the_one_that_is_free():
    """A ball around the elbow of one branch leaves the other."""

    def delta(branch, items):
        bodies = {"link_radius_m": 0.01, "environment": {"items": items}}
        return mechanism_of(LegsMechanism(legs=delta_legs(branch), bodies=bodies))

    pose = at([0, 0, -0.7])[None]
    elbows = {branch: inverse_kinematics(delta(branch, []), pose).elbows[0, 0] for branch in ("minus", "plus")}
    balls = {b: {"shape": "sphere", "radius_m": 0.03, "position_m": e.tolist()} for b, e in elbows.items()}
    reached = {
        (branch, blocked): bool(
            poses_labelled(delta(branch, [balls[b] for b in blocked]), pose, device="cpu")[0][0] == 1
        )
        for branch in ("minus", "plus", "either")
        for blocked in (("minus",), ("plus",), ("minus", "plus"))
    }
    assert [key for key, free in reached.items() if free] == [
        ("minus", ("plus",)), ("plus", ("minus",)), ("either", ("minus",)), ("either", ("plus",)),
    ]  # fmt: skip


def test_a_job_counts_what_collides_and_names_it():
    ceiling = {"items": [{"shape": "half_space", "name": "ceiling", "point_m": [0, 0, 0.6], "normal": [0, 0, -1]}]}
    hexapod = {"library": "stewart_gough", "length_m": [0.5, 0.8]}
    bodies = {"link_radius_m": 0.02, "environment": ceiling}
    job = {"voxel_size_m": 0.05, "device": "cpu", "refined_volume": 0.2}
    free = ws.parallel_workspace(hexapod, **job).document
    under = ws.parallel_workspace(hexapod | {"bodies": bodies}, **job)
    # The joints, on the platform at z, stay .02 m below the ceiling.
    heights = (under.volume.voxels.at[2] + under.volume.first_voxel[2] + 0.5) * 0.05
    assert heights.max() < 0.58 and under.document["samples"]["admitted"] == under.volume.n_occupied
    samples = under.document["samples"]
    assert samples["drawn"] == samples["admitted"] + samples["rejected"]["collision"]
    assert samples["drawn"] * 0.05**3 == pytest.approx(free["volume_m3"]["occupied"])
    assert 0 < under.document["headline"]["value"] < free["headline"]["value"] and "samples" not in free
    mechanism = mechanism_of(StewartGough(length_m=(0.5, 0.8), bodies=bodies))
    assert fault_at(mechanism, at([0, 0, 0.55])) == ""
    assert fault_at(mechanism, at([0, 0, 0.59])) == "collision: the link of leg 1 and ceiling come too near"


def test_the_estimate_counts_the_points_of_a_refined_volume(monkeypatch):
    """Of which bodies are asked; each takes as long as one of a voxel that is reached."""
    bodies = {"link_radius_m": 0.02, "environment": {"items": [POST]}}
    job = {"analysis": "parallel_workspace", "mechanism": {"library": "stewart_gough", "bodies": bodies}}
    planned = plan(job | {"voxel_size_m": 0.15, "refined_volume": 0.05})
    partial, asked, alone = run_shard(planned, 0), [], Solids.alone
    monkeypatch.setattr(Solids, "alone", lambda own, *of: (asked.append(len(of[1])), alone(own, *of))[1])
    finish(planned, partial)
    without = plan(job | {"voxel_size_m": 0.15, "refined_volume": None}).cost.seconds + refined_seconds(0.05)
    assert planned.cost.seconds - without == pytest.approx(sum(asked) / APART_PER_S, rel=0.5)


def test_indices_are_those_of_branches_that_keep_apart():
    """With a ball around the elbow of one branch those of the mechanism on the other alone."""
    position = {"lower_m": [-0.03, -0.03, -0.73], "upper_m": [0.03, 0.03, -0.67]}

    def centers(branch, items):
        legs = [leg.model_dump(exclude_none=True) for leg in delta_legs(branch)]
        mechanism = {
            "legs": legs,
            "region": position,
            "bodies": {"link_radius_m": 0.01, "environment": {"items": items}},
        }
        return ws.parallel_workspace(
            mechanism,
            voxel_size_m=0.02,
            indices=["inverse_condition_number"],
            task="linear",
            device="cpu",
            refined_volume=None,
        ).volume.voxels.statistics["maximum"]["inverse_condition_number"]

    elbow = inverse_kinematics(mechanism_of(LegsMechanism(legs=delta_legs("minus"))), at([0, 0, -0.7])[None]).elbows[
        0, 0
    ]
    ball = [{"shape": "sphere", "radius_m": 0.06, "position_m": elbow.tolist()}]
    np.testing.assert_allclose(centers("either", ball), centers("plus", []), rtol=1e-6)
    assert np.abs(centers("either", []) - centers("plus", [])).max() > 1e-3


BAR, STEP = ws.FiveBar(0.6, (0.5, 0.55), (0.6, 0.5)), 0.02
COLUMN = {"shape": "cylinder", "radius_m": 0.05, "length_m": 0.3, "position_m": [0.25, 0.45, 0]}
BEAM = {"shape": "box", "size_m": [0.1, 0.08, 0.2], "position_m": [0.9, 0.2, 0], "rpy_deg": [0, 0, 30]}


def bar_as_legs(mode, **fields):
    """A planar five-bar as two cranks, of which the links meet in the platform's origin; it stays in one layer."""
    legs = [
        {
            "type": "RUS",
            "base_m": [x, 0, 0],
            "platform_m": [0, 0, 0],
            "axis": [0, 0, 1],
            "zero": [1, 0, 0],
            "crank_m": crank,
            "link_m": link,
            "angle_deg": [-180, 180],
            "branch": {"+": "minus", "-": "plus"}[sign],
        }
        for x, crank, link, sign in zip((0, BAR.base_m), BAR.proximal_m, BAR.distal_m, mode, strict=True)
    ]
    region = {"lower_m": [None, None, -STEP / 4], "upper_m": [None, None, STEP / 4]}
    return {"legs": legs, "region": region, "placement": {"position_m": [0, 0, STEP / 2]}, **fields}


def test_a_planar_five_bar_among_obstacles_in_its_plane():
    """Its cells against inverse kinematics of the five-bar and MuJoCo's distances of its four links."""
    mode = "+-"
    around = [each | {"position_m": [*each["position_m"][:2], STEP / 2]} for each in (COLUMN, BEAM)]
    bodies = {"link_radius_m": RADIUS, "environment": {"items": around}, "margin_m": MARGIN}
    run = {"voxel_size_m": STEP, "refined_volume": None, "device": "cpu"}
    free = ws.parallel_workspace(bar_as_legs(mode), **run).volume
    assert free.n_occupied * STEP**2 == pytest.approx(workspace(BAR, mode).area_m2, rel=0.01)
    result = ws.parallel_workspace(bar_as_legs(mode, bodies=bodies), **run)
    cells = [{tuple(row) for row in (v.voxels.at.T + v.first_voxel).tolist()} for v in (free, result.volume)]
    some = sorted(cells[0])[:: max(len(cells[0]) // 300, 1)]
    points = (np.array(some)[:, :2] + 0.5) * STEP
    angles = BAR.inverse_kinematics(points, mode)
    standing = [("around", geom("CYLINDER", [0.05, 0.15, 0], at(COLUMN["position_m"])))]
    standing.append(("around", geom("BOX", [0.05, 0.04, 0.1], ws.Transform(
        position_m=BEAM["position_m"], rpy_deg=BEAM["rpy_deg"]).matrix())))  # fmt: skip
    least = []
    for point, elbows in zip(points, BAR.elbows(angles), strict=True):
        ends = [np.append(each, 0.0) for each in (*BAR.bases, *elbows, point)]
        lines = [[ends[a], ends[b]] for a, b in ((0, 2), (1, 3), (2, 4), (3, 4))]
        least.append(least_distance([("bar", line) for line in lines], standing))
    assert np.abs(np.array(least) - MARGIN).min() > 1e-7
    expected = np.array(least) > MARGIN
    np.testing.assert_array_equal([each in cells[1] for each in some], expected)
    assert 30 < (~expected).sum() < len(some) - 30
    assert result.document["samples"]["rejected"]["collision"] == len(cells[0]) - len(cells[1])


def test_a_five_bar_says_what_takes_bodies():
    job = {"analysis": "five_bar", "base_m": 0.6, "proximal_m": 0.5, "distal_m": 0.6}
    for field in ("environment", "constraints"):
        with pytest.raises(DocumentError) as error:
            plan(job | {field: {}})
        ((found, told),) = error.value.problems
        assert found == field and '"parallel_workspace"' in told and "RUS legs" in told and '"bodies"' in told


def test_exact_boundaries_refuse_bodies():
    bodies = {"link_radius_m": 0.02}
    with pytest.raises(InputError, match="else not only spheres bound") as error:
        ws.parallel_workspace({"library": "stewart_gough", "bodies": bodies}, method="exact")
    assert error.value.field == "mechanism.bodies"
    with pytest.raises(InputError, match="else not only spheres bound"):
        ws.method_comparison({"library": "six_pus", "bodies": bodies})


def corner_of(path, scale):
    """An L of two boxes in the plane, as a file of one closed mesh; and these boxes, (middle, half edges)."""
    outline = np.array([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], float)
    solid = trimesh.creation.extrude_triangulation(outline, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]], 1.0)
    solid.apply_scale(scale).export(path)
    return [(scale * np.array(middle), scale * np.array(half)) for middle, half in (
        ([1, 0.5, 0.5], [1, 0.5, 0.5]), ([0.5, 1, 0.5], [0.5, 1, 0.5]),
    )]  # fmt: skip


HUNG = [0.06, 0.02, -0.15]
KNOB = {"shape": "sphere", "radius_m": 0.06, "position_m": [0.2, -0.2, 0.08]}
SHELF = {"position_m": [0.24, -0.2, 0.5], "rpy_deg": [90, 0, 20]}
BALL = {"shape": "sphere", "name": "ball", "radius_m": 0.08, "position_m": [-0.3, 0.1, 0.75]}
CEILING = {"shape": "half_space", "name": "ceiling", "point_m": [0, 0, 0.85], "normal": [0, 0, -1]}


def test_solids_that_are_not_convex_on_the_platform_and_around(tmp_path):
    """Both L's are as their two boxes, of MuJoCo; with a ball in reach of the platform's, below a ceiling."""
    carried, around = corner_of(tmp_path / "carried.stl", 0.08), corner_of(tmp_path / "shelf.stl", 0.12)
    bodies = {
        "link_radius_m": RADIUS,
        "platform": {"items": [{"shape": "mesh", "path": str(tmp_path / "carried.stl"), "position_m": HUNG}, KNOB]},
        "platform_gap_m": GAP,
        "environment": {"items": [{"shape": "mesh", "path": str(tmp_path / "shelf.stl"), **SHELF}, BALL, CEILING]},
        "margin_m": MARGIN,
    }
    spec = StewartGough(length_m=(0.45, 0.9), bodies=bodies)
    mechanism, alone = mechanism_of(spec), mechanism_of(StewartGough(length_m=(0.45, 0.9)))
    poses = random_poses(2500, [-0.25, -0.25, 0.4], [0.25, 0.25, 0.7], 0.6)
    poses = poses[poses_labelled(alone, poses, device="cpu")[0] == 1][:300]
    T_shelf = ws.Transform(**SHELF).matrix()
    standing = [("shelf", geom("BOX", half, T_shelf @ at(middle))) for middle, half in around]
    standing.append(("shelf", geom("SPHERE", [0.08, 0, 0], at(BALL["position_m"]))))
    turned = np.diag([1.0, -1, -1, 1])
    turned[2, 3] = 0.85
    standing.append(("shelf", geom("PLANE", [0, 0, 1], turned)))
    parts = {"legs": [], "carried": [], "links": []}
    for T in poses:
        ends = np.stack([mechanism.base, mechanism.platform @ T[:3, :3].T + T[:3, 3]], axis=1)
        own = [("own", geom("BOX", half, T @ at(HUNG) @ at(middle))) for middle, half in carried]
        own.append(("own", geom("SPHERE", [0.06, 0, 0], T @ at(KNOB["position_m"]))))
        short = [(b, j - GAP * (j - b) / np.linalg.norm(j - b)) for b, j in ends]
        parts["legs"].append(least_distance(list(enumerate(ends)), standing))
        parts["carried"].append(least_distance([], own + standing))
        parts["links"].append(min(least_distance([("link", line)], own) for line in short))
    least = np.min(list(parts.values()), axis=0)
    assert 40 < compared(mechanism, poses, least) < len(poses) - 40
    # Each kind of pair blocks some pose by itself.
    blocked = np.array(list(parts.values())) < MARGIN
    assert (blocked[:, blocked.sum(axis=0) == 1].sum(axis=1) > 3).all()
    bodies["platform"]["items"][0]["convex"] = True
    hull = mechanism_of(StewartGough(length_m=(0.45, 0.9), bodies=bodies))
    assert (poses_labelled(hull, poses, device="cpu")[0] != poses_labelled(mechanism, poses, device="cpu")[0]).any()


def test_the_estimate_counts_triangles(tmp_path, monkeypatch):
    """Of a solid on the platform and one around, and of both together."""
    corner_of(tmp_path / "corner.stl", 0.1)
    item = {"items": [{"shape": "mesh", "path": str(tmp_path / "corner.stl")}]}
    bodies = {"link_radius_m": 0.02, "platform": item, "environment": item}
    mechanism = {"library": "stewart_gough", "bodies": bodies}
    job = {"analysis": "parallel_workspace", "mechanism": mechanism, "voxel_size_m": 0.05}
    faces, found = len(trimesh.load_mesh(tmp_path / "corner.stl").faces), [plan(job).cost.seconds]
    for effort in (1.0, 0.0):
        monkeypatch.setattr(Solids, "effort", effort)
        found.append(plan(job).cost.seconds)
    share = (found[0] - found[2]) / (found[1] - found[2])
    assert share == pytest.approx(1 + 2 * faces / TRIANGLES + faces**2 / PAIRS)


def test_a_body_within_a_solid_collides_with_it():
    """A capsule, and another solid, that touch no triangle of the one around them."""
    corners = np.array(trimesh.creation.box([6.0, 6, 6]).triangles)
    within = np.array([[[-1.0, 0, 0], [1, 0, 0]], [[-5.0, 0, 0], [-4, 0, 0]], [[0, 0, 0], [9.0, 0, 0]]])
    np.testing.assert_allclose(from_surface(corners, within, 3.0) > 0, [False, True, False])
    assert from_surface(corners, within, 3.0)[1] == pytest.approx(1.0)
    small, rod = (np.array(trimesh.creation.box(size).triangles) for size in ([2.0, 2, 2], [20, 0.1, 0.1]))
    assert between_surfaces(corners, small, 1.0) < 0 and between_surfaces(small, corners, 1.0) < 0
    assert between_surfaces(corners, rod + np.array([0, 1.0, 0.5]), 1.0) < 0
    assert between_surfaces(corners, small + np.array([4.5, 0, 0]), 1.0) == pytest.approx(0.5)
    assert between_surfaces(corners, small + np.array([9.0, 0, 0]), 1.0) == 1.0


@pytest.mark.parametrize(
    ("mechanism", "field", "message"),
    [
        ({"library": "delta", "minimum_leg_distance_m": 0.1} | THIN, "minimum_leg_distance_m", "keep apart by them"),
        ({"library": "delta", "bodies": THIN["bodies"] | {"platform": ENDLESS}}, "bodies.platform", "half-spaces"),
        ({"library": "delta", "bodies": {"link_radius_m": 0}}, "bodies.link_radius_m", "greater than 0"),
        ({"library": "delta", "bodies": {}}, "bodies.link_radius_m", "is required"),
    ],
)
def test_what_has_no_bodies(mechanism, field, message):
    with pytest.raises(DocumentError) as error:
        ws.parallel_workspace(mechanism)
    ((found, told),) = error.value.problems
    assert found == f"mechanism.{field}" and message in told
