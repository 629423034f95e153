"""What a view is made of: the manifest, as ``server/web/src/contract.ts`` has it, in the same words.

Lengths in metres, angles in radians, right-handed world frame with z up, quaternions w-x-y-z, matrices row-major.
Numbers that are not finite are null. Voxel arrays are x-fastest: cell (i, j, k) at i + nx (j + ny k).
"""

from typing import Any, Literal, NotRequired

from pydantic import ConfigDict, TypeAdapter, with_config
from typing_extensions import TypedDict

Vector = tuple[float, float, float]
Cells = tuple[int, int, int]
Number = float | None
Type = Literal["uint8", "uint16", "uint32", "float16", "float32", "glb"]
Role = Literal["surface", "refined", "boundary", "shared", "exclusive", "environment"]

_strict = with_config(ConfigDict(extra="forbid", allow_inf_nan=False))


@_strict
class Data(TypedDict):
    """Numbers in a blob, little-endian, or a GLB file."""

    blob: str
    type: Type
    length: int  # numbers of it; of a glb its bytes
    compression: Literal["deflate"] | None


@_strict
class ViewChain(TypedDict):
    """One kinematic chain of n coordinates and L joints, as `wsrender.robots.chain.Chain` says it."""

    joints: list[str]
    angle: list[bool]
    lower: list[Number]  # null: no limit
    upper: list[Number]
    periodic: list[bool]
    revolute: list[bool]
    source: list[int]
    scale: list[float]
    offset: list[float]
    T_joint: list[list[float]]
    T_tip: list[float]  # tool included
    T_tool: list[float]
    T_base: list[float]


@_strict
class ViewLink(TypedDict):
    """Bodies in one frame: 0 is the base, k + 1 the frame of joint k after its motion."""

    name: str
    frame: int
    geometry: Data
    kind: Literal["visual", "collision"]


@_strict
class Samples(TypedDict):
    """Configurations that a robot may be shown in, and what they are."""

    configurations: list[list[float]]
    said: str


@_strict
class ViewRobot(TypedDict):
    """A robot whose motion the page computes."""

    name: str
    chain: ViewChain
    links: list[ViewLink]
    home: list[float]
    samples: NotRequired[Samples]


@_strict
class Skeleton(TypedDict):
    """Lines through points, by configuration."""

    name: str
    points: list[list[Vector]]
    closed: bool


@_strict
class Category(TypedDict):
    """A value that is a name."""

    value: float
    name: str
    color: str


@_strict
class Channel(TypedDict):
    """One number a voxel, point or cell."""

    name: str
    statistic: str
    label: str
    unit: str
    minimum: float
    maximum: float
    data: Data
    categories: NotRequired[list[Category]]
    signed: NotRequired[bool]
    whole: NotRequired[bool]


@_strict
class BestSample(TypedDict):
    """Of which index the best sample of each voxel is kept."""

    index: str


@_strict
class Volume(TypedDict):
    """A block of voxels of the world lattice."""

    name: str
    label: str
    shape: Cells
    first_voxel: Cells
    voxel_size_m: float
    occupancy: Data
    channels: list[Channel]
    coarser: NotRequired["list[Volume]"]
    reduced: NotRequired[str]
    exact: bool
    best_sample: NotRequired[BestSample]


@_strict
class ViewMesh(TypedDict):
    """Triangles."""

    name: str
    label: str
    geometry: Data
    role: Role
    color: NotRequired[str]


@_strict
class ViewPoints(TypedDict):
    """Points, quantised to a box: uint16 triples from lower to upper."""

    name: str
    label: str
    count: int
    lower: Vector
    upper: Vector
    positions: Data
    channels: list[Channel]


@_strict
class Glyphs(TypedDict):
    """Arrows: float32 triples."""

    name: str
    label: str
    unit: str
    origins: Data
    vectors: Data


@_strict
class ViewCurves(TypedDict):
    """Lines through points."""

    name: str
    label: str
    closed: bool
    points: list[list[Vector]]


@_strict
class FloorMap(TypedDict):
    """A plane map of cells along the first two axes of ``T_world``."""

    name: str
    label: str
    T_world: list[float]
    shape: tuple[int, int]
    cell_m: tuple[float, float]
    origin_m: tuple[float, float]
    channels: list[Channel]


@_strict
class Quantity(TypedDict):
    """Numbers of a plot."""

    label: str
    unit: str
    values: list[Number]


@_strict
class ChannelName(TypedDict):
    """A channel, as "statistic:name", of a volume."""

    volume: str
    name: str


@_strict
class Plot(TypedDict):
    """Numbers for a plot beside the view; of a histogram x are the middles of its classes.

    ``sets``: what a point's x is of the view: the samples of the volume of ``robot``, or the scale of the mapping.
    """

    name: str
    label: str
    kind: Literal["histogram", "curve"]
    x: Quantity
    y: list[Quantity]
    channel: NotRequired[ChannelName]
    sets: NotRequired[Literal["samples", "scale"]]
    robot: NotRequired[int]


@_strict
class MappedVolumes(TypedDict):
    """Names of the volumes that a mapping is drawn by; the slave's is in its own world."""

    master: str
    slave: str


@_strict
class Mapping(TypedDict):
    """slave' = S R slave + offset in the master's world, S the scales along its axes."""

    master: str
    slave: str
    scale: float | Vector
    offset_m: Vector
    R: list[float]
    volumes: MappedVolumes


@_strict
class Fact(TypedDict):
    """A line of a summary."""

    label: str
    value: str


@_strict
class StaticPicture(TypedDict):
    """A picture as a file, relative to where the manifest is."""

    name: str
    label: str
    url: str


@_strict
class Manifest(TypedDict):
    """All of a view but its bulk data."""

    format: Literal[1]
    title: str
    analysis: str
    headline: list[Fact]
    warnings: list[str]
    job: Any
    robots: list[ViewRobot]
    skeletons: list[Skeleton]
    volumes: list[Volume]
    meshes: list[ViewMesh]
    points: list[ViewPoints]
    glyphs: list[Glyphs]
    curves: list[ViewCurves]
    maps: list[FloorMap]
    plots: list[Plot]
    mapping: Mapping | None
    pictures: list[StaticPicture]
    omitted: list[str]


MANIFEST = TypeAdapter(Manifest)
"""Checks a manifest, and makes its JSON Schema."""
