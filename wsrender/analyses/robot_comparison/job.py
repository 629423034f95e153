"""The job ``robot_comparison``: several robots side by side."""

from typing import Literal

from wsrender.documents.format import example
from wsrender.documents.quantities import RelativeTolerance
from wsrender.documents.several_robots import SeveralRobotsJob


class RobotComparisonJob(SeveralRobotsJob):
    """Several robots, or placements of one, side by side: same lattice, same scales, a table of differences."""

    model_config = example(
        analysis="robot_comparison",
        robots=[
            {"robot": {"library": "ur3e"}, "sampling": {"method": "sobol", "count": 4096}},
            {"robot": {"library": "ur5e"}, "sampling": {"method": "sobol", "count": 4096}},
        ],
        indices=["manipulability"],
        voxel_size_m=0.2,
        refined_volume=0.05,
    )

    analysis: Literal["robot_comparison"] = "robot_comparison"
    """Name of the analysis."""
    refined_volume: RelativeTolerance | None = 0.01
    """Half width of the 95 % interval of each robot's volume, area or length by inverse kinematics, relative to it [1];
    null: none is computed."""
