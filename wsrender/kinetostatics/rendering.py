"""One tick of a haptic loop: from where the device is to what it shall render. Knows neither clocks nor sockets.

The tip follows the device: damped inverse kinematics, motion scale and clutch.
"""

import math
from dataclasses import dataclass

import mujoco
import numpy as np

from wsrender.documents.kinetostatic_stream import CueValues, Sample, Scale, State, StreamOpen, StreamWarning
from wsrender.kinetostatics.force_fields import FieldState, ForceField
from wsrender.kinetostatics.kinematics import Posture
from wsrender.kinetostatics.passivity import EnergyControl, ThermalLimit

VELOCITY_TIME_S = 0.005  # over which velocities are smoothed
LOST_M = 1e-3  # distance of the tip to its goal beyond which it does not follow
STEPS = 4  # Newton steps of a tick
FIRST_STEPS = 400  # of the first sample, which may be far
LARGEST_STEP = 0.1  # of a joint [rad or m]
CLOSE_M = 1e-7  # residual at which it stops


@dataclass(eq=False, slots=True)
class Rendered:
    """What the device shall render: ``force`` (3,) [N], ``torque`` (3,) [N m], and what is known of the posture."""

    state: State
    force: np.ndarray
    torque: np.ndarray
    field: FieldState | None
    tracking_error_m: float | None
    warnings: tuple[StreamWarning, ...]
    cues: CueValues
    detail: str | None


class Rendering:
    """The law of one session, tick by tick; every tick lasts the device's period."""

    def __init__(self, field: ForceField, choice: StreamOpen):
        self.field, self._choice, self._cues = field, choice, choice.cues
        device, chain = field.device, field.chain
        self._size = 6 if field.is_wrench else 3
        self._length = field.length.length_m
        self.energy = EnergyControl(device, choice.cues.viscosity_n_s_per_m, choice.rise_s)
        self._thermal = ThermalLimit(device)
        self._period = device.period_s
        self._patience = max(round(choice.stale_after_s / self._period), 1)
        start = (chain.lower_limits + chain.upper_limits) / 2 if choice.start is None else np.array(choice.start)
        self._tracking = PoseTracking(field, start) if choice.input == "pose" else None
        self._place: tuple[np.ndarray, np.ndarray] | None = None  # of the device, at the last sample
        self._state: FieldState | None = None
        self._velocity = np.zeros(self._size)
        self._sent = np.zeros(self._size)
        self._silent, self._since = 0, 1  # ticks since the last valid sample
        self._mode: State = "waiting"
        self._detail: str | None = None
        self._scale: Scale = "medium"
        self._damping = self._viscosity = 0.0

    def refuse(self, reason: str) -> None:
        """The input of this tick is not valid: no force until one is."""
        self._mode, self._detail = "invalid_input", reason
        self._pause()

    def tick(self, sample: Sample | None) -> Rendered:
        """The next period, with the newest sample if one has come."""
        reason = None if sample is None else self._wrong(sample)
        if reason is not None:
            self.refuse(reason)
        elif sample is not None:
            self._take(sample)
        else:
            self._wait()
        return self._rendered()

    def _wrong(self, sample: Sample) -> str | None:
        """What makes a sample unusable."""
        n = self.field.chain.n
        if self._tracking is None:
            if sample.configuration is None:
                return "configuration: is required, the stream was opened for configurations"
            return None if len(sample.configuration) == n else f"configuration: must have {n} values, one per joint"
        if sample.position_m is None:
            return "position_m: is required, the stream was opened for poses"
        if (sample.quat_wxyz is not None) != self.field.is_wrench:
            return "quat_wxyz: must be given for a wrench device, and for no other"
        if sample.quat_wxyz is not None and not 1e-6 < math.hypot(*sample.quat_wxyz) < 1e6:
            return "quat_wxyz: says no rotation"
        return None

    def _take(self, sample: Sample) -> None:
        ticks, self._since, self._silent = self._since, 1, 0
        self._scale, self._detail = sample.scale, None
        factor = self._cues.motion_scales.factor(sample.scale)
        place = self._moved_tip(sample, factor)
        moved = self._displacement(place)
        if sample.clutch or factor == 0.0:
            self._mode = "clutched"
            self._pause()
            self._place = place
            return
        if self._mode != "rendering" or moved is None:
            self.energy.reset(self._size, self._state.energy if self._state else 0.0)
            self._velocity[:], moved = 0.0, np.zeros(self._size)
        else:
            self.energy.observe(self._sent, moved, self._capacity())
            elapsed = ticks * self._period
            share = 1 - math.exp(-elapsed / VELOCITY_TIME_S)
            self._velocity += share * (moved / elapsed - self._velocity)
        self._mode, self._place = "rendering", place
        self._sent = self._limited(self._scaled_force() * (factor if self._tracking else 1.0), moved)

    def _capacity(self) -> float:
        """Energy that the field can have stored where the tip is [J]; a normalised one does not say how much."""
        state = self._state
        assert state is not None
        if self._choice.field.form == "potential":
            return state.energy
        return math.inf if state.force.any() or state.torque.any() else 0.0

    def _moved_tip(self, sample: Sample, factor: float) -> tuple[np.ndarray, np.ndarray]:
        """Move the tip; position and rotation of the device."""
        if self._tracking is None:
            self._state = self.field.evaluate(sample.configuration)
            return self._state.posture.position, self._state.posture.rotation
        place = np.array(sample.position_m), _rotation(sample.quat_wxyz)
        if sample.clutch or factor == 0.0:
            self._tracking.release(*place)
        else:
            self._tracking.follow(*place, factor)
        self._state = self.field.evaluate(self._tracking.posture.q)
        return place

    def _displacement(self, place: tuple[np.ndarray, np.ndarray]) -> np.ndarray | None:
        """Motion of the device since the last sample, (3,) or (6,) with L × rotation [m]; None for the first."""
        if self._place is None:
            return None
        moved = place[0] - self._place[0]
        if not self.field.is_wrench:
            return moved
        return np.concatenate([moved, self._length * rotation_vector(place[1] @ self._place[1].T)])

    def _scaled_force(self) -> np.ndarray:
        """The field's force, with torque / L for a wrench device [N]."""
        state = self._state
        assert state is not None
        return np.concatenate([state.force, state.torque / self._length]) if self.field.is_wrench else state.force

    def _limited(self, force: np.ndarray, moved: np.ndarray) -> np.ndarray:
        """The force that is sent: what can be rendered of the field's, damping, peak and heat."""
        state = self._state
        assert state is not None
        force = self.energy.approach(force, moved)
        self._viscosity = self._cues.viscosity_n_s_per_m * state.ill_conditioning
        self._damping = self.energy.damping(force, self._velocity)
        force = force - (self._viscosity + self._damping) * self._velocity
        size, peak = math.sqrt(force @ force), self.field.device.peak_force_n
        if size > peak:
            force = force * (peak / size)
        return self._thermal.limited(force, self._period)

    def _wait(self) -> None:
        """A tick without a sample: the last force is held, until it is stale."""
        self._since += 1
        self._silent += 1
        if self._mode != "waiting" and self._silent >= self._patience:
            self._mode = "stale"
            self._pause()
        elif self._mode == "rendering":
            self._sent = self._thermal.limited(self._sent, self._period)

    def _pause(self) -> None:
        """Let go: no force, and the next one rises from zero."""
        self._sent = self._thermal.limited(np.zeros(self._size), self._period)
        self._velocity[:] = self._viscosity = self._damping = 0.0
        self._place = None

    def _rendered(self) -> Rendered:
        torque = self._sent[3:] * self._length if self.field.is_wrench else np.zeros(3)
        tracking = self._tracking.error_m if self._tracking and self._state else None
        return Rendered(
            self._mode,
            self._sent[:3],
            torque,
            self._state,
            tracking,
            self._warnings(),
            self._cue_values(),
            self._detail,
        )

    def _cue_values(self) -> CueValues:
        nearness = self._state.nearness if self._state and self._mode == "rendering" else 0.0
        low, high = self._cues.vibration_hz
        return CueValues.model_construct(
            viscosity_n_s_per_m=self._viscosity,
            injected_damping_n_s_per_m=self._damping,
            vibration_amplitude_n=self._cues.vibration_n * nearness,
            vibration_frequency_hz=low + (high - low) * nearness,
            motion_scale=self._scale,
            motion_scale_factor=self._cues.motion_scales.factor(self._scale),
            clutch=self._mode == "clutched",
        )

    def _warnings(self) -> tuple[StreamWarning, ...]:
        state, field = self._state, self.field
        if state is None:
            return ()
        found = []
        close = state.limit_distances < field.joint_limits.margin
        if close.any():
            names = [name for name, near in zip(field.chain.joint_names, close.tolist(), strict=True) if near]
            kinds = ["unfelt_joint_limit" if name in state.unfelt else "joint_limit" for name in names]
            found += [
                StreamWarning.model_construct(kind=kind, joint=name) for kind, name in zip(kinds, names, strict=True)
            ]
        walls, things = field.choice.boundary, field.choice.obstacles
        facts = {
            "ill_conditioned": state.ill_conditioning > 0.0,
            "boundary": walls is not None and state.boundary_m < walls.margin_m,
            "obstacle": things is not None and state.obstacle_m < things.margin_m,
            "not_tracking": self._tracking is not None and self._tracking.error_m > LOST_M,
            "thermal_limit": self._thermal.limit < field.device.peak_force_n,
        }
        found += [StreamWarning.model_construct(kind=kind, joint=None) for kind, holds in facts.items() if holds]
        return tuple(found)


def _rotation(quat_wxyz: tuple[float, ...] | None) -> np.ndarray:
    """Rotation matrix (3, 3) of a quaternion of any length; none is no rotation."""
    if quat_wxyz is None:
        return np.eye(3)
    quat, R = np.array(quat_wxyz), np.empty(9)
    mujoco.mju_normalize4(quat)
    mujoco.mju_quat2Mat(R, quat)
    return R.reshape(3, 3)


class PoseTracking:
    """The configuration q whose tip stands where the device leads it, q̇ = J⁺ (ẋ), within the joint limits.

    The same damped pseudo-inverse takes the field's torques to forces, so that power is the same on both sides. A
    device pose counts from where it was when scale or clutch last changed: the tip does not jump.
    """

    def __init__(self, field: ForceField, start: np.ndarray):
        self._field = field
        chain = field.chain
        self._lower = np.where(chain.periodic, -np.inf, chain.lower_limits)
        self._upper = np.where(chain.periodic, np.inf, chain.upper_limits)
        self.posture: Posture = field.kinematics.at(np.clip(start, self._lower, self._upper))
        self.error_m = 0.0
        self._goal: tuple[np.ndarray, np.ndarray] | None = None  # of the tip
        self._device: tuple[np.ndarray, np.ndarray] | None = None  # last pose of the device

    def follow(self, position: np.ndarray, rotation: np.ndarray, factor: float) -> None:
        """Lead the tip by the device's motion since the last call, times ``factor``; the first pose is taken as it is.

        ``position`` (3,) [m], ``rotation`` (3, 3); rotations are not scaled, and do not count for a force device.
        """
        if self._goal is None or self._device is None:
            self._goal, steps = (position, rotation), FIRST_STEPS
        else:
            before, turned_before = self._device
            turn = rotation @ turned_before.T if factor else np.eye(3)
            self._goal, steps = (self._goal[0] + factor * (position - before), turn @ self._goal[1]), STEPS
        self._device = position, rotation
        self._solve(*self._goal, steps)

    def release(self, position: np.ndarray, rotation: np.ndarray) -> None:
        """The device moves without the tip."""
        self._device = position, rotation
        self._goal = self.posture.position, self.posture.rotation

    def _solve(self, position: np.ndarray, rotation: np.ndarray, steps: int) -> None:
        field, posture = self._field, self.posture
        for _ in range(steps):
            error = position - posture.position
            self.error_m = math.sqrt(error @ error)
            if field.is_wrench:
                error = np.concatenate([error, rotation_vector(rotation @ posture.rotation.T)])
            if math.sqrt(error @ error) < CLOSE_M:
                break
            change = field.inverse_jacobian(posture) @ error
            largest = float(np.abs(change).max())
            if largest > LARGEST_STEP:
                change *= LARGEST_STEP / largest
            posture = field.kinematics.at(np.minimum(np.maximum(posture.q + change, self._lower), self._upper))
        error = position - posture.position
        self.posture, self.error_m = posture, math.sqrt(error @ error)


def rotation_vector(R: np.ndarray) -> np.ndarray:
    """Axis times angle (3,) [rad] of a rotation matrix (3, 3)."""
    quat_wxyz, vector = np.empty(4), np.empty(3)
    mujoco.mju_mat2Quat(quat_wxyz, R.ravel())
    mujoco.mju_quat2Vel(vector, quat_wxyz, 1.0)
    return vector
