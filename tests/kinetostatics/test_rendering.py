"""The law of a haptic loop: energy, safety, motion scale, clutch and cues, tick by tick."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.kinetostatics.test_passivity import DAMPING, MASS, PERIOD, SUBSTEPS, gantry
from wsrender.documents.kinetostatic_stream import Sample, StreamOpen
from wsrender.kinetostatics.passivity import loop_work, random_postures
from wsrender.kinetostatics.rendering import Rendering

STIFF = 25 * 2 * DAMPING / PERIOD  # far beyond what the device renders
LIMITS = {"margin_m": 0.05}
DEVICE = {"damping_n_s_per_m": DAMPING, "period_s": PERIOD}
STILL = {"viscosity_n_s_per_m": 0.0}


def opened(robot, **choices):
    field = {"conditioning": None, "haptic_device": DEVICE, **choices.pop("field", {})}
    document = StreamOpen(robot={"library": "ur5e"}, field=field, **choices)  # the robot is given, not named
    return Rendering(ws.force_field(robot, **field), document)


def walls(stiffness, **field):
    return opened(gantry(), field={"joint_limits": {**LIMITS, "stiffness_n_per_m": stiffness}, **field}, cues=STILL)


def at(number, q, **more):
    return Sample(sequence=number, configuration=tuple(np.asarray(q, float).tolist()), **more)


class Device:
    """Mass and damper under the force of a rendering, and a hand; joints are the tip's coordinates up to a rotation."""

    def __init__(self, rendering, q):
        self.rendering, self.q, self.v = rendering, np.array(q, float), np.zeros(3)
        self.R = rendering.field.kinematics.at(self.q).J[:3]
        self.given = self.taken = 0.0  # by the rendering, by the hand [J]
        self.ticks = 0

    def tick(self, hand):
        rendered = self.rendering.tick(at(self.ticks, self.q))
        self.ticks += 1
        dt = PERIOD / SUBSTEPS
        decay = np.exp(-DAMPING / MASS * dt)
        for _ in range(SUBSTEPS):  # exact for a constant force
            end = (rendered.force + hand) / DAMPING
            moved = end * dt + (self.v - end) * MASS / DAMPING * (1 - decay)
            self.v = end + (self.v - end) * decay
            self.q = self.q + np.linalg.solve(self.R, moved)
            self.given += rendered.force @ moved
            self.taken += hand @ moved
        return rendered

    @property
    def created(self):
        """Kinetic energy that no work of the hand explains [J], where it began at rest in free space."""
        return MASS * (self.v @ self.v) / 2 - self.taken


def largest_created(rendering, seed, seconds=0.5):
    device, rng = Device(rendering, [0, 0, 0]), np.random.default_rng(seed)
    hand, most = np.zeros(3), 0.0
    for tick in range(round(seconds / PERIOD)):
        if tick % 50 == 0:
            hand = rng.normal(size=3) * 2.0 * (tick < 300)
        device.tick(hand)
        most = max(most, device.created)
    return most


@pytest.mark.parametrize("stiffness", [300.0, 900.0, STIFF])
def test_no_energy_is_created_however_stiff_the_field(stiffness):
    """On the raw field of the largest stiffness the same device oscillates: see test_passivity."""
    for seed in range(3):
        rendering = walls(stiffness)
        assert rendering.energy.stiffness < 2 * DAMPING / PERIOD
        assert largest_created(rendering, seed) < 1e-6


def worst_loop(robot, radius, count=60):
    """The circle (start, plane) on which a normalised field gives most work, and that work [J]."""
    field, rng = ws.force_field(robot, form="normalised"), np.random.default_rng(0)
    found = []
    for q in random_postures(field, count, rng):
        plane = np.linalg.qr(field.kinematics.at(q).J[:3] @ rng.normal(size=(field.chain.n, 2)))[0] * radius
        for sense in (1, -1):
            work = loop_work(field, q, plane * [1, sense])
            found += [] if work is None else [(work, q, plane * [1, sense])]
    return max(found, key=lambda each: each[0])


def test_a_normalised_field_gives_no_work_for_ever():
    """Led round and round the worst closed path: the raw force gives work on each, the rendered one once at most."""
    robot, radius, speed, loops = ws.load_robot("phantom_omni"), 0.0076, 0.1, 5
    work, q, plane = worst_loop(robot, radius)
    assert work > 5e-3
    rendering = opened(
        robot, field={"form": "normalised", "conditioning": {}}, input="pose", start=q.tolist(), cues=STILL
    )
    start = rendering.field.kinematics.at(q).position
    ticks = round(2 * np.pi * radius / speed / PERIOD)
    given, dissipated, force, before, injected = 0.0, 0.0, np.zeros(3), start, 0.0
    for k in range(loops * ticks):
        place = start + plane @ [np.cos(2 * np.pi * k / ticks) - 1, np.sin(2 * np.pi * k / ticks)]
        moved = place - before
        given, dissipated = given + force @ moved, dissipated + DAMPING * (moved @ moved) / PERIOD
        rendered = rendering.tick(Sample(sequence=k, position_m=tuple(place.tolist())))
        force, before, injected = rendered.force, place, max(injected, rendered.cues.injected_damping_n_s_per_m)
    assert given - dissipated < work / 2 < loops * work / 4
    assert rendering.energy.most_created < work / 2
    assert injected > 0


def near_limit(margin=0.01):
    robot = ws.load_robot("phantom_omni")
    q = (robot.lower_limits + robot.upper_limits) / 2
    q[0] = robot.upper_limits[0] - margin
    return robot, q


def after(rendering, ticks, q):
    return [rendering.tick(at(k, q)) for k in range(ticks)][-1]


def test_the_force_rises_and_is_the_fields():
    robot, q = near_limit()
    rendering = opened(robot, rise_s=0.1)
    first, last = rendering.tick(at(0, q)), after(rendering, 200, q)
    assert np.linalg.norm(first.force) <= 6.4 * PERIOD / 0.1 + 1e-9
    assert last.force == pytest.approx(rendering.field.force(q))
    assert np.linalg.norm(last.force) > 3
    assert last.state == "rendering"


def test_silence_ends_the_force_and_it_comes_back_from_zero():
    robot, q = near_limit()
    rendering = opened(robot, stale_after_s=0.02)
    held = after(rendering, 200, q)
    silent = [rendering.tick(None) for _ in range(30)]
    states = [each.state for each in silent]
    assert states == ["rendering"] * 19 + ["stale"] * 11
    assert silent[18].force == pytest.approx(held.force, rel=1e-3)
    assert not any(each.force.any() for each in silent[19:])
    assert np.linalg.norm(rendering.tick(at(0, q)).force) < 0.1
    assert after(rendering, 200, q).force == pytest.approx(held.force)


def test_a_wrong_sample_ends_the_force_at_once():
    robot, q = near_limit()
    rendering = opened(robot)
    after(rendering, 200, q)
    wrong = rendering.tick(Sample(sequence=1, configuration=(0.0, 0.0)))
    assert (wrong.state, wrong.detail) == ("invalid_input", "configuration: must have 6 values, one per joint")
    assert not wrong.force.any()
    pose = rendering.tick(Sample(sequence=2, position_m=(0, 0, 0)))
    assert pose.detail == "configuration: is required, the stream was opened for configurations"
    rendering.refuse("not JSON")
    assert not rendering.tick(None).force.any()
    assert rendering.tick(at(3, q)).state == "rendering"


@pytest.mark.parametrize("text", ['{"sequence":1,"configuration":[NaN]}', '{"sequence":1,"configuration":[1e999]}'])
def test_numbers_that_are_not_finite_are_no_sample(text):
    with pytest.raises(ValueError, match="finite"):
        Sample.model_validate_json(text)


def test_a_sample_holds_one_place():
    with pytest.raises(ValueError, match="either configuration or position_m"):
        Sample(sequence=1)
    with pytest.raises(ValueError, match="either configuration or position_m"):
        Sample(sequence=1, configuration=(0,), position_m=(0, 0, 0))


def test_the_tip_follows_the_device():
    robot, q = near_limit(0.3)
    rendering = opened(robot, input="pose", start=(q - 0.2).tolist())
    goal = robot.forward_kinematics(q)[0][:3, 3]
    found = rendering.tick(Sample(sequence=0, position_m=tuple(goal.tolist())))
    assert found.tracking_error_m < 1e-6
    assert found.field.posture.position == pytest.approx(goal, abs=1e-6)
    far = rendering.tick(Sample(sequence=1, position_m=(9.0, 0.0, 0.0)))
    for k in range(50):
        far = rendering.tick(Sample(sequence=2 + k, position_m=(9.0, 0.0, 0.0)))
    assert far.tracking_error_m > 8
    assert "not_tracking" in [warning.kind for warning in far.warnings]
    assert np.isfinite(far.force).all()
    limits = far.field.posture.q
    assert (limits <= robot.upper_limits + 1e-12).all()
    assert (limits >= robot.lower_limits - 1e-12).all()


def test_motion_scales_and_clutch():
    robot, q = near_limit(0.4)
    rendering = opened(robot, input="pose", start=q.tolist())
    start = robot.forward_kinematics(q)[0][:3, 3]
    device = start.copy()

    def tip(step, **more):
        nonlocal device
        device = device + step
        rendered = rendering.tick(Sample(sequence=0, position_m=tuple(device.tolist()), **more))
        return rendered.field.posture.position, rendered

    step = np.array([0.0, 0.002, 0.001])
    assert tip(0 * step)[0] == pytest.approx(start, abs=1e-6)
    assert tip(step)[0] == pytest.approx(start + step, abs=1e-6)
    assert tip(step, scale="fine")[0] == pytest.approx(start + 1.25 * step, abs=1e-6)
    assert tip(step, scale="rough")[0] == pytest.approx(start + 4.25 * step, abs=1e-6)
    still, clutched = tip(100 * step, clutch=True)
    assert still == pytest.approx(start + 4.25 * step, abs=1e-6)
    assert (clutched.state, clutched.cues.clutch) == ("clutched", True)
    assert not clutched.force.any()
    seen, view = tip(step, scale="view")
    assert seen == pytest.approx(still, abs=1e-9)
    assert (view.cues.motion_scale, view.cues.motion_scale_factor) == ("view", 0.0)
    assert tip(-step)[0] == pytest.approx(still - step, abs=1e-6)


def test_a_scaled_motion_feels_a_scaled_force():
    """Power is the same on both sides: three times the motion of the tip, three times the force on the device."""
    robot, q = near_limit(0.15)
    place = tuple(robot.forward_kinematics(q)[0][:3, 3].tolist())
    forces = {}
    for scale in ("medium", "rough"):
        rendering = opened(robot, input="pose", start=q.tolist())
        for k in range(300):
            rendered = rendering.tick(Sample(sequence=k, position_m=place, scale=scale))
        forces[scale] = rendered.force
    assert forces["rough"] == pytest.approx(3 * forces["medium"], rel=1e-6)
    assert 0.1 < np.linalg.norm(forces["medium"]) < 2


def test_cues_rise_towards_limits_and_bad_conditioning():
    robot, q = near_limit(0.0)
    rendering = opened(robot, field={"conditioning": {}}, cues={"vibration_n": 0.5, "vibration_hz": [50, 150]})
    at_limit = after(rendering, 3, q).cues
    assert at_limit.vibration_amplitude_n == pytest.approx(0.5)
    assert at_limit.vibration_frequency_hz == pytest.approx(150)
    half = after(rendering, 3, near_limit(np.radians(5))[1]).cues
    assert half.vibration_amplitude_n == pytest.approx(0.25)
    assert half.vibration_frequency_hz == pytest.approx(100)
    stretched = near_limit(0.5)[1]
    stretched[2] = 0.0
    state = rendering.field.evaluate(stretched)
    rendered = after(rendering, 3, stretched)
    assert rendered.cues.viscosity_n_s_per_m == pytest.approx(0.1 * state.ill_conditioning)


def test_viscosity_opposes_motion():
    robot, q = near_limit(0.5)
    field = {"joint_limits": None, "conditioning": {"inverse_condition_on": 1.0, "condition_threshold": 1.01}}
    field["conditioning"]["stiffness_n_m"] = 1e-9  # nothing is felt but the viscosity
    rendering = opened(robot, field=field, cues={"viscosity_n_s_per_m": 0.2})
    speed = np.zeros(6)
    speed[0] = 0.5
    for k in range(200):
        rendered = rendering.tick(at(k, q - 0.1 + PERIOD * k * speed))
    velocity = rendered.field.posture.J[:3] @ speed
    assert rendered.cues.viscosity_n_s_per_m == pytest.approx(0.2)
    assert rendered.force == pytest.approx(-0.2 * velocity, rel=0.02, abs=1e-3)


def test_the_continuous_force_is_kept():
    robot, q = near_limit(0.001)
    hot = {**DEVICE, "thermal_time_s": 0.5}
    rendering = opened(robot, field={"haptic_device": hot})
    rendered = after(rendering, 4000, q)
    assert np.linalg.norm(rendered.force) == pytest.approx(1.4, abs=0.01)
    assert "thermal_limit" in [warning.kind for warning in rendered.warnings]


def test_a_wrench_device_turns():
    robot, q = near_limit(0.1)
    wrench = {**DEVICE, "kind": "wrench"}
    rendering = opened(robot, field={"haptic_device": wrench, "task": "full"}, input="pose", start=q.tolist())
    q[4] = robot.upper_limits[4] - 0.1
    T = robot.forward_kinematics(q)[0]
    quat_wxyz = Rotation.from_matrix(T[:3, :3]).as_quat(scalar_first=True)
    sample = {"position_m": tuple(T[:3, 3].tolist()), "quat_wxyz": tuple(quat_wxyz.tolist())}
    for k in range(300):
        rendered = rendering.tick(Sample(sequence=k, **sample))
    expected = rendering.field.force(q)
    assert np.concatenate([rendered.force, rendered.torque]) == pytest.approx(expected, abs=1e-4)
    assert np.linalg.norm(rendered.torque) > 1e-3
    missing = rendering.tick(Sample(sequence=0, position_m=(0, 0, 0)))
    assert missing.detail == "quat_wxyz: must be given for a wrench device, and for no other"


def test_too_much_viscosity_is_refused():
    with pytest.raises(ws.DocumentError, match=r"at most half the device's own damping, 0\.25 N s/m"):
        StreamOpen(robot={"library": "ur5e"}, cues={"viscosity_n_s_per_m": 0.3})
