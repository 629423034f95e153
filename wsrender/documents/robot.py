"""The robot of a job document: where its model comes from, where it stands, what it carries."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Field, StrictStr, model_validator

from wsrender.documents.document import Document
from wsrender.documents.quantities import (
    Name,
    Number,
    PositiveNumber,
    Sha256,
    is_empty,
    is_none,
    numbers_of,
    quoted,
    real,
    sequence,
)
from wsrender.documents.shapes import ToolShape
from wsrender.documents.transform import LARGEST, LengthUnit, Transform, Vector, number_list

MOST_TOOL_SHAPES, MOST_EXCLUDED, MOST_MOUNT_JOINTS = 100, 10_000, 6
SOURCES = ("library", "dh", "mjcf", "urdf", "model", "path")
_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
_IN_DEGREES = ("alpha", "theta", "limits")


def _interval(value: Any) -> tuple[float, ...] | None:
    if value is None:
        return None
    numbers = numbers_of(value)
    if len(numbers) != 2:
        raise ValueError("must be [lower, upper], two finite numbers, or null")
    if not numbers[0] < numbers[1]:
        raise ValueError("must have the lower limit below the upper one")
    if max(abs(number) for number in numbers) > LARGEST:
        raise ValueError(f"must lie within ±{LARGEST:g}")
    return numbers


def _rows(value: Any) -> list:
    rows = sequence(value)
    if not rows:
        raise ValueError("must have at least one row")
    return rows


def _joint_name(value: Any) -> Any:
    if isinstance(value, str) and not value.isprintable():
        raise ValueError("must hold printable characters only")
    return value


def _argument(value: Any) -> Any:
    """A number or a truth value as xacro reads it."""
    if isinstance(value, bool):
        return str(value).lower()
    return repr(value) if isinstance(value, int | float) else value


def _range(value: Any) -> tuple[float, ...]:
    if (limits := _interval(value)) is None:
        raise ValueError("must be [lower, upper], two finite numbers")
    return limits


Inertia = Annotated[tuple[float, ...], Field(min_length=3, max_length=6), number_list(3, 6)]
Limits = Annotated[tuple[float, float] | None, BeforeValidator(_interval)]
Range = Annotated[tuple[float, float], BeforeValidator(_range)]
Length = Annotated[float, Field(ge=-LARGEST, le=LARGEST), BeforeValidator(real)]
XmlText = Annotated[StrictStr, Field(min_length=1)]
Argument = Annotated[StrictStr, BeforeValidator(_argument)]
NotNegative = Annotated[float, Field(ge=0), BeforeValidator(real)]


def _axis(value: Any) -> Any:
    if isinstance(value, str) and value in _AXES:
        return value
    if isinstance(value, str) or len(numbers := numbers_of(value)) != 3:
        raise ValueError('must be "x", "y", "z" or a direction of three finite numbers')
    return numbers


def _pair(value: Any) -> Any:
    if len(names := sequence(value)) != 2:
        raise ValueError("must be a pair of names")
    return names


ShapePair = Annotated[tuple[Name, Name], BeforeValidator(_pair)]
Excluded = Annotated[tuple[ShapePair, ...], BeforeValidator(sequence), Field(max_length=MOST_EXCLUDED)]


def matrix_of(inertia: tuple[float, ...]) -> np.ndarray:
    """The matrix (3, 3) of an `Inertia`."""
    ixx, iyy, izz, ixy, ixz, iyz = (*inertia, 0.0, 0.0, 0.0)[:6]
    return np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])


def least_moment(inertia: tuple[float, ...]) -> float:
    """The least principal moment of an `Inertia`; 0 where only rounding makes it negative."""
    moments = np.linalg.eigvalsh(matrix_of(inertia))
    return float(moments[0]) if moments[0] < -1e-9 * np.abs(moments).max() else max(float(moments[0]), 0.0)


class DHRow(Document):
    """One joint of a Denavit–Hartenberg table, with its limits and, optionally, the inertia of its link.

    The joint variable is added to ``theta`` (revolute) or to ``d`` (prismatic). Angles may be given in
    degrees (``alpha_deg``, ``theta_deg``, ``limits_deg``); they are kept in radians.
    """

    joint: Literal["revolute", "prismatic"] = "revolute"
    """Kind of joint."""
    a: Length = 0.0
    """Length of the common normal [m]."""
    alpha: Number = 0.0
    """Twist about the common normal [rad]."""
    d: Length = 0.0
    """Offset along the joint axis, without the joint variable [m]."""
    theta: Number = 0.0
    """Angle about the joint axis, without the joint variable [rad]."""
    limits: Limits = None
    """[lower, upper] of the joint variable [rad or m]; null: a revolute joint that turns for ever."""
    alpha_deg: Number | None = None
    """Twist about the common normal [°], instead of alpha."""
    theta_deg: Number | None = None
    """Angle about the joint axis [°], instead of theta."""
    limits_deg: Limits = None
    """[lower, upper] of a revolute joint [°], instead of limits."""
    name: Annotated[Name, BeforeValidator(_joint_name)] | None = None
    """Name of the joint; null: joint1, joint2, … by its place in the table."""
    mass: NotNegative | None = None
    """Mass of the link [kg]; null: not published."""
    center_of_mass: Vector = (0.0, 0.0, 0.0)
    """Centre of mass of the link in its DH frame [m]."""
    inertia: Inertia = (0.0, 0.0, 0.0)
    """About the centre of mass, axes of the DH frame: [ixx, iyy, izz] or these and ixy, ixz, iyz [kg m²]."""
    armature: NotNegative = 0.0
    """Inertia of the rotor as seen by the joint: gear ratio² × rotor inertia [kg m² or kg]."""
    effort_limit: PositiveNumber | None = None
    """Largest torque or force of the joint [N m or N]; null: not published."""

    @model_validator(mode="before")
    @classmethod
    def _degrees_to_radians(cls, data: Any) -> Any:
        if not isinstance(data, Mapping):
            return data
        row = dict(data)
        for field in _IN_DEGREES:
            degrees = row.get(f"{field}_deg")
            lengths = field == "limits" and row.get("joint") == "prismatic"
            if degrees is None or row.get(field) is not None or lengths:
                continue  # nothing to convert, or a conflict
            try:
                row[field] = _radians(field, degrees)
            except ValueError:
                continue  # the field's own validator says what is wrong
            del row[f"{field}_deg"]
        return row

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        prismatic = self.joint == "prismatic"
        for field in _IN_DEGREES:
            if getattr(self, f"{field}_deg") is None:
                continue
            if prismatic and field == "limits":
                yield "limits_deg", 'must not be given for a prismatic joint: use "limits", in metres'
            else:
                yield f"{field}_deg", f'must not be given together with "{field}": one of the two is enough'
        if prismatic and self.limits is None and self.limits_deg is None:
            yield "limits", "must be given for a prismatic joint: [lower, upper] in metres"
        if self.mass is None and (any(self.inertia) or any(self.center_of_mass)):
            yield "mass", 'must be given together with "inertia" and "center_of_mass"'
        if (least := least_moment(self.inertia)) < 0:
            yield "inertia", f"must not have a negative principal moment, here {least:g} kg m²"

    def inertia_matrix(self) -> np.ndarray:
        """Inertia of the link about its centre of mass, axes of the DH frame [kg m²], shape (3, 3)."""
        return matrix_of(self.inertia)


class DHTable(Document):
    """A serial robot as a table of Denavit–Hartenberg parameters, one row per joint from base to tip.

    ``modified`` (Craig 1986): T_i = Rx(α_{i−1}) Tx(a_{i−1}) Rz(θ_i) Tz(d_i), row i holding a_{i−1}, α_{i−1}.
    ``standard`` (Denavit & Hartenberg 1955; Paul 1981): T_i = Rz(θ_i) Tz(d_i) Tx(a_i) Rx(α_i).
    """

    convention: Literal["modified", "standard"]
    """Which of the two conventions the rows follow."""
    rows: Annotated[tuple[DHRow, ...], Field(min_length=1), BeforeValidator(_rows)]
    """One row per joint, from the base to the tip."""
    name: Annotated[Name, BeforeValidator(_joint_name)] = "dh"
    """Name of the robot."""
    link_radius: Annotated[PositiveNumber | None, Field(exclude_if=is_none)] = None
    """Radius of capsules along the links, which then are the robot's shapes [m]; null: it has none."""

    if TYPE_CHECKING:  # what may be given is more than what is kept

        def __init__(
            self,
            *,
            convention: Literal["modified", "standard"],
            rows: Sequence[DHRow | Mapping[str, Any]],
            name: str = "dh",
            link_radius: float | None = None,
        ): ...

    def joint_names(self) -> tuple[str, ...]:
        """Names of the joints, joint1, joint2, … where a row gives none."""
        return tuple(row.name or f"joint{k}" for k, row in enumerate(self.rows, start=1))

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        names = self.joint_names()
        for k, name in enumerate(names):
            if name in names[:k]:
                yield "rows", f'must not give two joints the name "{name}"'
                return


class MountJoint(Document):
    """A joint that carries the base of a robot, without mass or shapes of its own: a rail, a lift, a torso's waist."""

    name: Annotated[Name, BeforeValidator(_joint_name)]
    """Name of the joint."""
    joint: Literal["prismatic", "revolute"] = "prismatic"
    """Kind of joint."""
    axis: Annotated[Literal["x", "y", "z"] | Vector, BeforeValidator(_axis)]
    """Along what it slides, or about what it turns, in the robot's base frame while all joints of the mount are at 0:
    "x", "y", "z" or a direction of any length."""
    position_m: Vector = (0.0, 0.0, 0.0)
    """A point of a revolute joint's axis in the same frame [m]."""
    limits: Limits = None
    """[lower, upper] of the joint [rad or m]; null: a revolute joint that turns for ever."""
    limits_deg: Limits = None
    """[lower, upper] of a revolute joint [°], instead of limits."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if self.limits is not None and self.limits_deg is not None:
            yield "limits_deg", 'must not be given together with "limits": one of the two is enough'
        if not 1e-6 < math.hypot(*self.direction) < 1e6:
            yield "axis", f"must not have length {math.hypot(*self.direction):g}: it says no direction"
        if self.joint == "revolute":
            return
        if self.limits_deg is not None:
            yield "limits_deg", 'must not be given for a prismatic joint: use "limits", in metres'
        elif self.limits is None:
            yield "limits", "must be given for a prismatic joint: [lower, upper] in metres"
        if any(self.position_m):
            yield "position_m", "must not be given for a prismatic joint: where its axis lies changes nothing"

    @property
    def direction(self) -> tuple[float, float, float]:
        """The axis (3,), of any length."""
        return _AXES[self.axis] if isinstance(self.axis, str) else self.axis

    @property
    def range(self) -> list[float] | None:
        """[lower, upper] [rad or m]; None: it turns for ever."""
        given = self.limits or (self.limits_deg and tuple(map(math.radians, self.limits_deg)))
        return list(given) if given else None


class RobotSpec(Document):
    """A robot: exactly one source of its model, and optionally where it stands, its tool, and what the model lacks."""

    library: Name | None = None
    """Name of a robot of the library."""
    dh: DHTable | None = None
    """Denavit–Hartenberg table."""
    mjcf: XmlText | None = None
    """Text of an MJCF model."""
    urdf: XmlText | None = None
    """Text of a URDF or SDF model."""
    model: Sha256 | None = None
    """SHA-256 of a model, or a ZIP of one with its files, uploaded to a server, 64 hexadecimal digits."""
    path: Name | None = None
    """An .xml (MJCF), .urdf, .xacro or .sdf file, a ZIP or a folder; local runs only."""
    entry: Annotated[Name | None, Field(exclude_if=is_none)] = None
    """Which file of a ZIP or folder is the model; null: the only one that no other includes."""
    packages: Annotated[dict[Name, Name], Field(exclude_if=is_empty)] = Field(default={})
    """Folders of ROS packages by name, for the addresses package:// in the file ``path``, before ROS_PACKAGE_PATH and
    the ament index."""
    xacro: Annotated[dict[Name, Argument], Field(exclude_if=is_empty)] = Field(default={})
    """Arguments of the xacro file ``path``, by name."""
    placement: Transform | None = None
    """The robot's base frame in the world; null: they coincide."""
    mount: Annotated[
        tuple[MountJoint, ...], BeforeValidator(sequence), Field(max_length=MOST_MOUNT_JOINTS, exclude_if=is_empty)
    ] = ()
    """Joints that carry the robot's base, a rail or a torso, from the ground up: they are the first of its chain. The
    base frame stands at ``placement`` while they are at 0."""
    tool: Transform | None = None
    """The tool point in the frame of the tip; null: they coincide."""
    tool_shapes: Annotated[
        tuple[ToolShape, ...], BeforeValidator(sequence), Field(max_length=MOST_TOOL_SHAPES, exclude_if=is_empty)
    ] = ()
    """Shapes that the tip carries, in its frame, of tool and payload: they collide as a body fixed to the tip's would,
    which is called tool."""
    limits: dict[Name, Range] = Field(default={})
    """[lower, upper] of joints of the chain, by name [rad or m], instead of the model's."""
    limits_deg: dict[Name, Range] = Field(default={})
    """[lower, upper] of hinges of the chain, by name [°], instead of the model's."""
    length_unit_m: LengthUnit | None = None
    """The model's unit of length [m]: 0.001 for millimetres; 1 confirms metres. The model's positions, sizes, slides
    and centres of mass are multiplied by it, its inertias [kg unit²] by its square. null: metres, and a job is refused
    where they are beyond any arm."""
    effort_limits: Annotated[dict[Name, PositiveNumber], Field(exclude_if=is_empty)] = Field(default={})
    """Largest torques or forces of joints, by name, in both directions [N m or N], instead of the model's."""
    velocity_limits: Annotated[dict[Name, PositiveNumber], Field(exclude_if=is_empty)] = Field(default={})
    """Largest speeds of joints, by name [rad/s or m/s], instead of the model's."""
    reference: Annotated[dict[Name, Number], Field(exclude_if=is_empty)] = Field(default={})
    """Where joints beside the chain stand, by name [rad or m]; others of them at the model's zero."""
    srdf: Annotated[StrictStr | None, Field(min_length=1, exclude_if=is_none)] = None
    """Text of an SRDF, whose disabled pairs of links do not collide; null: none."""
    exclude: Annotated[Excluded, Field(exclude_if=is_empty)] = ()
    """Pairs of names of shapes, or of bodies for all shapes on them, that do not collide."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        given = [name for name in SOURCES if getattr(self, name) is not None]
        if not given:
            yield SOURCES[0], f"is required, or another source of the robot: one of {quoted(SOURCES)}"
        for name in given[1:]:
            yield name, f'must not be given together with "{given[0]}": a robot has one source'
        for name in ("packages", "xacro"):
            if getattr(self, name) and self.path is None:
                yield name, 'must be given together with "path" alone: it says how that file is read'
        if self.entry is not None and self.path is None and self.model is None:
            yield "entry", 'must be given together with "path" or "model" alone: it names a file of a ZIP'
        names = [shape.name for shape in self.tool_shapes]
        for k, name in enumerate(names):
            if name is not None and name in names[:k]:
                yield f"tool_shapes.{k}.name", f'must be another than that of another tool shape, "{name}"'
        names = [joint.name for joint in self.mount]
        for k, name in enumerate(names):
            if name in names[:k]:
                yield f"mount.{k}.name", f'must be another than that of another joint of the mount, "{name}"'
        for joint in sorted(self.limits.keys() & self.limits_deg.keys()):
            yield f"limits_deg.{joint}", 'must not be given together with "limits": one of the two is enough'

    @property
    def source(self) -> str:
        """Which of the sources is given: library, dh, mjcf, urdf, model or path."""
        return next(name for name in SOURCES if getattr(self, name) is not None)


def _radians(field: str, degrees: Any) -> float | list[float]:
    if field == "limits":
        return [math.radians(angle) for angle in _interval(degrees) or ()]
    return math.radians(real(degrees))
