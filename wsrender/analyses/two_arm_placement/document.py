"""The form of the result documents of the analysis ``two_arm_placement``."""

from typing import Annotated, Literal

from pydantic import Field

from wsrender.results.document import (
    Count,
    NamedRobot,
    Place,
    Point,
    Pose,
    Quaternion,
    ResultDocument,
    ResultPart,
    ResultPlacements,
    Share,
    may_lack,
)


class ServedShares(ResultPart):
    """Shares of the targets, by weight."""

    first: Share
    """The first arm alone."""
    second: Share
    """The second alone."""
    both: Share
    """Both."""
    none: Share
    """Neither."""
    undecided: Share
    """Neither was found."""


class ServedTargets(ResultPart):
    """Targets by which arm serves them from the best pair of placements."""

    count: Count
    """Targets."""
    first: Count
    """The first arm alone."""
    second: Count
    """The second alone."""
    both: Count
    """Both."""
    none: Count
    """Neither."""
    undecided: Count
    """Neither was found."""
    share: ServedShares
    """By weight."""


class PlacementPairs(ResultPart):
    """Pairs of placements."""

    count: Count
    """How many there are."""
    most_weight: float
    """What the targets weigh that a pair serves at most."""
    serving_all: Count
    """Pairs that serve all targets."""


class PlacedArm(Place):
    """Where an arm of the best pair stands."""

    placement: Count
    """Number of the placement."""
    served: Count
    """Targets that it serves from there."""
    T_world_base: Pose
    """Rows of a homogeneous matrix [m]."""


class BestPair(ResultPart):
    """The best pair of placements."""

    first: PlacedArm
    """Of the first arm."""
    second: PlacedArm
    """Of the second."""


class PlacementsOfBoth(ResultPart):
    """Placements of either arm by itself."""

    first: ResultPlacements
    """Of the first arm."""
    second: ResultPlacements
    """Of the second."""


class HandOverLabels(ResultPart):
    """Poses of a hand-over from the best pair of placements."""

    free: Count
    """Both arms can hold it at once."""
    blocked: Count
    """They cannot without coming too near each other."""
    undecided: Count
    """Neither was found."""
    none: Count
    """An arm does not reach it."""


class BestHandOver(ResultPart):
    """The pose of a hand-over with most room to the joints' limits."""

    pose: Count
    """Its number."""
    position_m: Point
    """Where the first arm's tip is [m]."""
    quat_wxyz: Quaternion
    """How it is turned."""
    q_first: list[float]
    """Configuration of the first arm [rad or m]."""
    q_second: list[float]
    """Configuration of the second [rad or m]."""
    joint_limit_margin: float
    """Least room to a limit, by ranges [1]."""


class ResultHandOver(ResultPart):
    """Poses that both arms can hold at once."""

    poses: Count
    """Poses that were asked."""
    offered: Count
    """Those that some pair of placements offers."""
    pairs: Count
    """Pairs of placements that offer any."""
    most: Count
    """Poses that a pair offers at most."""
    of_best_pair: HandOverLabels
    """Poses from the best pair."""
    best: BestHandOver | None
    """The best of them; null: it offers none."""


class TwoArmPlacementResult(ResultDocument):
    """Where two arms stand so that one or the other serves most targets."""

    analysis: Literal["two_arm_placement"]
    """Name of the analysis."""
    robots: Annotated[list[NamedRobot], Field(min_length=2, max_length=2)]
    """Both arms."""
    targets: ServedTargets
    """Targets."""
    pairs: PlacementPairs
    """Pairs of placements."""
    best: BestPair
    """The best of them."""
    placements: PlacementsOfBoth
    """Of either arm by itself."""
    hand_over: ResultHandOver = may_lack()
    """Where it was asked for."""
