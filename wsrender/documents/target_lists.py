"""Targets of a job document: one by one, or as a table in a file; and when they are served well enough."""

import math
from collections.abc import Iterator, Mapping
from os import PathLike, fspath
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import BeforeValidator, Field, ValidationError

from wsrender.documents.array_files import ArrayFile
from wsrender.documents.document import Document
from wsrender.documents.environment import Bounds
from wsrender.documents.problems import located, worded
from wsrender.documents.quantities import (
    AngleTolerance,
    NonNegativeNumber,
    PositiveNumber,
    is_empty,
    is_none,
    sequence,
    share,
)
from wsrender.documents.shapes import Sphere
from wsrender.documents.targets import Points, Targets
from wsrender.documents.transform import LengthUnit, Quaternion, Vector

MOST_TARGETS, LONGEST_TEXT = 1_000_000, 64  # rows, and characters of a name
POSITION, QUATERNION = ("x_m", "y_m", "z_m"), ("qw", "qx", "qy", "qz")
ANGLES = ("roll_deg", "pitch_deg", "yaw_deg")
TOLERANCES = ("position_tolerance_m", "angle_tolerance_rad")
NUMBERS = (*POSITION, *QUATERNION, *ANGLES, "weight", *TOLERANCES)
TEXTS = ("name", "free_axis")
AXES = ("x", "y", "z")
UNIT = 1e-3  # by which the length of a quaternion may differ from 1: components of three digits


class Target(Document):
    """A point, or a pose of the tip, in the world."""

    position_m: Vector
    """Its position [m]."""
    quat_wxyz: Quaternion | None = None
    """Its orientation, a quaternion of unit length, scalar first; null: any orientation will do, or rpy_deg."""
    rpy_deg: Vector | None = None
    """Instead, roll, pitch, yaw about fixed x, y, z as in URDF: R = Rz(yaw) Ry(pitch) Rx(roll) [°]."""
    free_axis: Literal["x", "y", "z"] | None = None
    """Axis of the tip about which it may turn as it likes; null: none."""
    name: str = Field(default="", max_length=LONGEST_TEXT)
    """Its name in tables."""
    weight: PositiveNumber = 1.0
    """What it counts in shares."""
    position_tolerance_m: PositiveNumber | None = None
    """Largest distance that counts as reached [m]; null: that of the job."""
    angle_tolerance_rad: AngleTolerance | None = None
    """Largest angle that counts as reached [rad]; null: that of the job."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if self.quat_wxyz is not None and self.rpy_deg is not None:
            yield "rpy_deg", 'must not be given together with "quat_wxyz": one orientation is enough'
        if self.quat_wxyz is not None and not abs(math.hypot(*self.quat_wxyz) - 1) <= UNIT:
            yield "quat_wxyz", f"must have unit length, not {math.hypot(*self.quat_wxyz):g}"
        if self.free_axis is not None and self.quat_wxyz is None and self.rpy_deg is None:
            yield "free_axis", "must not be given without an orientation, of which it is an axis"


class TargetTable(ArrayFile):
    """A table of targets in a file: CSV or Parquet with named columns, or points of shape (N, 3) as CSV or .npy."""

    length_unit_m: LengthUnit | None = None
    """Unit of the positions in metres: 0.001 of millimetres, 1 confirms metres; null: metres, where the arm's size does
    not speak against it."""

    def __init__(self, path: Any = None, /, **values: Any):
        super().__init__(path, **values)

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]


class TargetVolume(Document):
    """A volume to cover: cells of at most a step fill it, and their centres are the targets, which weigh the same.

    A box has whole cells, as many along each edge; a ball the cells of the box around it whose centres are inside.
    """

    box: Bounds | None = None
    """A box along the world's axes, with all sides; null: a sphere is given."""
    sphere: Sphere | None = None
    """A ball; null: a box is given."""
    step_m: PositiveNumber
    """Largest edge of a cell [m]; nothing is said of points between the centres."""
    quat_wxyz: Quaternion | None = None
    """How the tip stands at all of them, a quaternion of unit length, scalar first; null: any orientation will do."""
    free_axis: Literal["x", "y", "z"] | None = None
    """Axis of the tip about which it may turn as it likes; null: none."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if (self.box is None) == (self.sphere is None):
            yield "box", 'must be given, or else "sphere": one of the two'
        elif self.box and None in (*self.box.lower_m, *self.box.upper_m):
            yield "box", "must have all sides: a volume to cover ends everywhere"
        elif (count := math.prod(self.cells)) > MOST_TARGETS:
            yield "step_m", f"must be larger: there would be {count:,} cells, allowed are {MOST_TARGETS:,}"
        yield from Target.model_construct(quat_wxyz=self.quat_wxyz, free_axis=self.free_axis).conflicts()

    @property
    def ends(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (3,) of the box, or of that around the ball [m]."""
        if self.sphere:
            center = np.array(self.sphere.position_m)
            return center - self.sphere.radius_m, center + self.sphere.radius_m
        assert self.box
        return np.array(self.box.lower_m, float), np.array(self.box.upper_m, float)

    @property
    def cells(self) -> tuple[int, ...]:
        """How many cells there are along x, y, z of the box, or of that around the ball."""
        lower, upper = self.ends
        return tuple(max(1, math.ceil(edge / self.step_m - 1e-9)) for edge in (upper - lower).tolist())

    @property
    def points(self) -> np.ndarray:
        """The centres (N, 3) [m], those along z first."""
        lower, upper = self.ends
        along = [low + (np.arange(n) + 0.5) * (high - low) / n
                 for low, high, n in zip(lower, upper, self.cells, strict=True)]  # fmt: skip
        found = np.stack(np.meshgrid(*along, indexing="ij"), axis=-1).reshape(-1, 3)
        if not self.sphere:
            return found
        return found[np.linalg.norm(found - self.sphere.position_m, axis=1) <= self.sphere.radius_m]

    @property
    def cell_m3(self) -> float:
        """Volume of a cell [m³]."""
        lower, upper = self.ends
        return float(np.prod((upper - lower) / self.cells))


def _targets(value: Any) -> Any:
    if isinstance(value, str | PathLike):
        return TargetTable.model_validate({"path": fspath(value)})
    if isinstance(value, TargetTable | TargetVolume):
        return value
    if isinstance(value, Mapping) and not value.keys().isdisjoint(TargetVolume.model_fields):
        return TargetVolume.model_validate(value)
    choices = 'a list of targets, a table: {"path": …}, or a volume: {"box": …, "step_m": …}'
    if isinstance(value, Mapping):
        if value and value.keys().isdisjoint(TargetTable.model_fields):
            key = next(iter(value))
            of = "a target, which must stand in a list" if key in Target.model_fields else "none of them"
            raise ValueError(f'must be {choices}; "{key}" is a field of {of}')
        return TargetTable.model_validate(value)
    if not isinstance(value, list | tuple) or not value:
        raise ValueError(f"must be {choices}")
    return tuple(_target(each, k) for k, each in enumerate(value))


def _target(value: Any, number: int) -> Target:
    try:
        return value if isinstance(value, Target) else Target.model_validate(value)
    except ValidationError as error:
        problems = [located((number, *each["loc"]), each["msg"], each["input"]) for each in worded(error).errors()]
        raise ValidationError.from_exception_data("targets", problems) from None


ListOrTable = Annotated[
    Annotated[tuple[Target, ...], Field(min_length=1, max_length=MOST_TARGETS)] | TargetTable | TargetVolume,
    BeforeValidator(_targets),
]


class Criterion(Document):
    """That enough of the targets are reached, and with room to the joints' limits."""

    least_share: Annotated[float, Field(gt=0, le=1), BeforeValidator(share)]
    """Least share of the targets, by weight, that is reached; 0.95: 38 of 40 that weigh the same."""
    joint_margin_deg: NonNegativeNumber = 0.0
    """Room to either limit that all hinges with limits keep at once [°]."""
    joint_margin_m: NonNegativeNumber = 0.0
    """Room to either limit that all slides keep at once [m]."""


Criteria = Annotated[tuple[Criterion, ...], Field(max_length=16, exclude_if=is_empty), BeforeValidator(sequence)]


class ListedTargets(Targets):
    """Targets as a job has them that takes lists and tables too."""

    long_fields: ClassVar[tuple[str, ...]] = (*Targets.long_fields, "targets")

    points_m: Points | None = None  # type: ignore[assignment]
    """Positions of the targets in the world frame, rows of x, y, z, or a single one [m]; null: targets are given."""
    targets: Annotated[ListOrTable | None, Field(exclude_if=is_none)] = None
    """Instead of points_m and quats_wxyz: targets with names, weights, free axes and tolerances of their own, one by
    one, or as a table in a file, {"path": "holes.csv"}; or a volume to cover by points at a step."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if (self.points_m is None) == (self.targets is None):
            yield "points_m", 'must be given, or else "targets": one of the two'
        if self.points_m is None and self.quats_wxyz is not None:
            yield "quats_wxyz", 'must not be given without "points_m": targets say their own orientations'
        yield from super().conflicts()
