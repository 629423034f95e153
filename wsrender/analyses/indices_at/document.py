"""The form of the result documents of the analysis ``indices_at``."""

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


class GivenConfigurations(ResultPart):
    """What was looked at."""

    method: Literal["given"]
    """Configurations were given."""
    samples: Count
    """How many."""


class IndicesAtResult(ResultDocument):
    """Indices at given configurations."""

    analysis: Literal["indices_at"]
    """Name of the analysis."""
    robot: RobotEntry
    """The robot."""
    sampling: GivenConfigurations
    """What was looked at."""
    samples: ResultSamples = may_lack()
    """Under constraints: what they admit."""
    rejections: Rejections = may_lack()
    """Under constraints: what they reject."""
    indices: dict[str, Extremes]
    """By name, over the admitted configurations."""
    choices: ResultChoices
    """What makes their values unambiguous."""
