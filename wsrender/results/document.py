"""What result documents are made of: the form of the parts that several analyses have, and of what all of them have.

Each analysis has a class of its own after `ResultDocument`. They say, and a server publishes, what a document holds;
nothing is read or written with them.
"""

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from wsrender.documents.format import FORMAT

Count = Annotated[int, Field(ge=0)]
Share = Annotated[float, Field(ge=0, le=1)]
Pair = Annotated[list[float], Field(min_length=2, max_length=2)]
Point = Annotated[list[float], Field(min_length=3, max_length=3)]
PlanePoint = Annotated[list[float], Field(min_length=2, max_length=2)]
Quaternion = Annotated[list[float], Field(min_length=4, max_length=4)]
Pose = Annotated[list[Quaternion], Field(min_length=4, max_length=4)]
Sha256 = Annotated[str, Field(pattern="^[0-9a-f]{64}$")]


def may_lack() -> Any:
    """Of a field that a document need not have; it is never null for that reason."""
    return Field(default_factory=lambda: None)


class ResultPart(BaseModel):
    """A part of a result document; it holds nothing else."""

    model_config = ConfigDict(extra="forbid", use_attribute_docstrings=True, protected_namespaces=())


class RobotEntry(ResultPart):
    """A robot."""

    name: str
    """Its name."""
    user_defined: bool
    """Whether it is a Python class."""
    model_hash: Sha256
    """SHA-256 of the model's text."""
    chain_hash: Sha256
    """SHA-256 of the chain from base to tip."""
    base_frame: str
    """Where the chain begins."""
    tip_frame: str
    """Where it ends."""
    T_world_base: Pose
    """Where the base stands, rows of a homogeneous matrix [m]."""
    T_tip_tool: Pose
    """The tool in the frame of the tip [m]."""
    joint_names: list[str]
    """Joints from base to tip."""
    lower_limits: list[float | None]
    """Their lower limits [rad or m]; null: none."""
    upper_limits: list[float | None]
    """Their upper limits [rad or m]; null: none."""
    has_inertia: bool
    """Whether the model says its inertias."""


class NamedRobot(ResultPart):
    """A robot among several."""

    name: str
    """What it is called."""
    robot: RobotEntry
    """The robot."""


class Headline(ResultPart):
    """The number that an analysis is about."""

    quantity: Literal["volume", "area", "length"]
    """What is measured."""
    value: float | None
    """The measure; null where there is none."""
    ci95: Pair | None
    """Interval that holds it with 95 % confidence."""
    unit: Literal["m3", "m2", "m"]
    """Unit of value and interval."""
    reason: str
    """Why there is none."""


class WarningEntry(ResultPart):
    """Something that a user should know."""

    code: str
    """The kind of warning for programs; stable."""
    message: str
    """What was found."""
    remedy: str
    """What to do about it."""
    field: str | None
    """The field of the job document that decides it, dotted."""


class Provenance(BaseModel):
    """What the numbers come from; what else an analysis says of that stands beside these."""

    model_config = ConfigDict(extra="allow", use_attribute_docstrings=True)

    wsrender: str
    """Version of wsrender."""
    warp: str = Field(alias="warp-lang")
    """Version of Warp."""
    mujoco: str
    """Version of MuJoCo."""
    numpy: str
    """Version of NumPy."""
    precision: Literal["float32", "float64"]
    """Floating-point type of the kernels."""
    target: str
    """What they were compiled for."""
    seed: Count = may_lack()
    """Seed of what was drawn."""
    pipeline: str = may_lack()
    """Samples, constraints, indices and what was kept, in a line."""
    sampling_path: str = may_lack()
    """How samples were evaluated."""
    citation: str
    """How to cite wsrender."""
    run: dict[str, str]
    """When it ended (`date`), and by which `command`."""
    host: dict[str, str]
    """Python and system that it ran on."""


class ArtifactEntry(ResultPart):
    """A file of a result."""

    name: str
    """Its name in a result folder."""
    media_type: str
    """Its media type."""
    bytes: Count
    """Its size."""
    sha256: Sha256
    """SHA-256 of its content."""
    shape: list[Count] | None
    """Shape of what it holds."""
    units: dict[str, str]
    """Units of what it holds, by name."""
    frame: str | None
    """Frame that its coordinates refer to."""


class ResultDocument(ResultPart):
    """What every result document has."""

    format: int = Field(json_schema_extra={"const": FORMAT})
    """Format of the document."""
    job: dict[str, Any]
    """The job document that was run, with all defaults."""
    headline: Headline
    """The number that the analysis is about."""
    warnings: list[WarningEntry]
    """What should be known of the model and the numbers."""
    provenance: Provenance
    """What the numbers come from."""
    timing_s: dict[str, Annotated[float, Field(ge=0)]]
    """How long its steps took [s]."""
    artifacts: list[ArtifactEntry] = may_lack()
    """Its files, once it is saved."""


class Interval(ResultPart):
    """A value with its 95 % interval."""

    value: float | None
    """The value; null where there is none."""
    ci95: Pair | None
    """The interval; null where there is none."""


class Blocked(Interval):
    """What all configurations of are rejected."""

    by: dict[str, Interval]
    """By each constraint."""


class ResultFalseNegatives(ResultPart):
    """How often inverse kinematics found nothing at points that are reached."""

    tested: Count
    """Points that are known to be reached."""
    missed: Count
    """Those that it did not find."""


class RefinedVolume(ResultPart):
    """A volume by inverse kinematics, with its 95 % interval."""

    value: float | None
    """The volume [m³]."""
    ci95: Pair | None
    """Its interval."""
    tolerance: float
    """Half width that was asked for, relative to the value [1]."""
    met: bool
    """Whether the interval is as narrow as that."""
    undecided: float
    """Of the measure what was left undecided."""
    points: Count
    """Points that were decided."""
    position_tolerance_m: float
    """How near the tip must come [m]."""
    false_negatives: list[ResultFalseNegatives]
    """Of each robot."""


class Parts(ResultPart):
    """What constraints leave of a measure."""

    free: Interval
    """Free."""
    blocked: Blocked
    """Blocked by a constraint."""
    undecided: Interval
    """Left undecided."""


class ResultRefinedMeasure(RefinedVolume):
    """A volume [m³], area [m²] or length [m] by inverse kinematics, with its 95 % interval."""

    quantity: Literal["volume", "area", "length"]
    """What is measured."""
    unit: Literal["m3", "m2", "m"]
    """Its unit."""
    reason: str
    """Why there is none."""
    parts: Parts = may_lack()
    """Under constraints: what is free, and blocked."""


class Measured(ResultPart):
    """A measure by inverse kinematics, and under constraints what of it is free, blocked and undecided."""

    refined: ResultRefinedMeasure | None
    """The measure; null where none was asked for, or it is of another kind."""
    free: Interval = may_lack()
    """Free."""
    blocked: Blocked = may_lack()
    """Blocked by a constraint."""
    undecided: Interval = may_lack()
    """Left undecided."""


class VoxelVolume(Measured):
    """Volumes [m³] by voxels and by inverse kinematics."""

    occupied: float
    """Of voxels with a sample."""
    inner: float
    """Of those with six such neighbours."""
    outer: float
    """Of those and their neighbours."""


class Sampling(ResultPart):
    """What was sampled."""

    method: str
    """How."""
    samples: Count
    """How many."""
    seed: Count
    """Seed of what was drawn."""
    per_joint: list[Count] = may_lack()
    """Levels of each joint, of a grid."""
    locked: dict[str, float]
    """Joints that were held [rad or m]."""


class ResultSamples(ResultPart):
    """What constraints admit."""

    drawn: Count
    """Samples."""
    admitted: Count
    """Those that all constraints admit."""
    rejected: dict[str, Count]
    """By the first constraint that rejects them."""


class FirstRejected(ResultPart):
    """The first sample that a constraint rejected."""

    sample: Count
    """Its number."""
    configuration: list[float]
    """Its configuration [rad or m]."""


class CollidingPair(ResultPart):
    """Two shapes that come too near each other."""

    constraint: str
    """What keeps them apart."""
    shapes: Annotated[list[str], Field(min_length=2, max_length=2)]
    """Their names."""
    samples: Count
    """Samples in which they do."""


class CollidingPairs(ResultPart):
    """Which shapes collide how often."""

    counted: Count
    """Samples that were looked at."""
    colliding: list[CollidingPair]
    """Most often first."""


class Rejections(ResultPart):
    """What constraints reject."""

    first: dict[str, FirstRejected]
    """By constraint."""
    pairs: CollidingPairs = may_lack()
    """Where shapes are kept apart."""


class LostVolume(ResultPart):
    """Volume of voxels that lost all their samples [m³]."""

    drawn: float
    """Of all voxels with a sample."""
    lost: float
    """Of those that lost theirs."""
    lost_at_random: Interval
    """If as many samples were dropped at random."""


class MovedMean(ResultPart):
    """The mean of an index."""

    drawn: float
    """Over all samples."""
    admitted: float | None
    """Over those admitted; null: there are none."""
    at_random: Interval | None
    """If as many were dropped at random."""


class MovedMeans(ResultPart):
    """How means change."""

    counted: Count
    """Samples that were looked at."""
    indices: dict[str, MovedMean]
    """By index."""


class SweepRejections(Rejections):
    """What constraints reject of a sampled joint space, and what that changes."""

    volume_m3: LostVolume
    """Volume that is lost [m³]."""
    means: MovedMeans
    """Means of indices."""


class Extremes(ResultPart):
    """An index over configurations."""

    maximum: float | None
    """Its largest value; null: there is none."""
    minimum: float | None
    """Its least value; null: there is none."""
    cut_share: Share = may_lack()
    """Share of the values that a limit cuts."""
    unit: str
    """Its unit."""


class IndexEntry(ResultPart):
    """An index over a workspace."""

    maximum: float
    """Its largest value."""
    minimum: float
    """Its least value."""
    mean: float = may_lack()
    """Its mean, of one that may be negative, or is of the user."""
    joint_mean: float | None
    """Mean over samples, relative to the maximum; null of one that may be negative."""
    workspace_mean: float | None
    """Mean over voxels, relative to the maximum; null where no voxel keeps it."""
    cut_share: Share = may_lack()
    """Share of the values that a limit cuts."""
    unit: str
    """Its unit."""


class ResultChoices(ResultPart):
    """What makes the values of indices unambiguous."""

    task: list[Literal["x", "y", "z", "rx", "ry", "rz"]]
    """Rows of the Jacobian."""
    convention: str
    """How rows of different units are made comparable."""
    characteristic_length_m: float
    """By which length [m]."""
    joint_limit_penalty: float | None
    """k of the penalty near limits; null: none."""
    torque_scaling: bool
    """Whether dynamic indices are scaled by the joints' torques."""
    inertia: str
    """What inertias dynamic indices take."""
    index_options: dict[str, dict[str, Any]]
    """Options of indices that have some."""


class SurfaceEntry(ResultPart):
    """A mesh."""

    mesh: str
    """Its name among the files."""
    volume_m3: float
    """What it encloses [m³]."""
    area_m2: float
    """Its area [m²]."""
    watertight: bool
    """Whether it is closed."""
    triangles: Count
    """How many it has."""
    voxel_size_m: float = may_lack()
    """Edge of the voxels that it is of [m]."""
    alpha_m: float = may_lack()
    """α of an alpha shape [m]."""
    split_edges: Count = may_lack()
    """Edges of an alpha shape that were split, for surfaces touch in them."""
    points: Count = may_lack()
    """Points that it is of."""
    volume_of_one_half_m3: float | None = may_lack()
    """What that of half of them encloses [m³]; null: nothing."""
    volume_of_other_half_m3: float | None = may_lack()
    """What that of the other half encloses [m³]; null: nothing."""


class NoSurface(ResultPart):
    """A mesh that there is not."""

    mesh: None
    """None."""
    reason: str
    """Why."""


class ResultBounds(ResultPart):
    """A box in the world."""

    lower: Point
    """Its lower corner [m]."""
    upper: Point
    """Its upper corner [m]."""


class GlobalIndices(ResultPart):
    """Indices of the whole workspace."""

    global_isotropy: float
    """Least over largest singular value, over all samples (Stocco et al. 1998)."""
    structural_length_index: float | None
    """Lengths of the links over the cube root of the volume; null where there is none."""
    structural_length_reason: str
    """Why."""


class Converged(ResultPart):
    """A grid of a sampling that converges."""

    per_joint: Count
    """Levels of each joint."""
    samples: Count
    """Its samples."""
    value: float
    """What converges."""


class OneOfSeveral(NamedRobot):
    """The workspace of a robot among several."""

    sampling: Sampling
    """What was sampled."""
    samples: ResultSamples = may_lack()
    """Under constraints: what they admit."""
    rejections: SweepRejections = may_lack()
    """Under constraints: what they reject."""
    indices: dict[str, IndexEntry]
    """By name."""
    volume_m3: VoxelVolume
    """Volumes [m³]."""
    headline: Headline
    """What is measured of it alone."""
    bounds_m: ResultBounds
    """Box around its positions [m]."""
    global_: GlobalIndices = Field(alias="global")
    """Indices of its whole workspace."""
    convergence: list[Converged] | None
    """Grids of a sampling that converges; null of others."""


class LabelCounts(ResultPart):
    """Voxels by label and by reason."""

    labels: dict[str, Count]
    """By label."""
    reasons: dict[str, Count]
    """By reason."""


class CriterionEntry(ResultPart):
    """What targets must fulfil, and whether they do."""

    least_share: Share
    """Least share of the targets, by weight."""
    joint_margin_deg: float
    """Room to the limits of hinges [°]."""
    joint_margin_m: float
    """Room to the limits of slides [m]."""
    reached: Count
    """Targets that fulfil it."""
    share: Share
    """Their share, by weight."""
    undecided_share: Share
    """Share of those that are undecided."""
    verdict: Literal["pass", "fail", "undecided"]
    """Whether enough do."""


class Covered(ResultPart):
    """How much of a volume of targets is reached."""

    points: Count
    """Points that stand for it."""
    step_m: float
    """Their distance at most [m]."""
    volume_m3: float
    """The volume [m³]."""
    share: Share
    """Share that is reached."""
    undecided_share: Share
    """Share that is undecided."""
    evidence: str
    """What that rests on."""


class PlacementLabels(ResultPart):
    """Pairs of a placement and a target by label."""

    served: Count
    """The target is reached from there."""
    blocked: Count = may_lack()
    """It is reached, but constraints reject all configurations."""
    unreachable: Count
    """It is not reached."""
    undecided: Count
    """Neither was found."""


class ResultPlacements(ResultPart):
    """Placements of a base, and what they serve."""

    count: Count
    """How many there are."""
    on_the_edge: Count = may_lack()
    """How many of them stand on the edge of a table."""
    targets: Count
    """Targets."""
    shape: dict[str, Count]
    """Values of each coordinate that varies."""
    labels: PlacementLabels
    """Pairs of a placement and a target."""
    proven: Count
    """Pairs whose label is a proof."""
    reasons: dict[str, Count]
    """Blocked pairs by constraint."""
    most_served: Count
    """Targets that a placement serves at most."""
    serving_all: Count
    """Placements that serve all."""
    alike: Count
    """Placements in a row that serve the same whatever yaw is."""
    evidence: str
    """What labels rest on."""


class Place(ResultPart):
    """Where a base stands."""

    x_m: float
    """x [m]."""
    y_m: float
    """y [m]."""
    z_m: float
    """z [m]."""
    roll_deg: float
    """About x, first [°]."""
    pitch_deg: float
    """About y [°]."""
    yaw_deg: float
    """About z, last [°]."""
