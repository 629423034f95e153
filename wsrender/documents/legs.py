"""Legs of a parallel mechanism: what joins base and platform, and how far it moves; serial joints before or after it.

Legs of the types UPS, PUS, RUS and delta are solved in closed form; "serial" is any chain of hinges and slides, solved
numerically. Base points and axes are in the mechanism's base frame, platform points in the platform's. U: universal,
S: spherical, P: prismatic, R: revolute joint; the actuated joint is the one with limits.
"""

import math
from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from wsrender.documents.arm import Arm
from wsrender.documents.document import Document
from wsrender.documents.problems import tagged
from wsrender.documents.quantities import Name, integer, numbers_of, quoted, real
from wsrender.documents.robot import LARGEST, Transform, Vector

SMALLEST_AXIS = 1e-9
MOST_JOINTS = 3  # before, and after


def _interval(value: Any) -> tuple[float, float]:
    numbers = numbers_of(value)
    if len(numbers) != 2 or not -LARGEST <= numbers[0] < numbers[1] <= LARGEST:
        raise ValueError(f"must be [lower, upper], lower below upper, within ±{LARGEST:g}")
    return numbers[0], numbers[1]


def _lengths(value: Any) -> tuple[float, float]:
    interval = _interval(value)
    if interval[0] < 0:
        raise ValueError("must be [shortest, longest], neither negative")
    return interval


def _axis(value: Any) -> tuple[float, ...]:
    numbers = numbers_of(value)
    if len(numbers) != 3 or not SMALLEST_AXIS < math.hypot(*numbers) < LARGEST:
        raise ValueError("must be a list of 3 finite numbers, not all 0; any length will do")
    return numbers


Interval = Annotated[tuple[float, float], BeforeValidator(_interval)]
Lengths = Annotated[tuple[float, float], BeforeValidator(_lengths)]
Axis = Annotated[tuple[float, float, float], BeforeValidator(_axis)]
Link = Annotated[float, Field(gt=0, le=LARGEST), BeforeValidator(real)]
Branch = Literal["plus", "minus", "either"]


class Cone(Document):
    """The directions that a passive joint allows the link beyond it."""

    axis: Axis
    """Middle direction of the link, seen from its base-side joint to the platform; any length."""
    half_angle_deg: Annotated[float, Field(gt=0, le=180), BeforeValidator(real)]
    """Largest angle between the link and the axis [°]."""


class _Leg(Document):
    base_m: Vector
    """Where the leg starts: the joint, or the origin of the rail, in the base frame [m]."""
    platform_m: Vector
    """The spherical joint of the platform, in the platform's frame [m]."""
    base_cone: Cone | None = None
    """Directions of the link at its base-side joint, in the base frame (of a crank: turning with it, as it stands at
    angle 0); null: all."""
    platform_cone: Cone | None = None
    """Directions of the link at its spherical joint, in the platform's frame; null: all."""


class UPSLeg(_Leg):
    """Universal joint, actuated length, spherical joint."""

    type: Literal["UPS"] = "UPS"
    """Kind of leg."""
    length_m: Lengths
    """[shortest, longest] distance of its joints [m]."""


class PUSLeg(_Leg):
    """Actuated slider on a rail, universal joint, link of fixed length, spherical joint."""

    type: Literal["PUS"] = "PUS"
    """Kind of leg."""
    axis: Axis
    """Direction of the rail in the base frame; any length."""
    slide_m: Interval
    """[lower, upper] coordinate of the slider along the axis, from base_m [m]."""
    link_m: Link
    """Length of the link [m]."""
    branch: Branch = "either"
    """Which side of the platform joint the slider stands on: "plus" (farther along the axis), "minus", "either"."""


class RUSLeg(_Leg):
    """Actuated crank, universal joint, link of fixed length, spherical joint."""

    type: Literal["RUS"] = "RUS"
    """Kind of leg."""
    axis: Axis
    """Axis of the crank in the base frame; any length."""
    zero: Axis
    """Direction of the crank at angle 0, at right angles to the axis; any length."""
    crank_m: Link
    """Length of the crank [m]."""
    link_m: Link
    """Length of the link [m]."""
    angle_deg: Interval
    """[lower, upper] angle of the crank [°], at most a full turn apart."""
    branch: Branch = "either"
    """Which of the two crank angles is used: "plus" (the larger, less than half a turn beyond the direction of the
    platform joint), "minus" (before it) or "either"."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        along = sum(a * b for a, b in zip(self.axis, self.zero, strict=True))
        if abs(along) > 1e-6 * math.hypot(*self.axis) * math.hypot(*self.zero):
            yield "zero", "must be at right angles to axis"
        if self.angle_deg[1] - self.angle_deg[0] > 360:
            yield "angle_deg", f"must not span more than 360°, here {self.angle_deg[1] - self.angle_deg[0]:g}°"


class DeltaLeg(RUSLeg):
    """Actuated crank and a parallelogram (Clavel 1988): as RUS, but three of them keep the platform from turning."""

    type: Literal["delta"] = "delta"  # type: ignore[assignment]
    """Kind of leg."""


class SerialLeg(Arm):
    """Any chain of hinges and slides, such as an MJCF model; its inverse kinematics is solved numerically.

    The robot's placement is that of its base frame in the mechanism's base frame.
    """

    type: Literal["serial"] = "serial"
    """Kind of leg."""
    attachment: Transform = Transform()
    """The frame of the platform in which the tip of the leg is held."""
    holds: Literal["position", "pose"] = "position"
    """What holds the tip: "position", a spherical joint (3 constraints); "pose", a rigid joint (6)."""
    actuated: tuple[Name, ...] = ()
    """Names of the actuated joints, which indices need; the others are passive."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        turned = (self.attachment.quat_wxyz, self.attachment.rpy_deg, self.attachment.euler_xyz_deg)
        if self.holds == "position" and turned != (None,) * 3:
            yield "attachment", 'must have no orientation with "holds": "position", a spherical joint'
        if len(set(self.actuated)) < len(self.actuated):
            yield "actuated", f"must be different names, not {quoted(self.actuated)}"


LEGS: dict[str, type[Document]] = {"UPS": UPSLeg, "PUS": PUSLeg, "RUS": RUSLeg, "delta": DeltaLeg, "serial": SerialLeg}
_known = tagged("type", LEGS)


def _leg(value: Any) -> Any:
    if isinstance(value, _Leg | SerialLeg):
        return value
    value = _known(value)
    if not isinstance(value, dict):
        raise ValueError("must be an object")
    return LEGS[value["type"]].model_validate(value)


ClosedFormLeg = UPSLeg | PUSLeg | RUSLeg | DeltaLeg
Leg = Annotated[ClosedFormLeg | SerialLeg, BeforeValidator(_leg)]


class SerialJoint(Document):
    """A joint in series with the parallel mechanism.

    Voxels are tested at so many levels of its range; refined volumes search all its values.
    """

    type: Literal["revolute", "prismatic"] = "revolute"
    """Kind of joint."""
    position_m: Vector = (0.0, 0.0, 0.0)
    """A point of its axis, in the frame before it [m]."""
    axis: Axis = (0.0, 0.0, 1.0)
    """Direction of its axis in the frame before it; any length."""
    limits_deg: Interval | None = None
    """[lower, upper] angle of a revolute joint [°], at most a full turn apart."""
    limits_m: Interval | None = None
    """[lower, upper] position of a prismatic joint along its axis [m]."""
    levels: Annotated[int, Field(ge=2, le=1000), BeforeValidator(integer)] = 25
    """Values from the lower to the upper limit, both included, at which voxels are tested."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        wanted, other = ("limits_deg", "limits_m") if self.type == "revolute" else ("limits_m", "limits_deg")
        if getattr(self, wanted) is None:
            yield wanted, f"must be given for a {self.type} joint"
        if getattr(self, other) is not None:
            yield other, f'must be null for a {self.type} joint: use "{wanted}"'
        if self.limits_deg is not None and self.limits_deg[1] - self.limits_deg[0] > 360:
            yield "limits_deg", "must not span more than 360°"

    @property
    def limits(self) -> tuple[float, float]:
        """Lower and upper limit [rad or m]."""
        if self.type == "revolute":
            assert self.limits_deg is not None
            return math.radians(self.limits_deg[0]), math.radians(self.limits_deg[1])
        assert self.limits_m is not None
        return self.limits_m


SerialJoints = Annotated[tuple[SerialJoint, ...], Field(max_length=MOST_JOINTS)]
