"""The job ``workspace``: a sampled joint space, as map, volume and global indices."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, StrictBool, model_validator

from wsrender.documents.arm import Arm
from wsrender.documents.constraints import Constrained
from wsrender.documents.format import JobDocument, example
from wsrender.documents.options import IndexChoices, MapColumns, StatisticsOrNone, Surfaces
from wsrender.documents.quantities import Count, Name, RelativeTolerance, VoxelSize, is_none
from wsrender.documents.sampling import DEFAULT_COUNT, SEVERAL_COUNT, Sampling, Sobol


class WorkspaceJob(IndexChoices, Constrained, Arm, JobDocument):
    """Sample the joint space of a robot: distribution map, volume data and global indices."""

    model_config = example(
        analysis="workspace",
        robot={"library": "phantom_omni"},
        tip="tool",
        sampling={"method": "sobol", "count": 1000000},
        indices=["manipulability", "inverse_condition_number"],
        task="linear",
    )

    analysis: Literal["workspace"] = "workspace"
    """Name of the analysis."""
    sampling: Sampling = Sobol(DEFAULT_COUNT)
    """How the joint space is sampled; by default 2^24 Sobol samples, with a map 2^20."""
    voxel_size_m: VoxelSize | None = None
    """Edge of a voxel [m]; null: what holds 48 samples on average, at least a hundredth of the cube root of the
    workspace's convex-hull volume."""
    voxel_statistics: StatisticsOrNone = None
    """What is kept per voxel, from count, maximum, mean, minimum; count always is. null: what means something for the
    indices, count and maximum of the six."""
    refined_volume: RelativeTolerance | None = 0.01
    """Half width of the headline's 95 % interval, relative to it [1]: of the volume that inverse kinematics finds
    reachable, of a planar workspace the area, of a line the length; under constraints of what it finds free, beside
    what they block; null: none is computed."""
    best_sample: Annotated[Name | None, Field(exclude_if=is_none)] = None
    """An index of the job: of every voxel the number of the sample with its largest value is kept, of equal ones the
    smallest; `configuration_of` has its configuration. null: none is kept."""
    voxel_labels: StrictBool = False
    """Whether every voxel is labelled reachable, unreachable or undecided by inverse kinematics; under constraints
    reachable in configurations that they admit, or blocked by one where others are found."""
    surfaces: Surfaces = ()
    """Meshes of the workspace, each with its volume: "marching_cubes" of the voxels, "convex_hull" and {"alpha_shape":
    α in metres} of the picture's subsample, {"iso_surface": index, "fraction": μ} of the voxels. Where none is asked
    for, that of the voxels is among the files all the same."""
    keep_map: StrictBool = False
    """Whether the distribution map, one row per sample, is kept."""
    map_columns: MapColumns = ()
    """More columns of the map: "configuration" [rad or m] and "orientation" (quat_wxyz)."""
    max_samples: Count = 10_000_000_000
    """Largest number of samples that the job may take."""

    @model_validator(mode="before")
    @classmethod
    def _fewer_rows(cls, data: Any) -> Any:
        """Fewer samples by default where a row is kept for each."""
        if isinstance(data, Mapping) and "sampling" not in data and data.get("keep_map") is True:
            return {**data, "sampling": Sobol(SEVERAL_COUNT)}
        return data

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        if self.map_columns and not self.keep_map:
            yield "map_columns", 'must be empty unless "keep_map" is true'
        if self.best_sample and self.voxel_statistics is not None and "maximum" not in self.voxel_statistics:
            yield "best_sample", 'needs the voxel statistic "maximum", whose samples it keeps'
