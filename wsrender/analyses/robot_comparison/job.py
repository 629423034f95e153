"""The job ``robot_comparison``: several robots side by side."""

from typing import Literal

from wsrender.documents.quantities import RelativeTolerance
from wsrender.documents.several_robots import SeveralRobotsJob


class RobotComparisonJob(SeveralRobotsJob):
    """Several robots, or placements of one, side by side: same lattice, same scales, a table of differences."""

    analysis: Literal["robot_comparison"] = "robot_comparison"
    """Name of the analysis."""
    refined_volume: RelativeTolerance | None = 0.01
    """Half width of the 95 % interval of each robot's volume, area or length by inverse kinematics, relative to it [1];
    null: none is computed."""
