"""The form of the result documents of the analysis ``collaborative_volume``."""

from typing import Literal

from pydantic import Field

from wsrender.results.document import (
    Blocked,
    Count,
    Interval,
    NamedRobot,
    RefinedVolume,
    ResultDocument,
    ResultPart,
    ResultSamples,
    may_lack,
)


class RandomRuns(ResultPart):
    """What was drawn."""

    method: Literal["random"]
    """Random configurations."""
    samples: Count
    """In all runs."""
    seed: Count
    """Seed of the first."""


class AdmittedSides(ResultPart):
    """What constraints admit of either arm, over all runs."""

    left: ResultSamples
    """Of the left arm."""
    right: ResultSamples
    """Of the right arm."""


class Refinement(ResultPart):
    """A division of the box."""

    refinement: Count
    """Its number; 0 is the coarsest."""
    mean_m3: float
    """Mean volume over the runs [m³]."""
    variance_m6: float | None
    """Its variance [m⁶]; null: there is one run."""
    bias: float | None
    """Relative to the true volume; null where that is not known, or 0."""


class CollaborativeCells(ResultPart):
    """Cells of the finest division, in the mean over the runs."""

    collaborative: float
    """That both arms reach."""
    boundary: float
    """On the boundary of these."""


class CollaborativeVolume(ResultPart):
    """Volumes that both arms reach [m³]."""

    body_elemental: float
    """By the algorithm, in the finest division."""
    true: RefinedVolume | None
    """By inverse kinematics; null: none was asked for."""
    free: Interval = may_lack()
    """Free."""
    blocked: Blocked = may_lack()
    """Blocked by a constraint."""
    undecided: Interval = may_lack()
    """Left undecided."""


class PartsAlone(ResultPart):
    """What of a measure is free, blocked and undecided."""

    free: Interval
    """Free."""
    blocked: Blocked
    """Blocked by a constraint."""
    undecided: Interval
    """Left undecided."""


class CollaborativeVolumeResult(ResultDocument):
    """Volume that two arms reach together."""

    analysis: Literal["collaborative_volume"]
    """Name of the analysis."""
    robots: list[NamedRobot] = Field(max_length=2)
    """Those of the arms that are robots."""
    admission: AdmittedSides = may_lack()
    """Under constraints: what they admit."""
    sampling: RandomRuns
    """What was drawn."""
    refinements: list[Refinement]
    """Divisions of the box, the coarsest first."""
    cells: CollaborativeCells
    """Of the finest."""
    volume_m3: CollaborativeVolume
    """Volumes [m³]."""
    area_m2: PartsAlone = may_lack()
    """Under constraints, of workspaces in one plane [m²]."""
    length_m: PartsAlone = may_lack()
    """Under constraints, of workspaces on one line [m]."""
