"""The job ``shared_workspace``: what several robots reach together."""

from collections.abc import Iterator
from typing import Literal

from wsrender.documents.constraints import ArmsConstraints
from wsrender.documents.format import example
from wsrender.documents.quantities import RelativeTolerance
from wsrender.documents.several_robots import PlacedRobot, PlacementScan, SeveralRobotsJob


class SharedWorkspaceJob(SeveralRobotsJob):
    """What several robots reach together: union, shared volume, volume by number of robots, shared quality."""

    model_config = example(
        analysis="shared_workspace",
        robots=[
            {"robot": {"library": "scara"}, "sampling": {"method": "sobol", "count": 4096}},
            {
                "robot": {"library": "scara", "placement": {"position_m": [0.3, 0.0, 0.0]}},
                "sampling": {"method": "sobol", "count": 4096},
            },
        ],
        indices=["manipulability"],
        task=["x", "y"],
        voxel_size_m=0.05,
    )

    analysis: Literal["shared_workspace"] = "shared_workspace"
    """Name of the analysis."""
    constraints: ArmsConstraints | None = None  # pyright: ignore[reportIncompatibleVariableOverride]
    """Which configurations of every robot are admitted, and in which two of them may be together; null: all."""
    refined_volume: RelativeTolerance | None = 0.01
    """Relative tolerance of the refined volumes that any and that at least two robots reach [1], at every value of a
    scan too: by inverse kinematics, each with a 95 % interval; under constraints of what is free, beside what they
    block. null: none."""
    scan: PlacementScan | None = None
    """A coordinate of a robot's placement to vary; gives shared volume against it. null: none."""

    def sweeps(self) -> list[PlacedRobot]:
        """The robots, and the one that is scanned once more for each value."""
        moved = [] if self.scan is None else [self.robots[self.scan.robot]] * len(self.scan.values)
        return [*self.robots, *moved]

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        if self.scan is not None:
            yield from self.scan.conflicts_with([robot.robot for robot in self.robots])
