"""The form of the result documents of the analysis ``shared_workspace``."""

from typing import Annotated, Literal

from pydantic import Field

from wsrender.results.document import (
    Blocked,
    Interval,
    OneOfSeveral,
    ResultChoices,
    ResultDocument,
    ResultPart,
    ResultRefinedMeasure,
    SurfaceEntry,
    may_lack,
)


class RefinedTogether(ResultPart):
    """What is reached by inverse kinematics."""

    any: ResultRefinedMeasure
    """By at least one robot."""
    shared: ResultRefinedMeasure
    """By at least two."""


class MeasuredTogether(ResultPart):
    """Measures by inverse kinematics, and under constraints what of the shared one is free, blocked and undecided."""

    refined: RefinedTogether | None
    """Measures; null where none were asked for, or they are of another kind."""
    free: Interval = may_lack()
    """Free."""
    blocked: Blocked = may_lack()
    """Blocked by a constraint."""
    undecided: Interval = may_lack()
    """Left undecided."""


class SharedVolume(MeasuredTogether):
    """Volumes [m³] by voxels and by inverse kinematics."""

    any: float
    """That any robot reaches."""
    shared: float
    """That at least two reach."""
    exactly: dict[str, float]
    """By the number of robots that reach it."""


class SharedIndex(ResultPart):
    """The product of an index of all robots, relative to its maxima, over the shared voxels."""

    maximum: float | None
    """Its largest value; null: nothing is shared."""
    mean: float | None
    """Its mean; null: nothing is shared."""


class SharedWorkspaceResult(ResultDocument):
    """What several robots reach together."""

    analysis: Literal["shared_workspace"]
    """Name of the analysis."""
    robots: Annotated[list[OneOfSeveral], Field(min_length=2)]
    """Each by itself."""
    choices: ResultChoices
    """What makes the values of indices unambiguous."""
    voxel_size_m: float
    """Edge of a voxel [m]."""
    volume_m3: SharedVolume
    """Volumes [m³]."""
    area_m2: MeasuredTogether = may_lack()
    """Of workspaces in one plane: areas [m²]."""
    length_m: MeasuredTogether = may_lack()
    """Of workspaces on one line: lengths [m]."""
    shared_ratio: float
    """What is shared over what any reaches."""
    shared_ratio_volume: Literal["refined", "occupied"]
    """Which measures that ratio is of."""
    quality: dict[str, SharedIndex]
    """By index."""
    surfaces: dict[str, SurfaceEntry]
    """Meshes by name."""
