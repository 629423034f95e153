"""Targets of an end effector in a job document: points or poses, and how it is decided whether they are reached."""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar

from pydantic import AfterValidator, Field, ValidationInfo

from wsrender.documents.document import Document
from wsrender.documents.options import Device, Precision
from wsrender.documents.quantities import AngleTolerance, PositiveNumber, Seed, rows_of

SMALLEST_LENGTH = 1e-6  # of a quaternion that says a rotation


def _one_for_all(quaternions: tuple[Any, ...], info: ValidationInfo) -> tuple[Any, ...]:
    """A single quaternion beside several positions, as often as there are positions."""
    positions = info.data.get("points_m") or info.data.get("position_m") or ()
    return quaternions * len(positions) if len(quaternions) == 1 and positions else quaternions


Points = Annotated[tuple[tuple[float, float, float], ...], Field(min_length=1), rows_of(3, least=1)]
Quaternions = Annotated[
    tuple[tuple[float, float, float, float], ...],
    Field(min_length=1),
    rows_of(4, least=1),
    AfterValidator(_one_for_all),
]


class Deciding(Document):
    """How inverse kinematics decides: what counts as reached, and what its searches depend on."""

    position_tolerance_m: PositiveNumber = 1e-5
    """Largest distance to a target that counts as reached [m]."""
    angle_tolerance_rad: AngleTolerance = 1e-5
    """Largest angle to a target's orientation that counts as reached [rad]."""
    seed: Seed = 0
    """Seed of all that is drawn, such as the starts of searches."""
    precision: Precision = "float64"
    """Floating-point type of the kernels."""
    device: Device = "auto"
    """Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N"."""


class WeighedDeciding(Deciding):
    """The same, of searches that weigh angles against distances."""

    characteristic_length_m: PositiveNumber | None = None
    """Length that makes an angle comparable to a distance while both shrink [m]; null: half the reach."""


class Targets(WeighedDeciding):
    """The fields of every job that decides which of given targets a robot reaches."""

    long_fields: ClassVar[tuple[str, ...]] = ("points_m", "quats_wxyz")

    points_m: Points
    """Positions of the targets in the world frame, rows of x, y, z, or a single one [m]."""
    quats_wxyz: Quaternions | None = None
    """Orientations of the targets, a quaternion w, x, y, z for each point, or one for all; null: any orientation
    will do."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        if self.quats_wxyz is None or self.points_m is None:  # of jobs that take other targets
            return
        if len(self.quats_wxyz) != len(self.points_m):
            yield "quats_wxyz", f"must have as many rows as points_m, {len(self.points_m)}, not {len(self.quats_wxyz)}"
        for k, quat in enumerate(self.quats_wxyz):
            if sum(x * x for x in quat) < SMALLEST_LENGTH**2:
                yield "quats_wxyz", f"must not have length 0: row {k} says no rotation"
                return
