"""Sampling plans: the numbers that make a sample a pure function of its 64-bit index ([WSR] II.B).

The kernels evaluate the plan; it knows the chain's limits and the sampling of a job document, and no device.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeVar

import numpy as np

from wsrender.content import Content
from wsrender.documents.quantities import argument, real
from wsrender.documents.sampling import BoundaryBiased, Converge, Grid, Random, Sobol
from wsrender.errors import InputError, ResourceError
from wsrender.robots.joint_space import JointSpace
from wsrender.robots.plausibility import need_ranges

Joints = TypeVar("Joints", bound=JointSpace)

SOBOL_BITS = 52
LARGEST_LEVELS = 2**31 - 256  # the kernel adds the place within a block of 256 in 32-bit integers

# Primitive polynomials (degree, coefficients) and initial direction numbers of dimensions 2 to 16:
# S. Joe, F. Y. Kuo, *Constructing Sobol sequences with better two-dimensional projections*, 2008, new-joe-kuo-6.
_JOE_KUO = (
    (1, 0, (1,)),
    (2, 1, (1, 3)),
    (3, 1, (1, 3, 1)),
    (3, 2, (1, 1, 1)),
    (4, 1, (1, 1, 3, 3)),
    (4, 4, (1, 3, 5, 13)),
    (5, 2, (1, 1, 5, 5, 17)),
    (5, 4, (1, 1, 5, 5, 5)),
    (5, 7, (1, 1, 7, 11, 19)),
    (5, 11, (1, 1, 5, 1, 1)),
    (5, 13, (1, 1, 1, 3, 11)),
    (5, 14, (1, 3, 5, 5, 31)),
    (6, 1, (1, 3, 3, 9, 7, 49)),
    (6, 13, (1, 1, 1, 15, 21, 21)),
    (6, 16, (1, 3, 1, 13, 27, 49)),
)


@dataclass(frozen=True, eq=False)
class SamplingPlan(Content):
    """A sampling of n coordinates, resolved against a chain's limits.

    ``lower``, ``upper`` (n,) float64 [rad or m]: interval of each coordinate, of zero width where locked. ``levels``
    (n,) int64: grid levels. ``directions`` (n, 52) and ``shift`` (n,) uint64: scrambled Sobol numbers, the leading
    bit of the fraction being bit 63. ``given`` (count, n): the configurations themselves, method "given".
    """

    method: str
    count: int
    seed: int
    lower: np.ndarray
    upper: np.ndarray
    levels: np.ndarray
    directions: np.ndarray | None = None
    shift: np.ndarray | None = None
    given: np.ndarray | None = None

    @property
    def step(self) -> np.ndarray:
        """Interval between grid levels, else the width of the interval, (n,)."""
        width = self.upper - self.lower
        return width / np.maximum(self.levels - 1, 1) if self.method == "grid" else width

    def __str__(self) -> str:
        levels = self.levels.tolist()
        if self.method != "grid":
            return f"{self.method} {_short(self.count)}"
        return f"grid {levels[0]}^{len(levels)}" if len({*levels}) == 1 else f"grid {' × '.join(map(str, levels))}"


def _short(count: int) -> str:
    """A whole number, as 1e6 where that is shorter."""
    return min(str(count), np.format_float_scientific(count, trim="-", exp_digits=1).replace("e+", "e"), key=len)


def plan_sampling(chain: JointSpace, sampling, max_samples: int | None = None) -> SamplingPlan:
    """Resolve a sampling of the job document, or configurations (N, n) [rad or m] themselves, for a chain.

    Raises InputError for unknown or out-of-range locked joints and wrong numbers of levels, ResourceError where a
    plan has more than ``max_samples`` samples.
    """
    levels = np.ones(chain.n, np.int64)
    if isinstance(sampling, np.ndarray):
        return SamplingPlan("given", len(sampling), 0, chain.lower_limits, chain.upper_limits, levels, given=sampling)
    locked = _locked_values(chain, sampling.locked, "sampling.locked")
    lower = np.where(np.isnan(locked), chain.lower_limits, locked)
    upper = np.where(np.isnan(locked), chain.upper_limits, locked)
    free = np.isnan(locked)
    if isinstance(sampling, Grid):
        return _grid(chain, sampling, lower, upper, free, max_samples)
    if isinstance(sampling, Converge):
        raise TypeError("a converging sampling is a sequence of grids")
    count = sampling.count
    _check_count(count, max_samples, "count")
    if isinstance(sampling, Sobol):
        if count > 2**SOBOL_BITS:
            raise ResourceError("sampling.count", f"{count} samples; a Sobol sequence has at most 2^{SOBOL_BITS}")
        directions, shift = scrambled_sobol(free, sampling.seed)
        return SamplingPlan("sobol", count, sampling.seed, lower, upper, levels, directions, shift)
    method = {Random: "random", BoundaryBiased: "boundary"}[type(sampling)]
    return SamplingPlan(method, count, sampling.seed, lower, upper, levels)


def held_chain(chain: Joints, locked: Mapping[str, float]) -> Joints:
    """The chain with joints held, by name, at a value [rad or m].

    Raises InputError, naming ``locked``, for an unknown joint or a value beyond its limits; naming ``robot.limits`` for
    another joint without usable ones.
    """
    _locked_values(chain, locked, "locked")
    held = chain.held(locked)
    need_ranges(held, "robot.limits")
    return held


def _locked_values(chain: JointSpace, locked: Mapping[str, float], field: str) -> np.ndarray:
    """The value of each coordinate (n,) that is locked, NaN of the others; InputError names the ``field``."""
    values = np.full(chain.n, np.nan)
    if not isinstance(locked, Mapping):
        raise InputError(field, f"must be values by joint, not {locked!r}")
    for name, value in locked.items():
        if name not in chain.joint_names:
            raise InputError(f"{field}.{name}", f"unknown joint; allowed: {', '.join(chain.joint_names)}")
        i = chain.joint_names.index(name)
        low, high = chain.lower_limits[i], chain.upper_limits[i]
        # A value typed with few digits may lie just outside the limit it means.
        argument(f"{field}.{name}", real, value)
        if not chain.periodic[i] and not low - 1e-4 <= value <= high + 1e-4:
            raise InputError(f"{field}.{name}", f"{value} is outside the joint's limits [{low:.6g}, {high:.6g}]")
        values[i] = value
    return values


def _grid(chain: JointSpace, sampling: Grid, lower, upper, free, max_samples) -> SamplingPlan:
    per_joint = sampling.per_joint
    if isinstance(per_joint, int):
        levels = np.full(chain.n, per_joint, np.int64)
    elif len(per_joint) == chain.n:
        levels = np.array(per_joint, np.int64)
    elif len(per_joint) == free.sum():
        levels = np.ones(chain.n, np.int64)
        levels[free] = per_joint
    else:
        raise InputError(
            "sampling.per_joint",
            f"{len(per_joint)} numbers for {chain.n} joints, {free.sum()} of them not locked: "
            f"{', '.join(chain.joint_names)}",
        )
    levels = np.where(free, levels, 1)
    if levels.max(initial=1) > LARGEST_LEVELS:
        raise ResourceError("sampling.per_joint", f"{levels.max()} levels; at most {LARGEST_LEVELS} per joint")
    count = 1
    for level in levels:
        count *= int(level)
    _check_count(count, max_samples, "per_joint")
    # A periodic joint takes -pi + 2 pi k / levels, k = 1 … levels: no posture twice. One level of an interval is
    # its middle.
    first = np.where(chain.periodic, lower + (upper - lower) / levels, lower)
    single = free & (levels == 1) & ~chain.periodic
    middle = (lower + upper) / 2
    start = np.where(single, middle, np.where(free, first, lower))
    return SamplingPlan("grid", count, 0, start, np.where(single, middle, upper), levels)


def _check_count(count: int, max_samples: int | None, field: str) -> None:
    if max_samples is not None and count > max_samples:
        remedy = "use the sampling method sobol with fewer samples" if field == "per_joint" else "ask for fewer"
        raise ResourceError(
            f"sampling.{field}",
            f"{count:.4g} samples; at most max_samples = {max_samples:.4g}: {remedy}, or raise max_samples",
        )


def sobol_directions(dimensions: int) -> np.ndarray:
    """Direction numbers of the first dimensions, shape (dimensions, SOBOL_BITS) uint64, leading bit first."""
    numbers = np.zeros((dimensions, SOBOL_BITS), np.uint64)
    for d in range(dimensions):
        if d == 0:
            values = [1] * SOBOL_BITS
        else:
            degree, coefficients, initial = _JOE_KUO[d - 1]
            values = list(initial)
            for i in range(degree, SOBOL_BITS):
                value = values[i - degree] ^ (values[i - degree] << degree)
                for k in range(1, degree):
                    if coefficients >> (degree - 1 - k) & 1:
                        value ^= values[i - k] << k
                values.append(value)
        numbers[d] = [v << (63 - i) for i, v in enumerate(values)]
    return numbers


def scrambled_sobol(free: np.ndarray, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Direction numbers (n, 52) and digital shift (n,) of free coordinates; zeros for locked ones.

    Linear matrix scrambling and a digital shift (Matoušek, *On the L2-discrepancy for anchored boxes*, 1998). The last
    are kept: they take longer than a sweep of a few samples.
    """
    return _scrambled(tuple(free.tolist()), seed)


@lru_cache(maxsize=16)
def _scrambled(freedoms: tuple[bool, ...], seed: int) -> tuple[np.ndarray, np.ndarray]:
    free = np.array(freedoms, bool)
    n, dimensions = len(free), int(free.sum())
    # Raw output of a bit generator: NumPy keeps its stream stable for ever.
    bits = np.random.Philox(key=seed)
    directions, shift = np.zeros((n, SOBOL_BITS), np.uint64), np.zeros(n, np.uint64)
    scrambled = np.zeros((dimensions, SOBOL_BITS), np.uint64)
    for d, plain in enumerate(sobol_directions(dimensions)):
        rows = bits.random_raw(64)
        for i in range(64):
            # Row i of a lower triangular matrix with unit diagonal gives bit 63 - i of the scrambled number.
            place = np.uint64(63 - i)
            above = np.uint64((2**64 - 1) << (64 - i) & (2**64 - 1))
            row = (np.uint64(rows[i]) & above) | (np.uint64(1) << place)
            parity = np.bitwise_count(plain & row).astype(np.uint64) & np.uint64(1)
            scrambled[d] |= parity << place
    directions[free] = scrambled
    shift[free] = bits.random_raw(dimensions)
    directions.flags.writeable = shift.flags.writeable = False
    return directions, shift


def subsample(count: int, size: int) -> np.ndarray:
    """Sorted sample indices for pictures, at most ``size``: all, or pseudo-random ones (the same for equal counts)."""
    if count <= size:
        return np.arange(count, dtype=np.int64)
    generator = np.random.Philox(key=0)
    return np.unique((generator.random_raw(size) % np.uint64(count)).astype(np.int64))
