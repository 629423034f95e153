"""A tip that follows a device: damped inverse kinematics, motion scale and clutch."""

import math

import mujoco
import numpy as np

from wsrender.kinetostatics.force_fields import ForceField
from wsrender.kinetostatics.kinematics import Posture

STEPS = 4  # Newton steps of a tick
FIRST_STEPS = 400  # of the first sample, which may be far
LARGEST_STEP = 0.1  # of a joint [rad or m]
CLOSE_M = 1e-7  # residual at which it stops


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
