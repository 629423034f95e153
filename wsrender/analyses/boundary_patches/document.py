"""The form of the result documents of the analysis ``boundary_patches``."""

from typing import Literal

from wsrender.results.document import (
    Count,
    Pair,
    Point,
    RefinedVolume,
    ResultDocument,
    ResultPart,
    RobotEntry,
    may_lack,
)


class ResultPrimitive(ResultPart):
    """A surface, by the numbers that its kind has."""

    kind: str
    """Plane, sphere, cylinder, cone, torus, or a free form."""
    point_m: Point = may_lack()
    """A point of a plane, or of a cylinder's axis [m]."""
    normal: Point = may_lack()
    """Normal of a plane."""
    center_m: Point = may_lack()
    """Centre of a sphere or torus [m]."""
    apex_m: Point = may_lack()
    """Apex of a cone [m]."""
    axis: Point = may_lack()
    """Axis of a cylinder, cone or torus."""
    radius_m: float = may_lack()
    """Radius [m]."""
    tube_radius_m: float = may_lack()
    """Radius of a torus's tube [m]."""
    half_angle_rad: float = may_lack()
    """Half the angle of a cone [rad]."""


class Generator(ResultPart):
    """What generates a patch."""

    limits: list[str]
    """Joints that stand at a limit, and which."""
    free: list[str]
    """Joints that move."""
    singular: bool
    """Whether the arm is singular there."""


class PatchEntry(ResultPrimitive):
    """A patch of the boundary."""

    method: str
    """How it was found."""
    generated_by: list[Generator]
    """What generates it."""
    area_m2: float
    """Its area [m²]."""
    residual_m: float | None
    """How far its points are from the surface [m]; null: it is a free form that nothing was fitted to."""
    points_fitted: Count
    """How many they are."""
    nearest: ResultPrimitive = may_lack()
    """Of a free form: the surface that is nearest to it."""


class EdgeEntry(ResultPart):
    """Where two patches meet."""

    kind: str
    """Line, circle, or a free curve."""
    patches: list[Count]
    """Numbers of the patches."""
    corners: list[Count]
    """Numbers of the corners at its ends."""
    length_m: float
    """Its length [m]."""
    angle_between_normals_rad: Pair
    """Least and largest angle between the patches' normals [rad]."""
    residual_m: float | None
    """How far its points are from that curve [m]."""
    center_m: Point = may_lack()
    """Centre of a circle [m]."""
    axis: Point = may_lack()
    """Its axis."""
    radius_m: float | None = may_lack()
    """Its radius [m]."""


class CornerEntry(ResultPart):
    """Where edges meet."""

    position_m: Point
    """Where [m]."""
    patches: list[Count]
    """Numbers of the patches."""


class PatchVolume(ResultPart):
    """Volumes [m³]."""

    integrated: float = may_lack()
    """By integration, of arms of three joints."""
    enclosed: float
    """That the patches enclose."""
    refined: RefinedVolume = may_lack()
    """By inverse kinematics, of others."""


class ResultPatchMesh(ResultPart):
    """The mesh of the patches."""

    mesh: Literal["patches"]
    """Its name among the files."""
    triangles: Count
    """How many it has."""
    volume_m3: float
    """What it encloses [m³]."""
    watertight: bool
    """Whether it is closed."""


class BoundaryPatchesResult(ResultDocument):
    """The boundary surface of what a spatial arm reaches, in patches."""

    analysis: Literal["boundary_patches"]
    """Name of the analysis."""
    robot: RobotEntry
    """The robot."""
    joints: list[str]
    """Joints that move the tip's position."""
    cell_width_m: float
    """Edge of a cell [m]."""
    patches: list[PatchEntry]
    """Patches."""
    edges: list[EdgeEntry]
    """Edges."""
    corners: list[CornerEntry]
    """Corners."""
    volume_m3: PatchVolume
    """Volumes [m³]."""
    integration_error_m3: float = may_lack()
    """What integration may be off [m³]."""
    fit_tolerance_m: float = may_lack()
    """How near points must be to a fitted surface [m]."""
    undecided: Count = may_lack()
    """Points that inverse kinematics left undecided."""
    mesh: ResultPatchMesh = may_lack()
    """The mesh; none where all that is reached is thinner than a cell."""
