"""The job of a planar five-bar."""

import math
from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field

from wsrender.documents.format import JobDocument, example
from wsrender.documents.mechanism import LEAST_RANGE, WORKING_MODES
from wsrender.documents.point_sets import PairsOrFile
from wsrender.documents.quantities import PositiveNumber, VoxelSize, distinct, integer, quoted, real, sequence

MOST_CELLS = 1_000_000  # of one working mode's map
MOST_ROWS = 10_000  # of points and joint angles
# Of lengths: squares of their sums and differences keep some digits.
SHORTEST_M, LARGEST_M, LARGEST_RATIO = 1e-6, 1e6, 1e4
_ONE_TURN = 2 * math.pi * (1 + 1e-12)


def _pair(value: Any) -> tuple[float, ...]:
    numbers = tuple(real(number) for number in sequence(value)) if hasattr(value, "__len__") else (real(value),) * 2
    if len(numbers) != 2 or not min(numbers) > 0:
        raise ValueError("must be a number above 0, or a list of two: left and right")
    return numbers


def _limits(value: Any) -> tuple[Any, ...]:
    if value is None:
        return (None, None)
    legs = sequence(value)
    if len(legs) != 2:
        raise ValueError("must be a list of two: [low, high] or null for left and right")
    return tuple(None if leg is None else _interval(leg) for leg in legs)


def _interval(value: Any) -> tuple[float, float]:
    numbers = [real(number) for number in sequence(value)]
    if (
        len(numbers) != 2
        or not LEAST_RANGE * (1 - 1e-9) <= numbers[1] - numbers[0] <= _ONE_TURN
        or max(map(abs, numbers)) > 1000
    ):
        raise ValueError("must be [low, high] for each leg, high 0.001 rad to a turn above low, within ±1000 rad")
    return numbers[0], numbers[1]


def _modes(value: Any) -> tuple[str, ...]:
    asked = distinct(sequence(value))
    if any(mode not in WORKING_MODES for mode in asked):
        raise ValueError(f"must be a list of items from {quoted(WORKING_MODES)}")
    return tuple(mode for mode in WORKING_MODES if mode in asked)


def _levels(value: Any) -> tuple[float, ...]:
    levels = tuple(sorted(real(level) for level in sequence(value)))
    if len(levels) > 50 or len(set(levels)) < len(levels) or any(level <= 1 for level in levels):
        raise ValueError("must be a list of at most 50 different numbers above 1")
    return levels


Pair = Annotated[
    tuple[float, float],
    BeforeValidator(_pair, json_schema_input_type=tuple[PositiveNumber, PositiveNumber] | PositiveNumber),
]
_Interval = tuple[float, float] | None


class FiveBarJob(JobDocument):
    """Workspace, conditioning, singularities and aspects of a planar five-bar with two actuated base joints."""

    model_config = example(
        analysis="five_bar",
        base_m=1.0,
        proximal_m=1.0,
        distal_m=0.8,
        voxel_size_m=0.1,
        points_m=[[0.5, 0.9]],
    )

    constraints_elsewhere: ClassVar[str] = (
        'its boundaries are those of joint limits alone; "parallel_workspace" takes "bodies" of two RUS legs whose '
        "links meet in platform_m = [0, 0, 0], in a region of one layer of voxels"
    )

    analysis: Literal["five_bar"] = "five_bar"
    """Name of the analysis."""
    base_m: PositiveNumber
    """L0: distance of the base joints A = (0, 0) and B = (L0, 0) [m]."""
    proximal_m: Pair
    """L1: lengths of the links A C and B D [m]; one number stands for both."""
    distal_m: Pair
    """L2: lengths of the links C P and D P [m]; one number stands for both."""
    limits_rad: Annotated[
        tuple[_Interval, _Interval],
        BeforeValidator(_limits, json_schema_input_type=tuple[_Interval, _Interval] | None),
    ] = (None, None)
    """Limits [low, high] of θ1 and θ2 [rad]; null: the joint turns freely."""
    working_modes: Annotated[tuple[Literal["++", "+-", "-+", "--"], ...], BeforeValidator(_modes)] = WORKING_MODES
    """Signs of sin(θ3 − θ1) and sin(θ4 − θ2)."""
    voxel_size_m: VoxelSize | None = None
    """Edge of the cells of the Cartesian maps [m]; null: a 250th of the workspace's box."""
    joint_steps: Annotated[int, Field(ge=8, le=1000), BeforeValidator(integer)] = 180
    """Cells of the joint-space maps in a turn of an actuated joint."""
    levels: Annotated[tuple[float, ...], BeforeValidator(_levels)] = (1.25, 1.5, 2.0, 3.0, 5.0, 10.0)
    """Condition numbers whose iso-curves are traced."""
    points_m: PairsOrFile = ()
    """Points [x, y] whose postures in every working mode are given, with their indices, at most 10,000 [m]; or a file
    of them, {"path": "points.csv"}."""
    joint_angles_rad: PairsOrFile = ()
    """Pairs [θ1, θ2] whose postures in both assembly modes are given, with their indices, at most 10,000 [rad]; or a
    file of them."""

    def arms(self) -> dict[tuple[str | int, ...], Any]:
        """No robots: the mechanism is in the job."""
        return {}

    def sweeps(self) -> list[Any]:
        """No joint space is sampled."""
        return []

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        for field in ("points_m", "joint_angles_rad"):
            if isinstance(rows := getattr(self, field), tuple) and len(rows) > MOST_ROWS:
                yield field, f"must be a list of at most {MOST_ROWS} pairs of numbers, not of {len(rows)}"
        lengths = {"base_m": (self.base_m,), "proximal_m": self.proximal_m, "distal_m": self.distal_m}
        longest = max(length for pair in lengths.values() for length in pair)
        for name, pair in lengths.items():
            if min(pair) < max(SHORTEST_M, longest / LARGEST_RATIO) or longest > LARGEST_M:
                yield name, f"must lie within {SHORTEST_M:g} … {LARGEST_M:g} m, and within 1/10000 of the longest link"
        reach = 2 * (max(self.proximal_m) + max(self.distal_m))
        if self.voxel_size_m is not None and (reach / self.voxel_size_m) ** 2 > MOST_CELLS:
            smallest = reach / math.sqrt(MOST_CELLS)
            yield (
                "voxel_size_m",
                f"must be at least {smallest:.3g} for links of these lengths, not {self.voxel_size_m:g}",
            )
