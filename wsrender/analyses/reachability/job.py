"""The job ``reachability``: which of given targets a robot reaches."""

from typing import Literal

from wsrender.documents.arm import Arm
from wsrender.documents.constraints import Constrained
from wsrender.documents.format import JobDocument, example
from wsrender.documents.target_lists import Criteria, ListedTargets


class ReachabilityJob(ListedTargets, Constrained, Arm, JobDocument):
    """Which of given targets a robot reaches within its joint limits, by inverse kinematics from many starts.

    Under constraints a target is reachable where a configuration is admitted, and blocked where all were rejected.
    """

    model_config = example(
        analysis="reachability",
        robot={"library": "ur5e"},
        points_m=[[0.4, 0.2, 0.3], [1.5, 0.0, 0.0]],
        quats_wxyz=[[0.0, 1.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]],
    )

    analysis: Literal["reachability"] = "reachability"
    """Name of the analysis."""
    criteria: Criteria = ()
    """What the targets must fulfil for the result to pass."""
