"""The job ``parallel_workspace``: where, and in which orientations, a parallel mechanism holds its platform."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field, model_validator

from wsrender.documents.arm import Arm, ArmPath
from wsrender.documents.format import JobDocument, example
from wsrender.documents.mechanism import MechanismSpec
from wsrender.documents.options import Device, IndexOptions, IndicesOrNone, Precision, Task
from wsrender.documents.orientations import MOST_ORIENTATIONS, Orientations
from wsrender.documents.quantities import Count, PositiveNumber, RelativeTolerance, Seed, VoxelSize, real
from wsrender.documents.robot import Transform, Vector

BY_BOUNDARY = ("exact", "solids")


class ParallelWorkspaceJob(JobDocument):
    """Workspace of a parallel mechanism: the poses for which every leg has a solution within its limits.

    ``constant_orientation``: positions at one orientation; ``orientation``: orientations at one position;
    ``total_orientation``: positions at which all of a set of orientations are reached (Merlet 2006); ``dexterous``: the
    share of a set of orientations that is reached at each position.
    """

    model_config = example(
        analysis="parallel_workspace",
        mechanism={"library": "stewart_gough", "length_m": [0.5, 0.8]},
        voxel_size_m=0.1,
        refined_volume=0.1,
    )

    constraints_elsewhere: ClassVar[str] = 'bodies and what stands around are "bodies" of the "mechanism"'

    analysis: Literal["parallel_workspace"] = "parallel_workspace"
    """Name of the analysis."""
    mechanism: MechanismSpec
    """The mechanism; a string is a name of the library: stewart_gough, six_pus, delta, master_4dof."""
    kind: Literal["constant_orientation", "orientation", "dexterous", "total_orientation"] = "constant_orientation"
    """Which workspace."""
    orientation: Transform | None = None
    """Orientation of the platform in the base frame, without position_m; null: none. Of constant_orientation only."""
    position_m: Vector | None = None
    """Position of the platform in the world [m]. Of the kind orientation, which needs it."""
    orientations: Orientations = None
    """Orientations in the base frame: {"euler_xyz_deg": …} or {"tilt_deg": …}. All kinds but constant_orientation."""
    method: Literal["grid", "grid_by_subsystem", "exact", "solids"] = "grid_by_subsystem"
    """"grid" asks every leg at every point, "grid_by_subsystem" the next subsystem of legs where the last ones reach:
    the same voxels, sooner. "exact" (faces, volume, topology) and "solids" (boolean operations on meshes) are for the
    constant orientation of mechanisms whose workspace only spheres bound: UPS legs, pairs of PUS legs."""
    voxel_size_m: VoxelSize | None = None
    """Edge of a voxel [m]; null: a hundredth of the cube root of the workspace's volume, estimated."""
    indices: IndicesOrNone = ()
    """Local indices at the voxels' centres: "kinematic" or a list of names; []: none. Of constant_orientation. With
    serial joints the largest over their values, from the Jacobian of all joints."""
    index_options: IndexOptions = Field(default={})
    """Options of the indices that have any: {index: {option: value}}."""
    task: Task | None = None
    """Rows of the Jacobian, in base axes: "linear", "angular", "full" or a list; null: "full", "linear" of a delta."""
    characteristic_length_m: PositiveNumber = 1.0
    """Length that divides the linear rows where a task has angular ones too [m]."""
    dexterous_threshold: Annotated[float, Field(gt=0, le=1), BeforeValidator(real)] = 1.0
    """Least share of the orientations that counts as dexterous [1]."""
    refined_volume: RelativeTolerance | None = 0.01
    """Half width of the 95 % interval of the volume, relative to it [1], from random points; null: not computed. The
    default is 0.01 of a constant orientation by the methods "grid" and "grid_by_subsystem", else null. Serial joints
    are searched over all their values; the interval covers the steps of sets of orientations. In a plane it is that of
    the area, on a line of the length."""
    seed: Seed = 0
    """Seed of the random points."""
    max_poses: Count = 10_000_000_000
    """Largest number of poses that the job may test."""
    precision: Precision = "float64"
    """Floating-point type of the kernels."""
    device: Device = "auto"
    """Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N"."""

    @model_validator(mode="before")
    @classmethod
    def _refined_by_default(cls, data: Any) -> Any:
        if not isinstance(data, Mapping) or "refined_volume" in data:
            return data
        plain = data.get("kind", "constant_orientation") == "constant_orientation"
        on_grid = data.get("method", "grid_by_subsystem") not in BY_BOUNDARY
        return dict(data) if plain and on_grid else {**data, "refined_volume": None}

    def arms(self) -> dict[ArmPath, Arm]:
        """The legs of the mechanism that are robots, by path."""
        return {("mechanism", *path): leg for path, leg in self.mechanism.serial_legs().items()}

    def sweeps(self) -> list[Any]:
        """No joint spaces are sampled."""
        return []

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        constant, at_point = self.kind == "constant_orientation", self.kind == "orientation"
        if self.orientation is not None and not constant:
            yield "orientation", f'must be null with kind "{self.kind}": use "orientations"'
        if self.orientation is not None and any(self.orientation.position_m):
            yield "orientation", "must not shift: its position_m must be 0"
        if (self.position_m is not None) != at_point:
            yield "position_m", f'must be {"given" if at_point else "null"} with kind "{self.kind}"'
        if (self.orientations is None) != constant:
            yield "orientations", f'must be {"null" if constant else "given"} with kind "{self.kind}"'
        if self.method in BY_BOUNDARY:
            if self.arms():
                message = "the workspace of legs that are solved numerically has no known boundary"
                yield "method", f'must be "grid" or "grid_by_subsystem" with legs of the type "serial": {message}'
            if not constant:
                yield "method", f'must be "grid" or "grid_by_subsystem" with kind "{self.kind}"'
            for name in ("indices", "refined_volume", "voxel_size_m"):
                if getattr(self, name):
                    yield name, f'must not be given with the method "{self.method}": it has no voxels'
        if self.indices and not constant:
            yield "indices", f'must be [] with kind "{self.kind}": an index belongs to one pose'
        if at_point and self.refined_volume is not None:
            yield "refined_volume", "must be null where only the orientation varies"
        if self.orientations is not None and self.orientations.count > min(MOST_ORIENTATIONS, self.max_poses):
            yield "orientations", f"are {self.orientations.count:.4g}; at most {MOST_ORIENTATIONS:.4g} are tested"
