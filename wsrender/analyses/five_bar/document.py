"""The form of the result documents of the analysis ``five_bar``."""

from typing import Annotated, Literal

from pydantic import Field

from wsrender.results.document import Count, Pair, PlanePoint, ResultDocument, ResultPart

WorkingMode = Literal["++", "+-", "-+", "--"]
AssemblyMode = str
Angles = Annotated[list[float], Field(min_length=4, max_length=4)]


class FiveBarEntry(ResultPart):
    """The five-bar."""

    name: str
    """Its name."""
    base_m: float
    """L0 [m]."""
    proximal_m: Pair
    """L1 of both legs [m]."""
    distal_m: Pair
    """L2 of both legs [m]."""
    limits_rad: Annotated[list[Pair | None], Field(min_length=2, max_length=2)]
    """Limits of θ1 and θ2 [rad]; null: the joint turns freely."""


class LatticeSampling(ResultPart):
    """What was looked at."""

    samples: Count
    """Cells of the maps."""
    method: Literal["lattices"]
    """How."""


class ModeWorkspace(ResultPart):
    """The workspace of a working mode."""

    working_mode: WorkingMode
    """Signs of sin(θ3 − θ1) and sin(θ4 − θ2)."""
    area_m2: float
    """Its area [m²]."""
    perimeter_m: float
    """Its perimeter [m]."""
    arcs: Count
    """Arcs of its boundary."""
    loops: Count
    """Loops of these."""


class ResultAspect(ResultPart):
    """Part of a workspace without a singular posture."""

    working_mode: WorkingMode
    """Its working mode."""
    assembly_mode: AssemblyMode
    """Its assembly mode."""
    area_m2: float
    """Its area [m²]."""
    area_error_m2: float
    """What that may be off [m²]."""
    holes: Count
    """Holes in it."""


class ModeConditioning(ResultPart):
    """Condition numbers in a working mode; null where nothing is reached."""

    working_mode: WorkingMode
    """The mode."""
    least_kappa_a: float | None
    """Least of A."""
    mean_inverse_kappa_a: float | None
    """Mean of the inverse, of A."""
    least_kappa_b: float | None
    """Least of B."""
    mean_inverse_kappa_b: float | None
    """Mean of the inverse, of B."""
    least_kappa_j: float | None
    """Least of J."""
    mean_inverse_kappa_j: float | None
    """Mean of the inverse, of J."""


class IsotropicPoint(ResultPart):
    """A point at which J is isotropic."""

    working_mode: WorkingMode
    """In which mode."""
    position_m: PlanePoint
    """Where [m]."""
    angles_rad: Angles
    """θ1 … θ4 [rad]."""


class PostureEntry(ResultPart):
    """A posture, and its indices."""

    reachable: bool
    """Whether there is one."""
    angles_rad: Angles | None
    """θ1 … θ4 [rad]; null: there is none."""
    kappa_a: float | None
    """Condition number of A; null: infinite."""
    kappa_b: float | None
    """Condition number of B; null: infinite."""
    kappa_j: float | None
    """Condition number of J; null: infinite."""
    manipulability_m2: float | None
    """Manipulability [m²]; null: it is not finite."""


class PointPosture(PostureEntry):
    """The posture of a point in a working mode."""

    position_m: PlanePoint
    """The point [m]."""
    working_mode: WorkingMode
    """The mode."""


class AssemblyPosture(PostureEntry):
    """The posture of actuated angles in an assembly mode."""

    theta_rad: Pair
    """θ1 and θ2 [rad]."""
    assembly_mode: AssemblyMode
    """The mode."""
    position_m: PlanePoint | None
    """Where P is [m]; null: there is none."""


class FiveBarResult(ResultDocument):
    """A planar five-bar."""

    analysis: Literal["five_bar"]
    """Name of the analysis."""
    robot: FiveBarEntry
    """The five-bar."""
    sampling: LatticeSampling
    """What was looked at."""
    voxel_size_m: float
    """Edge of the cells of the Cartesian maps [m]."""
    workspaces: list[ModeWorkspace]
    """By working mode."""
    aspects: list[ResultAspect]
    """Of each working mode."""
    kappa: list[ModeConditioning]
    """By working mode."""
    isotropic_points: list[IsotropicPoint]
    """Of each working mode."""
    points: list[PointPosture]
    """Points that were asked, in every working mode."""
    assemblies: list[AssemblyPosture]
    """Actuated angles that were asked, in both assembly modes."""
