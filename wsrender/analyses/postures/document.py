"""The form of the result documents of the analysis ``postures``."""

from typing import Literal

from wsrender.results.document import (
    Count,
    Extremes,
    Rejections,
    ResultChoices,
    ResultDocument,
    ResultPart,
    ResultSamples,
    RobotEntry,
    may_lack,
)


class SelfMotions(ResultPart):
    """Curves of postures."""

    count: Count
    """How many."""
    closed: Count
    """Those that end where they begin."""


class Aspects(ResultPart):
    """Which postures connect without a singular configuration."""

    most_of_a_pose: Count
    """Aspects of a pose at most."""
    proven: Count
    """Poses of which they are proven."""
    cuspidal_poses: Count
    """Poses with two postures in one aspect."""
    evidence: str
    """What that rests on."""


class FoundPostures(ResultPart):
    """Postures of all poses together."""

    poses: Count
    """Poses that were asked."""
    reached: Count
    """Those with a posture."""
    postures: Count
    """Postures, without windings."""
    configurations: Count
    """With windings."""
    listed: Count
    """Rows of the table."""
    most_of_a_pose: Count
    """Postures of a pose at most."""
    self_motions: SelfMotions
    """Curves of them."""
    families: Count
    """Postures that stand for a family at a singular pose."""
    doubtful: Count
    """Those that are nearly singular."""
    complete: Count
    """Poses of which all are found."""
    evidence: str
    """What that rests on."""
    largest_residual_m: float
    """How far the tip is from its pose at most [m]."""
    largest_residual_rad: float
    """How far it is turned from it at most [rad]."""
    aspects: Aspects = may_lack()
    """Where they were asked for."""
    free: Count = may_lack()
    """Under constraints: postures that they admit."""


class PosturesResult(ResultDocument):
    """All configurations of given poses."""

    analysis: Literal["postures"]
    """Name of the analysis."""
    robot: RobotEntry
    """The robot."""
    postures: FoundPostures
    """What was found."""
    samples: ResultSamples = may_lack()
    """Under constraints: what they admit."""
    rejections: Rejections = may_lack()
    """Under constraints: what they reject."""
    indices: dict[str, Extremes] = may_lack()
    """Where some were asked for, by name."""
    choices: ResultChoices = may_lack()
    """What makes their values unambiguous."""
