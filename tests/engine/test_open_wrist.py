"""Searches along joint 6 of open arms, against forward kinematics, a dense sweep and the numerical solver."""

from dataclasses import replace

import numpy as np
import pytest
import warp as wp
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from wsrender_kernels.open_wrist import open_wrist_kernel

import wsrender as ws
from tests.engine import open_wrist_poses
from tests.engine.test_closed_form import EXACT, anywhere, apart, in_the_box, near_limits
from tests.reference.arms_by_axes import axes_of, chain_of
from tests.reference.open_arms import ARMS, TABLES, open_arm, random_open_arm
from tests.reference.redundant_arms import with_limits
from wsrender.engine import open_wrist, open_wrist_postures, search_open_wrist
from wsrender.reach import InverseSolver
from wsrender.robots.closed_form import ClosedForm, OpenWristForm

COUNT = 2000  # poses of an arm


def search(chain, T, **options):
    return search_open_wrist(OpenWristForm.of(chain), T, **{"device": "cpu"} | options)


def unit_vectors(random, count):
    v = random.normal(size=(count, 3))
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def check_on_pose(chain, T, sets):
    """Postures within the limits reach their pose."""
    solutions = OpenWristForm.of(chain).rest.configurations(sets.rows[..., :12])
    pose, number = np.nonzero(sets.rows[..., 12] > sets.margin)
    assert chain.poses(solutions[pose, number]) == pytest.approx(T[pose], abs=EXACT)


def check_made(chain, seed=0, count=COUNT):
    """Made poses are reached, by the posture that is said to be there; the one that made them is in the set."""
    form = OpenWristForm.of(chain)
    for q in (anywhere(chain, count, seed), near_limits(chain, count // 2, seed)):
        T = chain.poses(q)
        found = search(chain, T)
        assert not found.unreachable.any()
        solutions = form.rest.configurations(found.rows[found.reached, :12])
        assert ((solutions >= chain.lower_limits) & (solutions <= chain.upper_limits)).all()
        assert chain.poses(solutions) == pytest.approx(T[found.reached], abs=1e-8)
    q = anywhere(chain, count, seed)
    sets = open_wrist_postures(form, chain.poses(q), device="cpu")
    there = sets.rows[..., 12] > -open_wrist_poses.NEAR
    nearest = np.where(there, apart(chain, q[:, None], form.rest.configurations(sets.rows[..., :12])), np.inf)
    assert not ((nearest.min(axis=1) > 1e-6) & (sets.flags == 0)).any()
    assert (sets.flags > 0).mean() < 0.05
    check_on_pose(chain, chain.poses(q), sets)
    return search(chain, chain.poses(q))


@pytest.mark.parametrize("name", ARMS)
def test_made_poses_are_reached_and_their_configuration_is_in_the_set(name):
    found = check_made(open_arm(name))
    assert found.reached.mean() > (0.99 if name in TABLES else 0.97)
    assert found.evaluations.mean() < (12 if name in TABLES else 120)


@settings(max_examples=6, deadline=None, derandomize=True)
@given(seed=st.integers(0, 2**32 - 1))
def test_random_arms(seed):
    check_made(random_open_arm(seed), seed, 500)


def narrow_in_turn(chain, random):
    """The chain with joint 6's range a ball of any width, and one joint's narrow, each joint in turn."""
    last = OpenWristForm.of(chain).solved.axes.axes[5].coordinate
    for joint in np.delete(np.arange(6), last):
        lower, upper = np.full(6, -np.pi), np.full(6, np.pi)
        width = 10 ** random.uniform(-2, 0.49)
        lower[last], upper[last] = -width, width
        lower[joint] = random.uniform(-3, 3)
        upper[joint] = lower[joint] + 10 ** random.uniform(-5, -2)
        yield with_limits(chain, lower, upper)


@pytest.mark.parametrize("name", ["CRX-10iA", "xArm6", "Jaco2, backwards", "random 0", "random 1", "random 2"])
def test_balls_that_hold_a_posture_are_not_closed(name):
    """Around the posture that made the pose, which no other joint's limits leave a choice."""
    chain, random = open_arm(name), np.random.default_rng(1)
    for arm in narrow_in_turn(chain, random):
        found = search(arm, arm.poses(anywhere(arm, 600, random.integers(1 << 30))))
        assert not found.unreachable.any()


@pytest.mark.parametrize(("moved", "turned"), [(1e-2, 0.0), (0.0, 2e-2)])
@pytest.mark.parametrize("name", ["CRX-10iA", "xArm6", "Jaco2, backwards", "random 0", "random 1", "random 2"])
def test_poses_within_the_tolerances_of_one_that_is_reached_are_not_closed(name, moved, turned):
    chain, random, missed = open_arm(name), np.random.default_rng(2), 0
    for arm in narrow_in_turn(chain, random):
        T = arm.poses(anywhere(arm, 200, random.integers(1 << 30)))
        T[:, :3, 3] += moved * unit_vectors(random, 200)
        T[:, :3, :3] = Rotation.from_rotvec(turned * unit_vectors(random, 200)).as_matrix() @ T[:, :3, :3]
        assert not search(arm, T, position_m=moved, angle_rad=turned).unreachable.any()
        missed += search(arm, T, position_m=moved / 100, angle_rad=turned / 100).unreachable.sum()
    assert missed > 20


def test_poses_turned_within_the_tolerance_are_not_closed_where_no_point_moves():
    """About where axes 4, 5 and 6 nearly meet: joints 1 to 3 stay, joints 4 to 6 turn."""
    chain, random, missed = open_arm("Piper"), np.random.default_rng(2), 0
    T_tip = np.eye(4)
    T_tip[2, 3] = -0.091
    for arm in narrow_in_turn(chain.placed(T_tip_tool=chain.T_tip_tool @ T_tip), random):
        T = arm.poses(anywhere(arm, 200, random.integers(1 << 30)))
        T[:, :3, :3] = Rotation.from_rotvec(2e-2 * unit_vectors(random, 200)).as_matrix() @ T[:, :3, :3]
        assert not search(arm, T, angle_rad=2e-2).unreachable.any()
        missed += search(arm, T, angle_rad=2e-4).unreachable.sum()
    assert missed > 20


@pytest.mark.parametrize("name", ["CRX-10iA", "xArm6", "Jaco2", "Piper", "random 1", "random 2"])
def test_the_numerical_solver_refutes_nothing(name):
    chain = open_arm(name)
    T = np.concatenate([in_the_box(chain, 600), chain.poses(near_limits(chain, 100))])
    T[600:, :3, 3] += 1e-3 * unit_vectors(np.random.default_rng(0), 100)
    found = search(chain, T, position_m=1e-5, angle_rad=1e-5)
    solver = InverseSolver(chain, kind="pose", position_m=1e-5, angle_rad=1e-5, device="cpu", threads=1)
    solver.closed = None
    there = solver.solve(T[:, :3, 3], T[:, :3, :3]).label == 1
    assert not (there & found.unreachable).any()
    assert (found.reached | found.unreachable)[:600].mean() > 0.99
    assert found.unreachable[:600].mean() > 0.2 and there.any()


def test_what_tightens_the_search_changes_no_label(monkeypatch):
    chain = open_arm("CRX-10iA")
    T = np.concatenate([in_the_box(chain, 2000), chain.poses(near_limits(chain, 200))])
    found = search(chain, T)
    monkeypatch.setattr(open_wrist, "SEARCHES", ((8, 1e-2), (9000, 1e-5)))
    other = search(chain, T)
    assert not (found.unreachable & other.reached).any() and not (found.reached & other.unreachable).any()
    assert (found.unreachable != other.unreachable).mean() < 2e-3
    assert not (found.evaluations == other.evaluations).all()


@pytest.mark.parametrize("joint", [3, 4])
def test_wrists_that_turn_further_than_axis_5_are_not_closed(joint):
    """Axes 4 and 5 nearly in line, joint 6 almost through them: by far more than z in a ball, where sin z is known."""
    random, h, o = np.random.default_rng(0), np.empty((6, 3)), np.zeros((6, 3))
    h[0], h[1], h[2] = [0, 0, 1], [0, 1, 0], [1, 0, 0]
    o[2], o[3:] = [0.3, 0, 0.1], [0.3, 0.2, 0.5]
    h[3], h[4], h[5] = [0, 0, 1], [0.2, 0, np.sqrt(0.96)], [0, 1, 0]
    o[5] += [1e-4, 0, 0]
    for _ in range(10):
        lower, upper = np.full(6, -np.pi), np.full(6, np.pi)
        lower[joint] = random.uniform(-3, 3)
        upper[joint] = lower[joint] + 1e-3
        chain = chain_of(h, o, np.eye(4), lower, upper)
        assert not search(chain, chain.poses(anywhere(chain, 2000, 1))).unreachable.any()


def test_without_limits_more_is_reached():
    chain = open_arm("Piper")
    free = with_limits(chain, np.full(6, -np.pi), np.full(6, np.pi))
    T = in_the_box(chain, 2000)
    found, expected = search(chain, T, unlimited=True), search(free, T)
    decided = (found.reached | found.unreachable) & (expected.reached | expected.unreachable)
    assert decided.mean() > 0.99
    assert (found.reached == expected.reached)[decided].all()
    assert (found.reached & search(chain, T).unreachable).sum() > 20


def test_a_pose_is_decided_by_itself():
    chain = open_arm("CRX-10iA")
    T = np.concatenate([in_the_box(chain, 3000), chain.poses(near_limits(chain, 300))])
    whole, order = search(chain, T, threads=1), np.random.default_rng(0).permutation(len(T))[:1234]
    part = search(chain, T[order], threads=2)
    for name in ("reached", "unreachable", "rows", "evaluations"):
        assert (getattr(part, name) == getattr(whole, name)[order]).all()
    sets = open_wrist_postures(OpenWristForm.of(chain), T, device="cpu", threads=1)
    some = open_wrist_postures(OpenWristForm.of(chain), T[order], device="cpu", threads=2)
    assert (some.rows == sets.rows[order]).all() and (some.flags == sets.flags[order]).all()


def test_near_singular_poses_keep_their_postures_or_are_flagged():
    """Two postures close together, of poses made where the Jacobian is nearly singular."""
    chain = open_arm("CRX-10iA")
    q = anywhere(chain, 60_000)
    s = np.linalg.svd(chain.jacobians(q), compute_uv=False)[:, -1]
    q = q[np.argsort(s)[:400]]
    form = OpenWristForm.of(chain)
    sets = open_wrist_postures(form, chain.poses(q), device="cpu")
    there = sets.rows[..., 12] > -open_wrist_poses.NEAR
    nearest = np.where(there, apart(chain, q[:, None], form.rest.configurations(sets.rows[..., :12])), np.inf)
    assert not ((nearest.min(axis=1) > 1e-4) & (sets.flags == 0)).any()


@pytest.mark.parametrize(
    ("name", "count", "seed", "number"),
    [
        ("CRX-10iA/L", 20_000, 1, 14074),
        ("random 2", 20_000, 1, 17782),
        ("random 5", 60_000, 1, 39162),
        ("random 10", 6000, 0, 2398),
        ("random 12", 20_000, 1, 1381),
        ("random 12", 20_000, 1, 6465),
        ("random 14", 20_000, 1, 5903),
        ("Jaco2", 1 << 16, 114, 25340),
        ("Jaco2", 1 << 16, 5000, 43407),
        ("HC10", 1 << 16, 206, 46061),
        ("random 1", 1 << 16, 1002, 48129),
        ("random 3", 1 << 16, 102, 49608),
    ],
)
def test_roots_that_the_ends_of_a_ball_do_not_show_are_found(name, count, seed, number):
    """Two close together, lost where f is not close to its cubic, beside a third on a cubic that turns twice, or below
    an extremum that a curve which bends both ways has not come to yet, or next to a fold,
    where a bound by the derivative of a branch that is not there is none."""
    chain = open_arm(name)
    q = anywhere(chain, count, seed)[[number]]
    form = OpenWristForm.of(chain)
    sets = open_wrist_postures(form, chain.poses(q), device="cpu")
    there = sets.rows[0, :, 12] > -open_wrist_poses.NEAR
    assert apart(chain, q, form.rest.configurations(sets.rows[0, there, :12])).min() < 1e-6


def test_postures_where_the_arm_nearly_folds_are_as_exact():
    """Joint 1 turns 17,000 times as fast as joint 6 there, though the whole arm is far from singular."""
    chain = open_arm("random 0")
    T = chain.poses(anywhere(chain, 1 << 16)[[14018]])
    sets = open_wrist_postures(OpenWristForm.of(chain), T, device="cpu")
    assert sets.count == 1 and not sets.flags
    check_on_pose(chain, T, sets)


def test_what_is_not_a_number_is_undecided():
    chain = open_arm("xArm6")
    T = chain.poses(anywhere(chain, 3))
    T[1, 0, 3] = np.nan
    found = search(chain, T)
    assert found.reached.tolist() == [True, False, True] and not found.unreachable.any()
    assert open_wrist_postures(OpenWristForm.of(chain), T, device="cpu").flags[1] > 0
    assert len(search(chain, T[:0]).reached) == 0


def test_on_every_device(device):
    chain = open_arm("CRX-10iA")
    T = np.concatenate([in_the_box(chain, 2000), chain.poses(anywhere(chain, 1000))])
    found, expected = search(chain, T, device=device), search(chain, T)
    assert not (found.unreachable & expected.reached).any() and not (found.reached & expected.unreachable).any()
    assert (found.unreachable != expected.unreachable).mean() < 1e-3
    sets, others = (open_wrist_postures(OpenWristForm.of(chain), T[2000:], device=where) for where in (device, "cpu"))
    assert (sets.count == others.count).mean() > 0.99


@pytest.mark.parametrize("sets", [False, True])
def test_kernels_compile_for_cuda_without_a_gpu(sets, tmp_path):
    shape = open_wrist.kernel_shape(OpenWristForm.of(open_arm("CRX-10iA")), sets)
    wp.compile_aot_module(
        open_wrist_kernel(shape, cuda=True).module, device=None, arch=90, module_dir=str(tmp_path), use_ptx=True
    )
    assert list(tmp_path.glob("*.ptx"))


def test_violations_of_long_sweeps():
    fine = {"poses": 10, "unreachable": 0, "missed": 0}
    assert open_wrist_poses.violations({"a": fine}) == []
    told = open_wrist_poses.violations({"a": fine, "b": fine | {"unreachable": 1}, "c": fine | {"missed": 2}})
    assert [each.split(":")[0] for each in told] == ["b", "c"]


def test_classes():
    """By the axes, moved or not; not where they are off, or where digits are lost."""
    chain = open_arm("CRX-10iA")
    assert ClosedForm.of(chain) is None
    assert OpenWristForm.of(chain).name == (
        "ball search along joint 6, axes 1 and 2 intersecting, axes 4 and 5 intersecting"
    )
    assert OpenWristForm.of(open_arm("Jaco2, backwards")).name == (
        "ball search along joint 1, axes 6 and 5 intersecting, axes 3 and 2 intersecting"
    )
    h, o, T_tip = axes_of(chain)
    for k in (0, 3):  # axes k and k + 1 meet no more
        moved = o + np.where(np.arange(6) <= k, 1e-4, 0.0)[:, None] * np.cross(h[k], h[k + 1])
        off = chain_of(h, moved, T_tip, chain.lower_limits, chain.upper_limits)
        assert OpenWristForm.of(chain_of(h, o, T_tip, off.lower_limits, off.upper_limits))
        assert OpenWristForm.of(off) is None
    turned = chain.T_joint.copy()
    turned[2, :3, :3] = Rotation.from_rotvec([2e-6, 2e-6, 2e-6]).as_matrix() @ turned[2, :3, :3]
    assert OpenWristForm.of(replace(chain, T_joint=turned)) is None
    assert OpenWristForm.of(open_arm("CRX-10iA"), "position") is None


def test_postures_at_the_end_of_an_arc_are_flagged():
    """There axes are in line and the arm is stretched: what is left of the equation touches 0, up to rounding."""
    rows = [(-0.9, 180, -2.8, -80, (-360, 360)), (0, 90, 0, 40, (-101, -44)), (-3.9, -90, -4.4, 90, (-360, 360))]
    rows += [(2.1, 90, 0, 90, None), (-4, 0, 0, 0, (-180, 180)), (0, 0, 0, 88, (-360, 360))]
    names = ("a", "alpha_deg", "d", "theta_deg", "limits_deg")
    table = ws.DHTable(convention="standard", rows=[dict(zip(names, row, strict=True)) for row in rows])
    chain = ws.load_robot(table).chain
    lower, upper = np.maximum(chain.lower_limits, -6), np.minimum(chain.upper_limits, 6)
    q = np.random.default_rng(0).uniform(lower, upper, (500, 6))
    q[:, 2:4] = [0.0, np.pi]
    form = OpenWristForm.of(chain)
    found = open_wrist_postures(form, chain.poses(q), device="cpu")
    off = np.remainder(form.rest.configurations(found.rows[..., :12]) - q[:, None] + np.pi, 2 * np.pi) - np.pi
    there = (np.abs(off).max(axis=2) < 1e-3) & (found.rows[..., 12] > -4)
    assert ((found.flags > 0) | there.any(axis=1)).all()
