"""The form of the result documents of the analysis ``workspace``."""

from typing import Literal

from pydantic import Field

from wsrender.results.document import (
    Converged,
    GlobalIndices,
    IndexEntry,
    LabelCounts,
    Measured,
    NoSurface,
    ResultBounds,
    ResultChoices,
    ResultDocument,
    ResultSamples,
    RobotEntry,
    Sampling,
    SurfaceEntry,
    SweepRejections,
    VoxelVolume,
    may_lack,
)


class WorkspaceResult(ResultDocument):
    """What a sampled joint space reaches."""

    analysis: Literal["workspace"]
    """Name of the analysis."""
    robot: RobotEntry
    """The robot."""
    sampling: Sampling
    """What was sampled."""
    samples: ResultSamples = may_lack()
    """Under constraints: what they admit."""
    rejections: SweepRejections = may_lack()
    """Under constraints: what they reject."""
    indices: dict[str, IndexEntry]
    """By name."""
    choices: ResultChoices
    """What makes their values unambiguous."""
    voxel_size_m: float
    """Edge of a voxel [m]."""
    volume_m3: VoxelVolume
    """Volumes [m³]."""
    area_m2: Measured = may_lack()
    """Of a workspace on a surface: its area [m²]."""
    length_m: Measured = may_lack()
    """Of a workspace on a curve: its length [m]."""
    voxel_labels: LabelCounts | None
    """Labelled voxels; null where none were asked for."""
    surfaces: dict[str, SurfaceEntry | NoSurface]
    """Meshes that were asked for, by name."""
    bounds_m: ResultBounds
    """Box around the positions [m]."""
    global_: GlobalIndices = Field(alias="global")
    """Indices of the whole workspace."""
    convergence: list[Converged] | None
    """Grids of a sampling that converges; null of others."""
