"""Jobs of several robots on one lattice, and a coordinate of one's placement, varied."""

from collections.abc import Iterator, Sequence
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from wsrender.documents.arm import Arm, ArmPath
from wsrender.documents.constraints import Constrained
from wsrender.documents.document import Document
from wsrender.documents.format import JobDocument
from wsrender.documents.options import IndexChoices
from wsrender.documents.quantities import Count, FileName, Number, VoxelSize, distinct, integer, real, sequence
from wsrender.documents.robot import RobotSpec, Transform
from wsrender.documents.sampling import SEVERAL_COUNT, Sampling, Sobol

MOST_ROBOTS = 64
_ANGLES = ("roll", "pitch", "yaw")
_MOST_VALUES = 1000


class NamedArm(Arm):
    """One of several robots."""

    name: FileName | None = None
    """What the result calls it; null: the model's name, with a number where two have the same."""


class PlacedRobot(NamedArm):
    """One of several robots, with its own sampling."""

    sampling: Sampling = Sobol(SEVERAL_COUNT)
    """How its joint space is sampled; by default 2^20 Sobol samples."""


class SeveralRobotsJob(IndexChoices, Constrained, JobDocument):
    """A job of several robots that are swept on one lattice, all under the same constraints."""

    robots: Annotated[tuple[PlacedRobot, ...], Field(min_length=2, max_length=MOST_ROBOTS), BeforeValidator(sequence)]
    """The robots and where they stand; the arms of one model are the same robot with other base and tip."""
    voxel_size_m: VoxelSize | None = None
    """Edge of a voxel [m]; null: the smallest of those that the robots would have by themselves,
    but not so small that one of them is left with holes."""
    max_samples: Count = 10_000_000_000
    """Largest number of samples that each robot may take."""

    def arms(self) -> dict[ArmPath, Arm]:
        """Every robot by its path."""
        return {("robots", k): robot for k, robot in enumerate(self.robots)}

    def sweeps(self) -> list[PlacedRobot]:
        """The robots whose joint spaces the job samples, each as often as it does."""
        return list(self.robots)

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        yield from same_names(self.robots)


def same_names(robots: Sequence[NamedArm]) -> Iterator[tuple[str, str]]:
    """(field, message) of robots that are called the same."""
    given = [robot.name for robot in robots if robot.name]
    if len(set(given)) < len(given):
        yield "robots", f"must not give two robots the same name: {', '.join(given)}"


def _values(value: Any) -> tuple[float, ...]:
    values = distinct(real(number) for number in sequence(value))
    if len(values) > _MOST_VALUES:
        raise ValueError(f"must have at most {_MOST_VALUES} values")
    return values


class PlacementScan(Document):
    """A coordinate of one robot's placement takes each of some values; everything else stays."""

    robot: Annotated[int, Field(ge=0), BeforeValidator(integer)] = 1
    """Which robot moves: its place in the list of robots, counted from 0."""
    axis: Literal["x", "y", "z", "roll", "pitch", "yaw"] = "x"
    """The coordinate: of position_m [m], or of rpy_deg [°]."""
    values: Annotated[tuple[Number, ...], Field(min_length=1), BeforeValidator(_values)]
    """The values that it takes [m or °]."""

    @property
    def unit(self) -> str:
        """Unit of the values."""
        return "deg" if self.axis in _ANGLES else "m"

    def conflicts_with(self, robots: Sequence[RobotSpec]) -> Iterator[tuple[str, str]]:
        """(field, message) of what does not go together with the robots of the job."""
        if self.robot >= len(robots):
            yield "scan", f"must name a robot by its place, 0 … {len(robots) - 1}, not {self.robot}"
        elif self.axis in _ANGLES:
            placement = robots[self.robot].placement or Transform()
            if placement.quat_wxyz is not None or placement.euler_xyz_deg is not None:
                yield "scan", f"of {self.axis} needs a placement without quat_wxyz and euler_xyz_deg: use rpy_deg"

    def placements(self, placement: Transform | None) -> list[Transform]:
        """The placement with each of the values in the place of its own."""
        placement = placement or Transform()
        field = "rpy_deg" if self.axis in _ANGLES else "position_m"
        at = (_ANGLES if self.axis in _ANGLES else "xyz").index(self.axis)
        own = getattr(placement, field) or (0.0, 0.0, 0.0)
        moved = [(*own[:at], value, *own[at + 1 :]) for value in self.values]
        return [placement.model_copy(update={field: coordinates}) for coordinates in moved]
