"""The job of master–slave mapping."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field, StrictBool

from wsrender.documents.arm import Arm, ArmPath
from wsrender.documents.constraints import Constrained
from wsrender.documents.document import Document
from wsrender.documents.format import JobDocument, example
from wsrender.documents.mechanism import MechanismSpec
from wsrender.documents.options import Device
from wsrender.documents.point_sets import PointSet, is_point_set
from wsrender.documents.quantities import Number, PositiveNumber, Seed, VoxelSize, integer, listed_rows, real, sequence
from wsrender.documents.robot import Transform, Vector
from wsrender.documents.sampling import BoundaryBiased, Grid, Random, Sampling, Sobol

MOST_POINTS = 1_000_000


class MappedRobot(Constrained, Arm):
    """A master or slave, and the configurations whose positions stand for its workspace.

    Under constraints positions count that an admitted configuration reaches.
    """

    sampling: Sampling = Sobol(20_000)
    """How its joint space is sampled."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        if not isinstance(self.sampling, Grid | Random | Sobol | BoundaryBiased):
            yield "sampling", 'must not be "converge": the positions of one sampling are mapped'


class MappedMechanism(Document):
    """A parallel mechanism as master or slave: positions of its platform, which is not turned."""

    mechanism: MechanismSpec
    """The mechanism; a string is a name of the library, such as "master_4dof"."""
    count: Annotated[int, Field(ge=4, le=MOST_POINTS), BeforeValidator(integer)] = 20_000
    """Positions, spread evenly over the workspace."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if self.mechanism.serial_legs():
            yield "mechanism", 'must have no legs of the type "serial": map a mechanism with legs in closed form'


def _source(value: Any) -> Any:
    if isinstance(value, MappedRobot | MappedMechanism | PointSet):
        return value
    if isinstance(value, Mapping) and "mechanism" in value:
        return MappedMechanism.model_validate(value)
    return (PointSet if is_point_set(value) else MappedRobot).model_validate(value)


def _scale(value: Any) -> tuple[float, ...]:
    numbers = tuple(real(number) for number in sequence(value)) if hasattr(value, "__len__") else (real(value),) * 3
    if len(numbers) != 3 or not min(numbers) > 0:
        raise ValueError("must be a number above 0, or a list of three")
    return numbers


def _bounds(value: Any) -> tuple[float, ...]:
    numbers = tuple(real(number) for number in sequence(value))
    if len(numbers) != 2 or not numbers[0] < numbers[1]:
        raise ValueError("must be [low, high], low below high")
    return numbers


def _positive_bounds(value: Any) -> tuple[float, ...]:
    numbers = _bounds(value)
    if not numbers[0] > 0:
        raise ValueError("must be [low, high], both above 0")
    return numbers


def _vectors(value: Any) -> tuple[Any, ...]:
    vectors = tuple(listed_rows(value))
    if not 1 <= len(vectors) <= 100:
        raise ValueError("must be a list of 1 … 100 offsets [x, y, z]")
    return vectors


RobotOrPoints = Annotated[MappedRobot | MappedMechanism | PointSet, BeforeValidator(_source)]
Bounds = Annotated[tuple[float, float], BeforeValidator(_bounds)]
PositiveBounds = Annotated[tuple[float, float], BeforeValidator(_positive_bounds)]


class Containment(Document):
    """What decides whether a point lies in a workspace that is known by points."""

    kind: Literal["alpha_shape", "voxels"] = "alpha_shape"
    """The alpha shape of the points, or the voxels that hold them."""
    alpha_m: PositiveNumber | None = None
    """Radius α of the alpha shape [m]; null: twice the smallest with which all points belong
    to it."""
    voxel_size_m: VoxelSize | None = None
    """Edge of the voxels [m]; it must be given for voxels."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if self.kind == "voxels" and self.voxel_size_m is None:
            yield "voxel_size_m", 'must be given with the kind "voxels"'
        if self.kind == "voxels" and self.alpha_m is not None:
            yield "alpha_m", 'must be null with the kind "voxels"'
        if self.kind == "alpha_shape" and self.voxel_size_m is not None:
            yield "voxel_size_m", 'must be null with the kind "alpha_shape"'


class MappingSearch(Document):
    """Search of the mapping with the largest slave volume that succeeds.

    One scale at a given offset is found to a millionth, with an offset a local optimum to about 0.5 %.
    """

    scale: PositiveBounds = (0.1, 10.0)
    """Bounds [low, high] of the scale itself [1]: of each of three, or of one number, the geometric mean of the scales
    along x, y, z, which keep the job's proportions."""
    uniform: StrictBool = True
    """Whether one number scales x, y and z in the job's proportions, or three."""
    offset_m: tuple[Bounds, Bounds, Bounds] | None = None
    """Bounds [low, high] of the offset along x, y, z [m]; null: it stays each of the job's offsets."""
    steps: Annotated[int, Field(ge=2, le=10_000), BeforeValidator(integer)] = 50
    """Scales of the curve of volume against scale."""
    seed: Seed = 0
    """Seed of the search over more than one number."""


class MasterSlaveMappingJob(JobDocument):
    """Whether a slave's workspace, scaled, turned and shifted, lies in its master's, and the largest that does."""

    model_config = example(
        analysis="master_slave_mapping",
        master={"robot": {"library": "phantom_omni"}, "sampling": {"method": "sobol", "count": 4096}},
        slave={"points": [[0, 0, 0], [0.05, 0, 0], [0, 0.05, 0], [0, 0, 0.05], [0.05, 0.05, 0.05]]},
        offsets_m=[[0.0, -0.1, 0.0], [0.1, 0.0, 0.1]],
    )

    constraints_elsewhere: ClassVar[str] = 'give them to the "master" or the "slave", each has its own'

    analysis: Literal["master_slave_mapping"] = "master_slave_mapping"
    """Name of the analysis."""
    master: RobotOrPoints
    """The robot that is moved by hand: {"robot": …, "sampling": …} or {"points": [[x, y, z], …]}."""
    slave: RobotOrPoints
    """The robot that follows."""
    scale: Annotated[
        tuple[Number, Number, Number],
        BeforeValidator(
            _scale, json_schema_input_type=tuple[PositiveNumber, PositiveNumber, PositiveNumber] | PositiveNumber
        ),
    ] = (1.0, 1.0, 1.0)
    """S: scales along x, y, z of the master's world; one number stands for three."""
    rotation: Transform | None = None
    """R: rotation of the slave's points (its position_m must be 0); null: none."""
    offsets_m: Annotated[
        tuple[Vector, ...], BeforeValidator(_vectors, json_schema_input_type=tuple[Vector, ...] | Vector)
    ] = ((0.0, 0.0, 0.0),)
    """Offsets [m], a list or a single one, that are compared: slave' = S R slave + offset."""
    containment: Containment = Containment()
    """What decides whether a point lies in a workspace."""
    search: MappingSearch | None = None
    """Search of the largest scale, and optionally offset; null: the mapping is only tested."""
    device: Device = "auto"
    """Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N"."""

    def arms(self) -> dict[ArmPath, Arm]:
        """The robots among master and slave, by path."""
        sources = {("master",): self.master, ("slave",): self.slave}
        return {path: source for path, source in sources.items() if isinstance(source, Arm)}

    def sweeps(self) -> list[Any]:
        """The robots whose joint spaces the job samples."""
        return list(self.arms().values())

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if self.rotation is not None and any(self.rotation.position_m):
            yield "rotation", 'must not shift: its position_m must be 0; use "offsets_m"'
        if self.search is not None and self.search.offset_m is not None and len(self.offsets_m) > 1:
            yield "offsets_m", "must be one where the search finds the offset"
