"""The force field of a robot's limits and conditioning ([CB]), as a function of its configuration.

Two forms. ``normalised``: every term is a ramp of force along a unit direction; these directions are no gradient, so a
closed path can do net work. ``potential``: F = −∇U. A quantity g(q) has the Cartesian gradient (J⁺)ᵀ ∂g/∂q with the
damped pseudo-inverse J⁺, which is the exact one unless a singular value is below a hundredth of the largest: it is the
gradient along motions q̇ = J⁺ ẋ, and F·ẋ = −dU/dt along them.

So the potential form does no net work on a closed path of the joints, but for three things, which
`passivity.path_work` measures: the force is clipped at the device's peak; near singular postures the pseudo-inverse is
damped; and where an arm has more joints than the device has directions, joints may move while the tip rests
(self-motions), which changes U and is not felt. On any path the work is at most the device's peak times its length.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.documents.kinetostatics import ForceFieldChoice, JointLimitForce
from wsrender.errors import InputError
from wsrender.kinetostatics.boundary import boundary_distance
from wsrender.kinetostatics.characteristic_length import characteristic_length
from wsrender.kinetostatics.conditioning import (
    Condition,
    ConditioningRamp,
    TaskConditioning,
    damped_factor,
    damped_inverse,
    decomposed,
)
from wsrender.kinetostatics.kinematics import Posture, PostureKinematics
from wsrender.kinetostatics.ramps import JointLimitRamp, ObstacleDistance, SurfaceRamp
from wsrender.robot import Robot, as_robot
from wsrender.robot.indices import task_rows
from wsrender.robot.model_robot import configuration_rows
from wsrender.short_repr import short_repr
from wsrender.volume.table import Table

FELT = 1e-6  # least norm of a limit's direction that can be felt, relative to the largest
_ONES = np.ones(6)
STEP = 1e-6  # of central differences [m]; torque devices turn by as many metres over the characteristic length
CUT = 10.0  # longest axis of a force ellipsoid over its shortest: at singular postures it is endless


@dataclass(eq=False, slots=True)
class FieldState:
    """What a posture feels.

    ``force`` (3,) [N] and ``torque`` (3,) [N m] at the tip, world axes, clipped at the device's peak; ``clipped`` [N]:
    how much larger they would be, 0 where they are whole. ``energy`` [J] of the form "potential", else 0.
    ``limit_distances`` (n,) [rad or m], ``boundary_m`` and ``obstacle_m`` [m] (infinite where there is none).
    ``nearness`` 0 … 1 to the nearest of these limits, ``ill_conditioning`` 0 … 1 the share of
    the conditioning ramp. ``unfelt``: joints at a limit whose direction no force of the device shows.
    """

    posture: Posture
    force: np.ndarray
    torque: np.ndarray
    clipped: float
    energy: float
    inverse_condition: float
    limit_distances: np.ndarray
    boundary_m: float
    obstacle_m: float
    nearness: float
    ill_conditioning: float
    unfelt: tuple[str, ...]

    __repr__ = short_repr


@dataclass(eq=False, slots=True)
class _Pushes:
    """What the terms of a posture add up; ``wrench`` (3,) or (6,) is the force, with the torque / length [N]."""

    wrench: np.ndarray
    energy: float = 0.0
    nearness: float = 0.0
    unfelt: tuple[str, ...] = ()


class ForceField:
    """The forces of a `ForceFieldChoice` for a robot; build it with `force_field`.

    ``length`` is the characteristic length with its method. Not for several threads at once.
    """

    def __init__(self, robot: Robot, choice: ForceFieldChoice, device: str = "auto", *, threads: int | None = None):
        self.robot, self.choice, self.device = robot, choice, choice.haptic_device
        self.kinematics = PostureKinematics(robot)
        self.chain = chain = self.kinematics.chain
        rows = task_rows(choice.task)
        self.length = characteristic_length(self.kinematics, choice.characteristic_length, rows)
        peak, length = self.device.peak_force_n, self.length.length_m
        self.conditioning = TaskConditioning(self.kinematics, rows, length)
        limits = choice.joint_limits
        self.joint_limits = JointLimitRamp(chain, limits or JointLimitForce(), peak, length)
        self._has_limits = limits is not None
        self._ramp = ConditioningRamp(choice.conditioning, peak, length) if choice.conditioning else None
        self._boundary = self._obstacles = None
        if wall := choice.boundary:
            distance = boundary_distance(chain, wall, device, threads)
            self._boundary = SurfaceRamp(distance, wall.margin_m, wall.stiffness_n_per_m, peak)
        if things := choice.obstacles:
            self._obstacles = SurfaceRamp(ObstacleDistance(things), things.margin_m, things.stiffness_n_per_m, peak)
        self.is_wrench = self.device.kind == "wrench"
        self._same_rows = rows == ((0, 1, 2, 3, 4, 5) if self.is_wrench else (0, 1, 2))
        self._normalised = choice.form == "normalised"
        self._size = 6 if self.is_wrench else 3
        self._row_scale = np.array([1 / length] * 3 + [1.0] * 3)[:, None]

    def __repr__(self) -> str:
        return f"<ForceField {self.chain.name}: {self.choice.form}, {self.device.kind}>"

    def force(self, q: Any) -> np.ndarray:
        """Force (3,) [N] at a configuration (n,), or force and torque (6,) [N, N m] of a wrench device.

        World axes, at the tip, clipped at the device's peak.
        """
        state = self.evaluate(q)
        return np.concatenate([state.force, state.torque]) if self.is_wrench else state.force

    def forces(self, q: Any) -> np.ndarray:
        """Forces (N, 3) or (N, 6) at configurations (N, n)."""
        return np.array([self.force(row) for row in configuration_rows(q, self.chain.n)])

    def energy(self, q: Any) -> float:
        """Potential energy U [J] of the form "potential"; InputError for the other, which has none."""
        if self._normalised:
            raise InputError("form", '"normalised" has no energy: its forces are no gradient')
        return self.evaluate(q).energy

    def joint_forces(self, q: Any) -> np.ndarray:
        """The joint-limit ramps f_i (n,) [N] at a configuration (n,)."""
        limits = self.joint_limits
        return limits.peak * limits.ramps(limits.shares(self._checked(q)))

    def evaluate(self, q: Any) -> FieldState:
        """Everything that a configuration (n,) feels. Raises InputError for a wrong shape or a number not finite."""
        posture = self.kinematics.at(self._checked(q))
        condition = self.conditioning.at(posture)
        pushes = _Pushes(np.zeros(self._size))
        shares = self.joint_limits.shares(posture.q)
        at_limits = self._has_limits and np.count_nonzero(shares) > 0
        share = self._ramp.share(condition.inverse) if self._ramp else 0.0
        if at_limits or share > 0.0:
            u, sigma, v = condition.parts if self._same_rows else decomposed(self._jacobian(posture))
            # J⁺ = V Σ⁺ Uᵀ: what the terms ask of the joints goes through V Σ⁺, their sum through Uᵀ.
            factor, along = damped_factor(sigma, v), np.zeros(len(sigma))
            if at_limits:
                along += self._limit_force(pushes, shares, factor)
            if share > 0.0:
                along += self._conditioning_force(pushes, posture, condition, factor)
            pushes.wrench = u.dot(along) if self._normalised else self._dual(u.dot(along))
        boundary = self._add_surface(pushes, self._boundary, posture.position)
        obstacle = self._add_surface(pushes, self._obstacles, posture.position)
        force, torque, clipped = self._clipped(pushes.wrench)
        return FieldState(
            posture, force, torque, clipped, pushes.energy, condition.inverse, self.joint_limits.distances(posture.q),
            boundary, obstacle, pushes.nearness, share, pushes.unfelt,
        )  # fmt: skip

    def inverse_jacobian(self, posture: Posture) -> np.ndarray:
        """Damped pseudo-inverse (n, 3) of the linear Jacobian, or (n, 6) of the whole one for a wrench device."""
        inverse = damped_inverse(self._jacobian(posture))
        return inverse * self._row_scale.T if self.is_wrench else inverse

    def stiffness(self, q: Any) -> np.ndarray:
        """∂F/∂x by central differences along q̇ = J⁺ ẋ, (3, 3) [N/m]; of a wrench device, its forces by positions."""
        q = self._checked(q)
        inverse = self.inverse_jacobian(self.kinematics.at(q))[:, :3]
        K = np.empty((3, 3))
        for axis in range(3):
            step = STEP * inverse[:, axis]
            K[:, axis] = (self.evaluate(q + step).force - self.evaluate(q - step).force) / (2 * STEP)
        return K

    def _checked(self, q: Any) -> np.ndarray:
        q = np.asarray(q, np.float64)
        if q.shape != (self.chain.n,) or np.count_nonzero(np.isfinite(q)) < len(q):
            return configuration_rows(q, self.chain.n)[0]  # says what is wrong, or takes a single row
        return q

    def _jacobian(self, posture: Posture) -> np.ndarray:
        """The linear, or of a wrench device the homogeneous Jacobian."""
        return posture.J * self._row_scale if self.is_wrench else posture.J[:3]

    def _dual(self, homogeneous: np.ndarray) -> np.ndarray:
        """Dual of a homogeneous velocity (v/L, ω) as force and torque / L, both [N]."""
        return homogeneous / self.length.length_m if self.is_wrench else homogeneous

    def _limit_force(self, pushes: _Pushes, shares: np.ndarray, factor: np.ndarray) -> np.ndarray:
        """Force of the joint limits along the left singular vectors, (k,)."""
        limits = self.joint_limits
        ramps = limits.ramps(shares).tolist()
        pushes.nearness = max(map(abs, ramps))
        # Squared norms of the rows of J⁺, which are those of V Σ⁺.
        squares = (factor * factor).dot(_ONES[: factor.shape[1]]).tolist()
        least = FELT * FELT * max(squares)
        if min(squares) <= least:
            facts = zip(self.chain.joint_names, squares, ramps, strict=True)
            pushes.unfelt = tuple(name for name, square, ramp in facts if square <= least and ramp)
        if not self._normalised:
            pushes.energy += limits.energy(shares)
            return limits.torques(shares).dot(factor)
        facts = zip(ramps, squares, strict=True)
        scaled = [limits.peak * ramp / math.sqrt(square) if square > least else 0.0 for ramp, square in facts]
        return _bounded(np.array(scaled).dot(factor), limits.peak)

    def _conditioning_force(
        self, pushes: _Pushes, posture: Posture, condition: Condition, factor: np.ndarray
    ) -> np.ndarray:
        """Force of the conditioning along the left singular vectors, (k,)."""
        assert self._ramp is not None
        direction = self.conditioning.gradient(posture, condition).dot(factor)
        if not self._normalised:
            pushes.energy += self._ramp.energy(condition.inverse)
            return self._ramp.slope(condition.inverse) * direction
        size = math.sqrt(direction.dot(direction))
        strength = self._ramp.peak * self._ramp.share(condition.inverse)
        return direction * (strength / size if size > 1e-9 else 0.0)

    def _add_surface(self, pushes: _Pushes, ramp: SurfaceRamp | None, position: np.ndarray) -> float:
        """Add the force of a surface; the distance to it [m]."""
        if ramp is None:
            return np.inf
        distance, gradient = ramp.distance.at(position)
        if distance < ramp.margin:
            force = ramp.normalised if self._normalised else ramp.potential
            pushes.wrench[:3] += force(distance, gradient)
            pushes.energy += 0.0 if self._normalised else ramp.energy(distance)
            pushes.nearness = max(pushes.nearness, ramp.share(distance))
        return distance

    def _clipped(self, wrench: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        """Force [N] and torque [N m], no larger together than the device's peak, and by how much they were [N]."""
        peak = self.device.peak_force_n
        clipped = max(math.sqrt(wrench.dot(wrench)) - peak, 0.0)
        wrench = _bounded(wrench, peak)
        return wrench[:3], wrench[3:] * self.length.length_m if self.is_wrench else np.zeros(3), clipped


def _bounded(vector: np.ndarray, most: float) -> np.ndarray:
    """The vector, shortened to a length of ``most`` where it is longer."""
    size = math.sqrt(vector.dot(vector))
    return vector * (most / size) if size > most else vector


def force_field(robot: Any, *, device: str = "auto", threads: int | None = None, **choices: Any) -> ForceField:
    """The force field of a robot: a Robot, or a library name, file or DH table as `load_robot` takes.

    ``choices`` are the fields of ``field`` in the job document ``kinetostatic_field``: form, haptic_device, task,
    characteristic_length, joint_limits, conditioning, boundary, obstacles, as dicts or documents. ``device`` is where
    the workspace's boundary is sampled, on so many CPU ``threads``.

    The form "normalised" does net work on closed paths. "potential" does none as long as its force is below the
    device's peak, no singular posture is near, and the joints of a redundant arm come back without moving by
    themselves; else at most peak × length of the path. Raises DocumentError, InputError, ModelError.

    >>> field = ws.force_field("phantom_omni")
    >>> field
    <ForceField phantom_omni: potential, force>
    >>> field.evaluate([0.0, 0.5, 0.0, 0.0, 0.0, 0.0]).force.shape
    (3,)
    """
    return ForceField(as_robot(robot), ForceFieldChoice(**choices), device, threads=threads)


def limit_nearness(field: ForceField, q: np.ndarray) -> np.ndarray:
    """Of every joint 0 in the middle of its range … 1 at a limit (n,); 0 for joints without limits."""
    chain = field.chain
    half = (chain.upper_limits - chain.lower_limits) / 2
    middle = (chain.upper_limits + chain.lower_limits) / 2
    share = np.abs(q - middle) / np.where(half > 0, half, np.inf)
    return np.where(chain.periodic, 0.0, np.minimum(share, 1.0))


def ellipsoids(J: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Axes (3, 3), one a row, and the radii (3,) of the velocity and the force ellipsoid of a linear Jacobian (3, n).

    Velocities J q̇ with |q̇| ≤ 1 have radii σ_k, forces F with |Jᵀ F| ≤ 1 radii 1/σ_k (Yoshikawa 1985), cut at ten times
    the shortest.
    """
    u, sigma, _ = np.linalg.svd(J)
    sigma = np.pad(sigma, (0, 3 - len(sigma)))
    shortest = 1 / sigma[0] if sigma[0] > 0 else 1.0
    return u.T, sigma, np.minimum(1 / np.maximum(sigma, 1e-300), CUT * shortest)


def posture_tables(field: ForceField, q: Any) -> dict[str, Table]:
    """Tables of one configuration (n,): ``posture``, a row per point of the skeleton, and ``ellipsoids``, one per axis.

    ``posture``: position [m] of base, joints and tip, the joint's name and nearness to its limit (of the base and the
    tip: none and 0). ``ellipsoids``: axis, velocity [m], force [1/m] radii, and the field's force [N] by components.
    """
    state, chain = field.evaluate(q), field.chain
    points = field.robot.skeleton(state.posture.q)[0]
    source = chain.joint_source
    names = ["", *(chain.joint_names[k] for k in source), ""]
    nearness = np.concatenate([[0.0], limit_nearness(field, state.posture.q)[source], [0.0]])
    axes, velocity, force = ellipsoids(state.posture.J[:3])
    return {
        "posture": Table({"position": points, "joint": np.array(names), "limit_nearness": nearness}, {"position": "m"}),
        "ellipsoids": Table(
            {"axis": axes, "velocity": velocity, "force": force, "rendered_force": state.force},
            {"velocity": "m", "force": "1/m", "rendered_force": "N"},
        ),
    }
