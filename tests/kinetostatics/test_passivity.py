"""A simulated device of 3 degrees of freedom on a rendered field: when it creates energy, and when not."""

import numpy as np
import pytest

import wsrender as ws
from tests.kinetostatics.test_force_field import OBSTACLES, SOFT, STRONG, arm
from wsrender.documents.kinetostatics import HapticDevice
from wsrender.kinetostatics.passivity import (
    largest_loop_work,
    loop_path,
    loop_work,
    path_work,
    stiffness_bound,
    stiffnesses,
)

MASS, DAMPING, PERIOD, SUBSTEPS = 0.05, 0.5, 1e-3, 10
BOUND = 2 * DAMPING / PERIOD
DEVICE = {"peak_force_n": 1e4, "continuous_force_n": 1e4, "damping_n_s_per_m": DAMPING, "period_s": PERIOD}


def gantry():
    """Three slides: the tip is where the joints are, so the field is known in closed form."""
    rows = [
        ws.DHRow(joint="prismatic", alpha_deg=90, limits=(-0.1, 0.1)),
        ws.DHRow(joint="prismatic", alpha_deg=90, theta_deg=90, limits=(-0.1, 0.1)),
        ws.DHRow(joint="prismatic", limits=(-0.1, 0.1)),
    ]
    return ws.load_robot(ws.DHTable(convention="standard", rows=rows))


def walls(stiffness, form="potential"):
    limits = {"margin_m": 0.05, "stiffness_n_per_m": stiffness}
    return ws.force_field(gantry(), form=form, haptic_device=DEVICE, joint_limits=limits, conditioning=None)


def energy_created(field, seed, seconds=0.4):
    """Largest gain of ½mv² + U over the work of a random hand, along a trajectory from rest [J].

    The device moves in ten substeps per period while the force is held (zero-order hold).
    """
    rng = np.random.default_rng(seed)
    q = rng.uniform(-0.09, 0.09, 3)
    R = field.kinematics.at(q).J[:3]  # constant: joints to the world
    v, work, gain = np.zeros(3), 0.0, 0.0
    start = field.energy(q)
    dt = PERIOD / SUBSTEPS
    decay = np.exp(-DAMPING / MASS * dt)
    hand = np.zeros(3)
    for tick in range(round(seconds / PERIOD)):
        if tick % 40 == 0:
            hand = rng.normal(size=3) * 4.0 * (tick < 200)  # lets go half-way
        force = field.force(q)
        for _ in range(SUBSTEPS):  # exact for a constant force on mass and damper
            total = force + hand
            after = total / DAMPING + (v - total / DAMPING) * decay
            moved = total / DAMPING * dt + (v - total / DAMPING) * MASS / DAMPING * (1 - decay)
            q, v, work = q + np.linalg.solve(R, moved), after, work + hand @ moved
        gain = max(gain, MASS * (v @ v) / 2 + field.energy(q) - start - work)
    return gain


def test_no_energy_is_created_below_the_bound():
    for share in (0.3, 0.95):
        field = walls(share * BOUND)
        assert stiffnesses(field, 64).max() == pytest.approx(share * BOUND, rel=1e-6)
        assert max(energy_created(field, seed) for seed in range(5)) < 1e-6


def test_far_above_the_bound_energy_is_created():
    """The test above can fail: a spring of 25 times the bound drives the device into oscillation."""
    assert max(energy_created(walls(25 * BOUND), seed) for seed in range(2)) > 1e-3


def test_the_bound_of_a_device():
    device = HapticDevice(damping_n_s_per_m=0.5, period_s=0.001)
    assert stiffness_bound(device) == pytest.approx(1000)
    assert stiffness_bound(device, 0.2) == pytest.approx(600)
    assert stiffness_bound(device, 0.7) == 0


def test_work_of_closed_paths():
    """None for a potential that is not clipped; some where directions are normalised."""
    robot = ws.load_robot("phantom_omni")
    soft = {"joint_limits": {"stiffness_n_m_per_rad": 0.5}, "conditioning": {"stiffness_n_m": 0.05}}
    potential = largest_loop_work(ws.force_field(robot, form="potential", haptic_device=DEVICE, **soft), 24)
    normalised = largest_loop_work(ws.force_field(robot, form="normalised"), 24)
    assert min(potential.paths, normalised.paths) > 10
    assert potential.work_j < 0.02 * normalised.work_j
    dissipated = normalised.damping_n_s_per_m * normalised.speed_m_per_s * normalised.length_m
    assert dissipated == pytest.approx(normalised.work_j)


TERMS = {"joint_limits": SOFT, "conditioning": {"inverse_condition_on": 0.6, "stiffness_n_m": 5.0}}
TERMS |= {"obstacles": OBSTACLES | {"stiffness_n_per_m": 100.0}}


def potential(joints, kind="force", **device):
    """All terms that act on the tip or the joints; nothing is clipped by a strong device."""
    choices = {**TERMS, "task": "full" if kind == "wrench" else "linear"}
    device = {"kind": kind, **(device or STRONG)}
    return ws.force_field(arm(joints), form="potential", haptic_device=device, **choices)


def joint_loops(field, count, steps, seed=0, farthest=50.0):
    """Closed paths (steps + 1, n) of the joints through a sixth of their ranges, across ramps and beyond limits.

    Their Jacobians have condition numbers below ``farthest``: the pseudo-inverse is damped above 100.
    """
    random, chain = np.random.default_rng(seed), field.chain
    span = chain.upper_limits - chain.lower_limits
    angle = 2 * np.pi * np.arange(steps + 1)[:, None] / steps
    while count:
        middle = random.uniform(chain.lower_limits, chain.upper_limits)
        swings = random.normal(size=(2, chain.n)) * span / 12
        path = middle + np.cos(angle) * swings[0] + np.sin(angle) * swings[1]
        path[-1] = path[0]
        if max(np.linalg.cond(field._jacobian(field.kinematics.at(q))) for q in path[::4]) < farthest:
            count -= 1
            yield path


@pytest.mark.parametrize(("joints", "kind"), [(3, "force"), (6, "wrench")])
def test_a_potential_that_is_not_clipped_does_no_work_round_closed_loops_of_the_joints(joints, kind):
    """∮ F·dx → 0 with the steps, while forces do joules on the way."""
    field, ratios = potential(joints, kind), []
    for path in joint_loops(field, 6, 400):
        fine, coarse = path_work(field, path), path_work(field, path[::2])
        done = sum(abs(path_work(field, part).work_j) for part in (path[:101], path[100:201], path[200:301]))
        assert abs(fine.work_j) < 1e-3 * max(done, 1e-2)
        ratios.append(fine.hidden_j / coarse.hidden_j)
        assert fine.clipped_j == 0 and fine.energy_j == pytest.approx(0, abs=1e-12)
        assert fine.hidden_j < 0.01 * max(done, 1e-2)  # kinks inside of obstacles
    assert np.median(ratios) < 0.4


def test_a_redundant_arm_gives_what_its_energy_loses_where_its_joints_follow_the_tip():
    """Along q̇ = J⁺ ẋ, which need not come back: ∫ F·dx = −ΔU. Round loops of the joints self-motions take part."""
    field = potential(6)
    random, followed = np.random.default_rng(2), 0
    for closed in joint_loops(field, 6, 60):
        path = loop_path(field, closed[0], 0.02 * np.linalg.qr(random.normal(size=(3, 2)))[0])
        if path is None:
            continue
        work = path_work(field, path)
        assert work.work_j == pytest.approx(-work.energy_j, abs=1e-3)
        followed += abs(work.energy_j) > 5e-3
        round_ = path_work(field, closed)
        assert abs(round_.work_j) <= round_.bound_j
    assert followed > 0
    self_motions = [path_work(field, path) for path in joint_loops(field, 6, 200)]
    assert max(abs(each.work_j) for each in self_motions) > 0.01  # not felt, and said so
    assert all(abs(each.work_j) <= each.hidden_j for each in self_motions)


def test_the_work_of_a_clipped_potential_is_bounded():
    """6.4 N of far more: net work, below what was cut off and below peak × length."""
    field = potential(3, peak_force_n=6.4, continuous_force_n=1.4)
    works = [path_work(field, path) for path in joint_loops(field, 12, 200)]
    assert max(abs(each.work_j) for each in works) > 0.05
    for each in works:
        assert abs(each.work_j) <= each.bound_j <= each.peak_j
        assert each.bound_j <= each.clipped_j + each.hidden_j + abs(each.energy_j)
    assert min(each.bound_j / each.peak_j for each in works) < 0.5
    assert any(each.clipped_j == 0 and abs(each.work_j) < 1e-3 for each in works) or len(works) == 12


def test_the_loops_of_a_result_have_a_bound():
    for form in ("potential", "normalised"):
        loop = largest_loop_work(ws.force_field("phantom_omni", form=form), 24)
        assert 0 < loop.work_j <= loop.bound_j <= 6.4 * loop.length_m * 1.001
        assert (loop.clipped > 0) == (form == "potential")
    soft = {"joint_limits": {"stiffness_n_m_per_rad": 0.5}, "conditioning": {"stiffness_n_m": 0.05}}
    whole = largest_loop_work(ws.force_field("phantom_omni", form="potential", haptic_device=DEVICE, **soft), 24)
    assert whole.clipped == 0 and whole.bound_j < 0.02 * loop.bound_j


def test_loop_work_of_a_constant_curl():
    """The trapezoidal rule along a circle in a field whose curl is known: π r² curl."""
    field = walls(100.0)
    evaluate = field.evaluate

    def swirl(q):
        state = evaluate(q)
        x, y, _ = state.posture.position
        state.force = np.array([-3.0 * y, 3.0 * x, 0.0])
        return state

    field.evaluate = swirl  # type: ignore[method-assign]
    work = loop_work(field, np.zeros(3), 0.02 * np.eye(3)[:, :2])
    assert work == pytest.approx(np.pi * 0.02**2 * 6.0, rel=3e-3)
