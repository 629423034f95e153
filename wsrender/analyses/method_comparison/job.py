"""The job ``method_comparison``: one workspace of a parallel mechanism by four methods."""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field

from wsrender.documents.arm import Arm, ArmPath
from wsrender.documents.format import JobDocument, example
from wsrender.documents.mechanism import MechanismSpec
from wsrender.documents.options import Device
from wsrender.documents.quantities import VoxelSize, distinct, integer, sequence
from wsrender.documents.robot import Transform

MOST_SIZES, FINEST_BALL = 12, 7


def _sizes(value: Any) -> tuple[Any, ...] | None:
    if value is None:
        return None
    sizes = distinct(sequence(value))
    if len(sizes) > MOST_SIZES:
        raise ValueError(f"must be a list of 1 … {MOST_SIZES} numbers, or null")
    return sizes


def _subdivisions(value: Any) -> tuple[int, ...]:
    counts = distinct(integer(count) for count in sequence(value))
    if not 1 <= min(counts) <= max(counts) <= FINEST_BALL:
        raise ValueError(f"must be a list of whole numbers 1 … {FINEST_BALL}")
    return counts


class MethodComparisonJob(JobDocument):
    """Volume, error and time of the four methods of Shah, Narayanan and Krovi (2010), over voxel and mesh sizes."""

    model_config = example(
        analysis="method_comparison",
        mechanism={"library": "six_pus"},
        voxel_sizes_m=[0.4],
        ball_subdivisions=[1],
    )

    constraints_elsewhere: ClassVar[str] = 'spheres alone bound its mechanisms; arms take them in "workspace"'

    analysis: Literal["method_comparison"] = "method_comparison"
    """Name of the analysis."""
    mechanism: MechanismSpec
    """A mechanism whose workspace only spheres bound: UPS legs, pairs of PUS legs."""
    orientation: Transform | None = None
    """Orientation of the platform in the base frame, without position_m; null: none."""
    voxel_sizes_m: Annotated[tuple[VoxelSize, ...] | None, BeforeValidator(_sizes)] = None
    """Edges of the voxels of methods A and B [m]; null: a 5th, 10th, 20th and 40th of the volume's cube root."""
    ball_subdivisions: Annotated[tuple[int, ...], Field(), BeforeValidator(_subdivisions)] = (2, 3, 4, 5)
    """How often the edges of the icosahedra that stand for balls in method D are halved."""
    device: Device = "auto"
    """Where the kernels of methods A and B run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N"."""

    def arms(self) -> dict[ArmPath, Arm]:
        """No serial robots."""
        return {}

    def sweeps(self) -> list[Any]:
        """No joint spaces are sampled."""
        return []

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if self.orientation is not None and any(self.orientation.position_m):
            yield "orientation", "must not shift: its position_m must be 0"
        if self.mechanism.before or self.mechanism.after:
            yield "mechanism", "must have no serial joints"
        if self.mechanism.serial_legs():
            yield "mechanism", 'must have no legs of the type "serial": their workspace has no known boundary'
