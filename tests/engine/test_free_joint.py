"""Searches along a free joint of arms of seven, against forward kinematics and arms of six, one for each value."""

import threading
from itertools import pairwise

import numpy as np
import pytest
import warp as wp
from scipy.spatial.transform import Rotation
from wsrender_kernels.free_joint import free_joint_kernel

import wsrender as ws
from tests.engine import free_joint_sweeps
from tests.engine.test_closed_form import anywhere, in_the_box, near_limits
from tests.reference.arms_by_axes import RELATIONS, axes_of, chain_of
from tests.reference.redundant_arms import RANDOM_ARMS, redundant_arm, swept, with_limits
from wsrender.engine import closed_postures, free_joint, search_free_joint
from wsrender.engine.kernel_cache import launch
from wsrender.robots.closed_form import FreeJointForm

ARMS = ["franka_panda", "kuka_iiwa14"]


def chain_named(name):
    return RANDOM_ARMS[name] if name in RANDOM_ARMS else ws.load_robot(name).chain


def search(chain, T, **options):
    return search_free_joint(FreeJointForm.of(chain), T, **{"device": "cpu"} | options)


def narrow_in_turn(chain, random):
    """The chain with the free joint's range a ball of any width, and one joint's narrow, each joint in turn."""
    free = FreeJointForm.of(chain).free.coordinate
    for joint in np.delete(np.arange(7), free):
        lower, upper = np.full(7, -np.pi), np.full(7, np.pi)
        width = 10 ** random.uniform(-2, 0.49)
        lower[free], upper[free] = -width, width
        lower[joint] = random.uniform(-3, 3)
        upper[joint] = lower[joint] + 10 ** random.uniform(-5, -2)
        yield with_limits(chain, lower, upper)


@pytest.mark.parametrize("name", [*ARMS, *RANDOM_ARMS])
def test_balls_that_hold_a_posture_are_not_closed(name, monkeypatch):
    """Hundreds of balls for every pose: those around the posture that made it, at its centre and not."""
    monkeypatch.setattr(free_joint, "SEARCHES", ((32, 32, 0.05), (2048, 2048, 2e-5)))
    chain, random, balls = chain_named(name), np.random.default_rng(1), []
    for arm in narrow_in_turn(chain, random):
        q = anywhere(arm, 600, random.integers(1 << 30))
        found = search(arm, arm.poses(q))
        assert not found.unreachable.any()
        balls.append(found.balls.mean())
    assert np.mean(balls) > 50


@pytest.mark.parametrize(("moved", "turned"), [(1e-2, 0.0), (0.0, 2e-2)])
@pytest.mark.parametrize("name", [*ARMS, *RANDOM_ARMS])
def test_poses_within_the_tolerances_of_one_that_is_reached_are_not_closed(name, moved, turned):
    chain, random, missed = chain_named(name), np.random.default_rng(2), 0
    for arm in narrow_in_turn(chain, random):
        T = arm.poses(anywhere(arm, 150, random.integers(1 << 30)))
        T[:, :3, 3] += moved * unit_vectors(random, 150)
        T[:, :3, :3] = Rotation.from_rotvec(turned * unit_vectors(random, 150)).as_matrix() @ T[:, :3, :3]
        assert not search(arm, T, position_m=moved, angle_rad=turned).unreachable.any()
        missed += search(arm, T, position_m=moved / 100, angle_rad=turned / 100).unreachable.sum()
    assert missed > 20


def unit_vectors(random, count):
    v = random.normal(size=(count, 3))
    return v / np.linalg.norm(v, axis=1, keepdims=True)


@pytest.mark.parametrize("name", [*ARMS, *RANDOM_ARMS])
def test_made_poses_are_reached(name):
    """By the posture that is said to be there."""
    chain = chain_named(name)
    form = FreeJointForm.of(chain)
    for q in (anywhere(chain, 4000), near_limits(chain, 500)):
        T = chain.poses(q)
        found = search(chain, T)
        assert not found.unreachable.any()
        at = found.at[found.reached]
        rows = closed_postures(form.rest, form.standing(T[found.reached], at), keep=True, device="cpu").rows
        best = np.argmax(rows[..., 12], axis=1)
        solutions = form.configurations(rows[..., :12], at)[np.arange(len(at)), best]
        assert ((solutions >= chain.lower_limits) & (solutions <= chain.upper_limits)).all()
        assert chain.poses(solutions) == pytest.approx(T[found.reached], abs=1e-8)


@pytest.mark.parametrize("name", ARMS)
def test_few_made_poses_are_undecided(name):
    """Those away from limits and from the straight elbow."""
    chain = chain_named(name)
    q = anywhere(chain, 20_000)
    off = np.minimum(q - chain.lower_limits, chain.upper_limits - q).min(axis=1)
    straight = name == "kuka_iiwa14"  # the Panda's, offset as it is, is beyond its limits
    clear = (off > 1e-3) & ~(straight & (np.abs(np.sin(q[:, 3])) < 1e-3))
    found = search(chain, chain.poses(q[clear]), position_m=1e-5, angle_rad=1e-5)
    assert clear.mean() > 0.98
    assert found.reached.mean() > 0.999


@pytest.mark.parametrize("name", [*ARMS, *RANDOM_ARMS])
def test_no_value_of_the_free_joint_refutes_what_is_proven(name):
    chain = chain_named(name)
    T = in_the_box(chain, 1500)
    found = search(chain, T)
    there = swept(chain, T, 128)
    assert not (there & found.unreachable).any()
    assert not (~there & found.reached).mean() > 0.02  # between two values
    assert min(found.unreachable.mean(), (found.unreachable | found.reached).mean() - 0.79) > 0.2
    assert found.balls.mean() < 10


@pytest.mark.parametrize("name", [name for name in RANDOM_ARMS if "rail" in name])
def test_no_place_on_a_rail_refutes_what_is_proven(name):
    """Poses near ones that are reached, as few others are in the box of a long rail."""
    arm, random = chain_named(name), np.random.default_rng(5)
    ends = np.where(arm.joint_is_revolute, 1.2, 0.7)
    arm = with_limits(arm, -ends, ends)
    T = arm.poses(anywhere(arm, 600))
    T[:, :3, 3] += random.uniform(0, 0.5, (600, 1)) * unit_vectors(random, 600)
    turned = Rotation.from_rotvec(random.uniform(0, 1.5, (600, 1)) * unit_vectors(random, 600))
    T[:, :3, :3] = turned.as_matrix() @ T[:, :3, :3]
    found, there = search(arm, T), swept(arm, T, 128)
    assert not (there & found.unreachable).any()
    assert (there & found.reached).sum() > 0.95 * found.reached.sum() > 150
    assert (found.unreachable & (found.balls > 0)).mean() > 0.3


def test_where_a_wrist_passes_the_shoulder_at_a_ball_s_centre_its_distance_still_grows():
    """A rail along axis 1: at the centre of the outermost ball the wrist is as high as where axes 1 and 2 meet, and its
    distance from there changes by the square alone. Reached at the ball's end, where joint 1's narrow limits are."""
    searched = 0
    for seed in range(7, 13):
        h, o, T_tip = axes_of(redundant_arm(RELATIONS[0], seed, rail=True))
        h[0], random = h[1], np.random.default_rng(seed)
        for _ in range(40):
            q, wrist = np.append(0, random.uniform(-2.5, 2.5, 6)), o[4]
            for k in (3, 2, 1):
                wrist = o[k] + Rotation.from_rotvec(q[k] * h[k]).apply(wrist - o[k])
            height = (wrist - o[2]) @ h[1]
            if not 0.03 < abs(height) < 1:
                continue
            lower, upper = np.full(7, -3.1), np.full(7, 3.1)
            lower[0], upper[0] = min(0, 16 * height) - 1e-9, max(0, 16 * height) + 1e-9  # eight balls: one ends at 0
            lower[1], upper[1] = q[1] - 1e-3, q[1] + 1e-3
            arm = chain_of(h, o, T_tip, lower, upper, [False, *[True] * 6])
            assert not search(arm, arm.poses(q[None])).unreachable.any()
            searched += 1
    assert searched > 200


@pytest.mark.parametrize("name", [*ARMS, *RANDOM_ARMS])
def test_labels_do_not_depend_on_the_first_balls(name):
    """The range of the free joint in three: what is out of reach is so in each, what is reached in one."""
    chain = chain_named(name)
    free = FreeJointForm.of(chain).free.coordinate
    T = np.concatenate([in_the_box(chain, 2000), chain.poses(near_limits(chain, 300))])
    whole = search(chain, T)
    ends = np.quantile([chain.lower_limits[free], chain.upper_limits[free]], [0.0, 0.23, 0.7, 1.0])
    parts = []
    for low, high in pairwise(ends):
        lower, upper = chain.lower_limits.copy(), chain.upper_limits.copy()
        lower[free], upper[free] = low, high
        parts.append(search(with_limits(chain, lower, upper), T))
    reached = np.any([part.reached for part in parts], axis=0)
    out = np.all([part.unreachable for part in parts], axis=0)
    assert not (whole.unreachable & reached).any() and not (whole.reached & out).any()
    assert (whole.unreachable != out).mean() < 2e-3


def test_labels_do_not_depend_on_the_balls_that_are_allowed(monkeypatch):
    chain = chain_named("kuka_iiwa14")
    T = np.concatenate([in_the_box(chain, 3000), chain.poses(near_limits(chain, 200))])
    found = search(chain, T)
    monkeypatch.setattr(free_joint, "SEARCHES", ((4, 4, 1e-4), (5000, 5000, 1e-4)))
    other = search(chain, T)
    assert not (found.unreachable & other.reached).any() and not (found.reached & other.unreachable).any()
    assert (found.unreachable != other.unreachable).mean() < 2e-3
    assert not (found.balls == other.balls).all()


@pytest.mark.parametrize("name", ARMS)
def test_labels_and_places_do_not_depend_on_what_cuda_searches_first(name, monkeypatch):
    chain = chain_named(name)
    T = np.concatenate([in_the_box(chain, 3000), chain.poses(near_limits(chain, 300))])
    found = search(chain, T)
    monkeypatch.setattr(free_joint, "SEARCHES", (free_joint.FIRST_ON_CUDA, *free_joint.SEARCHES))
    other = search(chain, T)
    for name in ("reached", "unreachable", "at"):
        assert (getattr(found, name) == getattr(other, name)).all()
    again = other.balls > found.balls
    assert 0 < again.mean() < 0.1 and not (other.balls < found.balls).any()


def test_without_limits_more_is_reached():
    """What no limit keeps the arm from: the arm whose joints all turn."""
    chain = chain_named("franka_panda")
    free = with_limits(chain, np.full(7, -np.pi), np.full(7, np.pi))
    T = in_the_box(chain, 3000)
    found, expected = search(chain, T, unlimited=True), search(free, T)
    decided = (found.reached | found.unreachable) & (expected.reached | expected.unreachable)
    assert decided.mean() > 0.99
    assert (found.reached == expected.reached)[decided].all()
    assert (found.reached & search(chain, T).unreachable).sum() > 20


def test_a_pose_is_decided_by_itself():
    chain = chain_named("kuka_iiwa14")
    T = np.concatenate([in_the_box(chain, 3000), chain.poses(near_limits(chain, 300))])
    whole = search(chain, T, threads=1)
    order = np.random.default_rng(0).permutation(len(T))[:1234]
    part = search(chain, T[order], threads=2)
    for found, expected in ((part.reached, whole.reached), (part.unreachable, whole.unreachable), (part.at, whole.at)):
        assert (found == expected[order]).all()
    assert (part.balls == whole.balls[order]).all()


@pytest.mark.parametrize("name", ["franka_panda", *list(RANDOM_ARMS)[:2]])
def test_products_are_the_poses_that_they_make(name, monkeypatch):
    """Whatever is decided together, and by how many threads."""
    chain, random = chain_named(name), np.random.default_rng(6)
    T = np.concatenate([in_the_box(chain, 300), chain.poses(anywhere(chain, 300))])
    T_tip = np.tile(np.eye(4), (7, 1, 1))
    T_tip[:, :3, 3] = random.normal(size=(7, 3)) * 0.05
    T_tip[:, :3, :3] = Rotation.from_rotvec(random.normal(size=(7, 3)) * 0.3).as_matrix()
    expected = search(chain, (T[:, None] @ T_tip).reshape(-1, 4, 4))
    assert min(expected.reached.mean(), expected.unreachable.mean()) > 0.02
    for threads in (1, 2, 3):
        found = search(chain, T, T_tip=T_tip, threads=threads)
        assert (found.reached == expected.reached).mean() > 0.999
        assert (found.unreachable == expected.unreachable).mean() > 0.999
        assert not (found.unreachable & expected.reached).any() and not (found.reached & expected.unreachable).any()
        monkeypatch.setattr(free_joint, "TOGETHER", 500)
        apart = search(chain, T, T_tip=T_tip, threads=threads)
        monkeypatch.undo()
        assert (apart.reached == found.reached).all() and (apart.unreachable == found.unreachable).all()
        assert (apart.balls == found.balls).all() and (apart.at == found.at).all()


def test_threads_share_all_poses(monkeypatch):
    """In parts that none of them waits long for, each pose in one."""
    chain, parts = chain_named("kuka_iiwa14"), []
    T = np.concatenate([in_the_box(chain, 30_000), chain.poses(anywhere(chain, 20_000))])

    def launched(*args, inputs, **options):
        parts.append((threading.get_ident(), inputs[-1].numpy().copy()))
        launch(*args, inputs=inputs, **options)

    monkeypatch.setattr(free_joint, "launch", launched)
    found = search(chain, T, threads=2, position_m=1e-4, angle_rad=1e-4)
    first = parts[: -(-len(T) // free_joint.PART)]
    assert (np.sort(np.concatenate([which for _, which in first])) == np.arange(len(T))).all()
    assert len({thread for thread, _ in parts}) == 2
    rest = np.concatenate([which for _, which in parts[len(first) :]])
    assert 0 < len(rest) < len(T) / 20
    assert found.reached[rest].any() and not found.unreachable[rest].any()


def test_on_every_device(device):
    chain = chain_named("franka_panda")
    T = np.concatenate([in_the_box(chain, 3000), chain.poses(anywhere(chain, 1000))])
    found, expected = search(chain, T, device=device), search(chain, T)
    assert not (found.unreachable & expected.reached).any() and not (found.reached & expected.unreachable).any()
    assert (found.unreachable != expected.unreachable).mean() < 1e-3


def test_what_is_not_a_number_is_undecided():
    chain = chain_named("franka_panda")
    T = chain.poses(anywhere(chain, 3))
    T[1, 0, 3] = np.nan
    found = search(chain, T)
    assert found.reached.tolist() == [True, False, True]
    assert not found.unreachable.any()
    assert len(search(chain, T[:0]).reached) == 0


@pytest.mark.parametrize("name", [ARMS[0], next(iter(RANDOM_ARMS))])
def test_kernels_compile_for_cuda_without_a_gpu(name, tmp_path):
    shape = free_joint.kernel_shape(FreeJointForm.of(chain_named(name)))
    wp.compile_aot_module(
        free_joint_kernel(shape, cuda=True).module, device=None, arch=90, module_dir=str(tmp_path), use_ptx=True
    )
    assert list(tmp_path.glob("*.ptx"))


def test_violations_of_long_sweeps():
    fine, refuted = free_joint_sweeps.Figures(undecided=1e-3), free_joint_sweeps.Figures(refuted=1)
    figures = {"a": fine, "b": refuted, "c": free_joint_sweeps.Figures(unreachable=2, undecided=2e-3)}
    assert free_joint_sweeps.violations({"a": fine}) == []
    assert [told.split(":")[0] for told in free_joint_sweeps.violations(figures)] == ["b", "c", "c"]
