"""Sets of platform orientations: ranges of Euler angles, or tilts in all directions with a range of torsion."""

from collections.abc import Mapping
from math import prod
from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from wsrender.documents.document import Document
from wsrender.documents.quantities import integer, numbers_of, real, sequence

MOST_ORIENTATIONS = 10_000_000


def _angles(value: Any) -> tuple[float, float]:
    numbers = numbers_of(value)
    if len(numbers) != 2 or not -360 <= numbers[0] <= numbers[1] <= 360:
        raise ValueError("must be [lower, upper] in degrees, lower not above upper, within ±360")
    return numbers[0], numbers[1]


def _per_angle(value: Any) -> tuple[int, ...]:
    counts = tuple(integer(n) for n in sequence(value)) if hasattr(value, "__len__") else (integer(value),) * 3
    if len(counts) != 3 or not 1 <= min(counts) <= max(counts) <= 1000:
        raise ValueError("must be a whole number 1 … 1000, or a list of three")
    return counts


Angles = Annotated[tuple[float, float], BeforeValidator(_angles)]
Levels = Annotated[int, Field(ge=1, le=1000), BeforeValidator(integer)]
PerAngle = Annotated[
    tuple[int, int, int], BeforeValidator(_per_angle, json_schema_input_type=tuple[Levels, Levels, Levels] | Levels)
]


class EulerRanges(Document):
    """A grid of α, β, γ with R = Rx(α) Ry(β) Rz(γ), both ends of each range included."""

    euler_xyz_deg: tuple[Angles, Angles, Angles]
    """[lower, upper] of α, β and γ [°]."""
    per_angle: PerAngle = (11, 11, 11)
    """Levels of each angle; a range of no width has one."""

    @property
    def levels(self) -> tuple[int, ...]:
        """Levels of each angle, of which there are more than one only in a range of some width."""
        widths = [high - low for low, high in self.euler_xyz_deg]
        return tuple(count if width > 0 else 1 for count, width in zip(self.per_angle, widths, strict=True))

    @property
    def count(self) -> int:
        """Number of orientations."""
        return prod(self.levels)


class TiltRanges(Document):
    """Tilts up to an angle in all directions, R = Rz(φ) Ry(θ) Rz(σ - φ): azimuth, tilt, torsion (Bonev & Ryu 2001)."""

    tilt_deg: Annotated[float, Field(gt=0, le=180), BeforeValidator(real)]
    """Largest tilt θ of the platform's z axis [°]."""
    torsion_deg: Angles = (0.0, 0.0)
    """[lower, upper] of the torsion σ [°]; by default none."""
    tilts: Levels = 16
    """Levels of θ, from 0 to the largest."""
    azimuths: Levels = 36
    """Levels of φ around the circle."""
    torsions: Levels = 5
    """Levels of σ; a range of no width has one."""

    @property
    def levels(self) -> tuple[int, ...]:
        """Levels of azimuth, tilt and torsion."""
        low, high = self.torsion_deg
        return self.azimuths, self.tilts, self.torsions if high > low else 1

    @property
    def count(self) -> int:
        """Number of orientations."""
        return prod(self.levels)


def _orientations(value: Any) -> Any:
    if value is None or isinstance(value, Document):
        return value
    kinds = {"euler_xyz_deg": EulerRanges, "tilt_deg": TiltRanges}
    given = [kind for key, kind in kinds.items() if isinstance(value, Mapping) and key in value]
    if len(given) != 1:
        raise ValueError('must be an object with either "euler_xyz_deg" or "tilt_deg"')
    return given[0].model_validate(value)


Orientations = Annotated[EulerRanges | TiltRanges | None, BeforeValidator(_orientations)]
