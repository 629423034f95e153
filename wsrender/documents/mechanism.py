"""The mechanism of a job document: one of the library with its parameters, or legs given one by one."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from wsrender.documents.arm import Arm, ArmPath
from wsrender.documents.document import Document
from wsrender.documents.environment import Bounds, Environment
from wsrender.documents.legs import Interval, Leg, Lengths, Link, SerialJoint, SerialJoints, SerialLeg
from wsrender.documents.problems import shown
from wsrender.documents.quantities import (
    Name,
    NonNegativeNumber,
    PositiveNumber,
    is_none,
    points_of,
    quoted,
    real,
    sequence,
)
from wsrender.documents.robot import Transform, Vector

WORKING_MODES = ("++", "+-", "-+", "--")
"""Signs of sin(θ3 − θ1) and sin(θ4 − θ2): the sides to which the left and the right elbow bend."""
LEAST_RANGE = 1e-3  # [rad] of a base joint: with less the workspace is a line
MOST_LEGS = 12


def _three(value: Any) -> tuple[float, ...]:
    numbers = tuple(real(number) for number in sequence(value)) if hasattr(value, "__len__") else (real(value),) * 3
    if len(numbers) != 3 or not min(numbers) > 0:
        raise ValueError("must be a number above 0, or a list of three")
    return numbers


def _six_points(value: Any) -> tuple[tuple[float, ...], ...] | None:
    if value is None:
        return None
    points = points_of(value)
    if len(points) != 6:
        raise ValueError("must be a list of 6 points [x, y, z], finite numbers")
    return points


Three = Annotated[
    tuple[float, float, float],
    BeforeValidator(
        _three, json_schema_input_type=tuple[PositiveNumber, PositiveNumber, PositiveNumber] | PositiveNumber
    ),
]
SixPoints = Annotated[tuple[Vector, Vector, Vector, Vector, Vector, Vector] | None, BeforeValidator(_six_points)]


class Region(Bounds):
    """A box in the base frame that the origin of the platform does not leave; null: no side there [m]."""


class MechanismBodies(Document):
    """Solids of a mechanism, which keep apart from each other and from what stands around, at every pose.

    Serial joints before and after have no links of their own: what they carry is legs and platform.
    """

    link_radius_m: PositiveNumber | None = None
    """Radius of links and cranks, capsules along them [m]; those of legs that share a joint may touch. Null where all
    legs are serial: these keep apart with the shapes of their robots."""
    platform: Environment | None = None
    """Shapes that the platform carries, in its frame; null: none."""
    platform_gap_m: PositiveNumber | None = None
    """How much of a link, next to its joint at the platform, may touch the platform's shapes [m]; null: all of it."""
    environment: Environment | None = None
    """What stands around, in the world; null: nothing."""
    margin_m: NonNegativeNumber = 0.0
    """Least distance [m]; 0: bodies may touch."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        shapes = self.platform.items if self.platform else ()
        if any(item.shape == "half_space" for item in shapes):
            yield "platform", "must not have half-spaces: a platform ends somewhere"


class _Mechanism(Document):
    placement: Transform | None = None
    """The base frame in the world; null: they coincide."""
    before: SerialJoints = ()
    """Serial joints that carry the base frame, from the ground on: a hybrid mechanism."""
    after: SerialJoints = ()
    """Serial joints that the platform carries; the end of the last one takes the place of the platform."""
    region: Region = Region()
    """Where the origin of the platform may be, in the frame of the base as it is carried."""
    home: Transform | None = None
    """A pose of the platform in the base frame, which it must reach; null: none."""
    minimum_leg_distance_m: PositiveNumber | None = None
    """Least distance of the links of legs that do not share a joint [m]; null: they may cross."""
    bodies: Annotated[MechanismBodies | None, Field(exclude_if=is_none)] = None
    """Solids that keep apart; null: there are none."""

    def serial_legs(self) -> dict[ArmPath, Arm]:
        """The legs that are robots, by path; none of a mechanism of the library."""
        return {}

    @property
    def _legs(self) -> int | None:
        """Number of legs, where any may be serial."""
        return None

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if self.bodies is None:
            return
        serial = len(self.serial_legs()) == self._legs
        if not serial and self.bodies.link_radius_m is None:
            yield "bodies.link_radius_m", "is required: the radius of capsules along the links of legs in closed form"
        if serial and self.bodies.link_radius_m is not None:
            yield "bodies.link_radius_m", "must be null: all legs are serial, and have shapes of their own"
        if self.minimum_leg_distance_m is not None:
            yield (
                "minimum_leg_distance_m",
                "must be null with bodies: their links keep apart by themselves",
            )


_UPPER_HALF = Region(lower_m=(None, None, 0.0))


class SixPUS(_Mechanism):
    """The 6-PUS of Shah, Narayanan and Krovi (2010): a pair of sliders on each side of an equilateral triangle."""

    library: Literal["six_pus"] = "six_pus"
    """Name in the library."""
    side_m: Link = 5.0
    """Side L of the base triangle [m]."""
    platform_m: Link = 1.5
    """Side l of the platform triangle [m]."""
    link_m: Three = (2.5, 2.7, 2.6)
    """Lengths of the links of the pairs 1, 2, 3 [m]; a number: all the same."""
    slide_m: Lengths = (0.5, 2.25)
    """[a, b]: distance of a slider from the middle of its side [m]."""
    region: Region = _UPPER_HALF
    """Where the origin of the platform may be; by default above the base."""


class StewartGough(_Mechanism):
    """The 6-UPS platform of Gough (1956) and Stewart (1965)."""

    library: Literal["stewart_gough"] = "stewart_gough"
    """Name in the library."""
    base_radius_m: Link = 0.5
    """Radius of the circle of the base joints [m]."""
    platform_radius_m: Link = 0.3
    """Radius of the circle of the platform joints [m]."""
    base_angle_deg: Annotated[float, Field(ge=0, lt=120), BeforeValidator(real)] = 20.0
    """Angle between the two joints of a pair on the base, pairs at 0, 120, 240° [°]."""
    platform_angle_deg: Annotated[float, Field(ge=0, lt=120), BeforeValidator(real)] = 20.0
    """Angle between the two joints of a pair on the platform, pairs at 60, 180, 300° [°]."""
    base_points_m: SixPoints = None
    """The six base joints [x, y, z], instead of radius and angle [m]."""
    platform_points_m: SixPoints = None
    """The six platform joints [x, y, z] in the platform's frame, instead of radius and angle [m]."""
    length_m: Lengths = (0.5, 0.8)
    """[shortest, longest] leg [m]."""
    region: Region = _UPPER_HALF
    """Where the origin of the platform may be; by default above the base."""


class Delta(_Mechanism):
    """The delta robot of Clavel (1988): three cranks and parallelograms; the platform does not turn.

    Crank k turns in the vertical plane at the azimuth 120° k; at angle 0 it is level and points outwards, at positive
    angles down. The platform hangs below the base.
    """

    library: Literal["delta"] = "delta"
    """Name in the library."""
    base_radius_m: Link = 0.2
    """Distance of the cranks' axes from the middle of the base [m]."""
    platform_radius_m: Link = 0.05
    """Distance of the platform's joints from its middle [m]."""
    crank_m: Link = 0.235
    """Length of the cranks, the upper arms [m]."""
    link_m: Link = 0.8
    """Length of the parallelograms, the forearms [m]."""
    angle_deg: Interval = (-30.0, 90.0)
    """[lower, upper] angle of the cranks [°]."""
    region: Region = Region(upper_m=(None, None, 0.0))
    """Where the middle of the platform may be; by default below the base."""


class Master4DOF(Delta):
    """A delta on a revolute base, the four-joint master of a teleoperation (as in Zhang, Cursi and Yang 2019)."""

    library: Literal["master_4dof"] = "master_4dof"  # type: ignore[assignment]
    """Name in the library."""
    before: SerialJoints = (SerialJoint(axis=(1.0, 0.0, 0.0), limits_deg=(-60.0, 60.0)),)
    """Serial joints that carry the base frame; by default one about x, ±60°, so that the delta swings sideways."""


class LegsMechanism(_Mechanism):
    """Any parallel mechanism, as its legs."""

    legs: Annotated[tuple[Leg, ...], Field(min_length=1, max_length=MOST_LEGS)]
    """The legs, each {"type": "UPS" | "PUS" | "RUS" | "delta" | "serial", …}; 3 where all are "delta"."""
    name: Name = "mechanism"
    """Name of the mechanism."""

    def serial_legs(self) -> dict[ArmPath, Arm]:
        """The legs that are robots, by path."""
        return {("legs", k): leg for k, leg in enumerate(self.legs) if isinstance(leg, SerialLeg)}

    @property
    def _legs(self) -> int:
        return len(self.legs)

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        if self.serial_legs() and self.minimum_leg_distance_m is not None:
            yield "minimum_leg_distance_m", 'must be null with legs of the type "serial": they are no straight links'
        deltas = sum(leg.type == "delta" for leg in self.legs)
        if deltas not in (0, len(self.legs)):
            yield "legs", 'must not mix "delta" with others: a platform on parallelograms does not turn'
        elif deltas and deltas != 3:
            yield "legs", f'must be 3 where they are "delta", not {deltas}'


LIBRARY: dict[str, type[_Mechanism]] = {
    "stewart_gough": StewartGough,
    "six_pus": SixPUS,
    "delta": Delta,
    "master_4dof": Master4DOF,
}


def _mechanism(value: Any) -> Any:
    """The document of a mechanism; a string is a name of the library."""
    if isinstance(value, str):
        value = {"library": value}
    if isinstance(value, _Mechanism):
        return value
    if not isinstance(value, Mapping):
        raise ValueError("must be an object, or a name of the library of mechanisms")
    if "library" not in value:
        return LegsMechanism.model_validate(value) if "legs" in value else _refuse_sourceless()
    if "legs" in value:
        raise ValueError('must not give "library" together with "legs": a mechanism has one source')
    name = value["library"]
    if not isinstance(name, str) or name not in LIBRARY:
        raise ValueError(f'must have as "library" one of {quoted(LIBRARY)}, not {shown(name)}, or else "legs"')
    return LIBRARY[name].model_validate(value)


def _refuse_sourceless() -> None:
    raise ValueError(f'must have "library" (one of {quoted(LIBRARY)}) or "legs"')


_AnyMechanism = StewartGough | SixPUS | Master4DOF | Delta | LegsMechanism
_Named = Literal["stewart_gough", "six_pus", "delta", "master_4dof"]
MechanismSpec = Annotated[_AnyMechanism, BeforeValidator(_mechanism, json_schema_input_type=_AnyMechanism | _Named)]
