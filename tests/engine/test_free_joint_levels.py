"""Searches along a free joint level by level, which GPUs take, beside those of lanes; both run on the CPU here."""

import numpy as np
import pytest
import warp as wp
from scipy.spatial.transform import Rotation
from wsrender_kernels.free_joint_levels import free_joint_level_kernel, free_joint_start_kernel

from tests.engine.test_closed_form import anywhere, in_the_box, near_limits
from tests.engine.test_free_joint import ARMS, chain_named, search
from tests.reference.redundant_arms import RANDOM_ARMS, with_limits
from wsrender.engine import free_joint, free_joint_levels
from wsrender.engine.devices import devices_of
from wsrender.engine.evaluation import device_array
from wsrender.engine.free_joint import kernel_shape
from wsrender.engine.free_joint_levels import LevelSearch
from wsrender.reach.inverse_solver import InverseSolver
from wsrender.robots.closed_form import FreeJointForm


@pytest.fixture(autouse=True)
def everywhere(monkeypatch):
    monkeypatch.setattr(free_joint, "worth_levels", lambda device: True)


def by_levels(chain, T, **options):
    found = search(chain, T, places=False, **options)
    assert found.at is None and found.balls is None
    return found


def poses(chain, count=3000):
    return np.concatenate([in_the_box(chain, count), chain.poses(anywhere(chain, count // 3))])


def states(found):
    return found.reached.astype(int) - found.unreachable


@pytest.mark.parametrize("name", [*ARMS, *RANDOM_ARMS])
def test_states_are_those_of_lanes(name, device):
    """But for a posture within float64's rounding of limits, the only ones that other orders of balls may miss."""
    chain = chain_named(name)
    T, close = poses(chain), chain.poses(near_limits(chain, 400))
    found, expected = (states(decide(chain, T, device=device)) for decide in (by_levels, search))
    assert min((found > 0).mean(), (found < 0).mean()) > 0.02
    assert (found * expected >= 0).all() and (found != expected).mean() < 1e-3
    found, expected = (states(decide(chain, close, device=device)) for decide in (by_levels, search))
    assert (found >= 0).all() and (found * expected >= 0).all() and ((found == 0) & (expected != 0)).mean() < 5e-3


def test_in_float64_alone_the_same():
    chain = chain_named("franka_panda")
    form, T = FreeJointForm.of(chain), poses(chain)
    cpu = devices_of("cpu")[0]
    given = [device_array(values, wp.float64, cpu) for values in (T.ravel(), np.eye(4).ravel())]
    single, double = (
        LevelSearch(kernel_shape(form), form.numbers(0.0, 0.0), cpu, single=single).states(len(T), *given).numpy()
        for single in (True, False)
    )
    assert (single * double >= 0).all() and (single != double).mean() < 1e-3


def test_float32_reaches_nothing_that_float64_does_not(monkeypatch):
    """One joint's range is so narrow that postures clear of its ends are of 1.6e-3 to 2.4e-3 rad."""
    chain, random = chain_named("kuka_iiwa14"), np.random.default_rng(4)
    for joint in range(1, 7):
        q = anywhere(chain, 3000, joint)
        lower, upper = chain.lower_limits.copy(), chain.upper_limits.copy()
        lower[joint] = random.uniform(-1, 1)
        upper[joint] = lower[joint] + 2.05e-3
        q[:, joint] = lower[joint] + random.uniform(-4e-3, 6e-3, len(q))
        arm = with_limits(chain, lower, upper)
        found, expected = states(by_levels(arm, arm.poses(q))), states(search(arm, arm.poses(q)))
        assert (found * expected >= 0).all()
        assert (found > 0).sum() > 20


def test_lists_that_are_full_are_halved(monkeypatch):
    """Poses whose balls did not fit are decided again, fewer together: the same states to the bit."""
    chain = chain_named("kuka_iiwa14")
    T, decided = np.concatenate([poses(chain), chain.poses(near_limits(chain, 300))]), []
    expected = states(by_levels(chain, T))
    decide = LevelSearch._decide

    def counted(self, first, count, *rest):
        decided.append((first, count, decide(self, first, count, *rest)))
        return decided[-1][2]

    with monkeypatch.context() as patched:
        patched.setattr(LevelSearch, "_decide", counted)
        patched.setattr(free_joint_levels, "ROOM", 0)
        assert (states(by_levels(chain, T)) == expected).all()
    last = [(first, count) for first, count, most in decided if most <= 2 * free_joint_levels.WIDEST]
    assert 4 < len(last) < len(decided)
    assert sorted(at for first, count in last for at in range(first, first + count)) == list(range(len(T)))
    monkeypatch.setattr(free_joint_levels, "TOGETHER", 700)
    assert (states(by_levels(chain, T)) == expected).all()


def test_a_pose_of_too_many_balls_is_undecided(monkeypatch):
    """Of a level: counted where it is alone."""
    chain, most_of = chain_named("kuka_iiwa14"), []
    T = in_the_box(chain, 20_000)
    T = T[search(chain, T).balls > 0]
    whole = states(by_levels(chain, T))
    out, decide = np.flatnonzero(whole < 0), LevelSearch._decide
    with monkeypatch.context() as patched:
        patched.setattr(LevelSearch, "_decide", lambda *args: most_of.append(decide(*args)) or most_of[-1])
        for pose in out:
            by_levels(chain, T[pose : pose + 1])
    for most in (4, 16, 40):
        monkeypatch.setattr(free_joint_levels, "WIDEST", most)
        few = states(by_levels(chain, T))
        given_up = few != whole
        assert (few[given_up] == 0).all()
        assert (given_up[out] == (np.array(most_of) > most)).all()
        assert given_up[out].sum() > 2 and (most > 4 or given_up[whole > 0].any())


@pytest.mark.parametrize("name", ["franka_panda", list(RANDOM_ARMS)[1]])
def test_products_and_quaternions_are_the_poses_that_they_make(name):
    chain, random = chain_named(name), np.random.default_rng(6)
    T, T_tip = poses(chain, 300), np.tile(np.eye(4), (5, 1, 1))
    T_tip[:, :3, 3] = random.normal(size=(5, 3)) * 0.05
    T_tip[:, :3, :3] = Rotation.from_rotvec(random.normal(size=(5, 3)) * 0.3).as_matrix()
    whole = (T[:, None] @ T_tip).reshape(-1, 4, 4)
    expected = states(by_levels(chain, whole))
    assert min((expected > 0).mean(), (expected < 0).mean()) > 0.02
    assert (states(by_levels(chain, T, T_tip=T_tip)) == expected).mean() > 0.999
    turned = Rotation.from_matrix(whole[:, :3, :3]).as_quat(scalar_first=True) * 3
    assert (states(by_levels(chain, whole[:, :3, 3], quat_wxyz=turned)) == expected).mean() > 0.999


def test_what_is_not_a_number_is_undecided():
    chain = chain_named("franka_panda")
    T = chain.poses(anywhere(chain, 3))
    T[1, 0, 3] = np.nan
    assert states(by_levels(chain, T)).tolist() == [1, 0, 1]
    T[1, 0, 3], T[2, 0, 0] = 0.3, np.nan
    assert states(by_levels(chain, T))[[0, 2]].tolist() == [1, 0]
    assert len(by_levels(chain, T[:0]).reached) == 0


def test_labels_of_targets_are_found_so(monkeypatch):
    """Those that proofs, tables of labels and placements ask for; a posture that is asked for is searched alone."""
    chain, levels = chain_named("franka_panda"), []
    states_ = LevelSearch.states
    monkeypatch.setattr(LevelSearch, "states", lambda *args: levels.append(args[1]) or states_(*args))
    solver = InverseSolver(chain, kind="pose", position_m=1e-5, angle_rad=1e-5)
    T = poses(chain, 300)
    q = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    label = solver.closed.labels(T[:, :3, 3], T[:, :3, :3])
    assert (solver.closed.labels_by_quaternions(T[:, :3, 3], q) == label).mean() > 0.99
    assert (solver.closed.labels_from(T, np.eye(4)[None]) == label).mean() > 0.99
    assert levels == [len(T)] * 3
    solver.closed.nearest(T[:, :3, 3], T[:, :3, :3])
    assert len(levels) == 3
    monkeypatch.setattr(free_joint, "worth_levels", lambda device: False)
    assert (solver.closed.labels(T[:, :3, 3], T[:, :3, :3]) == label).all()
    assert len(levels) == 3


@pytest.mark.parametrize("real", [wp.float32, wp.float64])
def test_kernels_compile_for_cuda_without_a_gpu(real, tmp_path):
    shape = kernel_shape(FreeJointForm.of(chain_named("franka_panda")))
    made = [free_joint_level_kernel(free_joint.replace(shape, real=real), cuda=True)]
    made += [free_joint_start_kernel(shape, cuda=True)] * (real is wp.float64)
    for k, kernel in enumerate(made):
        folder = tmp_path / str(k)
        wp.compile_aot_module(kernel.module, device=None, arch=90, module_dir=str(folder), use_ptx=True)
        assert list(folder.glob("*.ptx"))
