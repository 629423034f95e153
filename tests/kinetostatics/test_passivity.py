"""A simulated device of 3 degrees of freedom on a rendered field: when it creates energy, and when not."""

import numpy as np
import pytest

import wsrender as ws
from wsrender.kinetostatics.passivity import largest_loop_work, loop_work, stiffness_bound, stiffnesses
from wsrender.spec.kinetostatics import HapticDevice

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
