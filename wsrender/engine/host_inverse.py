"""Inverse kinematics of a robot that is defined by a Python class: the steps of the kernel `inverse`, in NumPy."""

import numpy as np
import warp as wp
from wsrender_kernels.inverse import (
    FAR_AWAY,
    FIRST_DAMPING,
    FLAT,
    GOOD,
    LARGEST_DAMPING,
    LARGEST_STEP,
    LEAST_DAMPING,
    POOR,
    REACHED,
    RELAX,
    RUNNING,
    SHORTEN,
    SHORTEST_STEP,
    STATIONARY,
    STIFFEN,
    TARGET_SIZES,
)

from wsrender.engine.tries import Accuracy, Tries, angle_of, step_bounds
from wsrender.robots.kinematics import Kinematics

BATCH = 1 << 13  # tries that are advanced together: their Jacobians stay in the cache


def host_tries(
    chain: Kinematics, targets: np.ndarray, starts: np.ndarray, accuracy: Accuracy, without_limits: bool, steps: int
) -> Tries:
    """As `solve_inverse`. Where a configuration beyond the limits has no pose, it is no nearer to any target."""
    parts = []
    for first in range(0, max(len(targets), 1), BATCH):
        batch = slice(first, first + BATCH)
        tries = _HostTries(chain, targets[batch], starts[batch], accuracy, without_limits)
        with np.errstate(invalid="ignore", divide="ignore"):
            tries.run(steps)
        parts.append((tries.q, tries.distance_2, tries.rotation_2, tries.verdict))
    q, distance_2, rotation_2, verdict = (np.concatenate(part) for part in zip(*parts, strict=True))
    return Tries(q, np.sqrt(distance_2), angle_of(rotation_2), verdict == REACHED, verdict == STATIONARY)


class _HostTries:
    """T tries on their way; names and shapes as in the kernel's `step`, with a leading axis for the tries."""

    def __init__(self, chain: Kinematics, targets: np.ndarray, starts: np.ndarray, accuracy: Accuracy, unlimited: bool):
        self.chain, self.targets, self.accuracy = chain, targets, accuracy
        self.lower, self.upper, self.scale = step_bounds(chain, accuracy, unlimited)
        self.weight = accuracy.length**2 / 4
        count = len(targets)
        self.q, self.dq = starts.astype(np.float64), np.zeros(starts.shape)
        self.distance_2, self.rotation_2 = np.full(count, FAR_AWAY), np.full(count, FAR_AWAY)
        self.damping, self.expected = np.full(count, FIRST_DAMPING), np.full(count, FAR_AWAY)
        self.verdict = np.full(count, RUNNING)

    def run(self, steps: int) -> None:
        """Take every try to its end, or through so many steps."""
        for _ in range(steps):
            running = np.flatnonzero(self.verdict == RUNNING)
            if not len(running):
                return
            self._step(running)

    def _step(self, at: np.ndarray) -> None:
        trial = np.clip(self.q[at] + self.dq[at], self.lower, self.upper)
        poses = self.chain.poses(trial)
        error, distance_2, rotation_2 = _errors(poses, self.targets[at], self.accuracy.length)
        gain = (self.distance_2[at] - distance_2) / 2 + self.weight * (self.rotation_2[at] - rotation_2)
        better, expected = gain > 0, self.expected[at]
        change = np.select([gain > GOOD * expected, gain < POOR * expected], [RELAX, STIFFEN], 1.0)
        self.damping[at] = np.clip(self.damping[at] * change, LEAST_DAMPING[wp.float64], LARGEST_DAMPING)
        nearer, other = at[better], at[~better]
        self.dq[other] *= SHORTEN
        self.expected[other] *= SHORTEN
        self.q[nearer] = trial[better]
        self.distance_2[nearer], self.rotation_2[nearer] = distance_2[better], rotation_2[better]
        flat = self._aim(nearer, poses[better], error[better])
        self.verdict[nearer[flat]] = STATIONARY
        self.verdict[at[np.abs(self.dq[at]).max(axis=1) < SHORTEST_STEP[wp.float64]]] = STATIONARY
        there = (self.distance_2[nearer] <= self.accuracy.position_m**2) & (
            self.rotation_2[nearer] <= self.accuracy.rotation_2
        )
        self.verdict[nearer[there]] = REACHED

    def _aim(self, at: np.ndarray, poses: np.ndarray, error: np.ndarray) -> np.ndarray:
        """The next step of tries that stand at ``poses``, and whether nothing leads nearer, (T,) bool."""
        q, M = self.q[at], error.shape[1]
        J = np.nan_to_num(self.chain.jacobians(q), nan=0.0)  # next to where there is no pose
        if self.targets.shape[1] == TARGET_SIZES["axis"]:  # a turn about the axis itself changes nothing
            z = poses[:, :3, 2:3]
            J[:, 3:] -= z * (z * J[:, 3:]).sum(axis=1, keepdims=True)
        A = J[:, :M] * self.scale
        A[:, 3:] *= self.accuracy.length
        size = (A**2).sum(axis=(1, 2))
        down = (A * error[:, :, None]).sum(axis=1)
        held = ((q <= self.lower) & (down < 0)) | ((q >= self.upper) & (down > 0))
        A *= ~held[:, None]
        slopes = down * ~held
        H = A @ A.transpose(0, 2, 1)
        H[:, np.arange(M), np.arange(M)] += (self.damping[at] * size / M)[:, None] + np.finfo(float).tiny
        dq = (A * np.linalg.solve(H, error[:, :, None])).sum(axis=1)
        shrink = LARGEST_STEP / np.maximum(np.abs(dq).max(axis=1), LARGEST_STEP)
        self.dq[at] = dq * self.scale * shrink[:, None]
        self.expected[at] = (dq * slopes).sum(axis=1) * shrink / 2
        cost = self.distance_2[at] + self.weight * self.rotation_2[at]
        return (slopes**2).sum(axis=1) <= (self.accuracy.flatness * FLAT[wp.float64]) ** 2 * size * cost


def _errors(poses: np.ndarray, targets: np.ndarray, length: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What is left to the targets, (T, M) [m], and its squares: of the distance, and 8 sin²(angle / 2)."""
    error = targets[:, :3] - poses[:, :3, 3]
    distance_2 = (error**2).sum(axis=1)
    if targets.shape[1] == TARGET_SIZES["position"]:
        return error, distance_2, np.zeros(len(targets))
    wanted = targets[:, 3:].reshape(len(targets), -1, 3)  # a row for each axis
    axes = poses[:, :3, :3].transpose(0, 2, 1)[:, -wanted.shape[1] :]
    twice = 2.0 if wanted.shape[1] == 1 else 1.0  # one axis moves half as much as three do
    turn = np.cross(axes, wanted).sum(axis=1) * (twice * length / 2)
    return np.hstack([error, turn]), distance_2, twice * ((axes - wanted) ** 2).sum(axis=(1, 2))
