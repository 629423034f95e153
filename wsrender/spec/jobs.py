"""Job documents: what to analyse, one discriminated union on ``analysis``."""

from collections.abc import Iterator
from typing import Annotated, Literal, get_args

from pydantic import BeforeValidator, Discriminator, StrictBool

from wsrender.spec.arm import Arm
from wsrender.spec.document import Document
from wsrender.spec.options import (
    Configurations,
    Device,
    Indices,
    MapColumns,
    NotAvailable,
    Penalty,
    Statistics,
    Task,
)
from wsrender.spec.problems import tagged
from wsrender.spec.quantities import Count, PositiveNumber
from wsrender.spec.sampling import Grid, Sampling
from wsrender.spec.surfaces import Surfaces


class _IndexedJob(Arm):
    """The fields shared by all jobs that evaluate local indices of one robot."""

    indices: Indices = "kinematic"
    """Local indices: "kinematic", "dynamic", "all", or a list of names."""
    task: Task = "linear"
    """Rows of the Jacobian, in base axes: "linear", "angular", "full", or a list from x y z rx ry rz."""
    characteristic_length_m: PositiveNumber = 1.0
    """Length that divides the linear rows of a task that mixes linear and angular rows [m]."""
    convention: Literal["standard", "table_1", "wsrender_code"] = "standard"
    """Which definition of the indices: the standard one, Table I of the WSRender paper, or its program."""
    joint_limit_penalty: Penalty = None
    """K of the joint-limit penalisation [1]; null or false: off; true: 10."""
    torque_scaling: StrictBool = False
    """Whether dynamic indices scale every joint by its largest effort [N m or N]."""
    inertia: Literal["kernel", "mujoco"] = "kernel"
    """What evaluates the joint-space inertia: the kernels, or MuJoCo itself."""
    precision: Literal["float32", "float64"] = "float32"
    """Floating-point type of the kernels."""
    device: Device = "auto"
    """Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N"."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if self.convention == "wsrender_code":
            if self.task not in ("linear", "full"):
                yield "task", 'must be left at "linear": the convention "wsrender_code" chooses its own rows'
            if self.precision == "float32":
                yield "precision", 'must be "float64" with the convention "wsrender_code", not "float32"'
            if self.torque_scaling:
                yield "torque_scaling", 'must be false with the convention "wsrender_code", which has none'
        elif self.torque_scaling and self.indices == "kinematic":
            yield "torque_scaling", "must be false with kinematic indices: it scales dynamic ones"


class WorkspaceJob(_IndexedJob):
    """Sample the joint space of a robot: distribution map, volume data and global indices."""

    analysis: Literal["workspace"] = "workspace"
    """Name of the analysis."""
    sampling: Sampling = Grid()
    """How the joint space is sampled."""
    voxel_size_m: PositiveNumber | None = None
    """Edge of a voxel [m]; null: a hundredth of the cube root of the workspace's convex-hull volume."""
    voxel_statistics: Statistics = ("count", "maximum")
    """What is kept per voxel, from count, maximum, mean, minimum; count always is."""
    refined_volume: NotAvailable = None
    """Relative tolerance of the refined volume [1]; not available in this version: null."""
    surfaces: Surfaces = ("marching_cubes",)
    """Meshes of the workspace, each with its volume: "marching_cubes" of the voxels, "convex_hull" and {"alpha_shape":
    α in metres} of the picture's subsample, {"iso_surface": index, "fraction": μ} of the voxels."""
    keep_map: StrictBool = False
    """Whether the distribution map, one row per sample, is kept."""
    map_columns: MapColumns = ()
    """More columns of the map: "configuration" [rad or m] and "orientation" (quat_wxyz)."""
    max_samples: Count = 10_000_000_000
    """Largest number of samples that the job may take."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        if self.map_columns and not self.keep_map:
            yield "map_columns", 'must be empty unless "keep_map" is true'


class IndicesAtJob(_IndexedJob):
    """Local indices at given configurations."""

    analysis: Literal["indices_at"] = "indices_at"
    """Name of the analysis."""
    configurations: Configurations = None
    """Rows of joint values [rad or m], one per joint from base to tip; null where Python passes an array."""
    precision: Literal["float32", "float64"] = "float64"
    """Floating-point type of the kernels."""


_AnyJob = WorkspaceJob | IndicesAtJob
ANALYSES: dict[str, type[Document]] = {job.model_fields["analysis"].default: job for job in get_args(_AnyJob)}

Job = Annotated[_AnyJob, Discriminator("analysis"), BeforeValidator(tagged("analysis", ANALYSES))]
