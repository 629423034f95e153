"""The form of the result documents of the analysis ``inverse_reachability``."""

from typing import Literal

from wsrender.results.document import Count, Place, Pose, ResultDocument, ResultPart, RobotEntry, Share, may_lack


class BaseLabels(ResultPart):
    """Base poses by label."""

    reachable: Count
    """The target is reached from there."""
    unreachable: Count
    """It is not."""
    undecided: Count
    """Neither was found."""
    blocked: Count = may_lack()
    """It is reached, but constraints reject all configurations."""


class BasePositions(ResultPart):
    """Positions of the base."""

    count: Count
    """How many there are."""
    reached: Count
    """From how many the target is reached in some orientation."""
    all: Count
    """From how many it is in all."""


class Bases(ResultPart):
    """Base poses, and whether the target is reached from them."""

    count: Count
    """How many there are."""
    shape: dict[str, Count]
    """Values of each coordinate that varies."""
    orientations: Count
    """Orientations at each position."""
    labels: BaseLabels
    """By label."""
    reasons: dict[str, Count]
    """Blocked ones by constraint."""
    codes: list[str]
    """What the numbers in the column `label` of the table mean."""
    positions: BasePositions
    """Positions of the base."""
    share: Share
    """Share of all orientations from which the target is reached, in the mean over the positions."""
    alike: Count
    """Poses in a row that are the same whatever yaw is."""
    evidence: str
    """What labels rest on."""


class BestBase(Place):
    """The base pose that is farthest from those from which the target is not reached."""

    T_world_base: Pose
    """Rows of a homogeneous matrix [m]."""


class InverseReachabilityResult(ResultDocument):
    """From which base poses a robot reaches a target."""

    analysis: Literal["inverse_reachability"]
    """Name of the analysis."""
    robot: RobotEntry
    """The robot."""
    bases: Bases
    """Base poses."""
    best: BestBase | None
    """The best of them; null: the target is reached from none."""
