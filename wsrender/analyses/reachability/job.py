"""The job ``reachability``: which of given targets a robot reaches."""

from typing import Literal

from wsrender.documents.arm import Arm
from wsrender.documents.constraints import Constrained
from wsrender.documents.format import JobDocument
from wsrender.documents.target_lists import Criteria, ListedTargets


class ReachabilityJob(ListedTargets, Constrained, Arm, JobDocument):
    """Which of given targets a robot reaches within its joint limits, by inverse kinematics from many starts.

    Under constraints a target is reachable where a configuration is admitted, and blocked where all were rejected.
    """

    analysis: Literal["reachability"] = "reachability"
    """Name of the analysis."""
    criteria: Criteria = ()
    """What the targets must fulfil for the result to pass."""
