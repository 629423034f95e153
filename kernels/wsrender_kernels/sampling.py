"""Configurations as pure functions of a 64-bit sample index.

Samples come in blocks of LANES consecutive indices that start at a multiple of LANES, or on a grid also where a leading
coordinate changes. ``prepare(space, first)`` does what depends on the block alone, ``draw(space, block, first, lane)``
gives sample ``first + lane``: so the lane loop keeps only SIMD work.
"""

import math
from types import SimpleNamespace

import numpy as np
import warp as wp

from wsrender_kernels.elementary import elementary
from wsrender_kernels.factories import factory

LANES = 256
METHODS = ("grid", "random", "sobol", "boundary", "given")
SOBOL_BITS = 52

# Philox-4x32 with 7 rounds (Salmon, Moraes, Dror, Shaw, *Parallel random numbers: as easy as 1, 2, 3*, 2011, table 2).
_ROUNDS = 7
_MULTIPLIERS = (0xD2511F53, 0xCD9E8D57)
_KEY_STEPS = (0x9E3779B9, 0xBB67AE85)


@factory
def sample_space(real, n: int):
    """Struct with the numbers of a sampling, n = joints: each method fills what it needs."""
    vec_n, int_n = wp.types.vector(n, real), wp.types.vector(n, wp.int32)

    @wp.struct
    class SampleSpace:
        lower: vec_n
        upper: vec_n
        step: vec_n  # grid: interval between levels; else: upper - lower
        levels: int_n  # grid
        run: wp.int64  # grid with shared coordinates: samples in a row that have them in common
        key_0: wp.uint32  # random, boundary: the seed
        key_1: wp.uint32
        sobol_high: wp.array(dtype=wp.uint32)  # (n * SOBOL_BITS + n,) direction numbers, then the shift
        sobol_low: wp.array(dtype=wp.uint32)
        lane_high: wp.array(dtype=wp.uint32)  # (n * LANES,) contribution of the lowest bits of the index
        lane_low: wp.array(dtype=wp.uint32)
        given: wp.array(dtype=real)  # (n * given_stride,) configurations, one coordinate after the other
        given_first: wp.int64  # sample index of the first given configuration
        given_stride: wp.int64  # samples per coordinate

    return SampleSpace


_PHILOX = f"""
#if defined(__CUDA_ARCH__)
    typedef wp::uint32 word;
#else
    typedef wp::uint64 word;  // upper halves hold anything: wide products on the CPU then need no rearranging
#endif
    word x0 = c0, x1 = c1, x2 = c2, x3 = c3, key_0 = k0, key_1 = k1;
    #pragma unroll
    for (int round = 0; round < {_ROUNDS}; ++round) {{
        wp::uint64 a = wp::uint64(wp::uint32(x0)) * {_MULTIPLIERS[0]}u;
        wp::uint64 b = wp::uint64(wp::uint32(x2)) * {_MULTIPLIERS[1]}u;
        x0 = word(b >> 32) ^ x1 ^ key_0;
        x1 = word(b);
        x2 = word(a >> 32) ^ x3 ^ key_1;
        x3 = word(a);
        key_0 += {_KEY_STEPS[0]}u;
        key_1 += {_KEY_STEPS[1]}u;
    }}
    return wp::vec_t<4, wp::uint32>(wp::uint32(x0), wp::uint32(x1), wp::uint32(x2), wp::uint32(x3));
"""
_words = wp.types.vector(4, wp.uint32)


@wp.func_native(_PHILOX)
def random_words(c0: wp.uint32, c1: wp.uint32, c2: wp.uint32, c3: wp.uint32, k0: wp.uint32, k1: wp.uint32) -> _words:
    """Four random words of a counter and a key. In C, for the word of the registers differs."""


@factory
def whole_number(real):
    """Device function 32 bits -> their number, through signed integers, whose conversion is one vector instruction."""
    SIGN, HALF_RANGE = wp.uint32(0x80000000), real(2147483648.0)

    @wp.func
    def number(word: wp.uint32):
        return real(wp.int32(word ^ SIGN)) + HALF_RANGE

    return number


@factory
def uniform(real):
    """Device function (high, low 32 bits) -> [0, 1) in units of `unit_of`: the leading 24 or 53 bits."""
    u32 = wp.uint32
    EIGHT = u32(8)
    HIGH_32, LOW_21, ELEVEN = real(2.0**-32), real(2.0**-53), u32(11)
    number = whole_number(real)

    @wp.func
    def uniform32(high: u32, low: u32):
        return real(wp.int32(high >> EIGHT))

    @wp.func
    def uniform64(high: u32, low: u32):
        return number(high) * HIGH_32 + real(wp.int32(low >> ELEVEN)) * LOW_21

    return uniform32 if real is wp.float32 else uniform64


def unit_of(real):
    """What `uniform` counts in: a power of two, so that it may be multiplied with the interval beforehand."""
    return real(2.0**-24 if real is wp.float32 else 1.0)


@factory
def sampling(real, n: int, method: str, shared: int = 0) -> SimpleNamespace:
    """Device functions ``prepare(space, first) -> block`` and ``draw(space, block, first, lane) -> q (n,)``.

    ``shared``: leading coordinates of a grid that have the same values in all of a block, as `blocks` makes them: the
    compiler then takes what depends on them alone out of the lane loop.
    """
    if method == "grid":
        prepare, draw = _grid(real, n, shared)
    else:
        prepare, draw = {"random": _random, "boundary": _boundary, "sobol": _sobol, "given": _given}[method](real, n)
    return SimpleNamespace(prepare=prepare, draw=draw)


@factory
def blocks(real, n: int, shared: int):
    """Device function ``(space, first, count, task) -> first sample of the task's block, number of samples``.

    Blocks of LANES samples; with shared coordinates they also end where one of those changes.
    """
    Space = sample_space(real, n)
    SIZE = wp.int64(LANES)

    @wp.func
    def plain(space: Space, first: wp.int64, count: wp.int64, task: wp.int32):
        start = first + wp.int64(task) * SIZE
        return start, wp.int32(wp.min(SIZE, first + count - start))

    @wp.func
    def within_runs(space: Space, first: wp.int64, count: wp.int64, task: wp.int32):
        into_run = first % space.run
        per_run = (space.run + SIZE - wp.int64(1)) / SIZE
        number = into_run / SIZE + wp.int64(task)
        run = first - into_run + number / per_run * space.run
        start = run + number % per_run * SIZE
        end = wp.min(wp.min(start + SIZE, run + space.run), first + count)
        start = wp.max(start, first)
        return start, wp.int32(end - start)

    return within_runs if shared else plain


def _grid(real, n: int, shared: int):
    """Mixed-radix digits of the index, the last joint fastest; both limits included."""
    Space = sample_space(real, n)
    vec_n = wp.types.vector(n, real)
    int_n = wp.types.vector(n, wp.int32)
    f32 = wp.float32
    ONE = wp.float32(1.0)
    at_level = grid_level(real)
    SHARED, OWN = shared, n - shared

    @wp.func
    def prepare(space: Space, first: wp.int64):
        d = int_n()
        rest = first
        for back in range(n):
            i = n - 1 - back
            levels = wp.int64(space.levels[i])
            d[i] = wp.int32(rest % levels)
            rest = rest / levels
        return d

    @wp.func
    def draw(space: Space, block: int_n, first: wp.int64, lane: wp.int32):
        carry = lane
        q = vec_n()
        for i in range(SHARED):
            q[i] = at_level(space.lower[i], space.upper[i], space.step[i], block[i], space.levels[i])
        for back in range(OWN):
            i = n - 1 - back
            levels = space.levels[i]
            value = block[i] + carry
            # Integer division does not vectorise: estimate the quotient, then mend it by at most one.
            carry = wp.int32(wp.floor(f32(value) * (ONE / f32(levels))))
            value = value - carry * levels
            low = value < 0
            carry = wp.where(low, carry - 1, carry)
            value = wp.where(low, value + levels, value)
            high = value >= levels
            carry = wp.where(high, carry + 1, carry)
            value = wp.where(high, value - levels, value)
            q[i] = at_level(space.lower[i], space.upper[i], space.step[i], value, levels)
        return q

    return prepare, draw


@factory
def grid_level(real):
    """Device function (lower, upper, step, level, levels) -> value of a coordinate; both limits are met exactly."""

    @wp.func
    def at_level(lower: real, upper: real, step: real, level: wp.int32, levels: wp.int32):
        return wp.where(level == levels - 1, upper, lower + real(level) * step)

    return at_level


@factory
def base_levels(real):
    """Struct with the levels of a first joint that the sampling itself leaves at one value."""

    @wp.struct
    class BaseLevels:
        lower: real
        upper: real
        step: real
        levels: wp.int32

    return BaseLevels


def _stateless(Space):
    @wp.func
    def prepare(space: Space, first: wp.int64):
        return wp.int32(0)

    return prepare


def _uniforms(real, n: int):
    """Device function giving n independent uniforms of a sample, and what they count in: see `unit_of`.

    The four words of a counter are 21 bits of each of six coordinates: all that float32 takes. float64 takes as many
    more from a second counter, 42 in all.
    """
    Space = sample_space(real, n)
    vec_n = wp.types.vector(n, real)
    u32 = wp.uint32
    SIXES = (n + 5) // 6
    bits_type = wp.types.vector(6 * SIXES, wp.int32)
    LEADING, FOLLOWING = u32(0), u32(1)
    MASK, WORD = wp.int64(0xFFFFFFFF), wp.int64(32)
    TEN, ELEVEN, TEN_BITS, ELEVEN_BITS = u32(10), u32(11), u32(0x3FF), u32(0x7FF)
    UNIT_21, UNIT_42 = real(2.0**-21), real(2.0**-42)

    @wp.func
    def bits(space: Space, first: wp.int64, lane: wp.int32, part: u32):
        out = bits_type()
        for g in range(SIXES):
            w = random_words(u32(first & MASK) + u32(lane), u32(first >> WORD), u32(g), part, space.key_0, space.key_1)
            for k in range(4):
                out[6 * g + k] = wp.int32(w[k] >> ELEVEN)
            out[6 * g + 4] = wp.int32((w[0] & ELEVEN_BITS) << TEN | (w[1] & TEN_BITS))
            out[6 * g + 5] = wp.int32((w[2] & ELEVEN_BITS) << TEN | (w[3] & TEN_BITS))
        return out

    @wp.func
    def uniforms32(space: Space, first: wp.int64, lane: wp.int32):
        leading = bits(space, first, lane, LEADING)
        u = vec_n()
        for i in range(n):
            u[i] = real(leading[i])
        return u

    @wp.func
    def uniforms64(space: Space, first: wp.int64, lane: wp.int32):
        leading = bits(space, first, lane, LEADING)
        following = bits(space, first, lane, FOLLOWING)
        u = vec_n()
        for i in range(n):
            u[i] = real(leading[i]) * UNIT_21 + real(following[i]) * UNIT_42
        return u

    return (uniforms32, UNIT_21) if real is wp.float32 else (uniforms64, real(1.0))


def _random(real, n: int):
    Space = sample_space(real, n)
    uniforms, UNIT = _uniforms(real, n)

    @wp.func
    def draw(space: Space, block: wp.int32, first: wp.int64, lane: wp.int32):
        q = uniforms(space, first, lane)
        for i in range(n):
            q[i] = space.lower[i] + q[i] * (UNIT * space.step[i])
        return q

    return _stateless(Space), draw


def _boundary(real, n: int):
    """Beta(1/2, 1/2) between the limits, by its inverse distribution function (1 - cos(pi u)) / 2."""
    Space = sample_space(real, n)
    uniforms, unit = _uniforms(real, n)
    sincos = elementary(real).sincos
    PI, HALF, ONE = real(math.pi) * unit, real(0.5), real(1.0)

    @wp.func
    def draw(space: Space, block: wp.int32, first: wp.int64, lane: wp.int32):
        q = uniforms(space, first, lane)
        for i in range(n):
            _s, c = sincos(PI * q[i])
            q[i] = space.lower[i] + HALF * (ONE - c) * space.step[i]
        return q

    return _stateless(Space), draw


def _sobol(real, n: int):
    """Scrambled Sobol points in Gray-code order: the exclusive or of a direction number per bit of the index."""
    Space = sample_space(real, n)
    vec_n = wp.types.vector(n, real)
    words_type = wp.types.vector(2 * n, wp.uint32)
    unit, UNIT = uniform(real), unit_of(real)
    ONE, ZERO = wp.int64(1), wp.int64(0)
    BITS, SHIFT, BLOCK = SOBOL_BITS, n * SOBOL_BITS, LANES

    @wp.func
    def prepare(space: Space, first: wp.int64):
        x = words_type()
        for i in range(n):
            x[i] = space.sobol_high[SHIFT + i]
            x[n + i] = space.sobol_low[SHIFT + i]
        rest = first ^ (first >> ONE)
        bit = wp.int32(0)
        while rest > ZERO:
            if (rest & ONE) == ONE:
                for i in range(n):
                    x[i] = x[i] ^ space.sobol_high[i * BITS + bit]
                    x[n + i] = x[n + i] ^ space.sobol_low[i * BITS + bit]
            rest = rest >> ONE
            bit = bit + 1
        return x

    @wp.func
    def draw(space: Space, block: words_type, first: wp.int64, lane: wp.int32):
        q = vec_n()
        for i in range(n):
            high = block[i] ^ space.lane_high[i * BLOCK + lane]
            low = block[n + i] ^ space.lane_low[i * BLOCK + lane]
            q[i] = space.lower[i] + unit(high, low) * (UNIT * space.step[i])
        return q

    return prepare, draw


def _given(real, n: int):
    Space = sample_space(real, n)
    vec_n = wp.types.vector(n, real)

    @wp.func
    def draw(space: Space, block: wp.int32, first: wp.int64, lane: wp.int32):
        q = vec_n()
        for i in range(n):
            q[i] = space.given[wp.int64(i) * space.given_stride + (first - space.given_first) + wp.int64(lane)]
        return q

    return _stateless(Space), draw


def lane_table(directions: np.ndarray) -> np.ndarray:
    """Contribution of the index bits below LANES, shape (n, LANES), from direction numbers (n, SOBOL_BITS)."""
    lanes = np.arange(LANES, dtype=np.uint64)
    gray = lanes ^ (lanes >> np.uint64(1))
    table = np.zeros((len(directions), LANES), np.uint64)
    for bit in range(LANES.bit_length() - 1):
        table ^= np.where((gray >> np.uint64(bit)) & np.uint64(1), directions[:, bit : bit + 1], np.uint64(0))
    return table
