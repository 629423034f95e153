"""How the joint space is sampled ([WSR] II.B); a sample is a pure function of its index."""

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal, get_args

from pydantic import BeforeValidator, Discriminator, Field

from wsrender.documents.document import Document
from wsrender.documents.problems import tagged
from wsrender.documents.quantities import LARGEST_COUNT, Count, Name, Number, PositiveNumber, Seed, integer, sequence
from wsrender.keywords import keywords


def _per_joint(value: Any) -> int | tuple[int, ...]:
    if isinstance(value, str | Mapping) or value is None:
        raise ValueError("must be a whole number of samples, or a list with one per joint")
    counts = sequence(value) if hasattr(value, "__len__") else [value]
    if not counts:
        raise ValueError("must not be an empty list")
    counts = tuple(integer(count) for count in counts)
    if not 1 <= min(counts) <= max(counts) <= LARGEST_COUNT:
        raise ValueError(f"must lie between 1 and {LARGEST_COUNT}")
    return counts if hasattr(value, "__len__") else counts[0]


PerJoint = Annotated[Count | Annotated[tuple[Count, ...], Field(min_length=1)], BeforeValidator(_per_joint)]


class _Sampling(Document):
    locked: dict[Name, Number] = Field(default={})
    """Joints held at a value, by name [rad or m]; the others are sampled."""


class Grid(_Sampling):
    """Equal intervals, both limits included, over every joint that is not locked."""

    method: Literal["grid"] = "grid"
    """Name of the sampling method."""
    per_joint: PerJoint = 15
    """Samples per joint: one number for all, or a list from base to tip with one per joint, or one per
    joint that is not locked."""

    @keywords
    def __init__(
        self,
        per_joint: int | Sequence[int] = 15,
        *,
        locked: Mapping[str, float] | None = None,
        method: Literal["grid"] = "grid",
    ):
        Document.__init__(self, method=method, per_joint=per_joint, locked={} if locked is None else locked)

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]


class _Counted(_Sampling):
    # Subclasses name the constructor again: type checkers would give them one of keywords only.
    count: Count
    """Number of samples."""
    seed: Seed = 0
    """Seed of the sequence, 0 … 2^63 - 1."""

    def __init__(self, count: int, seed: int = 0, *, locked: Mapping[str, float] | None = None, **method: str):
        Document.__init__(self, count=count, seed=seed, locked={} if locked is None else locked, **method)

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]


class Random(_Counted):
    """Independent uniform samples of the joint space (Monte Carlo).

    A coordinate takes one of 2^42 values between its limits, with the precision float32 one of 2^21.
    """

    method: Literal["random"] = "random"
    """Name of the sampling method."""

    __init__ = _Counted.__init__


class Sobol(_Counted):
    """Scrambled Sobol sequence: low discrepancy, any number of samples."""

    method: Literal["sobol"] = "sobol"
    """Name of the sampling method."""

    __init__ = _Counted.__init__


class BoundaryBiased(_Counted):
    """More samples near the joint limits (beta-distributed), for outlining a workspace."""

    method: Literal["boundary"] = "boundary"
    """Name of the sampling method."""

    __init__ = _Counted.__init__


DEFAULT_COUNT = 2**24
"""Sobol samples of a workspace by default: half a second to a second on two cores, and voxels of a seventieth of it."""
SEVERAL_COUNT = 2**20
"""Of each of several robots, and where a row is kept for every sample."""
PYTHON_COUNT = 2**16
"""Of a robot that is defined by a Python class."""


class Converge(_Sampling):
    """Grids of growing size until a global index settles ([WSR] Algorithm 1)."""

    method: Literal["converge"] = "converge"
    """Name of the sampling method."""
    index: Name = "manipulability"
    """The local index whose global value must settle."""
    tolerance: PositiveNumber = 1e-4
    """Largest change of the global value between two grids that counts as settled [1]."""
    max_samples: Count = 1_000_000_000
    """A grid of more samples than this is not started; the result then says "not converged"."""
    start: Count = 15
    """Samples per joint of the first grid."""
    step: Count = 5
    """Samples per joint added from one grid to the next."""
    by: Literal["joint_mean", "workspace_mean"] = "joint_mean"
    """The global value: mean over samples, or mean over occupied voxels at one fixed voxel size."""

    @keywords
    def __init__(
        self,
        index: str = "manipulability",
        tolerance: float = 1e-4,
        max_samples: int = 1_000_000_000,
        *,
        start: int = 15,
        step: int = 5,
        by: Literal["joint_mean", "workspace_mean"] = "joint_mean",
        locked: Mapping[str, float] | None = None,
        method: Literal["converge"] = "converge",
    ):
        Document.__init__(
            self,
            method=method,
            index=index,
            tolerance=tolerance,
            max_samples=max_samples,
            start=start,
            step=step,
            by=by,
            locked={} if locked is None else locked,
        )

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]


def _no_number(value: Any) -> Any:
    if isinstance(value, int) and not isinstance(value, bool):
        raise ValueError(
            'must be an object, such as {"method": "sobol", "count": 1000000}, in Python ws.Sobol(1000000)'
        )
    return value


_AnySampling = Grid | Random | Sobol | BoundaryBiased | Converge
METHODS: tuple[str, ...] = tuple(model.model_fields["method"].default for model in get_args(_AnySampling))

Sampling = Annotated[
    _AnySampling, Discriminator("method"), BeforeValidator(tagged("method", METHODS)), BeforeValidator(_no_number)
]
