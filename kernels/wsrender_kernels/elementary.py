"""Elementary functions as polynomials.

A call into the C library in the lane loop keeps the CPU compiler from vectorising it, and CUDA's own versions
are slower too; these are branch-free and accurate to a few units in the last place of the working precision.
"""

import math
from types import SimpleNamespace

import warp as wp
from numpy.polynomial import Chebyshev, Polynomial

from wsrender_kernels.factories import factory

# Minimax polynomials of sin and cos on [-pi/4, pi/4] (Moshier, Cephes, 1989: sinf/cosf; fdlibm, 1993: __kernel_sin).
_SIN = {
    wp.float32: (-1.6666654611e-1, 8.3321608736e-3, -1.9515295891e-4),
    wp.float64: (
        -1.66666666666666324348e-01, 8.33333333332248946124e-03, -1.98412698298579493134e-04,
        2.75573137070700676789e-06, -2.50507602534068634195e-08, 1.58969099521155010221e-10,
    ),
}  # fmt: skip
_COS = {
    wp.float32: (4.166664568298827e-2, -1.388731625493765e-3, 2.443315711809948e-5),
    wp.float64: (
        4.16666666666666019037e-02, -1.38888888888741095749e-03, 2.48015872894767294178e-05,
        -2.75573143513906633035e-07, 2.08757232129817482790e-09, -1.13596475577881948265e-11,
    ),
}  # fmt: skip
# pi/2 in two parts, the first rounded: a fused multiply-add takes its multiples away exactly.
_HALF_PI = {
    wp.float32: (1.57079637050628662109375, -4.37113900018624283e-8),
    wp.float64: (1.57079632679489655800e00, 6.12323399573676603587e-17),
}
# Terms of log2's atanh series on [1/sqrt 2, sqrt 2], and of exp2's Taylor series on [-1/2, 1/2].
_LOG_TERMS = {wp.float32: 5, wp.float64: 11}
_EXP_TERMS = {wp.float32: 8, wp.float64: 14}
# x^(-1/3): of these leading 32 bits a third of those of x is taken away, which leaves |1 - x y³| < 0.103 (fitted); then
# steps to working precision.
_ROOT_GUESS = {wp.float32: 0x54A1F000, wp.float64: 0x553EE800}
_ROOT_STEPS = {wp.float32: 2, wp.float64: 3}

# x^(-1/2): half of the bits of x from these leaves e = 1 - x y² below 0.0682 (fitted), y times a polynomial in e
# through Chebyshev points, its constant term taken as 1, 1.4e-9 or 1.5e-6; in float64 a step of third order then leaves
# nothing.
_INVERSE_ROOT_GUESS = {wp.float32: 0x5F374740, wp.float64: 0x5FE6E8E800000000}
_INVERSE_ROOT = {
    real: Chebyshev.interpolate(lambda e: (1.0 - e) ** -0.5, degree, [-0.0682, 0.0682]).convert(kind=Polynomial)
    for real, degree in ((wp.float32, 5), (wp.float64, 3))
}
_OWN_ON_CUDA = {
    real: f"""
#if defined(__CUDA_ARCH__)
    return ::{name}(x);
#else
    return y;
#endif
"""
    for real, name in ((wp.float32, "rsqrtf"), (wp.float64, "rsqrt"))
}


def _coefficients(values, real):
    return wp.types.vector(len(values), real)(*values)


def bits_type(real):
    """Signed integer type of the same width as ``real``."""
    return wp.int32 if real is wp.float32 else wp.int64


@factory
def _own_on_cuda(real):
    @wp.func_native(_OWN_ON_CUDA[real])
    def own_on_cuda(x: real, y: real) -> real: ...

    return own_on_cuda


@factory
def elementary(real) -> SimpleNamespace:
    """Device functions of one precision.

    ``sincos(a) -> (sin a, cos a)``; ``sincos_from(a, rest, rest 2/pi, quarters)`` gives those of a + rest + quarters
    pi/2, where abs(rest) <= pi/4; ``log2`` for positive normal numbers; ``power(x, e) = 2^(e log2 x)``, 0 for x <= 0;
    ``two_thirds_power(x)``, the same for e = 2/3; ``ordered(x)`` maps a float to an integer that sorts alike (NaN sorts
    outside the infinities); ``scales(x) -> (4^-k, 2^k)``, x 4^-k between 1/2 and 2, for positive normal numbers and
    (2^126 or 2^1022, 0) for smaller ones. Of positive normal numbers, to 4 epsilon at most:
    ``inverse_root(x) = 1 / sqrt x`` and ``root_and_reciprocal(x) -> (sqrt x, 1 / x)``.
    """
    bits = bits_type(real)
    mantissa, bits_size = (23, 32) if real is wp.float32 else (52, 64)
    SIN, COS = _coefficients(_SIN[real], real), _coefficients(_COS[real], real)
    DEGREE = len(_SIN[real])
    PART_1, PART_2 = (real(part) for part in _HALF_PI[real])
    TWO_OVER_PI, HALF, ONE, ZERO = real(2.0 / math.pi), real(0.5), real(1.0), real(0.0)
    LOG_TERMS, EXP_TERMS = _LOG_TERMS[real], _EXP_TERMS[real]
    LOG = _coefficients([2.0 / math.log(2.0) / (2 * i + 1) for i in range(LOG_TERMS)], real)
    EXP = _coefficients([math.log(2.0) ** i / math.factorial(i) for i in range(EXP_TERMS)], real)
    SQRT_HALF = bits(0x3F3504F3) if real is wp.float32 else bits(0x3FE6A09E667F3BCD)
    MANTISSA = bits(mantissa)
    bias = 127 if real is wp.float32 else 1023
    LOWEST_EXPONENT_BIT, BITS_OF_ONE = bits(1 << mantissa), bits(bias << mantissa)
    BIAS, EXPONENT, OPPOSITE = bits(bias), bits((2 * bias + 1) << mantissa), bits(2 * bias << mantissa)
    SMALLEST = real(2.0**-126 if real is wp.float32 else 2.0**-1022)
    SIGN = bits(31 if real is wp.float32 else 63)
    MAGNITUDE = bits(2**31 - 1 if real is wp.float32 else 2**63 - 1)
    LOWEST, HIGHEST = real(-126.0 if real is wp.float32 else -1022.0), real(127.0 if real is wp.float32 else 1023.0)

    INFINITE, UNDEFINED = real(math.inf), real(math.nan)
    unsigned = wp.uint32 if real is wp.float32 else wp.uint64
    ROUND, ODD, NONE = real(1.5 * 2.0**mantissa), unsigned(1), unsigned(0)
    NEXT_TO_SIGN, QUARTER, SIGN_BIT = (
        unsigned(bits_size - 2),
        unsigned(2 ** (bits_size - 2)),
        unsigned(2 ** (bits_size - 1)),
    )
    ROOT_GUESS, ROOT_SHIFT, ROOT_STEPS = wp.int32(_ROOT_GUESS[real]), bits(bits_size - 32), _ROOT_STEPS[real]
    GUESS, ONE_BIT, THREE_EIGHTHS = bits(_INVERSE_ROOT_GUESS[real]), bits(1), real(0.375)
    INVERSE_ROOT = _coefficients(_INVERSE_ROOT[real].coef, real)
    INVERSE_ROOT_DEGREE = len(_INVERSE_ROOT[real].coef) - 1
    INVERSE_ROOT_STEPS = INVERSE_ROOT_DEGREE - 1
    own_on_cuda = _own_on_cuda(real)
    ROOT_1, ROOT_2, THREE = real(1.0 / 3.0), real(2.0 / 9.0), wp.int32(3)

    @wp.func
    def sincos_from(a: real, rest: real, rest_quarters: real, quarters: real):
        # Adding 1.5 * 2^(mantissa bits) rounds to an integer and leaves it in the low bits: cheaper than conversions.
        shifter = ROUND + quarters
        shifted = (a * TWO_OVER_PI + rest_quarters) + shifter
        k = shifted - shifter
        # Reduced before the rest is added, the angle loses nothing to the sum.
        r = ((a - k * PART_1) + rest) - k * PART_2
        z = r * r
        s = SIN[DEGREE - 1]
        c = COS[DEGREE - 1]
        for i in range(1, DEGREE):
            s = s * z + SIN[DEGREE - 1 - i]
            c = c * z + COS[DEGREE - 1 - i]
        s = r + r * z * s
        c = ONE + z * (z * c - HALF)
        quadrant = wp.cast(shifted, unsigned)
        swap = (quadrant & ODD) != NONE
        # Signs: the second bit of the quadrant, and of the next one.
        turned = quadrant << NEXT_TO_SIGN
        sine = wp.cast(wp.where(swap, c, s), unsigned) ^ (turned & SIGN_BIT)
        cosine = wp.cast(wp.where(swap, s, c), unsigned) ^ ((turned + QUARTER) & SIGN_BIT)
        return wp.cast(sine, real), wp.cast(cosine, real)

    @wp.func
    def sincos(a: real):
        return sincos_from(a, ZERO, ZERO, ZERO)

    @wp.func
    def sine(a: real):
        s, _c = sincos(a)
        return s

    @wp.func
    def cosine(a: real):
        _s, c = sincos(a)
        return c

    @wp.func
    def log2(x: real):
        i = wp.cast(x, bits)
        exponent = (i - SQRT_HALF) >> MANTISSA
        m = wp.cast(i - (exponent << MANTISSA), real)
        s = (m - ONE) / (m + ONE)
        z = s * s
        series = LOG[LOG_TERMS - 1]
        for j in range(1, LOG_TERMS):
            series = series * z + LOG[LOG_TERMS - 1 - j]
        value = wp.where(x == ZERO, -INFINITE, real(exponent) + s * series)
        return wp.where(x < ZERO, UNDEFINED, wp.where(x == INFINITE, INFINITE, value))

    @wp.func
    def exp2(x: real):
        t = wp.min(wp.max(x, LOWEST), HIGHEST)
        k = wp.floor(t + HALF)
        f = t - k
        series = EXP[EXP_TERMS - 1]
        for j in range(1, EXP_TERMS):
            series = series * f + EXP[EXP_TERMS - 1 - j]
        scale = wp.cast((bits(k) + BIAS) << MANTISSA, real)
        return wp.where(x < LOWEST, ZERO, wp.where(x > HIGHEST + ONE, INFINITE, series * scale))

    @wp.func
    def power(x: real, e: real):
        positive = x >= SMALLEST
        return wp.where(positive, exp2(e * log2(wp.where(positive, x, ONE))), ZERO)

    @wp.func
    def inverse_root(x: real):
        # A core of a CPU begins a SIMD division or root every 10 to 24 cycles, but two multiply-adds a cycle.
        y = wp.cast(GUESS - (wp.cast(x, bits) >> ONE_BIT), real)
        e = ONE - (x * y) * y
        series = INVERSE_ROOT[INVERSE_ROOT_DEGREE]
        for j in range(INVERSE_ROOT_STEPS):
            series = series * e + INVERSE_ROOT[INVERSE_ROOT_DEGREE - 1 - j]
        y = y + (y * e) * series
        if wp.static(real is wp.float64):
            e = ONE - (x * y) * y
            y = y + (y * e) * (HALF + THREE_EIGHTHS * e)
        return own_on_cuda(x, y)

    @wp.func
    def root_and_reciprocal32(x: real):
        # By `inverse_root` six indices are 2 to 7 % slower: the divider works beside the multipliers.
        return wp.sqrt(x), ONE / x

    @wp.func
    def root_and_reciprocal64(x: real):
        y = inverse_root(x)
        return x * y, y * y

    @wp.func
    def two_thirds_power(x: real):
        # x x^(-1/3): a third of the exponent, then y <- y (1 + e/3 + 2 e²/9), e = 1 - x y³ (Householder).
        leading = wp.int32(wp.cast(x, bits) >> ROOT_SHIFT)
        y = wp.cast(bits(ROOT_GUESS - leading / THREE) << ROOT_SHIFT, real)
        for _step in range(ROOT_STEPS):
            e = ONE - (x * y) * (y * y)
            y = y + (y * e) * (ROOT_1 + ROOT_2 * e)
        return wp.where(x >= SMALLEST, x * y, ZERO)

    @wp.func
    def ordered(x: real):
        i = wp.cast(x, bits)
        return i ^ ((i >> SIGN) & MAGNITUDE)

    @wp.func
    def scales(x: real):
        exponent = wp.cast(x, bits) & EXPONENT | LOWEST_EXPONENT_BIT
        root = wp.cast(((exponent + BITS_OF_ONE) >> ONE_BIT) & EXPONENT, real)
        return wp.cast(OPPOSITE - exponent, real), wp.where(x >= SMALLEST, root, ZERO)

    return SimpleNamespace(
        sincos=sincos,
        sincos_from=sincos_from,
        sine=sine,
        cosine=cosine,
        log2=log2,
        exp2=exp2,
        power=power,
        inverse_root=inverse_root,
        root_and_reciprocal=root_and_reciprocal32 if real is wp.float32 else root_and_reciprocal64,
        two_thirds_power=two_thirds_power,
        ordered=ordered,
        scales=scales,
    )
