"""Closed-form inverse kinematics against forward kinematics, arms of every class made at random."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import warp as wp
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from wsrender_kernels.closed_form import closed_form_kernel

import wsrender as ws
from tests.reference import closed_form_inverse
from tests.reference.arms_by_axes import PARALLEL, RELATIONS, axes_of, chain_of, frame, random_arm, reversed_chain
from wsrender.engine.closed_form import CLOSED_MARGIN, closed_postures, placed_bits, placed_slacks, shape_of
from wsrender.reach.moving_joints import moving_joints
from wsrender.robots.closed_form import ClosedForm
from wsrender.robots.reachable_box import reachable_box

COUNT = 4000  # poses of an example
EXACT, SAME = 1e-9, 1e-6  # residuals [m, 1], and postures [rad, m], where no root is double
OFF_LIMITS = (0.0, 1e-5, 1e-4, 1e-3, 1e-2)  # shares of ranges
SLIDES = ("RRP 0", "RRP 1", "RPP 4", "PRP 2", "PPR 4", "PRR 2", "PRR 3", "PPP 4", "RPR 0")


def with_slides(case):
    """An arm whose first three joints are of these kinds; where a slide must lie across an axis, it does."""
    kinds, relation = case.split()
    chain = random_arm(RELATIONS[int(relation)], 3, kinds)
    if kinds in ("PRP", "RPR"):
        h, o, T_tip = axes_of(chain)
        h[2] = np.cross(h[1], h[0]) / np.linalg.norm(np.cross(h[1], h[0]))
        chain = chain_of(h, o, T_tip, chain.lower_limits, chain.upper_limits, chain.joint_is_revolute)
    return chain


def anywhere(chain, count, seed=0):
    return np.random.default_rng(seed).uniform(chain.lower_limits, chain.upper_limits, (count, chain.n))


def near_limits(chain, count, seed=0):
    """Half of the coordinates stand at or close to a limit."""
    random = np.random.default_rng(seed)
    q, shape = anywhere(chain, count, seed), (count, chain.n)
    off = (chain.upper_limits - chain.lower_limits) * random.choice(OFF_LIMITS, shape)
    at = np.where(random.integers(0, 2, shape), chain.upper_limits - off, chain.lower_limits + off)
    return np.where(random.random(shape) < 0.5, at, q)


def postures(chain, T, **options):
    """What is found, all postures (N, 8, n), and which of them there are (N, 8)."""
    closed = ClosedForm.of(chain)
    found = closed_postures(closed, T, keep=True, device="cpu", **options)
    return found, closed.configurations(found.rows[..., :12]), found.rows[..., 12] >= -found.margin


def apart(chain, q, others):
    """Largest difference of any coordinate, hinges by turns, (..., ) [rad, m]."""
    off = np.abs(q - others)
    turned = np.abs(np.remainder(off + np.pi, 2 * np.pi) - np.pi)
    return np.where(chain.revolute, turned, off).max(axis=-1)


def check(chain, q, *, alone=True):
    """Every pose is found to be reached, by the posture that made it among others, which all reach it."""
    T = chain.poses(q)
    found, solutions, there = postures(chain, T)
    assert not (found.slack < -found.margin).any()
    assert (found.count[found.slack > found.margin] > 0).all()
    assert ((solutions >= chain.lower_limits) & (solutions <= chain.upper_limits)).all()
    if alone:
        nearest = np.where(there, apart(chain, q[:, None], solutions), np.inf).min(axis=1)
        assert (nearest < SAME).all()
        assert not found.flags.any()
    clear = np.nonzero(there & (found.rows[..., 12] > found.margin))
    assert chain.poses(solutions[clear]) == pytest.approx(T[clear[0]], abs=EXACT)


@pytest.mark.parametrize("kind", [*RELATIONS, PARALLEL])
@settings(max_examples=4, deadline=None, derandomize=True)
@given(seed=st.integers(0, 2**32 - 1), backwards=st.booleans())
def test_arms_of_every_class(kind, seed, backwards):
    chain = random_arm(kind, seed)
    chain = reversed_chain(chain) if backwards else chain
    check(chain, anywhere(chain, COUNT, seed))
    q = near_limits(chain, COUNT, seed)
    check(chain, q, alone=False)
    found = closed_postures(ClosedForm.of(chain), chain.poses(q), device="cpu", precision="float32")
    missed = found.slack < -found.margin  # of which float64 has the last word
    assert missed.mean() < (0.1 if kind == "general arm" else 1e-3)


@pytest.mark.parametrize("case", SLIDES)
def test_arms_with_slides(case):
    chain = with_slides(case)
    check(chain, anywhere(chain, COUNT))
    check(chain, near_limits(chain, COUNT), alone=False)


def at_singular_postures(chain, count):
    """Coordinates at limits, in the middle, and at multiples of 45°, a little off them or not."""
    random = np.random.default_rng(0)
    columns = []
    for lower, upper, turns in zip(chain.lower_limits, chain.upper_limits, chain.revolute, strict=True):
        values = [lower, upper, (lower + upper) / 2]
        values += [a for a in np.arange(-8, 9) * np.pi / 4 if turns and lower <= a <= upper]
        columns.append(random.choice(values, count))
    off = random.choice([0.0, 0.0, 1e-12, 1e-9, 1e-7, 1e-5], (count, chain.n)) * random.choice(
        [-1, 1], (count, chain.n)
    )
    return np.clip(np.array(columns).T + off, chain.lower_limits, chain.upper_limits)


@pytest.mark.parametrize("name", ["ur5e", "puma560", "gao_6r", "stanford_arm", "slave_5r", "scara"])
def test_singular_poses_are_not_called_unreachable(name):
    chain = ws.load_robot(name).chain
    q = at_singular_postures(chain, 2 * COUNT)
    check(chain, q, alone=False)
    found, _, _ = postures(chain, chain.poses(q))
    if name == "puma560":  # the axes of others' wrists are never quite in line
        in_line = (np.abs(np.sin(q[:, 4])) < 1e-11) & (found.slack > found.margin)
        assert in_line.mean() > 0.01
        assert ((found.flags & 1 > 0) >= in_line).all()


def wrist_in_line(q):
    q[4] = 0.0


def center_on_axis_1(q):
    q[2] = np.pi - 2 * q[1]


def center_on_axis_2(q):
    q[2] = np.pi


@pytest.mark.parametrize(
    ("name", "singular"),
    [("ur5e", wrist_in_line), ("puma560", wrist_in_line)]
    + [("articulated", singular) for singular in (wrist_in_line, center_on_axis_1, center_on_axis_2)],
)
def test_families_of_arms_with_narrow_limits_are_not_called_unreachable(name, singular):
    """A joint is free there: the posture that made a pose, or comes close to it, is one of many."""
    chain, random = ws.load_robot(name).chain, np.random.default_rng(0)
    for off in [0.0, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3] * 20:
        middle = random.uniform(-np.pi, np.pi, 6)
        singular(middle)
        below, above = random.uniform(0.0, 0.3, (2, 6))
        q = random.uniform(middle - below, middle + above, (100, 6))
        for row in q:
            singular(row)
        low, high = np.minimum(middle - below, q.min(axis=0)), np.maximum(middle + above, q.max(axis=0))
        arm = replace(chain, lower_limits=low, upper_limits=high)
        q = np.clip(q + off * random.normal(size=q.shape), low, high)
        found = closed_postures(ClosedForm.of(arm), arm.poses(q), device="cpu")
        assert not (found.slack < -found.margin).any()


def in_line(chain, count, seed=0):
    """Joint 5 at a multiple of a half turn, or 1e-4 to 1e-16 rad beside it; the others anywhere, or at limits."""
    random = np.random.default_rng(seed)
    q = np.where(random.random((count, 6)) < 0.7, anywhere(chain, count, seed), near_limits(chain, count, seed + 1))
    turns = np.pi * np.arange(-4, 5)
    turns = turns[(turns >= chain.lower_limits[4]) & (turns <= chain.upper_limits[4])]
    off = random.choice([0.0, 0.0, *10.0 ** -np.arange(4, 17)], count) * random.choice([-1, 1], count)
    q[:, 4] = random.choice(turns, count) + off
    return np.clip(q, chain.lower_limits, chain.upper_limits)


def arm_in_line(kind, tilt, seed):
    """Axis 6 is in line with axis 4 where joint 5, by ``tilt`` to both, stands at 0."""
    chain, random = random_arm(kind, seed), np.random.default_rng(seed)
    h, o, T_tip = axes_of(chain)
    h[4] = np.cos(tilt) * h[3] + np.sin(tilt) * frame(h[3], np.zeros(3))[:3, 0]
    h[5] = h[3]
    middle, half = random.uniform(-1, 1, 6), random.choice([0.4, 1.0, 2.0, 3.0, 3.5, 6.2], 6)
    middle[4] = 0.0
    return chain_of(h, o, T_tip, middle - half, middle + half)


@pytest.mark.parametrize("tilt", [np.pi / 2, np.pi / 2 - 1e-10, 1.1, 0.6])
@pytest.mark.parametrize("kind", [*RELATIONS[:4], PARALLEL])
def test_wrists_in_line_are_not_called_unreachable(kind, tilt):
    """Where joint 5 is known to the root of rounding alone, joint 4 may come out as anything."""
    for seed in range(4):
        chain = arm_in_line(kind, tilt, seed)
        form, T = ClosedForm.of(chain), chain.poses(in_line(chain, COUNT, seed))
        found = closed_postures(form, T, device="cpu")
        assert not (found.slack < -found.margin).any()
        single = closed_postures(form, T, device="cpu", precision="float32")
        assert (single.slack < -single.margin).mean() < 1e-3


def test_centers_on_axis_1_of_general_arms_are_not_called_unreachable():
    """Joint 1 comes out as anything there, and the wrist with it."""
    for seed in (39, 69, 76):  # of 80: these have such poses
        h, o, T_tip = axes_of(random_arm(RELATIONS[4], seed))
        random = np.random.default_rng(seed)
        o[3:] = o[0] + random.uniform(-0.5, 0.5) * h[0]
        middle, half = random.uniform(-1, 1, 6) * [1, 0, 0, 1, 1, 1], random.choice([0.4, 1.0, 2.0, 3.0, 3.5], 6)
        chain = chain_of(h, o, T_tip, middle - half, middle + half)
        q = np.where(random.random((COUNT, 6)) < 0.5, anywhere(chain, COUNT), near_limits(chain, COUNT))
        q[:, 1:3] = 0.0
        off = random.choice([0.0, 0.0, *10.0 ** -np.arange(4, 17)], (COUNT, 1)) * random.normal(size=q.shape)
        T = chain.poses(np.clip(q + off, chain.lower_limits, chain.upper_limits))
        found = closed_postures(ClosedForm.of(chain), T, device="cpu")
        assert not (found.slack < -found.margin).any()


def test_a_wrist_in_line_is_reached_where_two_arcs_meet():
    """Against 20,000 values of joint 4."""
    chain = random_arm(RELATIONS[0], 1)
    h, o, T_tip = axes_of(chain)
    h[4] = np.cross(h[3], [1.0, 0, 0]) / np.linalg.norm(np.cross(h[3], [1.0, 0, 0]))
    h[5] = h[3]
    random, sweep = np.random.default_rng(0), np.linspace(0, 1, 20_001)
    for flipped, _ in product((0.0, np.pi), range(12)):
        middle, half = random.uniform(-2, 2, 6), np.array([3.0, 3.0, 3.0, *random.uniform(0.1, 1.0, 3)])
        middle[4] = flipped
        arm = chain_of(h, o, T_tip, middle - half, middle + half)
        q = np.tile(middle, (50, 1))
        q[:, 3] += random.uniform(-3, 3, 50)
        T = arm.poses(q)
        found, solutions, there = postures(arm, T)
        four = middle[3] - half[3] + 2 * half[3] * sweep
        sign = 1.0 if flipped == 0.0 else -1.0
        six = sign * (q[:, 3, None] - four) + middle[5]
        off = np.abs(np.remainder(six - middle[5] + np.pi, 2 * np.pi) - np.pi).min(axis=1)
        clear = np.abs(off - half[5]) > 1e-3
        assert ((found.slack > 0) == (off < half[5]))[clear].all()
        assert (there.any(axis=1) == (off < half[5]))[clear].all()
        pose, branch = np.nonzero(there)
        assert (found.flags[pose] == 1).all()
        assert arm.poses(solutions[pose, branch]) == pytest.approx(T[pose], abs=1e-7)


@pytest.mark.parametrize("name", ["ur5e", "puma560", "stanford_arm"])
def test_postures_are_counted_with_their_windings(name):
    """Against all postures of the arm without limits, each turned by as many turns as the limits allow."""
    chain = ws.load_robot(name).chain
    T = chain.poses(anywhere(chain, COUNT))
    found, _, _ = postures(chain, T)
    ends = {"lower_limits": np.full(chain.n, -np.pi), "upper_limits": np.full(chain.n, np.pi)}
    _, free, there = postures(replace(chain, **ends), T)
    count = there.astype(int)
    for k in range(chain.n):
        turns = np.arange(-4, 5) * 2 * np.pi if chain.revolute[k] else np.zeros(1)
        values = free[..., k, None] + turns
        count = count * ((values > chain.lower_limits[k]) & (values < chain.upper_limits[k])).sum(axis=-1)
    clear = found.slack > 1e-6
    assert clear.mean() > 0.9
    doubt = np.abs(np.where(there, found.rows[..., 12], 1)).min(axis=1) < 1e-6
    agreeing = found.count == count.sum(axis=1)
    assert agreeing[clear & ~doubt].all()


def in_the_box(chain, count, seed=0):
    low, high = reachable_box(chain, chain.lower_limits, chain.upper_limits)
    T = np.tile(np.eye(4), (count, 1, 1))
    T[:, :3, 3] = np.random.default_rng(seed).uniform(low, high, (count, 3))
    T[:, :3, :3] = Rotation.random(count, random_state=seed + 1).as_matrix()
    return T


@pytest.mark.parametrize("name", ["ur5e", "puma560", "spherical"])
def test_poses_anywhere_against_other_closed_forms(name, precision, device):
    chain = ws.load_robot(name).chain
    T = in_the_box(chain, 5 * COUNT)
    with np.errstate(invalid="ignore", divide="ignore"):
        if name == "ur5e":
            solutions = closed_form_inverse.ur5e(T[:, :3, 3], T[:, :3, :3])
        else:
            arm = {"puma560": closed_form_inverse.puma560_arm, "spherical": closed_form_inverse.spherical_arm}[name]
            solutions = closed_form_inverse.with_spherical_wrist(name, arm(T[:, :3, 3]), T[:, :3, :3])
    limits = chain.lower_limits, chain.upper_limits, chain.revolute
    truth = closed_form_inverse.within_limits(solutions, *limits).any(axis=1)
    found = closed_postures(ClosedForm.of(chain), T, device=device, precision=precision)
    decided = np.abs(found.slack) > found.margin
    assert decided.mean() > 0.99
    assert ((found.slack > 0) == truth)[decided].all()
    assert ((found.count > 0) == truth)[decided].all()


def test_axes_and_positions():
    """What a target leaves open turns freely: the tip's z alone for UR's wrist, nothing but the point for Puma's."""
    turns = Rotation.from_rotvec(np.random.default_rng(1).uniform(-3, 3, (COUNT, 1)) * [0, 0, 1]).as_matrix()
    for name, kind in (("ur5e", "axis"), ("puma560", "axis"), ("puma560", "position"), ("stanford_arm", "axis")):
        chain = ws.load_robot(name).chain
        T = chain.poses(anywhere(chain, COUNT))
        T[:, :3, :3] = T[:, :3, :3] @ turns if kind == "axis" else Rotation.random(COUNT, random_state=2).as_matrix()
        part, kept = moving_joints(chain, axis=kind == "axis")
        closed = ClosedForm.of(part, kind)
        found = closed_postures(closed, T, keep=True, device="cpu")
        assert not (found.slack < -found.margin).any()
        pose, branch = np.nonzero(found.rows[..., 12] > found.margin)
        back = part.poses(closed.configurations(found.rows[pose, branch, :12]))
        columns = [2, 3] if kind == "axis" else [3]
        assert back[:, :3, columns] == pytest.approx(T[pose][:, :3, columns], abs=EXACT)
        assert len(kept) == part.n


HELD = [("franka_panda", (6,)), ("franka_panda", (1, 4, 5)), ("kuka_iiwa14", (0,)), ("kuka_iiwa14", (2,))]


@pytest.mark.parametrize(("name", "held"), HELD)
def test_joints_may_be_held_anywhere(name, held):
    """Far from 0, at either end or between."""
    chain, random = ws.load_robot(name).chain, np.random.default_rng(sum(held))
    for _ in range(4):
        values = {k: random.uniform(chain.lower_limits[k], chain.upper_limits[k]) for k in held}
        arm = chain.held({chain.joint_names[k]: value for k, value in values.items()})
        q = anywhere(arm, 200)
        found, solutions, there = postures(arm, arm.poses(q))
        pose, branch = np.nonzero(there)
        assert not (found.slack < -found.margin).any()
        assert (solutions[pose, branch][:, list(held)] == [values[k] for k in held]).all()
        assert (np.where(there, apart(arm, q[:, None], solutions), 9.0).min(axis=1) < SAME).all()


def test_a_pose_is_decided_by_itself():
    chain = ws.load_robot("puma560").chain
    closed, T = ClosedForm.of(chain), in_the_box(chain, 5000)
    whole = closed_postures(closed, T, device="cpu", threads=1)
    order = np.random.default_rng(0).permutation(len(T))[:1234]
    part = closed_postures(closed, T[order], keep=True, device="cpu", threads=2)
    assert (part.slack == whole.slack[order]).all()
    assert (part.count == whole.count[order]).all() and (part.flags == whole.flags[order]).all()


@pytest.mark.parametrize("backwards", [False, True])
def test_moved_bases_reach_what_is_moved_the_other_way(backwards):
    chain = random_arm(RELATIONS[0], 5)
    chain = reversed_chain(chain) if backwards else chain
    closed, bases = ClosedForm.of(chain), np.tile(np.eye(4), (1500, 1, 1))
    assert closed.solved.axes.reversed == backwards
    bases[:, :3, :3] = Rotation.random(1500, random_state=1).as_matrix()
    bases[:, :3, 3] = np.random.default_rng(2).uniform(-0.5, 0.5, (1500, 3))
    T = chain.poses(anywhere(chain, 3))
    found = placed_slacks(closed, bases, T, device="cpu", threads=2)
    for pose, slack in zip(T, found, strict=True):
        moved = chain.T_world_base @ np.linalg.inv(bases) @ pose
        assert np.abs(slack - closed_postures(closed, moved, device="cpu").slack).max() < 1e-8
    assert 0.02 < (found > 0).mean() < 0.98


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("numbers", [range(4, 10), range(3, 7 * 400), range(35, 7 * 400, 7), range(2, 7 * 400, 3)])
def test_bits_of_placed_bases_are_those_of_their_slacks(backwards, numbers):
    """Fewer bases than a task takes, all that follow one another, some of each position, and some at any."""
    chain = random_arm(RELATIONS[0], 5)
    chain = reversed_chain(chain) if backwards else chain
    closed, random, origin = ClosedForm.of(chain), np.random.default_rng(2), np.array([0.2, -0.1, 0.3])
    motions, positions = np.tile(np.eye(4), (7, 1, 1)), random.uniform(-0.5, 0.5, (400, 3)) + origin
    motions[:, :3, :3] = Rotation.random(7, random_state=1).as_matrix()
    motions[:, :3, 3] = random.uniform(-0.1, 0.1, (7, 3))
    bases = motions[np.array(numbers) % 7]
    bases[:, :3, 3] += positions[np.array(numbers) // 7] - origin
    T, targets = chain.poses(anywhere(chain, 11)), np.array([0, 1, 2, 3, 7, 8, 9, 10, 15, 16, 25])
    asked = {"origin": origin, "margin": 1e-3, "device": "cpu", "threads": 2}
    *found, left = placed_bits(closed, motions, positions, numbers, T, targets, **asked)
    slack = placed_slacks(closed, bases, T, device="cpu", threads=2)
    for bits, wanted in zip(found, (slack > CLOSED_MARGIN, slack < -1e-3), strict=True):
        assert bits.shape == (len(numbers), 4)
        each = np.unpackbits(bits.T, axis=0, bitorder="little")
        np.testing.assert_array_equal(each[targets], wanted)
        assert not np.delete(each, targets, axis=0).any()
    is_open = (slack >= -1e-3) & (slack <= CLOSED_MARGIN)
    np.testing.assert_array_equal(left, np.flatnonzero(is_open.any(axis=0)))
    assert 0 < (slack < -1e-3).sum() < slack.size and (slack > CLOSED_MARGIN).any()
    assert len(numbers) < 100 or 0 < len(left) < len(numbers)


def test_what_is_not_a_number_is_undecided():
    chain = ws.load_robot("ur5e").chain
    T = chain.poses(anywhere(chain, 3))
    T[1, 0, 3] = np.nan
    found = closed_postures(ClosedForm.of(chain), T, device="cpu")
    assert not abs(found.slack[1]) > found.margin and found.count[1] == 0
    assert (found.slack[[0, 2]] > found.margin).all()


@pytest.mark.parametrize(
    ("name", "precision"),
    [("ur5e", "float64"), ("ur5e", "float32"), ("puma560", "float64"), ("stanford_arm", "float64")],
)
def test_kernels_compile_for_cuda_without_a_gpu(name, precision, tmp_path):
    shape = shape_of(ClosedForm.of(ws.load_robot(name).chain), precision, keep=True)
    module = closed_form_kernel(shape, cuda=True).module
    wp.compile_aot_module(module, device=None, arch=90, module_dir=str(tmp_path), use_ptx=True)
    (ptx,) = tmp_path.glob("*.ptx")
    assert ("min.NaN.f32" in ptx.read_text()) == (precision == "float32")  # one instruction, not two of half the rate


def test_no_poses():
    closed = ClosedForm.of(ws.load_robot("ur5e").chain)
    found = closed_postures(closed, np.zeros((0, 4, 4)), keep=True, device="cpu")
    assert found.rows is not None and found.rows.shape == (0, 8, 14) and len(found.slack) == 0
