"""The form of the result documents of the analysis ``master_slave_mapping``."""

from typing import Annotated, Literal

from pydantic import Field

from wsrender.results.document import (
    Count,
    NamedRobot,
    Pair,
    Point,
    ResultDocument,
    ResultPart,
    ResultSamples,
    Share,
    SurfaceEntry,
    may_lack,
)


class MappedSamples(ResultPart):
    """What was sampled."""

    samples: Count
    """Points of both sides."""


class ResultServedPositions(ResultPart):
    """Sampled positions by whether a configuration that is admitted reaches them."""

    served: Count
    """One does."""
    blocked: dict[str, Count]
    """None does, by the constraint that rejects them."""
    undecided: Count
    """None was found."""


class AdmittedPositions(ResultSamples):
    """What constraints admit of a side's samples, and of their positions."""

    positions: ResultServedPositions
    """Positions."""


class MappingAdmission(ResultPart):
    """What constraints admit of either side that has some."""

    master: AdmittedPositions = may_lack()
    """Of the master."""
    slave: AdmittedPositions = may_lack()
    """Of the slave."""


class ResultMapping(ResultPart):
    """A mapping of the slave's workspace into the master's."""

    scale: Point
    """Scales along x, y, z."""
    offset_m: Point
    """Shift [m]."""
    succeeded: bool
    """Whether all points lie inside."""
    failing_points: Count
    """Those that do not."""
    reasons: dict[str, Count] = may_lack()
    """Under constraints of the master: failing points by why they fail."""
    inside: Share
    """Share of the points that lie inside."""
    volume_m3: float
    """Volume of the mapped slave [m³]."""
    efficiency: float
    """That over the master's."""


class MappingVolumes(ResultPart):
    """Volumes [m³] of the shapes around points."""

    master: float
    """The master's."""
    slave: float
    """The slave's."""
    mapped: float
    """The mapped slave's."""


class MappingSurfaces(ResultPart):
    """Meshes of both sides."""

    master: SurfaceEntry
    """The master's."""
    slave: SurfaceEntry
    """The mapped slave's."""


class ResultMappingSearch(ResultPart):
    """What the search tried."""

    found: bool
    """Whether any scale maps all points."""
    scale: Pair
    """Its scales, from … to."""
    most_inside: Share
    """Share of the points that lie inside at most."""
    at_scale: float
    """At which scale."""


class MasterSlaveMappingResult(ResultDocument):
    """Whether a slave's workspace lies in its master's."""

    analysis: Literal["master_slave_mapping"]
    """Name of the analysis."""
    robots: list[NamedRobot] = Field(max_length=2)
    """Those of the sides that are robots."""
    sampling: MappedSamples
    """What was sampled."""
    admission: MappingAdmission = may_lack()
    """Under constraints: what they admit."""
    mapping: ResultMapping
    """The best mapping."""
    offsets: Annotated[list[ResultMapping], Field(min_length=1)]
    """All that were tried as they are given, and what the search found."""
    volume_m3: MappingVolumes
    """Volumes [m³]."""
    surfaces: MappingSurfaces
    """Meshes."""
    search: ResultMappingSearch = may_lack()
    """Where one was asked for."""
