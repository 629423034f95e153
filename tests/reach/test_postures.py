"""All postures of a pose: against closed forms of the tests, other searches, brute force over turns, and MuJoCo."""

from itertools import permutations

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.collision.robots import collides
from tests.reference import closed_form_inverse
from wsrender.reach.posture_sets import MOST_OF_FAMILIES, PostureSolver
from wsrender.reach.posture_solver import PoseHolder
from wsrender.robot.links import link_shapes

FLOOR = {"items": [{"shape": "half_space", "name": "floor", "point_m": [0, 0, 0.05]}]}
GUARDED = {"self_collision": True, "environment": {"exclude": [["floor", "link1/0"]]}}
LINKS = ((0.1, -80, 0.3), (0.4, 20, 0.1), (0.15, 70, 0), (0.1, 60, 0.35), (0.05, -70, 0.1), (0, 0, 0.1))
GENERAL = ws.DHTable(
    convention="standard",
    name="general",
    rows=[{"a": a, "alpha_deg": alpha, "d": d, "limits_deg": [-170, 170]} for a, alpha, d in LINKS],
)


def drawn(chain, count, seed=0):
    low, high = chain.lower_limits, chain.upper_limits
    return low + np.random.default_rng(seed).random((count, chain.n)) * (high - low)


def solved(chain, T, **options):
    return PostureSolver(chain, device="cpu", **options).solve(T)


def apart(chain, q, others):
    """Largest difference of a coordinate to each of ``others`` (K, n), whole turns left out, (K,)."""
    off = np.abs(q - others)
    return np.where(chain.revolute, np.abs(np.remainder(off + np.pi, 2 * np.pi) - np.pi), off).max(axis=1, initial=0)


def nearest(chain, q, found):
    """Of each configuration (N, n) the distance to the nearest posture of its pose, (N,)."""
    return np.array([apart(chain, row, found[found.pose == k]).min(initial=9) for k, row in enumerate(q)])


@pytest.mark.parametrize("name", ["ur5e", "puma560", "scara", "stanford_arm", "slave_5r", "gao_6r"])
def test_the_generating_configuration_is_among_the_postures(name):
    chain = ws.load_robot(name).chain
    q = drawn(chain, 200)
    limit = np.arange(len(q)) % chain.n
    q[:50, :] = np.where(np.arange(chain.n) == limit[:50, None], chain.upper_limits, q[:50])  # a joint at its limit
    T = chain.poses(q)
    found = solved(chain, T)
    regular = np.linalg.svd(chain.jacobians(q), compute_uv=False)[:, -1] > 1e-3
    assert nearest(chain, q, found)[regular].max() < 1e-6 and regular.mean() > 0.8
    assert ((found.configurations >= chain.lower_limits) & (found.configurations <= chain.upper_limits)).all()
    back = chain.poses(found.configurations)
    assert np.linalg.norm(back[:, :3, 3] - T[found.pose, :3, 3], axis=1).max() <= 1e-9
    turn = Rotation.from_matrix(back[:, :3, :3].transpose(0, 2, 1) @ T[found.pose, :3, :3]).magnitude()
    assert turn.max() <= 1e-9 and found.residual_rad == pytest.approx(turn, abs=1e-14)
    assert found.complete[regular].mean() > 0.9
    for k in range(len(q)):
        own = found[found.pose == k]
        assert all(apart(chain, row, np.delete(own, i, 0)).min(initial=9) > 1e-6 for i, row in enumerate(own))


def test_postures_and_windings_of_a_ur_are_those_of_another_closed_form():
    """Of Hawkins's; turns by trying all."""
    chain = ws.load_robot("ur5e").chain
    T = chain.poses(drawn(chain, 100, seed=1))
    found = solved(chain, T)
    with np.errstate(invalid="ignore"):
        theirs = closed_form_inverse.ur5e(T[:, :3, 3], T[:, :3, :3])
    turns = 2 * np.pi * np.arange(-2, 3)[:, None]
    for k in range(len(T)):
        rows = theirs[k][np.isfinite(theirs[k]).all(axis=1)]
        own = np.flatnonzero(found.pose == k)
        assert len(own) == len(rows) and all(apart(chain, q, found[own]).min() < 1e-6 for q in rows)
        for i in own:
            q = found[i] + turns
            count = ((q >= chain.lower_limits) & (q <= chain.upper_limits)).sum(axis=0).prod()
            assert found.windings[i] == count
    assert found.count == found.windings.sum() and found.windings.max() == 32


def test_windings_are_listed_one_after_the_other():
    found = ws.postures("ur5e", [0.4, 0.2, 0.3], [0, 1, 0, 0], device="cpu")
    assert np.asarray(found).shape == (8, 6) and len(found) == 8 and found.count == 256
    chain = ws.load_robot("ur5e").chain
    all_of_them = np.array(list(found.wound()))
    assert len(np.unique(np.round(all_of_them, 6), axis=0)) == 256
    assert (np.abs(all_of_them) <= chain.upper_limits).all()
    assert chain.poses(all_of_them)[:, :3, 3] == pytest.approx(np.tile([0.4, 0.2, 0.3], (256, 1)), abs=1e-9)
    assert (next(found.wound(3)) == found[3]).all()


def test_a_limit_is_a_limit():
    """A micrometre's turn beyond it is no posture, what rounding puts there is."""
    chain = ws.load_robot("ur5e").chain
    q = drawn(chain, 40, seed=8)
    for beyond, there in ((1e-6, False), (1e-10, True)):
        q[:, 2] = chain.upper_limits[2] + beyond
        assert ((nearest(chain, q, solved(chain, chain.poses(q))) < 1e-5) == there).mean() > 0.9


@pytest.mark.parametrize("name", ["puma560", "ur5e"])
def test_a_search_finds_what_a_closed_form_knows(name):
    chain = ws.load_robot(name).chain
    T = chain.poses(drawn(chain, 40, seed=2))
    known, solver = solved(chain, T), PostureSolver(chain, device="cpu")
    solver.form = None
    found = solver.solve(T)
    assert (found.pose == known.pose).all() and not found.complete.any() and known.complete.mean() > 0.9
    assert all(apart(chain, q, found[found.pose == k]).min() < 1e-6 for q, k in zip(known, known.pose, strict=True))
    assert solver.evidence == "search from 512 starts a pose, sampled, not proven complete"


def test_positions_at_right_angles_are_decided():
    """The wrist that is thought at the tip of three hinges stands in line nowhere, so that no pose is in doubt."""
    rows = [{"a": 0, "alpha_deg": -90}, {"a": 0.4, "d": 0.2}, {"a": 0.3}]
    chain = ws.load_robot(ws.DHTable(convention="standard", name="elbow", rows=rows)).chain
    angles = np.meshgrid([0, np.pi / 2, 0.5], [-np.pi / 2, 0, 0.4], [np.pi / 2, 0.7, -1])
    found = solved(chain, chain.poses(np.reshape(angles, (3, -1)).T), kind="position")
    assert found.complete.all() and (np.bincount(found.pose) == 4).all()


def test_an_arm_without_a_closed_form_is_searched():
    robot = ws.load_robot(GENERAL)
    assert robot.closed_form is None
    q = drawn(robot.chain, 30, seed=3)
    found = solved(robot.chain, robot.chain.poses(q))
    assert nearest(robot.chain, q, found).max() < 1e-6
    assert np.bincount(found.pose).mean() > 2 and not found.complete.any() and not found.family.any()
    fewer = solved(robot.chain, robot.chain.poses(q), starts=4)
    assert len(fewer) < len(found)
    assert (solved(robot.chain, robot.chain.poses(q), seed=1).configurations == found.configurations).mean() < 1


def straight_elbow(chain, q):
    """The value of joint 3 at which the determinant of the Jacobian changes its sign."""

    def determinant(value):
        return np.linalg.det(chain.jacobians(np.array([[*q[:2], value, *q[3:]]]))[0])

    values = np.linspace(chain.lower_limits[2], chain.upper_limits[2], 50)
    signs = np.sign([determinant(value) for value in values])
    k = int(np.argmax(signs[1:] != signs[:-1]))
    return brentq(determinant, values[k], values[k + 1], xtol=1e-15)


def test_singular_postures_are_flagged():
    """A wrist in line is a family; an elbow that is straight is not; either is nearly singular."""
    chain = ws.load_robot("puma560").chain
    q = np.array([[0.3, -0.7, 0.5, 0.4, 0.0, 0.2], [0.3, -0.7, 0.5, 0.4, 0.7, 0.2]])
    found = solved(chain, chain.poses(q))
    own = [np.argmin(np.where(found.pose == k, apart(chain, q[k], found.configurations), 9)) for k in (0, 1)]
    in_line = found.family & (found.pose == 0)
    assert in_line.any() and (np.abs(np.sin(found[in_line][:, 4])) < 1e-6).all()
    assert (found.sigma_min[in_line] < 1e-8).all() and found.doubtful[in_line].all() and found.complete[0]
    assert not found.family[own[1]] and not found.doubtful[own[1]] and found.sigma_min[own[1]] > 1e-3
    assert found.complete[1] and in_line.sum() <= MOST_OF_FAMILIES
    q[1, 2] = straight_elbow(chain, q[1])
    for off in (0.0, 1e-6):  # on the fold, and where two postures are too near to tell them apart
        T = chain.poses(q[1:] + off * np.eye(6)[2])
        elbow = solved(chain, T)
        near = apart(chain, q[1], elbow.configurations) < 1e-3
        assert near.sum() == 1 and elbow.doubtful[near].all() and not elbow.family[near].any()


def test_what_constraints_block_is_what_mujoco_says():
    robot, quat = ws.load_robot("ur5e"), Rotation.random(6, random_state=4).as_quat(scalar_first=True)
    points = np.random.default_rng(5).uniform([-0.5, -0.5, 0.1], [0.5, 0.5, 0.5], (6, 3))
    found = ws.postures(robot, points, quat, constraints=GUARDED, environment=FLOOR, device="cpu")
    hit = collides(robot, found.configurations)
    moving = [k for k, shape in enumerate(robot.bodies.shapes) if shape.name != "link1/0"]
    lowest = np.array([min(link_shapes(robot, q)[k].vertices[:, 2].min() for k in moving) for q in found])
    assert len(found) > 20 and set(found.reasons) == {"", "environment", "self_collision"}
    assert (hit[found.reasons == "self_collision"]).all() and not hit[found.reasons == ""].any()
    clear = np.abs(lowest - 0.05) > 2e-3
    assert ((found.reasons == "environment") == (lowest < 0.05))[clear].all() and clear.mean() > 0.9
    free = ws.postures(robot, points, quat, device="cpu")
    assert (free.configurations == found.configurations).all() and (free.reasons == "").all()


def rolled(T, angles, axis):
    """Poses (K, 4, 4) of one pose turned by angles (K,) about an axis of its own."""
    turned = np.tile(T, (len(angles), 1, 1))
    turned[:, :3, :3] = T[:3, :3] @ Rotation.from_rotvec(np.outer(angles, np.eye(3)[axis])).as_matrix()
    return turned


def ur5e_postures(T):
    """Configurations (K, 6) of poses (N, 4, 4) by another closed form (Hawkins), hinges within half a turn."""
    with np.errstate(invalid="ignore"):
        q = closed_form_inverse.ur5e(T[:, :3, 3], T[:, :3, :3]).reshape(-1, 6)
    return np.remainder(q[np.isfinite(q).all(axis=1)] + np.pi, 2 * np.pi) - np.pi


def test_axes_about_which_the_last_joint_turns():
    """The other joints are those of the pose, however it is turned; the last one goes from limit to limit."""
    chain = ws.load_robot("ur5e").chain
    T = chain.poses(drawn(chain, 25, seed=11))
    turned = np.concatenate([rolled(each, np.array([angle]), 2) for angle, each in enumerate(T)])
    found, held = solved(chain, turned, kind="axis"), solved(chain.held({"joint6": 0.3}), turned, kind="axis")
    for k in range(len(T)):
        theirs = ur5e_postures(T[[k]])[:, :5]
        for ours in (found[found.pose == k][:, :5], held[held.pose == k][:, :5]):
            assert len(ours) == len(theirs)
            assert all(apart(chain, np.append(row, 0), np.pad(ours, ((0, 0), (0, 1)))).min() < 1e-6 for row in theirs)
    assert found.complete.mean() > 0.9 and held.complete.mean() > 0.9  # the others are nearly singular
    assert found.family.all() and not held.family.any()
    assert found.evidence.startswith("closed form (three parallel axes)") and (held.configurations[:, 5] == 0.3).all()
    assert found.windings.max() == held.windings.max() == 16  # of joints 1, 2, 4 and 5
    for posture, curve in zip(found, found.curves, strict=True):
        assert curve.configurations[:, :5] == pytest.approx(np.tile(posture[:5], (len(curve), 1)), abs=1e-9)
        assert curve.configurations[[0, -1], 5] == pytest.approx([-2 * np.pi, 2 * np.pi]) and not curve.singular


@pytest.mark.parametrize("axis", ["x", "y"])
def test_axes_about_which_all_joints_move(axis):
    """Every point of the curves holds the axis, and what a dense sweep of the turn finds is on one of them."""
    chain, k = ws.load_robot("ur5e").chain, "xyz".index(axis)
    q = drawn(chain, 1, seed=12)
    T = chain.poses(q)
    found = solved(chain, T, kind="axis", free_axis=axis, starts=1)
    assert "at 128 values of the turn about the free axis, self-motions in steps of 0.05" in found.evidence
    assert all(found.curves) and found.family.all() and not found.complete.any()
    for curve in found.curves:
        back = chain.poses(curve.configurations)
        assert np.abs(back[:, :3, [k, 3]] - T[0][:3, [k, 3]]).max() <= 1e-8
        assert (np.abs(curve.configurations) <= chain.upper_limits).all()
    swept = ur5e_postures(rolled(T[0], np.linspace(0, 2 * np.pi, 300), k))
    points = np.concatenate([curve.configurations for curve in found.curves])
    off = [apart(chain, row, points).min() for row in swept]
    assert len(swept) > 500 and max(off) < 0.05 and apart(chain, q[0], points).min() < 0.05


def test_opposite_axes_are_half_a_turn_apart():
    holder = PoseHolder(ws.load_robot("ur5e").chain, "axis")
    T = holder.chain.poses(np.full((1, 6), 0.3))
    T[:, :3, :3] = T[:, :3, :3] @ np.diag([1, -1, -1])
    left = holder.errors(np.full((1, 6), 0.3), T)
    assert np.linalg.norm(left[0, 3:]) == pytest.approx(np.pi) and abs(left[0, 3:] @ T[0, :3, 2]) < 1e-12


def test_positions_of_arms_in_a_plane_and_scaras():
    """By the law of cosines; the joint that a tip on its axis leaves alone turns as it likes."""
    rows = [{"a": 0.4, "limits_deg": [-170, 170]}, {"a": 0.3, "limits_deg": [-150, 150]}]
    slide = {"joint": "prismatic", "limits": [0.1, 0.3]}
    scara = [*rows, slide, {"limits_deg": [-180, 180]}]
    points = np.random.default_rng(2).uniform([-0.8, -0.8, 0.1], [0.8, 0.8, 0.3], (60, 3))
    for arm, idle in ((rows, 0), (scara, 1)):
        chain = ws.load_robot(ws.DHTable(convention="standard", name="arm", rows=arm)).chain
        T = np.tile(np.eye(4), (len(points), 1, 1))
        T[:, :3, 3] = points * [1, 1, idle]
        found = solved(chain, T, kind="position")
        for k, (x, y, _) in enumerate(points):
            cosine = (x**2 + y**2 - 0.25) / 0.24
            bends = [sign * np.arccos(cosine) for sign in (-1, 1)] if abs(cosine) < 1 else []
            both = [(np.arctan2(y, x) - np.arctan2(0.3 * np.sin(b), 0.4 + 0.3 * np.cos(b)), b) for b in bends]
            both = [np.remainder(np.add(each, np.pi), 2 * np.pi) - np.pi for each in both]
            theirs = sorted(tuple(each) for each in both if (np.abs(each) < chain.upper_limits[:2]).all())
            ours = sorted(tuple(each) for each in found[found.pose == k][:, :2])
            assert np.reshape(ours, (-1, 2)) == pytest.approx(np.reshape(theirs, (-1, 2)), abs=1e-6)
        assert len(found) > 50 and found.complete.all() and (found.family == bool(idle)).all()
        assert all((curve is not None) == bool(idle) for curve in found.curves)


def test_the_centre_of_a_wrist_leaves_three_joints_alone():
    chain = ws.load_robot("puma560").chain
    T = chain.poses(drawn(chain, 50, seed=13))
    found = solved(chain, T, kind="position")
    with np.errstate(invalid="ignore"):
        arm = closed_form_inverse.puma560_arm(T[:, :3, 3])
    arm = np.remainder(arm - chain.lower_limits[:3], 2 * np.pi) + chain.lower_limits[:3]
    there = np.isfinite(arm).all(axis=2) & (arm <= chain.upper_limits[:3]).all(axis=2)
    for k in range(len(T)):
        ours = found[found.pose == k][:, :3]
        assert len(ours) == there[k].sum() > 0
        assert all(np.abs(ours - row).max(axis=1).min() < 1e-6 for row in arm[k][there[k]])
    assert found.complete.all() and found.family.all() and found.curves == (None,) * len(found)
    wide = ws.load_robot("puma560", limits={"joint4": (-7, 7)}).chain
    assert (solved(wide, T, kind="position").windings == 1).all()  # joint 4 turns as it likes
    ur = solved(ws.load_robot("ur5e").chain, T[:1], kind="position")
    assert len(ur) == MOST_OF_FAMILIES and not ur.complete.any()
    assert ur.evidence.startswith("16 postures at most of families of 3 freedoms, search from")


def test_positions_alone():
    """Three joints put the centre of a Puma's wrist on a point in four ways."""
    robot = ws.load_robot("puma560")
    chain, held = robot.chain, robot.held(dict.fromkeys(robot.joint_names[3:], 0.4))
    points = chain.poses(np.hstack([drawn(chain, 30, seed=6)[:, :3], np.full((30, 3), 0.4)]))[:, :3, 3]
    found = ws.postures(held, points, device="cpu")
    assert held.chain.poses(found.configurations)[:, :3, 3] == pytest.approx(points[found.pose], abs=1e-9)
    assert set(np.bincount(found.pose)) <= {1, 2, 3, 4} and (found.configurations[:, 3:] == 0.4).all()


@pytest.mark.parametrize(
    ("position", "quat", "field", "message"),
    [
        ([[0, 0, 0.5]], [[1, 1, 0, 0]], "quat_wxyz", "row 0 has length 1.41421; unit length is needed"),
        ([[0, 0, 0.5]], [[1, 0, 0, 0]] * 2, "quat_wxyz", "has 2 rows for 1 of position_m"),
        ([0, np.nan, 0.5], [1, 0, 0, 0], "position_m", "row 0 has a value that is not finite"),
        ([0, 0.5], [1, 0, 0, 0], "position_m", "shape"),
    ],
)
def test_bad_poses_are_refused_by_name(position, quat, field, message):
    with pytest.raises(ws.InputError, match=message) as refusal:
        ws.postures("ur5e", position, quat)
    assert refusal.value.field == field


def test_bad_axes_are_refused_by_name():
    with pytest.raises(ws.InputError, match="'w' is not allowed; x, y, z, or None") as refusal:
        ws.postures("ur5e", [0, 0, 0.5], [1, 0, 0, 0], free_axis="w")
    assert refusal.value.field == "free_axis"
    with pytest.raises(ws.InputError, match="free_axis: must not be given without quat_wxyz"):
        ws.postures("ur5e", [0, 0, 0.5], free_axis="z")


def test_no_postures():
    found = ws.postures("ur5e", [5, 0, 0], [1, 0, 0, 0], device="cpu")
    assert np.asarray(found).shape == (0, 6) and found.count == 0 and found.complete.all() and not list(found.wound())


def along(curve, q):
    """Least distances of configurations (M, n) from a curve, hinges without turns: of its points, and of chords."""
    points = np.concatenate([curve.configurations, curve.configurations[:1]]) if curve.closed else curve.configurations
    dense = np.concatenate([points[:-1] + t * np.diff(points, axis=0) for t in np.linspace(0, 1, 9)] + [points[-1:]])
    return np.array([np.abs(dense - row).max(axis=1).min() for row in q])


@pytest.mark.parametrize("name", ["franka_panda", "kuka_iiwa14"])
def test_no_posture_of_a_redundant_arm_is_off_its_self_motions(name):
    """Every point holds the pose; a dense sweep of the last joint finds postures on the curves alone."""
    chain = ws.load_robot(name).chain
    q = drawn(chain, 2, seed=9)
    T = chain.poses(q)
    found = solved(chain, T, starts=64)
    assert found.family.all() and not found.complete.any() and all(found.curves) and len(found) >= 4
    assert f"at 128 values of {chain.joint_names[-1]}" in found.evidence and "not proven" in found.evidence
    for posture, curve, pose in zip(found, found.curves, found.pose, strict=True):
        back = chain.poses(curve.configurations)
        assert np.abs(back - T[pose]).max() <= 1e-8 and curve.pose == pose
        within = (curve.configurations >= chain.lower_limits) & (curve.configurations <= chain.upper_limits)
        assert within.all() and along(curve, posture[None])[0] < 1e-9
        steps = np.abs(np.diff(curve.configurations, axis=0)).max(axis=1)
        assert steps.max() < 0.08
        ends = curve.configurations[[0, -1]]
        at_limit = np.minimum(ends - chain.lower_limits, chain.upper_limits - ends).min(axis=1) < 1e-9
        assert not curve.singular and (curve.closed or at_limit.all())
    for k in range(len(q)):
        own = [curve for curve in found.curves if curve.pose == k]
        assert min(along(curve, q[[k]])[0] for curve in own) < 0.01
        for value in np.random.default_rng(k).uniform(chain.lower_limits[-1], chain.upper_limits[-1], 60):
            arm = chain.held({chain.joint_names[-1]: value})
            swept = solved(arm, T[[k]]).configurations
            assert all(min(along(curve, row[None])[0] for curve in own) < 0.01 for row in swept)
    apart_from_each_other = [
        np.median(along(a, b.configurations)) for a, b in permutations(found.curves, 2) if a.pose == b.pose
    ]
    assert min(apart_from_each_other) > 0.02


def test_self_motions_close_where_nothing_stops_them():
    """An arm in a plane that holds a point is a linkage of four bars: two closed curves where the shortest and the
    longest are together shorter than the others (Grashof 1883), else one."""
    arm = ws.load_robot(ws.DHTable(convention="standard", name="planar", rows=[{"a": a} for a in (0.4, 0.3, 0.2)]))
    assert arm.chain.periodic.all()
    for point, count in (([0.3, 0.1, 0.0], 2), ([0.8, 0.1, 0.0], 1), ([0.05, 0.0, 0.0], 2), ([0.15, 0.0, 0.0], 1)):
        bars = sorted([0.4, 0.3, 0.2, np.linalg.norm(point)])
        assert (bars[0] + bars[3] < bars[1] + bars[2]) == (count == 2)
        found = ws.postures(arm, point, device="cpu", starts=32)
        assert len(found) == count and found.family.all() and not found.complete.any()
        for curve in found.curves:
            at = arm.chain.poses(curve.configurations)[:, :3, 3]
            assert curve.closed and np.abs(at - point).max() <= 1e-8
            gap = np.remainder(curve.configurations[0] - curve.configurations[-1] + np.pi, 2 * np.pi) - np.pi
            assert np.linalg.norm(gap) < 0.07 and gap @ (curve.configurations[1] - curve.configurations[0]) > 0
    with pytest.raises(ws.InputError, match=r"curve_step: 0\.3 is not allowed"):
        ws.postures(arm, point, curve_step=0.3)
    for step in (0.2, 0.5):  # steps are shortened where the curve bends, and none goes round twice
        long = PostureSolver(arm.chain, kind="position", starts=32, curve_step=step, device="cpu")
        T = np.tile(np.eye(4), (1, 1, 1))
        T[0, :3, 3] = [0.3, 0.1, 0.0]
        found = long.solve(T)
        assert len(found) == 2 and max(map(len, found.curves)) < 12 / step
    fine, coarse = (ws.postures(arm, point, device="cpu", starts=32, curve_step=step) for step in (0.05, 0.2))
    assert 3 < sum(map(len, fine.curves)) / sum(map(len, coarse.curves)) < 5


def test_points_of_self_motions_say_what_blocks_them():
    robot = ws.load_robot("franka_panda")
    T = robot.chain.poses(drawn(robot.chain, 1, seed=9))
    quat = Rotation.from_matrix(T[0, :3, :3]).as_quat(scalar_first=True)
    low = {"region": {"half_space": {"point_m": [0, 0, T[0, 2, 3] + 0.1], "normal": [0, 0, -1]}}}
    found = ws.postures(robot, T[0, :3, 3], quat, constraints=low, starts=16, device="cpu")
    outside = {"region": {"half_space": {"point_m": [0, 0, T[0, 2, 3] - 0.1], "normal": [0, 0, -1]}}}
    beyond = ws.postures(robot, T[0, :3, 3], quat, constraints=outside, starts=16, device="cpu")
    for result, reasons in ((found, [{""}, {"region"}]), (beyond, [{""}, {"region"}])):
        told = {reason for curve in result.curves for reason in curve.reasons}
        assert told == set(result.reasons) and told in reasons
    assert set(found.reasons) != set(beyond.reasons)


def test_values_at_which_no_closed_form_is_known_are_left_out(monkeypatch):
    """As of a joint that is held where the others are ill-conditioned."""
    arm, held = ws.load_robot(ws.DHTable(convention="standard", rows=[{"a": a} for a in (0.4, 0.3, 0.2)])), []

    def every_second(solver, joint, value, own=PostureSolver._held):
        held.append(own(solver, joint, value))
        held[-1].form = held[-1].form if len(held) % 2 else None
        return held[-1]

    monkeypatch.setattr(PostureSolver, "_held", every_second)
    assert len(ws.postures(arm, [0.3, 0.1, 0.0], device="cpu", starts=1)) == 2 and len(held) == 129
