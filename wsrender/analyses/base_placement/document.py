"""The form of the result documents of the analysis ``base_placement``."""

from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from wsrender.results.document import (
    Count,
    Covered,
    CriterionEntry,
    NamedRobot,
    Place,
    Pose,
    ResultDocument,
    ResultPart,
    ResultPlacements,
    RobotEntry,
    may_lack,
)

INDICES = ConfigDict(json_schema_extra={"additionalProperties": {"type": "number"}}, extra="allow")


class ServingPlace(Place):
    """A placement, and what it serves; the least values of indices over the targets stand beside, by their names."""

    model_config = INDICES

    served: Count
    """Targets."""
    weight: float
    """What they weigh."""


class PlacementCell(ServingPlace):
    """A placement of the space."""

    placement: Count
    """Its number."""


class LargestTried(ResultPart):
    """How far was tried at most."""

    translation_m: float
    """Shift [m]."""
    rotation_rad: float
    """Turn [rad]."""


class PlacementTolerance(ResultPart):
    """How far the base may stand elsewhere and serve the same."""

    translation_m: float
    """Shifted [m]."""
    rotation_rad: float | None
    """Turned about any axis [rad]; null: where weight counts, a turned base is another case."""
    largest: LargestTried
    """What was tried at most."""


class BestPlacement(ServingPlace):
    """The best placement."""

    T_world_base: Pose
    """Where the base stands, rows of a homogeneous matrix [m]."""
    cell: PlacementCell
    """The best of the space, from which it was refined."""
    tolerance: PlacementTolerance = may_lack()
    """Where it was refined."""
    covered: Covered = may_lack()
    """Of a volume of targets: how much of it is reached from there."""


class BestOfRobots(BestPlacement):
    """The best placement of all robots."""

    robot: str
    """Which robot's it is."""


class PlacementPareto(ResultPart):
    """Placements that no other beats in one objective without being worse in the other."""

    objectives: Annotated[list[str], Field(min_length=2, max_length=2)]
    """Columns of the table."""
    placements: Count
    """How many there are."""
    values: Count
    """How many pairs of values."""


class ResultPlacedRobot(NamedRobot):
    """One of several robots, each placed by itself."""

    placements: ResultPlacements
    """Its placements."""
    best: BestPlacement | None
    """The best of them; null: none serves a target."""
    criteria: list[CriterionEntry] = may_lack()
    """What was asked of the targets."""
    verdict: Literal["pass", "fail", "undecided"] = may_lack()
    """Of all criteria."""


class PlacedArms(ResultPart):
    """Cells of the map by which robot does best there."""

    cells: Count
    """Cells."""
    alone: dict[str, Count]
    """Where one robot does best, by its name."""
    equal: Count
    """Where several do."""
    none: Count
    """Where none serves a target."""


class BasePlacementResult(ResultDocument):
    """Where the base of a robot, or of each of several, stands best."""

    model_config = ConfigDict(
        json_schema_extra={"oneOf": [{"required": ["robot", "placements"]}, {"required": ["robots"]}]}
    )

    analysis: Literal["base_placement"]
    """Name of the analysis."""
    robot: RobotEntry = may_lack()
    """The robot, of one."""
    placements: ResultPlacements = may_lack()
    """Its placements, of one."""
    robots: list[ResultPlacedRobot] = may_lack()
    """Of several each by itself."""
    arms: PlacedArms = may_lack()
    """Of several: which does best where."""
    best: BestOfRobots | BestPlacement | None
    """The best placement; null: none serves a target."""
    pareto: PlacementPareto = may_lack()
    """Where it was asked for."""
    criteria: list[CriterionEntry] = may_lack()
    """What was asked of the targets."""
    verdict: Literal["pass", "fail", "undecided"] = may_lack()
    """Of all criteria."""
