"""The form of the result documents of the analysis ``planar_boundary``."""

from typing import Annotated, Literal

from pydantic import Field

from wsrender.results.document import Count, PlanePoint, Point, ResultDocument, ResultPart, RobotEntry, may_lack


class ResultPlane(ResultPart):
    """The plane of the arm, in the world."""

    origin_m: Point
    """Its origin [m]."""
    x_axis: Point
    """Its x axis."""
    y_axis: Point
    """Its y axis."""
    normal: Point
    """Its normal."""


class BoundarySampling(ResultPart):
    """What was sampled."""

    method: str
    """How."""
    samples: Count
    """How many."""


class ResultSegment(ResultPart):
    """A line or an arc."""

    kind: Literal["line", "arc"]
    """Which of them."""
    start_m: PlanePoint
    """Where it begins [m]."""
    end_m: PlanePoint
    """Where it ends [m]."""
    center_m: PlanePoint = may_lack()
    """Centre of an arc [m]."""
    radius_m: float = may_lack()
    """Its radius [m]."""
    sweep_rad: float = may_lack()
    """Its angle, counter-clockwise [rad]."""


class ResultExactSegment(ResultSegment):
    """A segment of the exact boundary."""

    generated_by: list[dict[str, str]]
    """Joints that stand at a limit along it, or fold the arm."""
    configurations: list[list[float]]
    """Configurations along it, of each of these [rad or m]."""


class ExactLoop(ResultPart):
    """A closed curve of the exact boundary."""

    hole: bool
    """Whether it bounds a hole."""
    segments: list[ResultExactSegment]
    """Its segments."""


class RegionsBySolutions(ResultPart):
    """What is reached in so many postures."""

    solutions: Count
    """How many."""
    area_m2: float
    """Area [m²]."""
    regions: Count
    """Parts."""


class RegionsByComponents(ResultPart):
    """What is reached in so many self-motions."""

    components: Count
    """How many."""
    area_m2: float
    """Area [m²]."""
    regions: Count
    """Parts."""


class ExactPlanar(ResultPart):
    """The exact boundary."""

    dimension: Annotated[int, Field(ge=0, le=2)]
    """Of what is reached."""
    area_m2: float
    """Its area [m²]."""
    perimeter_m: float
    """Its perimeter, or the length of a curve [m]."""
    vertices_m: list[PlanePoint]
    """Where segments meet [m]."""
    inverse_solutions: list[RegionsBySolutions] | None
    """Regions by postures; null of an arm with a joint to spare."""
    self_motions: list[RegionsByComponents] | None
    """Regions by self-motions; null of an arm without."""
    regions_not_told_apart: str = may_lack()
    """Why neither is known."""
    loops: list[ExactLoop]
    """Its closed curves."""


class EstimatedLoop(ResultPart):
    """A closed curve of the estimated boundary."""

    segments: list[ResultSegment]
    """Its segments."""


class EstimatedPlanar(ResultPart):
    """The boundary as samples give it."""

    cell_width_m: float
    """Edge of the cells [m]."""
    boundary_cells: Count
    """Cells on the boundary."""
    line_tolerance_m2: float
    """Of lines [m²]."""
    arc_tolerance_m4: float
    """Of arcs [m⁴]."""
    area_m2: float
    """Its area [m²]."""
    mean_distance_to_exact_m: float | None
    """How far its cells are from the exact boundary, in the mean [m]; null: there are none."""
    mean_distance_to_exact_cells: float | None
    """That in cells."""
    critical_points_m: list[PlanePoint]
    """Where segments meet [m]."""
    converged: bool
    """Whether it is like the exact one."""
    not_converged_because: list[str]
    """Where it is not."""
    loops: list[EstimatedLoop]
    """Its closed curves."""


class PlanarBoundaryResult(ResultDocument):
    """The boundary of what a planar arm reaches."""

    analysis: Literal["planar_boundary"]
    """Name of the analysis."""
    robot: RobotEntry
    """The robot."""
    plane: ResultPlane
    """The plane."""
    sampling: BoundarySampling
    """What was sampled."""
    exact: ExactPlanar
    """The exact boundary."""
    monte_carlo: EstimatedPlanar
    """The estimated one."""
