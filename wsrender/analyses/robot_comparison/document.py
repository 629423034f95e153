"""The form of the result documents of the analysis ``robot_comparison``."""

from typing import Annotated, Literal

from pydantic import Field

from wsrender.results.document import OneOfSeveral, ResultChoices, ResultDocument, ResultPart


class ComparedQuantity(ResultPart):
    """A number of all robots."""

    quantity: str
    """What it is."""
    unit: str
    """Its unit."""
    values: list[float | None]
    """Of each robot; null: it has none."""
    differences: list[float | None]
    """From that of the first."""


class RobotComparisonResult(ResultDocument):
    """Several robots side by side."""

    analysis: Literal["robot_comparison"]
    """Name of the analysis."""
    robots: Annotated[list[OneOfSeveral], Field(min_length=2)]
    """Each by itself."""
    choices: ResultChoices
    """What makes the values of indices unambiguous."""
    voxel_size_m: float
    """Edge of a voxel [m]."""
    comparison: list[ComparedQuantity]
    """Their numbers."""
