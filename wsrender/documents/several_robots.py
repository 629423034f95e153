"""Jobs of several robots on one lattice."""

from collections.abc import Iterator
from typing import Annotated

from pydantic import BeforeValidator, Field

from wsrender.documents.arm import Arm, ArmPath
from wsrender.documents.format import JobDocument
from wsrender.documents.index_choices import IndexChoices
from wsrender.documents.quantities import Count, FileName, VoxelSize, sequence
from wsrender.documents.sampling import SEVERAL_COUNT, Sampling, Sobol

MOST_ROBOTS = 64


class PlacedRobot(Arm):
    """One of several robots, with its own sampling."""

    name: FileName | None = None
    """What the result calls it; null: the model's name, with a number where two have the same."""
    sampling: Sampling = Sobol(SEVERAL_COUNT)
    """How its joint space is sampled; by default 2^20 Sobol samples."""


class SeveralRobotsJob(IndexChoices, JobDocument):
    """A job of several robots that are swept on one lattice."""

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
        given = [robot.name for robot in self.robots if robot.name]
        if len(set(given)) < len(given):
            yield "robots", f"must not give two robots the same name: {', '.join(given)}"
