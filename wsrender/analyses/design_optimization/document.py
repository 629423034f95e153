"""The form of the result documents of the analysis ``design_optimization``."""

from typing import Any, Literal

from wsrender.results.document import Count, NamedRobot, Pair, Point, ResultDocument, ResultPart, may_lack


class DesignMechanism(ResultPart):
    """The mechanism."""

    name: str
    """Its name."""


class DesignParameterEntry(ResultPart):
    """A number that varies."""

    name: str
    """What it is called."""
    pointers: list[str]
    """Where it stands in the design."""
    bounds: Pair
    """Its bounds, in the unit of the field."""


class ObjectiveEntry(ResultPart):
    """What is to be best."""

    name: str
    """What it is called."""
    goal: Literal["maximize", "minimize"]
    """Which way."""
    weight: float
    """What it counts."""
    unit: str | None
    """Its unit; null: not known."""
    error_voxels: float = may_lack()
    """What it may be off, in voxels."""
    error_m: float | None = may_lack()
    """What it may be off [m]; null: the voxels' size is not known."""


class DesignFaultEntry(ResultPart):
    """Why designs have no value."""

    code: str
    """The kind of fault."""
    reason: str
    """What was said of the first of them."""
    designs: Count
    """How many they are."""
    parameters: dict[str, float]
    """The first of them."""


class DesignSearch(ResultPart):
    """How the search went."""

    method: str
    """Its method."""
    ended: str
    """Why it ended."""
    designs: Count
    """Designs."""
    evaluated: Count
    """Those that were evaluated; others were known."""
    without_value: Count
    """Those that have no value."""
    first_fault: str | None
    """Why the first of these has none."""
    faults: list[DesignFaultEntry]
    """Why others have none, by kind."""


class Design(ResultPart):
    """A design."""

    parameters: dict[str, float]
    """Its parameters."""
    values: dict[str, float]
    """Its objectives."""
    at_bounds: list[str]
    """Parameters that are at a bound."""
    design: dict[str, Any]
    """The job document that has it."""


class InscribedBall(ResultPart):
    """The largest ball in a workspace."""

    center_m: Point
    """Its centre [m]."""
    radius_m: float
    """Its radius [m]."""
    at_most_radius_m: float
    """What no other exceeds [m]."""


class InscribedCube(ResultPart):
    """The largest cube in a workspace, its edges along the axes of the base."""

    center_m: Point
    """Its centre [m]."""
    edge_m: float
    """Its edge [m]."""
    at_most_edge_m: float
    """What no other exceeds [m]."""


class ResultInscribed(ResultPart):
    """Largest bodies in the best design's workspace."""

    sphere: InscribedBall = may_lack()
    """Ball."""
    cube: InscribedCube = may_lack()
    """Cube."""


class DesignOptimizationResult(ResultDocument):
    """The best design of a robot or mechanism."""

    analysis: Literal["design_optimization"]
    """Name of the analysis."""
    robots: list[NamedRobot] = may_lack()
    """Robots of the design as it is written."""
    mechanism: DesignMechanism = may_lack()
    """Its mechanism."""
    parameters: list[DesignParameterEntry]
    """Numbers that vary."""
    objectives: list[ObjectiveEntry]
    """What is to be best."""
    search: DesignSearch
    """How the search went."""
    best: Design | None
    """The best design; null: none has a value."""
    inscribed: ResultInscribed = may_lack()
    """Where objectives are exact inscribed bodies."""
    pareto: list[Design] = may_lack()
    """Of a Pareto search: designs that no other beats."""
