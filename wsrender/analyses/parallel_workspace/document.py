"""The form of the result documents of the analysis ``parallel_workspace``."""

from typing import Any, Literal

from wsrender.results.document import (
    Count,
    Pair,
    Point,
    Pose,
    ResultBounds,
    ResultDocument,
    ResultPart,
    ResultSamples,
    RobotEntry,
    Share,
    SurfaceEntry,
    may_lack,
)


class ClosedFormLegEntry(ResultPart):
    """A leg with a closed form."""

    type: str
    """Its type."""
    lower: float
    """Lower limit of its actuated joint [m or rad]."""
    upper: float
    """Upper limit."""
    unit: Literal["m", "rad"]
    """Unit of these."""


class SerialLegEntry(ResultPart):
    """A leg that is an arm."""

    type: Literal["serial"]
    """Its type."""
    robot: RobotEntry
    """The arm."""
    holds: Literal["pose", "position"]
    """What of the platform it holds."""
    actuated: list[str]
    """Its joints that are driven."""


class MechanismEntry(ResultPart):
    """The mechanism."""

    name: str
    """Its name."""
    T_world_base: Pose
    """Where its base stands, rows of a homogeneous matrix [m]."""
    degrees_of_freedom: Count
    """Of the platform."""
    legs: list[SerialLegEntry | ClosedFormLegEntry]
    """Its legs."""


class PoseSampling(ResultPart):
    """What was looked at."""

    method: str
    """How."""
    samples: Count = may_lack()
    """Poses."""
    legs_evaluated: Count = may_lack()
    """Legs that were solved."""
    levels: list[Count] = may_lack()
    """Levels of each angle."""
    undecided: Count = may_lack()
    """Poses that a numerical solution neither found nor excluded; they count as not reached."""


class RefinedPositions(ResultPart):
    """A volume, area or length by uniform points, with its 95 % interval."""

    value: float
    """The measure [m³, m² or m]."""
    ci95: Pair
    """Its interval."""
    tolerance: float
    """Half width that was asked for, relative to the value [1]."""
    of: str
    """What is measured."""
    met: bool
    """Whether the interval is as narrow as that."""
    points: Count
    """Points that were decided."""
    orientation_steps: float = may_lack()
    """What levels of orientations may hide."""


class PositionVolume(ResultPart):
    """Volumes [m³]; by voxels, or of the surfaces that bound it."""

    occupied: float = may_lack()
    """Of voxels that are reached."""
    inner: float = may_lack()
    """Of those with six such neighbours."""
    outer: float = may_lack()
    """Of those and their neighbours."""
    dexterous: float = may_lack()
    """Where enough of the orientations are reached."""
    all_orientations: float = may_lack()
    """Where all are."""
    refined: RefinedPositions | None = may_lack()
    """By uniform points; null: none was asked for, or it is in `flat`."""
    exact: float = may_lack()
    """Of the exact boundary."""
    solids: float = may_lack()
    """Of meshes of balls."""


class FlatMeasure(ResultPart):
    """What is reached in a plane or on a line."""

    quantity: Literal["area", "length"]
    """What is measured."""
    unit: str
    """Its unit."""
    occupied: float
    """Of cells that are reached."""
    refined: RefinedPositions | None
    """By uniform points; null: none was asked for."""
    origin_m: Point
    """A point of it [m]."""
    axes: list[Point]
    """Its directions."""


class NoBounds(ResultPart):
    """Of nothing."""


class PoseIndex(ResultPart):
    """An index over the voxels."""

    maximum: float
    """Its largest value."""
    minimum: float
    """Its least value."""
    workspace_mean: float | None
    """Mean over voxels, relative to the maximum."""
    unit: str
    """Its unit."""
    task: list[str]
    """Rows of the Jacobian."""
    options: dict[str, Any] = may_lack()
    """Its options."""


class MatrixConditioning(ResultPart):
    """Condition numbers of a matrix over the voxels."""

    least_condition_number: float | None
    """The least; null: infinite everywhere."""
    mean_inverse: Share
    """Mean of the inverse."""


class ResultConditioning(ResultPart):
    """Condition numbers of A, B and J over the voxels."""

    A: MatrixConditioning
    """Of A."""
    B: MatrixConditioning
    """Of B."""
    J: MatrixConditioning
    """Of J."""


class Singularities(ResultPart):
    """Where a determinant changes its sign."""

    determinant: str
    """Its name."""
    sign_changes: Count
    """Points that were found."""
    positive_voxels: Count
    """Voxels in which it is positive."""
    negative_voxels: Count
    """Voxels in which it is negative."""
    everywhere: bool
    """Whether it is 0 everywhere."""


class SingularitiesByType(ResultPart):
    """Singularities of both types (Gosselin and Angeles 1990)."""

    type_1: Singularities
    """Of B: legs are stretched or folded."""
    type_2: Singularities
    """Of A: the platform moves while all joints stand."""
    branches: Count = may_lack()
    """Combinations of the legs' branches that are reached."""


class OrientationWorkspace(ResultPart):
    """Orientations that are reached at a position."""

    position_m: Point
    """The position [m]."""
    orientations: Count
    """Orientations that were asked."""
    reached: Count
    """Those that are reached."""
    share: Share
    """Their share, by measure."""
    share_of_ranges: Share
    """Share of the whole ranges."""
    share_of_ranges_ci95: Pair
    """Its 95 % interval."""
    measure: str
    """What measure that is."""


class ResultTopology(ResultPart):
    """The boundary as a surface."""

    vertices: Count
    """Vertices."""
    edges: Count
    """Edges."""
    faces: Count
    """Faces."""
    loops: Count
    """Loops that bound faces."""
    components: Count
    """Parts."""
    voids: Count
    """Hollows."""
    genus: int
    """Handles."""


class ParallelWorkspaceResult(ResultDocument):
    """Poses that a parallel mechanism reaches."""

    analysis: Literal["parallel_workspace"]
    """Name of the analysis."""
    mechanism: MechanismEntry
    """The mechanism."""
    kind: Literal["constant_orientation", "orientation", "dexterous", "total_orientation"]
    """Which workspace."""
    orientations: Count
    """Orientations of the platform that were asked."""
    serial_configurations: Count
    """Configurations of serial joints at its base."""
    sampling: PoseSampling
    """What was looked at."""
    samples: ResultSamples = may_lack()
    """Under constraints: what they admit."""
    voxel_size_m: float | None = may_lack()
    """Edge of a voxel [m]."""
    volume_m3: PositionVolume = may_lack()
    """Volumes [m³]."""
    area_m2: float = may_lack()
    """Area of the boundary [m²]."""
    indices: dict[str, PoseIndex] = may_lack()
    """By name."""
    bounds_m: ResultBounds | NoBounds = may_lack()
    """Box around what is reached [m]."""
    flat: FlatMeasure = may_lack()
    """What is reached in a plane or on a line."""
    conditioning: ResultConditioning = may_lack()
    """Condition numbers."""
    singularities: SingularitiesByType = may_lack()
    """Singularities."""
    orientation_workspace: OrientationWorkspace = may_lack()
    """Orientations that are reached."""
    surfaces: dict[str, SurfaceEntry] = may_lack()
    """Meshes by name."""
    topology: ResultTopology = may_lack()
    """Of the exact boundary."""
    empty: str = may_lack()
    """Why nothing is reached."""
