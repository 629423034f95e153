"""Force fields against the laws of Chablat and Bennis, MuJoCo-free closed forms, and finite differences."""

import numpy as np
import pytest

import wsrender as ws
from wsrender.errors import DocumentError

QUARTER = np.pi / 2
OBSTACLES = {
    "items": [
        {"shape": "sphere", "center_m": [0.3, 0.0, 0.4], "radius_m": 0.2},
        {"shape": "box", "size_m": [0.3, 0.2, 0.4], "pose": {"position_m": [-0.3, 0.2, 0.3], "rpy_deg": [10, 20, 30]}},
    ],
    "margin_m": 0.2,
}
STRONG = {"peak_force_n": 1e6, "continuous_force_n": 1e6}  # nothing is clipped
SOFT = {"stiffness_n_m_per_rad": 8.0, "stiffness_n_per_m": 50.0}


def one_joint():
    return ws.load_robot(ws.DHTable(convention="standard", rows=[ws.DHRow(a=0.2, limits_deg=(-90, 90))]))


def arm(count=3):
    """Anthropomorphic: waist, shoulder, elbow; then a wrist."""
    rows = [
        ws.DHRow(alpha_deg=90, d=0.3, limits_deg=(-150, 150)),
        ws.DHRow(a=0.4, limits_deg=(-20, 120)),
        ws.DHRow(a=0.35, limits_deg=(-140, -5)),
        ws.DHRow(alpha_deg=90, limits_deg=(-90, 90)),
        ws.DHRow(alpha_deg=-90, limits_deg=(-90, 90)),
        ws.DHRow(a=0.05, limits_deg=(-90, 90)),
    ]
    return ws.load_robot(ws.DHTable(convention="standard", rows=rows[:count]))


def postures(robot, count, seed=0, beyond=0.0):
    rng = np.random.default_rng(seed)
    span = robot.upper_limits - robot.lower_limits
    return rng.uniform(robot.lower_limits - beyond * span, robot.upper_limits + beyond * span, (count, len(span)))


@pytest.mark.parametrize(("angle", "force"), [(80, 0.0), (85, -3.2), (90, -6.4), (95, -6.4), (-85, 3.2), (0, 0.0)])
def test_ramp_of_a_joint_limit(angle, force):
    field = ws.force_field(one_joint(), form="normalised", conditioning=None)
    q = np.radians([angle])
    assert field.joint_forces(q) == pytest.approx([force], abs=1e-12)
    along = np.array([-np.sin(q[0]), np.cos(q[0]), 0])  # the tip's direction at growing q
    assert field.force(q) == pytest.approx(force * along, abs=1e-12)


def test_normalised_directions_are_rows_of_the_pseudo_inverse():
    robot = arm(6)
    field = ws.force_field(robot, form="normalised", conditioning=None)
    for q in postures(robot, 50):
        J = robot.jacobian(q)[0][:3]
        if np.linalg.cond(J) > 50:
            continue
        rows = np.linalg.pinv(J)
        norms = np.linalg.norm(rows, axis=1)
        felt = norms > 1e-6 * norms.max()
        expected = (field.joint_forces(q)[felt] / norms[felt]) @ rows[felt]
        expected *= min(1.0, 6.4 / max(np.linalg.norm(expected), 1e-9))
        assert field.force(q) == pytest.approx(expected, abs=1e-9)


def test_a_limit_that_cannot_be_felt_is_reported():
    robot = ws.load_robot("ur5e")  # its last axis goes through the tip
    q = np.array([0.1, -1.0, 1.0, 0.2, 0.5, robot.upper_limits[5] - 0.01])
    for form in ("normalised", "potential"):
        state = ws.force_field(robot, form=form, conditioning=None).evaluate(q)
        assert state.unfelt == (robot.joint_names[5],)
        assert state.force == pytest.approx([0, 0, 0], abs=1e-9)
        assert state.nearness > 0.9


def test_conditioning_force():
    """|F| by its ramp, direction by finite differences of i over positions of the tip."""
    robot = arm()
    choices = {"joint_limits": None, "conditioning": {"inverse_condition_on": 0.6, "condition_threshold": 10}}
    field = ws.force_field(robot, form="normalised", **choices)
    strengths = []
    for q in postures(robot, 60, seed=1):
        J = robot.jacobian(q)[0][:3]
        inverse = 1 / np.linalg.cond(J)
        if inverse < 0.02:
            continue
        expected = 6.4 * np.clip((0.6 - inverse) / (0.6 - 0.1), 0, 1)
        force = field.force(q)
        assert np.linalg.norm(force) == pytest.approx(expected, abs=1e-9)
        strengths.append(expected)
        gradient = np.empty(3)
        for axis in range(3):
            dq = np.linalg.solve(J, 1e-6 * np.eye(3)[axis])
            low, high = (1 / np.linalg.cond(robot.jacobian(q + sign * dq)[0][:3]) for sign in (-1, 1))
            gradient[axis] = (high - low) / 2e-6
        if expected > 0:
            assert force / expected == pytest.approx(gradient / np.linalg.norm(gradient), abs=1e-5)
    assert min(strengths) == 0 < max(strengths)


FIELDS = {
    "limits": {"joint_limits": SOFT, "conditioning": None},
    "conditioning": {"joint_limits": None, "conditioning": {"inverse_condition_on": 0.7, "stiffness_n_m": 2.0}},
    "obstacles": {"joint_limits": None, "conditioning": None, "obstacles": {**OBSTACLES, "stiffness_n_per_m": 80.0}},
    "all": {
        "joint_limits": SOFT,
        "conditioning": {"inverse_condition_on": 0.7, "stiffness_n_m": 2.0},
        "obstacles": {**OBSTACLES, "stiffness_n_per_m": 80.0},
    },
}


@pytest.mark.parametrize("name", FIELDS)
def test_a_potential_force_is_minus_the_gradient_of_its_energy(name):
    robot = arm()
    field = ws.force_field(robot, form="potential", haptic_device=STRONG, **FIELDS[name])
    felt = 0
    for q in postures(robot, 40, seed=2, beyond=0.02):
        J = robot.jacobian(q)[0][:3]
        if np.linalg.cond(J) > 50:  # where the pseudo-inverse is damped on purpose
            continue
        force, step = field.force(q), 1e-6
        gradient = np.empty(3)
        for axis in range(3):
            dq = np.linalg.solve(J, step * np.eye(3)[axis])
            gradient[axis] = (field.energy(q + dq) - field.energy(q - dq)) / (2 * step)
        assert force == pytest.approx(-gradient, abs=1e-5 * max(1.0, np.linalg.norm(force)))
        felt += np.linalg.norm(force) > 1e-3
    assert felt > 5


@pytest.mark.parametrize("kind", ["force", "wrench"])
def test_power_is_the_loss_of_energy_along_the_motion(kind):
    """A redundant arm (6 joints for a force), and a wrench: F·v + τ·ω = −dU/dt along q̇ = J⁺ (v, ω)."""
    robot = arm(6)
    device = {**STRONG, "kind": kind}
    choices = {**FIELDS["all"], "task": "full" if kind == "wrench" else "linear"}
    field = ws.force_field(robot, form="potential", haptic_device=device, **choices)
    rng = np.random.default_rng(3)
    for q in postures(robot, 30, seed=4):
        posture = field.kinematics.at(q)
        twist = rng.normal(size=6 if kind == "wrench" else 3)
        rate = field.inverse_jacobian(posture) @ twist
        if np.linalg.norm(posture.J[: len(twist)] @ rate - twist) > 1e-9:  # damped
            continue
        step = 1e-7 / np.linalg.norm(rate)
        change = (field.energy(q + step * rate) - field.energy(q - step * rate)) / (2 * step)
        assert field.force(q) @ twist == pytest.approx(-change, rel=1e-4, abs=1e-4)


def test_a_wrench_multiplies_its_torque_by_the_length():
    robot = arm(6)
    length = 0.25
    choices = {
        "haptic_device": {"kind": "wrench"},
        "characteristic_length": {"method": "given", "length_m": length},
        "conditioning": None,
        "task": "full",
    }
    field = ws.force_field(robot, form="normalised", **choices)
    q = np.radians([0, 50, -70, 30, 40, 86])  # only the last joint is at a limit
    J = robot.jacobian(q)[0] / np.array([[length]] * 3 + [[1.0]] * 3)
    row = np.linalg.inv(J)[5]
    row /= np.linalg.norm(row)
    expected = field.joint_forces(q)[5] * np.concatenate([row[:3], length * row[3:]])
    assert field.joint_forces(q)[5] == pytest.approx(-6.4 * 0.6)
    assert field.force(q) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("form", ["normalised", "potential"])
def test_the_sum_is_clipped_at_the_peak_and_finite_where_singular(form):
    robot = arm(6)
    choices = {"obstacles": OBSTACLES, "conditioning": {"inverse_condition_on": 0.9}}
    field = ws.force_field(robot, form=form, **choices)
    q = np.concatenate([postures(robot, 200, seed=5), np.zeros((1, 6)), [robot.upper_limits]])
    q[:100, 2] = 0.0  # stretched: singular
    sizes = np.linalg.norm(field.forces(q), axis=1)
    assert np.isfinite(sizes).all()
    assert sizes.max() == pytest.approx(6.4, abs=1e-9)


def test_a_planar_arm_feels_forces_in_its_plane():
    rows = [ws.DHRow(a=0.3, limits_deg=(-100, 100)), ws.DHRow(a=0.2, limits_deg=(-150, 150))]
    robot = ws.load_robot(ws.DHTable(convention="standard", rows=rows))
    field = ws.force_field(robot, task=["x", "y"], form="potential", haptic_device=STRONG, joint_limits=SOFT)
    q = np.radians([97, 60])
    torque = field.joint_limits.torques(field.joint_limits.shares(q))
    assert field.evaluate(q).inverse_condition > 0.2
    assert field.force(q)[:2] == pytest.approx(np.linalg.solve(robot.jacobian(q)[0][:2].T, torque), rel=1e-9)
    assert field.force(q)[2] == pytest.approx(0, abs=1e-9)


def test_placed_and_coupled_robots():
    """Forces turn with the base; the kinematics agree with the engine's."""
    choices = {"conditioning": {"inverse_condition_on": 0.9}, "joint_limits": SOFT}
    placement = ws.Transform(position_m=(1, 2, 3), rpy_deg=(20, 30, 40))
    here, there = ws.load_robot("ur5e"), ws.load_robot("ur5e", placement=placement)
    q = postures(here, 1, seed=6)[0]
    R = placement.matrix()[:3, :3]
    force = ws.force_field(here, **choices).force(q)
    assert np.linalg.norm(force) > 0.1
    assert ws.force_field(there, **choices).force(q) == pytest.approx(R @ force, abs=1e-9)
    posture = ws.force_field(there).kinematics.at(q)
    assert posture.position == pytest.approx(there.forward_kinematics(q)[0][:3, 3], abs=1e-12)
    assert posture.rotation == pytest.approx(there.forward_kinematics(q)[0][:3, :3], abs=1e-12)
    np.testing.assert_allclose(posture.J, there.jacobian(q)[0], atol=1e-12)


def test_overlapping_ramps():
    """A range narrower than two margins: both ramps push, each with its own energy."""
    rows = [ws.DHRow(a=0.2, limits_deg=(-6, 6))]  # margins of 10°
    robot = ws.load_robot(ws.DHTable(convention="standard", rows=rows))
    normalised = ws.force_field(robot, form="normalised", conditioning=None)
    soft = {"joint_limits": SOFT, "haptic_device": STRONG}
    potential = ws.force_field(robot, form="potential", conditioning=None, **soft)
    for angle in (-7.0, -3.0, 0.0, 2.0, 5.0):
        q = np.radians([angle])
        expected = 6.4 * (np.clip((4 - angle) / 10, 0, 1) - np.clip((angle + 4) / 10, 0, 1))
        assert normalised.joint_forces(q) == pytest.approx([expected], abs=1e-12)
        deep = np.radians([max(4 - angle, 0), max(angle + 4, 0)])
        assert potential.energy(q) == pytest.approx(SOFT["stiffness_n_m_per_rad"] * (deep @ deep) / 2)
        slope = (potential.energy(q + 1e-6) - potential.energy(q - 1e-6)) / 2e-6
        assert potential.force(q) @ robot.jacobian(q)[0][:3, 0] == pytest.approx(-slope, rel=1e-4, abs=1e-6)


def test_joints_without_limits_have_no_ramp():
    rows = [ws.DHRow(a=0.3), ws.DHRow(a=0.2, limits_deg=(-90, 90))]
    field = ws.force_field(ws.load_robot(ws.DHTable(convention="standard", rows=rows)), conditioning=None)
    state = field.evaluate([3.1, 0.0])
    assert state.force == pytest.approx([0, 0, 0])
    assert state.limit_distances == pytest.approx([np.inf, QUARTER])


def test_what_is_not_allowed():
    field = ws.force_field("ur5e", form="normalised")
    with pytest.raises(ws.InputError, match="q: row 0 has a value that is not finite"):
        field.force([0, 0, 0, 0, 0, np.nan])
    with pytest.raises(ws.InputError, match=r"q: has shape \(3,\)"):
        field.force([0, 0, 0])
    with pytest.raises(ws.InputError, match=r"normalised.*no gradient"):
        field.energy(np.zeros(6))
    with pytest.raises(DocumentError, match="form"):
        ws.force_field("ur5e", form="magnetic")


def test_a_user_defined_robot_is_refused():
    from tests.run.simple_robots import PlanarClass

    with pytest.raises(ws.InputError, match="defined by a Python class"):
        ws.force_field(PlanarClass())
