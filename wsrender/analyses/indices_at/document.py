"""The form of the result documents of the analysis ``indices_at``."""

from typing import Literal

from wsrender.results.document import (
    Choices,
    Count,
    Extremes,
    Part,
    Rejections,
    ResultDocument,
    RobotEntry,
    Samples,
    may_lack,
)


class GivenConfigurations(Part):
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
    samples: Samples = may_lack()
    """Under constraints: what they admit."""
    rejections: Rejections = may_lack()
    """Under constraints: what they reject."""
    indices: dict[str, Extremes]
    """By name, over the admitted configurations."""
    choices: Choices
    """What makes their values unambiguous."""
