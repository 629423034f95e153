"""Capability against arms whose approach directions have a closed form."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.reference import closed_form_inverse as closed_form
from tests.reference.published_robots import dh_table
from wsrender.reach.capability import capability, fibonacci_directions
from wsrender.reach.posture_counts import turned_frames
from wsrender.robot.constraints import constraints_for
from wsrender.run import execute, finish, plan, run_shard
from wsrender.run.partial_files import load_partial, save_partial

JOB = {
    "analysis": "capability",
    "robot": "spherical",
    "voxel_size_m": 0.05,
    "directions": 60,
    "dexterous_threshold": 0.94,
    "device": "cpu",
}


def test_directions_are_spread_evenly():
    directions = fibonacci_directions(500)
    assert np.linalg.norm(directions, axis=1) == pytest.approx(1)
    assert np.abs(directions.mean(axis=0)).max() < 1e-3
    cap = (directions @ fibonacci_directions(20).T > np.cos(0.5)).mean(axis=0)
    assert cap == pytest.approx((1 - np.cos(0.5)) / 2, abs=0.006)


def test_a_wrist_without_limits_approaches_from_everywhere():
    rows = [
        row.model_copy(update={"limits": None}) if k > 2 else row for k, row in enumerate(dh_table("spherical").rows)
    ]
    robot = ws.load_robot(ws.DHTable(convention="modified", rows=rows))
    found = capability(robot.chain, 0.05, fibonacci_directions(50))
    assert len(found.cells) > 200
    assert (found.index == 1).all()
    assert (found.undecided == 0).all()


def test_a_wrist_in_closed_form():
    """The sixth joint of the puma560 turns all round: the turn about a direction is free."""
    robot, directions = ws.load_robot("puma560"), fibonacci_directions(20)
    found = capability(robot.chain, 0.25, directions)
    centers = np.repeat((found.cells + 0.5) * 0.25, len(directions), axis=0)
    z = np.tile(directions, (len(found.cells), 1))
    x = np.cross(z, np.roll(z, 1, axis=1) + np.array([0.3, 0.1, 0.2]))
    x /= np.linalg.norm(x, axis=1)[:, None]
    R = np.stack([x, np.cross(z, x), z], axis=2)
    with np.errstate(invalid="ignore"):
        arm = closed_form.puma560_arm(centers)
        solutions = closed_form.with_spherical_wrist("puma560", arm, R)[:, :, :5]
    limits = robot.lower_limits[:5], robot.upper_limits[:5], robot.chain.revolute[:5]
    truth = closed_form.within_limits(solutions, *limits).any(axis=1).reshape(-1, len(directions))
    assert 0.1 < truth.mean() < 0.9
    assert not (found.reached & ~truth).sum() > 0.002 * truth.size  # directions within the tolerance of an angle
    assert not (~found.reached & truth).sum() > 0.002 * truth.size + found.undecided.sum()


@pytest.mark.parametrize("count", [100, 400, 1600])
def test_the_index_converges_with_the_directions(count):
    """Of a band 20 … 160° around any axis it is cos 20°; the error falls at least as count^(-3/4)."""
    axes = fibonacci_directions(30)
    cosines = axes @ fibonacci_directions(count).T
    share = (np.abs(cosines) <= np.cos(np.radians(20))).mean(axis=1)
    assert np.abs(share - np.cos(np.radians(20))).max() < 1.2 * count**-0.75


@pytest.fixture(scope="module")
def result():
    return execute(JOB)


def test_a_wrist_that_bends_20_to_160_degrees(result):
    """Its axis points along the slide: a direction is reached iff its angle to the radius lies in this range."""
    table, directions = result.tables["capability"], result.tables["directions"]["direction"]
    reached = np.unpackbits(table["direction_bits"], axis=1, count=60).astype(bool)
    radial = table["position"] / np.linalg.norm(table["position"], axis=1)[:, None]
    angle = np.degrees(np.arccos(radial @ directions.T))
    clear = np.minimum(np.abs(angle - 20), np.abs(angle - 160)) > 0.1
    expected = (angle >= 20) & (angle <= 160)
    assert (reached == expected)[clear & (table["undecided"] == 0)[:, None]].all()
    assert table["undecided"].sum() < 0.01 * reached.size
    assert result.document["capability"]["mean_index"] == pytest.approx(np.cos(np.radians(20)), abs=0.01)


def test_document_and_volume_say_the_same(result, tmp_path):
    entry, table = result.document["capability"], result.tables["capability"]
    assert entry["voxels"] == len(table) == np.count_nonzero(~np.isnan(index_of(result.volume)))
    assert entry["reachable_volume_m3"] == pytest.approx(len(table) * 0.05**3)
    dexterous = (table["reachability_index"] >= 0.94).sum()
    assert entry["dexterous_volume_m3"] == pytest.approx(dexterous * 0.05**3)
    assert 0 < dexterous < len(table)
    counted = (f"{entry[name]:.4g} m³" for name in ("reachable_volume_m3", "dexterous_volume_m3"))
    assert all(text in result.document["headline"]["reason"] for text in (*counted, " 94 %"))
    cells = np.round(table["position"] / 0.05 - 0.5).astype(int) - result.volume.first_voxel
    assert index_of(result.volume)[tuple(cells.T)] == pytest.approx(table["reachability_index"])
    assert result.tables["directions"]["voxels"].sum() == result.volume.count.sum()
    result.save(tmp_path)
    restored = ws.Result.load(tmp_path)
    assert (restored.tables["capability"]["direction_bits"] == table["direction_bits"]).all()
    assert "dexterous volume" in restored.summary()


def test_a_voxel_at_the_threshold_is_dexterous():
    """A wrist without limits approaches from everywhere: the index is exactly 1, the threshold that is the default."""
    dh = dh_table("spherical").model_dump(mode="json")
    rows = [{**row, "limits": None} if k > 2 else row for k, row in enumerate(dh["rows"])]
    document = {**JOB, "robot": {"dh": {**dh, "rows": rows}}, "voxel_size_m": 0.2, "directions": 5}
    del document["dexterous_threshold"]
    entry = execute(document).document["capability"]
    assert (entry["dexterous_threshold"], entry["mean_index"]) == (1.0, 1.0)
    assert entry["dexterous_volume_m3"] == entry["reachable_volume_m3"] > 0


@pytest.mark.parametrize(("tolerance", "warned"), [(1e-3, True), (0.5, False)])
def test_a_tip_that_cannot_turn_is_warned_of(tolerance, warned):
    """That of a scara always points along z; the nearest of 100 directions is 8° off."""
    found = ws.capability("scara", voxel_size_m=0.2, angle_tolerance_rad=tolerance, device="cpu").document
    assert (found["capability"]["maximum_index"] == 0.0) == warned
    assert [each["code"] for each in found["warnings"]] == ["no_direction_reached"] * warned


def index_of(volume):
    return volume.statistics["fraction"]["approach_directions"]


@pytest.mark.parametrize("height", [0.04, 0.01])
def test_a_planar_arm_approaches_in_its_plane(height):
    """3R, links 0.4, 0.2, 0.1 m: everywhere between 0.3 and 0.5 m the last link may point anywhere in the plane.

    The plane holds the centres of voxels, or lies beside them.
    """
    size, tilt = 0.08, 0.3
    rows = [ws.DHRow(a=a) for a in (0.4, 0.2, 0.1)]
    placement = ws.Transform(position_m=(0, 0, height))
    robot = ws.load_robot(ws.DHTable(convention="standard", rows=rows), placement=placement)
    directions = fibonacci_directions(40)
    found = capability(robot.chain, size, directions, approach_axis="x", angle_rad=tilt)
    radius = np.hypot(*((found.cells[:, :2] + 0.5) * size).T)
    assert (found.cells[:, 2] == 0).all()
    inside = (radius > 0.301) & (radius < 0.499)
    assert inside.sum() > 40
    assert (found.reached[inside] == (np.abs(np.arcsin(directions[:, 2])) <= tilt)).all()
    assert found.index[~inside].min() < found.index[inside].min()


def test_a_partial_result_travels(result, tmp_path):
    here = plan(JOB)
    save_partial(run_shard(here, 0), tmp_path / "partial.npz")
    there = plan(JOB, resolved=here.resolved())
    again = finish(there, load_partial(tmp_path / "partial.npz", there))
    bits = [r.tables["capability"]["direction_bits"] for r in (again, result)]
    assert np.array_equal(*bits)
    assert again.document["capability"] == result.document["capability"]


def test_default_voxels_are_a_twentieth_of_the_workspace():
    assert plan({"analysis": "capability", "robot": "ur5e", "device": "cpu"}).resolved()["voxel_size_m"] == 0.077


def test_directions_between_a_floor_and_a_box_in_closed_form():
    """A Puma of capsules along its links; its sixth joint turns nothing that may collide."""
    robot = ws.load_robot(dh_table("puma560").model_copy(update={"link_radius": 0.04}))
    around = ws.Environment([ws.HalfSpace(point_m=(0, 0, -0.3)), ws.Box(size_m=(0.2, 2, 2), position_m=(0.6, 0, 0))])
    job = {"analysis": "capability", "voxel_size_m": 0.25, "directions": 12, "device": "cpu"}
    result = execute({**job, "robot": robot.spec, "environment": around})
    (apart,) = constraints_for(robot, None, around)
    table, directions = result.tables["capability"], fibonacci_directions(12)
    centers = np.repeat(table["position"], len(directions), axis=0)
    z = np.tile(directions, (len(table["position"]), 1))
    x = np.cross(z, np.roll(z, 1, axis=1) + np.array([0.3, 0.1, 0.2]))
    x /= np.linalg.norm(x, axis=1)[:, None]
    with np.errstate(invalid="ignore"):
        arm = closed_form.puma560_arm(centers)
        solutions = closed_form.with_spherical_wrist("puma560", arm, np.stack([x, np.cross(z, x), z], axis=2))
    solutions[:, :, 5] = np.where(np.isnan(solutions[:, :, 5]), np.nan, 0.0)
    inside = closed_form.within_limits(solutions, robot.lower_limits, robot.upper_limits, robot.chain.revolute)
    admitted = np.zeros(inside.shape, bool)
    admitted[inside] = apart.host(solutions[inside], np.zeros((0, 4, 4))) == 0
    free, reach = admitted.any(axis=1), inside.any(axis=1)
    found = np.unpackbits(table["direction_bits"], axis=1, count=12).astype(bool).ravel()
    blocked, undecided = table["blocked_environment"].sum(), table["undecided"].sum()
    assert free.sum() > 300 and (reach & ~free).sum() > 30
    assert (found & ~free).sum() <= 0.002 * free.size
    assert (free & ~found).sum() <= 0.002 * free.size + undecided
    assert blocked == result.document["capability"]["blocked_pairs"]["environment"]
    assert abs(blocked - (reach & ~free).sum()) <= 0.004 * free.size + undecided


@pytest.mark.parametrize(("axis", "closed"), [("z", True), ("x", False)])
def test_the_document_says_what_decided(axis, closed):
    """A Puma's last joint turns about z: it is left out, and five joints have a closed form."""
    job = {"analysis": "capability", "robot": "puma560", "voxel_size_m": 0.8, "directions": 12, "device": "cpu"}
    found = execute({**job, "approach_axis": axis}).document["capability"]["evidence"]
    assert found == ("closed form (spherical wrist, axes 1 and 2 intersecting), margin 1e-7" if closed else "search")


def test_postures_are_counted_at_every_voxel():
    """Of a Puma, against another closed form; of poses of another axis too."""
    robot = ws.load_robot("puma560")
    job = {
        "analysis": "capability",
        "robot": "puma560",
        "voxel_size_m": 0.4,
        "directions": 6,
        "rolls": 3,
        "device": "cpu",
    }
    for axis in ("z", "-x"):
        result = execute(job | {"approach_axis": axis})
        table = result.tables["capability"]
        R = turned_frames(fibonacci_directions(6), 3)
        assert R[::3, :, 2] == pytest.approx(fibonacci_directions(6)) and np.linalg.det(R) == pytest.approx(1)
        if axis == "-x":  # along the direction
            R = np.stack([-R[:, :, 2], R[:, :, 0], -R[:, :, 1]], axis=2)
        points, poses = np.repeat(table["position"], len(R), axis=0), np.tile(R, (len(table), 1, 1))
        with np.errstate(invalid="ignore"):
            arm = closed_form.puma560_arm(points)
            solutions = closed_form.with_spherical_wrist("puma560", arm, poses)
        there = within(robot, solutions).reshape(len(table), len(R), -1).sum(axis=2)
        assert table["postures_mean"] == pytest.approx(there.mean(axis=1)) and 0.5 < there.mean() < 4
        assert (table["postures_most"] == there.max(axis=1)).all()
    entry = result.document["capability"]["postures"]
    assert (entry["poses_of_a_voxel"], entry["most"]) == (18, there.max()) and entry["mean"] == pytest.approx(
        there.mean()
    )
    assert np.nansum(result.volume.statistics["mean"]["postures"]) == pytest.approx(there.mean(axis=1).sum(), rel=1e-5)
    assert "postures of a pose" in result.summary()


def within(robot, solutions):
    return closed_form.within_limits(solutions, robot.lower_limits, robot.upper_limits, robot.chain.revolute)


def test_free_postures_are_counted_under_constraints():
    floor = {"items": [{"shape": "half_space", "name": "floor", "point_m": [0, 0, -0.05]}]}
    job = {"analysis": "capability", "robot": "ur5e", "voxel_size_m": 0.5, "directions": 4, "rolls": 2, "device": "cpu"}
    result = execute(job | {"environment": floor})
    table, R = result.tables["capability"], turned_frames(fibonacci_directions(4), 2)
    quat = np.tile(Rotation.from_matrix(R).as_quat(scalar_first=True), (len(table), 1))
    found = ws.postures("ur5e", np.repeat(table["position"], 8, axis=0), quat, environment=floor, device="cpu")
    free = np.bincount(found.pose[found.reasons == ""], minlength=len(quat)).reshape(-1, 8)
    assert (free.mean(axis=1) == table["postures_mean"]).all() and (found.reasons != "").sum() > 20


def test_postures_of_arms_without_a_closed_form_are_not_counted():
    with pytest.raises(ws.InputError, match="rolls: must be null: franka_panda has no closed form"):
        plan(JOB | {"robot": "franka_panda", "rolls": 2})
