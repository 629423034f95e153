"""Targets of a job document: one by one, or as a table in a file; and when they are served well enough."""

import math
from collections.abc import Iterator, Mapping
from os import PathLike, fspath
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field, ValidationError

from wsrender.documents.document import Document
from wsrender.documents.problems import located, worded
from wsrender.documents.quantities import Name, NonNegativeNumber, PositiveNumber, Sha256, real, sequence, share
from wsrender.documents.targets import Points, Targets
from wsrender.documents.transform import LengthUnit, Quaternion, Vector

MOST_TARGETS, LONGEST_TEXT = 1_000_000, 64  # rows, and characters of a name
TABLE_TYPES = {".csv": "text/csv", ".parquet": "application/vnd.apache.parquet", ".npy": "application/x-npy"}
"""Media types of tables by the endings of their files."""
POSITION, QUATERNION = ("x_m", "y_m", "z_m"), ("qw", "qx", "qy", "qz")
ANGLES = ("roll_deg", "pitch_deg", "yaw_deg")
TOLERANCES = ("position_tolerance_m", "angle_tolerance_rad")
NUMBERS = (*POSITION, *QUATERNION, *ANGLES, "weight", *TOLERANCES)
TEXTS = ("name", "free_axis")
AXES = ("x", "y", "z")
UNIT = 1e-3  # by which the length of a quaternion may differ from 1: components of three digits

Angle = Annotated[float, Field(gt=0, le=3.14), BeforeValidator(real)]


def _is_none(value: Any) -> bool:
    return value is None


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
    angle_tolerance_rad: Angle | None = None
    """Largest angle that counts as reached [rad]; null: that of the job."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if self.quat_wxyz is not None and self.rpy_deg is not None:
            yield "rpy_deg", 'must not be given together with "quat_wxyz": one orientation is enough'
        if self.quat_wxyz is not None and not abs(math.hypot(*self.quat_wxyz) - 1) <= UNIT:
            yield "quat_wxyz", f"must have unit length, not {math.hypot(*self.quat_wxyz):g}"
        if self.free_axis is not None and self.quat_wxyz is None and self.rpy_deg is None:
            yield "free_axis", "must not be given without an orientation, of which it is an axis"


class TargetTable(Document):
    """A table of targets in a file: CSV or Parquet with named columns, or points of shape (N, 3) as CSV or .npy."""

    path: Name | None = None
    """A .csv, .parquet or .npy file; local runs only."""
    model: Sha256 | None = None
    """SHA-256 of such a file that was uploaded to a server, 64 hexadecimal digits."""
    length_unit_m: LengthUnit | None = None
    """Unit of the positions in metres: 0.001 of millimetres, 1 confirms metres; null: metres, where the arm's size does
    not speak against it."""

    def __init__(self, path: Any = None, /, **values: Any):
        Document.__init__(self, **values if path is None else {"path": str(path), **values})

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if (self.path is None) == (self.model is None):
            yield "path", 'must be given, or else "model": one of the two'
        if self.path is not None and not self.path.lower().endswith((*TABLE_TYPES,)):
            yield "path", f'must end in {", ".join(TABLE_TYPES)}, not "{self.path}"'


def _targets(value: Any) -> Any:
    if isinstance(value, str | PathLike):
        return TargetTable.model_validate({"path": fspath(value)})
    if isinstance(value, TargetTable):
        return value
    if isinstance(value, Mapping):
        return TargetTable.model_validate(value)
    if not isinstance(value, list | tuple) or not value:
        raise ValueError('must be a list of targets, or a table: {"path": …}')
    return tuple(_target(each, k) for k, each in enumerate(value))


def _target(value: Any, number: int) -> Target:
    try:
        return value if isinstance(value, Target) else Target.model_validate(value)
    except ValidationError as error:
        problems = [located((number, *each["loc"]), each["msg"], each["input"]) for each in worded(error).errors()]
        raise ValidationError.from_exception_data("targets", problems) from None


ListOrTable = Annotated[
    Annotated[tuple[Target, ...], Field(min_length=1, max_length=MOST_TARGETS)] | TargetTable, BeforeValidator(_targets)
]


class Criterion(Document):
    """That enough of the targets are reached, and with room to the joints' limits."""

    least_share: Annotated[float, Field(gt=0, le=1), BeforeValidator(share)]
    """Least share of the targets, by weight, that is reached; 0.95: 38 of 40 that weigh the same."""
    joint_margin_deg: NonNegativeNumber = 0.0
    """Room to either limit that all hinges with limits keep at once [°]."""
    joint_margin_m: NonNegativeNumber = 0.0
    """Room to either limit that all slides keep at once [m]."""


Criteria = Annotated[
    tuple[Criterion, ...], Field(max_length=16, exclude_if=lambda value: not value), BeforeValidator(sequence)
]


class ListedTargets(Targets):
    """Targets as a job has them that takes lists and tables too."""

    long_fields: ClassVar[tuple[str, ...]] = (*Targets.long_fields, "targets")

    points_m: Points | None = None  # type: ignore[assignment]
    """Positions of the targets in the world frame, rows of x, y, z [m]; null: targets are given."""
    targets: Annotated[ListOrTable | None, Field(exclude_if=_is_none)] = None
    """Instead of points_m and quats_wxyz: targets with names, weights, free axes and tolerances of their own, one by
    one, or as a table in a file, {"path": "holes.csv"}."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if (self.points_m is None) == (self.targets is None):
            yield "points_m", 'must be given, or else "targets": one of the two'
        if self.points_m is None and self.quats_wxyz is not None:
            yield "quats_wxyz", 'must not be given without "points_m": targets say their own orientations'
        yield from super().conflicts()
