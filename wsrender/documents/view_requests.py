"""What a person who looks at a result or a robot asks of the engine, each a JSON object with the key ``ask``.

`wsrender.results.view.interactive` answers them; ``server/web/src/contract.ts`` says the same in TypeScript.
"""

from collections.abc import Mapping
from typing import Annotated, Any, Literal, get_args

import numpy as np
from pydantic import BeforeValidator, Field

from wsrender.documents.document import Document
from wsrender.documents.quantities import Count, Name, Number, VoxelSize, integer, numbers_of, quoted, sequence
from wsrender.documents.reading import check_depth
from wsrender.documents.robot import Range
from wsrender.documents.transform import LARGEST, Quaternion, Vector
from wsrender.errors import DocumentError

MOST_JOINTS = 64  # of a configuration; robots have fewer
NEARLY_RIGID = 1e-6  # of the columns of a rotation that a page has multiplied up


def _rigid(value: Any) -> tuple[float, ...]:
    numbers = numbers_of(value)
    if len(numbers) != 16:
        raise ValueError("must be a list of 16 finite numbers, a (4, 4) matrix row by row")
    T = np.reshape(numbers, (4, 4))
    turned = np.abs(T[:3, :3] @ T[:3, :3].T - np.eye(3)).max() < NEARLY_RIGID and np.linalg.det(T[:3, :3]) > 0
    if not turned or list(T[3]) != [0, 0, 0, 1] or np.abs(T).max() > LARGEST:
        raise ValueError("must be a rigid transform: a rotation, a position, and the last row 0 0 0 1")
    return numbers


def _cell(*counts: int) -> BeforeValidator:
    def cell(value: Any) -> tuple[int, ...]:
        found = tuple(integer(each) for each in sequence(value))
        if len(found) not in counts or min(found) < 0:
            raise ValueError(f"must be a list of {' or '.join(map(str, counts))} whole numbers, 0 or more")
        return found

    return BeforeValidator(cell)


Matrix = Annotated[tuple[float, ...], Field(min_length=16, max_length=16), BeforeValidator(_rigid)]
RobotNumber = Annotated[int, Field(ge=0, le=1000), BeforeValidator(integer)]
Configuration = Annotated[tuple[Number, ...], Field(min_length=1, max_length=MOST_JOINTS), BeforeValidator(sequence)]


class VoxelRequest(Document):
    """The exact values of a voxel, and where samples are kept its best configuration."""

    ask: Literal["voxel"] = "voxel"
    """voxel."""
    volume: Name
    """Name of the volume in the view; "live_0" is what the last ``volume`` of robot 0 gave."""
    cell: Annotated[tuple[int, int, int], _cell(3)]
    """Voxel (i, j, k), counted from the volume's first one."""
    voxel_size_m: VoxelSize | None = None
    """Edge of the voxels that are counted, a multiple of the file's where larger ones are shown [m]; null: that."""


class _OfRobot(Document):
    """A robot of the view, as it stands there or as it has been changed since."""

    robot: RobotNumber = 0
    """Its number in the view."""
    limits: dict[Name, Range] = Field(default={})
    """Limits of joints, by name, [lower, upper], in place of its own [rad or m]."""
    tool: Matrix | None = None
    """Tool point in the tip frame, a (4, 4) matrix row by row [m]; null: its own."""
    placement: Matrix | None = None
    """Base frame in the world, a (4, 4) matrix row by row [m]; null: its own."""


class IndicesRequest(_OfRobot):
    """All local indices of a robot at a configuration."""

    ask: Literal["indices_at"] = "indices_at"
    """indices_at."""
    q: Configuration
    """Joint values [rad or m]."""


class _Pose(_OfRobot):
    position_m: Vector
    """Position of the tip in the world [m]."""
    quat_wxyz: Quaternion
    """Its orientation; any length but zero."""


class InverseRequest(_Pose):
    """Whether a pose is reached, and in which configuration."""

    ask: Literal["inverse"] = "inverse"
    """inverse."""
    near: Configuration
    """Joint values of which the nearest configuration is wanted [rad or m]."""


class PosturesRequest(_Pose):
    """All configurations of a pose."""

    ask: Literal["postures"] = "postures"
    """postures."""


class PlacementRequest(Document):
    """Where a robot's base stands for a cell of a map of placements."""

    ask: Literal["placement"] = "placement"
    """placement."""
    map: Name
    """Name of the map in the view: that of its table."""
    cell: Annotated[tuple[int, ...], Field(min_length=1, max_length=2), _cell(1, 2)]
    """Cell (i, j) along the map's axes."""


class VolumeRequest(_OfRobot):
    """The volume of a robot whose limits, tool or placement have been changed."""

    ask: Literal["volume"] = "volume"
    """volume."""
    index: Name
    """The local index."""
    statistic: Literal["count", "maximum", "mean", "minimum"] = "maximum"
    """What is shown of it per voxel."""
    samples: Count = 1 << 20
    """Sobol samples."""
    voxel_size_m: VoxelSize | None = None
    """Edge of a voxel [m]; null: that of a job which does not say."""


Request = VoxelRequest | IndicesRequest | InverseRequest | PosturesRequest | PlacementRequest | VolumeRequest
REQUESTS: dict[str, type[Request]] = {kind.model_fields["ask"].default: kind for kind in get_args(Request)}


def read_request(request: Any) -> Request:
    """The request of a dict; raises DocumentError naming every field that is wrong."""
    if not isinstance(request, Mapping):
        raise DocumentError([("request", f"must be an object, not {type(request).__name__}")])
    check_depth(request)
    ask = request.get("ask")
    if not isinstance(ask, str) or ask not in REQUESTS:
        raise DocumentError([("ask", f"must be one of {quoted(REQUESTS)}, not {ask!r}")])
    return REQUESTS[ask](**{str(name): value for name, value in request.items()})
