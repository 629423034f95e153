"""The choices of a job document: task rows, indices, statistics, penalisation, surfaces, device."""

import re
from collections.abc import Iterator, Mapping
from numbers import Integral
from os import PathLike, fspath
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, StrictBool, WithJsonSchema

from wsrender.documents.array_files import ArrayFile
from wsrender.documents.document import Document
from wsrender.documents.quantities import (
    Name,
    Number,
    PositiveNumber,
    distinct,
    integer,
    listed_rows,
    number_rows,
    quoted,
    real,
    sequence,
    share,
)

TASK_ROWS = ("x", "y", "z", "rx", "ry", "rz")
NAMED_TASKS = {"linear": TASK_ROWS[:3], "angular": TASK_ROWS[3:], "full": TASK_ROWS}
INDEX_GROUPS = ("kinematic", "dynamic", "all")
STATISTICS = ("count", "maximum", "mean", "minimum")
MAP_COLUMNS = ("configuration", "orientation")
DEFAULT_PENALTY = 10.0  # K of [WSR] eq. 3 when the penalisation is on
SMALLEST_PENALTY, LARGEST_PENALTY = 1e-3, 1e6  # beyond them float32 cannot tell the penalisation from a constant
_DEVICE = re.compile(r"auto|cpu|cuda(:\d{1,3})?")
_ALLOWED = (
    'must be a list of "marching_cubes", "convex_hull", {"alpha_shape": radius in metres} and '
    '{"iso_surface": index, "fraction": of its maximum}'
)


def _task(value: Any) -> str | tuple[str, ...]:
    if isinstance(value, str) and value in NAMED_TASKS:
        return value
    if isinstance(value, str) or value is None or any(row not in TASK_ROWS for row in sequence(value)):
        raise ValueError(f"must be {quoted(NAMED_TASKS)} or a list of rows from {' '.join(TASK_ROWS)}")
    rows = _ordered(value, TASK_ROWS)
    return next((name for name, named in NAMED_TASKS.items() if rows == named), rows)


def _indices(value: Any) -> str | tuple[str, ...]:
    if isinstance(value, str) and value in INDEX_GROUPS:
        return value
    names = (value,) if isinstance(value, str) else () if value is None else distinct(sequence(value))
    if not names or not all(isinstance(name, str) and name for name in names):
        raise ValueError(f"must be {quoted(INDEX_GROUPS)}, the name of an index, or a list of such names")
    return names


def _indices_or_none(value: Any) -> str | tuple[str, ...]:
    return () if isinstance(value, list | tuple) and not value else _indices(value)


def _option_value(value: Any) -> bool | int | float | tuple[float, ...]:
    if isinstance(value, bool):
        return value
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return tuple(real(item) for item in value)
    try:
        return integer(value) if isinstance(value, Integral) else real(value)
    except ValueError:
        raise ValueError("must be a number, true, false or a list of numbers") from None


def _options(value: Any) -> dict[str, Any]:
    if not isinstance(value, Mapping):
        raise ValueError("must be an object")
    return dict(value)


def _statistics(value: Any) -> tuple[str, ...]:
    asked = sequence(value)
    return _ordered(asked if "count" in asked else ["count", *asked], STATISTICS)


def _statistics_or_none(value: Any) -> tuple[str, ...] | None:
    return None if value is None else _statistics(value)


def _columns(value: Any) -> tuple[str, ...]:
    columns = sequence(value)
    return _ordered(columns, MAP_COLUMNS) if columns else ()


def _penalty(value: Any) -> float | None:
    if value is True:
        return DEFAULT_PENALTY
    if value is None or value is False:
        return None
    number = real(value)
    if not SMALLEST_PENALTY <= number <= LARGEST_PENALTY:
        raise ValueError("must be 0.001 … 1e6 (the K of the penalisation), true (10) or null (off)")
    return number


def _device(value: Any) -> str:
    if not isinstance(value, str) or not _DEVICE.fullmatch(value):
        raise ValueError('must be "auto", "cpu", "cuda" or "cuda:N"')
    return value


def _configurations(value: Any) -> tuple[tuple[float, ...], ...] | ArrayFile:
    if isinstance(value, str | PathLike):
        value = {"path": fspath(value)}
    if isinstance(value, Mapping | ArrayFile):
        return ArrayFile.model_validate(value)
    rows = number_rows(listed_rows(value))
    if not rows:
        raise ValueError("must have at least 1 items")
    if len(lengths := set(map(len, rows))) > 1 or 0 in lengths:
        raise ValueError("must hold rows of one length, one joint value per joint")
    return rows


def _ordered(value: Any, allowed: tuple[str, ...]) -> tuple[str, ...]:
    """The distinct items of a list in the order of ``allowed``, so that equal jobs have equal documents."""
    items = distinct(sequence(value))
    unknown = [item for item in items if item not in allowed]
    if unknown:
        raise ValueError(f"must be a list of items from {' '.join(allowed)}")
    return tuple(name for name in allowed if name in items)


Task = Annotated[
    Literal["linear", "angular", "full"] | tuple[Literal["x", "y", "z", "rx", "ry", "rz"], ...], BeforeValidator(_task)
]
_Asked = Literal["kinematic", "dynamic", "all"] | tuple[Name, ...] | Name  # of a single name a list is made
Indices = Annotated[_Asked, BeforeValidator(_indices)]
IndicesOrNone = Annotated[_Asked, BeforeValidator(_indices_or_none)]
_OptionValue = Annotated[bool | int | float | tuple[Number, ...], BeforeValidator(_option_value)]
IndexOptions = Annotated[
    dict[Name, Annotated[dict[Name, _OptionValue], BeforeValidator(_options)]], BeforeValidator(_options)
]
Penalty = Annotated[
    float | None,
    BeforeValidator(_penalty),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "number", "minimum": SMALLEST_PENALTY, "maximum": LARGEST_PENALTY},
                {"type": "boolean"},
                {"type": "null"},
            ]
        }
    ),
]
StatisticsOrNone = Annotated[
    tuple[Literal["count", "maximum", "mean", "minimum"], ...] | None, BeforeValidator(_statistics_or_none)
]
MapColumns = Annotated[tuple[Literal["configuration", "orientation"], ...], BeforeValidator(_columns)]
Precision = Literal["float32", "float64"]
Device = Annotated[str, BeforeValidator(_device), Field(json_schema_extra={"pattern": f"^({_DEVICE.pattern})$"})]
_ROW = Annotated[tuple[float, ...], Field(min_length=1)]
_ROWS = Annotated[tuple[_ROW, ...], Field(min_length=1)]
Configurations = Annotated[
    _ROWS | ArrayFile,
    Field(union_mode="left_to_right"),
    BeforeValidator(_configurations, json_schema_input_type=_ROWS | _ROW | ArrayFile),
]
"""Rows of joint values, a single one as it is, or a file of them."""


class IndexChoices(Document):
    """Which local indices are evaluated, and how."""

    indices: Indices = "kinematic"
    """Local indices: "kinematic", "dynamic", "all", the name of an index, or a list of names."""
    index_options: IndexOptions = Field(default={})
    """Options of the indices that have any: {index: {option: value}}."""
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
    precision: Precision = "float32"
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


class AlphaShapeSurface(Document):
    """Boundary of the Delaunay tetrahedra of the sampled positions whose circumspheres are small enough."""

    alpha_shape: PositiveNumber
    """Largest radius of the circumspheres, α [m]."""


class IsoSurface(Document):
    """Surface of the voxels in which an index comes close to its maximum."""

    iso_surface: Name
    """The index; its largest value per voxel counts (its mean where the volume holds no maximum)."""
    fraction: Annotated[float, Field(gt=0, le=1), BeforeValidator(share)] = 0.9
    """Threshold μ, a fraction of the largest value of all voxels."""


Surface = Literal["marching_cubes", "convex_hull"] | AlphaShapeSurface | IsoSurface
_NAMED = ("marching_cubes", "convex_hull")
_KINDS = {"alpha_shape": AlphaShapeSurface, "iso_surface": IsoSurface}


def _surface(value: Any) -> Any:
    if isinstance(value, Document) or value in _NAMED:
        return value
    kinds = [kind for key, kind in _KINDS.items() if isinstance(value, Mapping) and key in value]
    if len(kinds) != 1:
        raise ValueError(_ALLOWED)
    return kinds[0].model_validate(value)


def _surfaces(value: Any) -> tuple[Any, ...]:
    surfaces = tuple(_surface(item) for item in sequence(value))
    if any(surface in surfaces[:k] for k, surface in enumerate(surfaces)):
        raise ValueError("must not ask for a surface twice")
    return surfaces


Surfaces = Annotated[tuple[Surface, ...], BeforeValidator(_surfaces)]
