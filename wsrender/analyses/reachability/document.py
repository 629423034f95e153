"""The form of the result documents of the analysis ``reachability``."""

from typing import Literal

from wsrender.results.document import (
    Count,
    Covered,
    CriterionEntry,
    ResultDocument,
    ResultPart,
    RobotEntry,
    Share,
    may_lack,
)


class ReachedShares(ResultPart):
    """Shares of the targets, by weight."""

    reachable: Share
    """Reached."""
    blocked: Share = may_lack()
    """Reached, but constraints reject all configurations."""
    unreachable: Share
    """Not reached."""
    undecided: Share
    """Neither was found."""


class ReachedTargets(ResultPart):
    """How many targets have which label."""

    count: Count
    """Targets."""
    reachable: Count
    """Reached."""
    blocked: Count = may_lack()
    """Reached, but constraints reject all configurations."""
    unreachable: Count
    """Not reached."""
    undecided: Count
    """Neither was found."""
    reasons: dict[str, Count]
    """By why they are not reached."""
    proven: Count
    """Those whose label is a proof."""
    evidence: str
    """What labels rest on."""
    largest_residual_of_reachable_m: float
    """How far the tip is from a reached target at most [m]."""
    largest_residual_of_reachable_rad: float
    """How far it is turned from it at most [rad]."""
    share: ReachedShares = may_lack()
    """Of targets that have weights."""


class ReachabilityResult(ResultDocument):
    """Which targets a robot reaches."""

    analysis: Literal["reachability"]
    """Name of the analysis."""
    robot: RobotEntry
    """The robot."""
    targets: ReachedTargets
    """How many have which label."""
    covered: Covered = may_lack()
    """Of a volume of targets: how much of it is reached."""
    criteria: list[CriterionEntry] = may_lack()
    """What was asked of the targets."""
    verdict: Literal["pass", "fail", "undecided"] = may_lack()
    """Of all criteria."""
