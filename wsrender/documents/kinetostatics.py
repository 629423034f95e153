"""Force fields of a kinetostatic (haptic) rendering, and the job ``kinetostatic_field``."""

import math
from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, StrictBool

from wsrender.documents.document import Document
from wsrender.documents.environment import MOST_SHAPES, Environment, Item
from wsrender.documents.options import Task
from wsrender.documents.quantities import Number, PositiveNumber, Seed, integer, real, sequence, share


def _joint_values(value: Any) -> tuple[float, ...] | None:
    return None if value is None else tuple(real(number) for number in sequence(value))


JointValues = Annotated[tuple[Number, ...] | None, BeforeValidator(_joint_values)]


def _obstacles(value: Any) -> Any:
    """An environment, such as `ws.Environment` makes, is one of obstacles."""
    return {"items": value.items} if type(value) is Environment else value


class CharacteristicLengthChoice(Document):
    """The length that divides the linear rows of a Jacobian, so that its entries have one unit."""

    method: Literal["given", "rms", "conditioning", "least_condition"] = "rms"
    """ "given"; "rms": root mean square of the joints' lever arms at a posture; "conditioning": least distance of the
    Jacobian to the isotropic matrices at the posture; "least_condition": least condition number there."""
    length_m: PositiveNumber | None = None
    """The length of the method "given" [m]."""
    posture: JointValues = None
    """Joint values of the posture [rad or m]; null: the middle of every joint's range."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if (self.method == "given") != (self.length_m is not None):
            yield "length_m", 'must be given with the method "given", and with no other'
        if self.method == "given" and self.posture is not None:
            yield "posture", 'must be null with the method "given"'


class HapticDevice(Document):
    """The device that is held in the hand; the defaults are a small desktop device."""

    kind: Literal["force", "wrench"] = "force"
    """Whether it renders a force (3 degrees of freedom) or force and torque (6)."""
    peak_force_n: PositiveNumber = 6.4
    """Largest force [N]; of a wrench, of √(force² + (torque / characteristic length)²)."""
    continuous_force_n: PositiveNumber = 1.4
    """Largest force that it can hold for ever [N]."""
    thermal_time_s: PositiveNumber = 10.0
    """Time constant with which its motors warm up [s]."""
    damping_n_s_per_m: PositiveNumber = 0.5
    """Viscous damping of its own mechanics [N s/m], which bounds the stiffness that it can render."""
    period_s: Annotated[float, Field(ge=5e-4, le=0.1), BeforeValidator(real)] = 0.001
    """Period of its loop [s]."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if self.continuous_force_n > self.peak_force_n:
            yield "continuous_force_n", f"must be at most peak_force_n, {self.peak_force_n:g}"


class JointLimitForce(Document):
    """A ramp before every joint limit."""

    margin_rad: PositiveNumber = math.radians(10)
    """Width of the ramp of a revolute joint [rad]."""
    margin_m: PositiveNumber = 0.01
    """Width of the ramp of a prismatic joint [m]."""
    stiffness_n_m_per_rad: PositiveNumber | None = None
    """Stiffness of a revolute joint's potential [N m/rad]; null: peak force × characteristic length / margin."""
    stiffness_n_per_m: PositiveNumber | None = None
    """Stiffness of a prismatic joint's potential [N/m]; null: peak force / margin."""


class ConditioningForce(Document):
    """A force away from ill-conditioned postures, towards a larger inverse condition number."""

    inverse_condition_on: Annotated[float, Field(gt=0, le=1), BeforeValidator(share)] = 0.2
    """Inverse condition number below which the force acts [1]."""
    condition_threshold: Annotated[float, Field(gt=1), BeforeValidator(real)] = 20.0
    """Condition number at which it has its full strength [1]."""
    stiffness_n_m: PositiveNumber | None = None
    """Stiffness of the potential [N m]; null: peak force × characteristic length / (width of the ramp)."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if not self.inverse_condition_on * self.condition_threshold > 1:
            yield "condition_threshold", f"must be above 1 / inverse_condition_on, {1 / self.inverse_condition_on:g}"


class BoundaryForce(Document):
    """A force from the boundary of the workspace inwards."""

    margin_m: PositiveNumber = 0.02
    """Distance from the boundary at which the force begins [m]."""
    stiffness_n_per_m: PositiveNumber | None = None
    """Stiffness of the potential [N/m]; null: peak force / margin."""
    cells: Annotated[int, Field(ge=16, le=256), BeforeValidator(integer)] = 48
    """Cells along the mean edge of the workspace's box; the boundary is known to about half a cell."""
    refined: StrictBool = False
    """Whether cells at the boundary are decided by inverse kinematics (slower), or by samples alone."""
    seed: Seed = 0
    """Seed of the samples."""


class ObstacleForce(Environment):
    """A force away from what stands around, on a ball around the end effector."""

    items: Annotated[tuple[Item, ...], Field(min_length=1, max_length=MOST_SHAPES)]
    """The obstacles; names are unique."""
    tip_radius_m: PositiveNumber = 0.005
    """Radius of the ball around the end effector [m]."""
    margin_m: PositiveNumber = 0.02
    """Distance at which the force begins [m]."""
    stiffness_n_per_m: PositiveNumber | None = None
    """Stiffness of the potential [N/m]; null: peak force / margin."""


class ForceFieldChoice(Document):
    """The forces by which a person feels the limits and the conditioning of a robot."""

    form: Literal["normalised", "potential"] = "potential"
    """ "normalised": ramps along unit directions, which do net work on closed paths; "potential": minus the gradient of
    a potential energy, conservative where it is not clipped at the device's peak, no singular posture is near and the
    joints of a redundant arm come back."""
    haptic_device: HapticDevice = HapticDevice()
    """The device that renders them."""
    task: Task = "linear"
    """Rows of the Jacobian whose condition number counts: "linear", "angular", "full", or a list."""
    characteristic_length: CharacteristicLengthChoice = CharacteristicLengthChoice()
    """The length that makes linear and angular rows comparable."""
    joint_limits: JointLimitForce | None = JointLimitForce()
    """Force of the joint limits; null: none."""
    conditioning: ConditioningForce | None = ConditioningForce()
    """Force of the conditioning; null: none."""
    boundary: BoundaryForce | None = None
    """Force of the workspace's boundary; null: none."""
    obstacles: Annotated[ObstacleForce | None, BeforeValidator(_obstacles)] = None
    """Force of obstacles, an environment with or without the choices of the force; null: none."""
