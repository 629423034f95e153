"""Singular values of an m×n matrix (m task rows), in descending order, accurate near singularities.

Up to three rows: an orthogonal factorisation of the rows gives det(A Aᵀ) without squaring the condition number; the
largest eigenvalue and the gap of the others come from the angle between the deviators of H = A Aᵀ and of H², the
smallest by deflation. Four to six rows: `rotations`.

The columns of J M^-1 differ by the ratio of the links' inertias, often 1e5. Errors then must stay relative to each
column, or float32 loses the small singular values: ``graded`` matrices are rotated by their largest columns first, or
orthogonalised by columns (Demmel & Veselić: Jacobi is accurate for a well-conditioned matrix times any scaling).
"""

import numpy as np
import warp as wp
from numpy.polynomial import Chebyshev, Polynomial

from wsrender_kernels.elementary import elementary
from wsrender_kernels.factories import factory
from wsrender_kernels.matrices import as_it_is, transpose
from wsrender_kernels.rotations import by_rotations, tiny

# Of a third of an angle: degree of the polynomials, and steps that square their error.
DEGREE, NEWTON_STEPS = {wp.float32: 9, wp.float64: 10}, {wp.float32: 0, wp.float64: 1}


def epsilon(real) -> float:
    """Machine epsilon of the working precision."""
    return float(np.finfo(wp.dtype_to_numpy(real)).eps)


@factory
def singular_values(real, m: int, n: int, graded: bool = False, inline: bool = True):
    """Device function ``(A: (m, n)) -> (m,)``, descending, as computed; the last m - n are exactly 0.

    Of more than three rows, ``inline`` or a function that is called.
    """
    if m > 3:
        return by_rotations(real, m, n, graded, inline)
    solver = _two_rows(real, n, graded) if m == 2 else {1: _one_row, 3: _three_rows}[m](real, n)
    rotated = _by_largest_columns(real, n) if graded and m == 3 else as_it_is(real, m, n)
    vec_m = wp.types.vector(m, real)
    mat_mn = wp.types.matrix((m, n), real)
    RANK = min(m, n)

    @wp.func
    def values(A: mat_mn):
        sigma = solver(rotated(A))
        out = vec_m()
        for i in range(RANK):
            out[i] = sigma[i]
        return out

    return values


@factory
def without_noise(real, m: int, n: int, length: int):
    """Device function on ``length`` singular values: those <= max(m, n) eps sigma_1 become exactly 0."""
    vec = wp.types.vector(length, real)
    NEGLIGIBLE, ZERO = real(max(m, n) * epsilon(real)), real(0.0)

    @wp.func
    def regular(sigma: vec):
        out = sigma
        for i in range(1, length):
            out[i] = wp.where(sigma[i] > NEGLIGIBLE * sigma[0], sigma[i], ZERO)
        return out

    return regular


def _by_largest_columns(real, n: int):
    """Device function A -> R = E A: rows of E span the largest column, then the largest remainder (pivoted QR)."""
    vec3, vec_n, mat_3n = wp.types.vector(3, real), wp.types.vector(n, real), wp.types.matrix((3, n), real)
    ZERO, TINY = real(0.0), tiny(real)
    inverse_root, columns_of = elementary(real).inverse_root, transpose(real, 3, n)
    NONE = wp.int32(-1)

    @wp.func
    def direction(v: vec3):
        size = wp.dot(v, v)
        return v * wp.where(size > TINY, inverse_root(size), ZERO)

    @wp.func
    def by_largest_columns(A: mat_3n):
        columns = columns_of(A)
        first = NONE
        largest = ZERO
        a = vec3()
        for j in range(n):
            size = wp.dot(columns[j], columns[j])
            better = size > largest
            largest = wp.where(better, size, largest)
            first = wp.where(better, j, first)
            for r in range(3):
                a[r] = wp.where(better, columns[j, r], a[r])
        e1 = direction(a)
        # The pivots' remainders are exactly zero: their rounding errors would drown the small columns.
        along = vec_n()
        second = NONE
        largest = ZERO
        b = vec3()
        for j in range(n):
            along[j] = wp.dot(e1, columns[j])
            columns[j] -= e1 * along[j]
            size = wp.where(first == j, ZERO, wp.dot(columns[j], columns[j]))
            better = size > largest
            largest = wp.where(better, size, largest)
            second = wp.where(better, j, second)
            for r in range(3):
                b[r] = wp.where(better, columns[j, r], b[r])
        e2 = direction(b - e1 * wp.dot(e1, b))
        e3 = wp.cross(e1, e2)
        R = mat_3n()
        R[0] = along
        for j in range(n):
            R[1, j] = wp.where(first == j, ZERO, wp.dot(e2, columns[j]))
            R[2, j] = wp.where(first == j or second == j, ZERO, wp.dot(e3, columns[j]))
        return R

    return by_largest_columns


def _one_row(real, n: int):
    vec_1 = wp.types.vector(1, real)
    mat_1n = wp.types.matrix((1, n), real)

    @wp.func
    def one_row(A: mat_1n):
        return vec_1(wp.sqrt(wp.dot(A[0], A[0])))

    return one_row


def _two_rows(real, n: int, graded: bool):
    vec_2 = wp.types.vector(2, real)
    mat_2n = wp.types.matrix((2, n), real)
    # The remainder of a large column errs by its rounding; orthogonalised once more, by the square of it.
    PASSES = 2 if graded else 1
    HALF, ZERO, ONE, TINY = real(0.5), real(0.0), real(1.0), tiny(real)
    scales = elementary(real).scales

    @wp.func
    def two_rows(A: mat_2n):
        a = A[0]
        b = A[1]
        # In units that leave A Aᵀ a trace of about 1, as in three_rows: fourth powers follow.
        unit, scale = scales(wp.dot(a, a) + wp.dot(b, b))
        aa = wp.dot(a, a) * unit
        ab = wp.dot(a, b) * unit
        bb = wp.dot(b, b) * unit
        per_aa = wp.where(aa > TINY, ONE / aa, ZERO) * unit
        rest = b
        for _pass in range(PASSES):
            rest = rest - a * (wp.dot(a, rest) * per_aa)
        area = wp.sqrt(aa) * wp.sqrt(wp.dot(rest, rest) * unit)
        d = HALF * (aa - bb)
        largest = wp.sqrt(HALF * (aa + bb) + wp.sqrt(d * d + ab * ab))
        return vec_2(largest * scale, wp.where(largest > TINY, area / largest, ZERO) * scale)

    return two_rows


@factory
def _three_rows(real, n: int):
    vec_3 = wp.types.vector(3, real)
    mat_3n = wp.types.matrix((3, n), real)
    third_of_angle, functions = _third_of_angle(real), elementary(real)
    scales, root_and_reciprocal = functions.scales, functions.root_and_reciprocal
    ZERO, HALF, ONE, TWO, THREE, FOUR = (real(v) for v in (0.0, 0.5, 1.0, 2.0, 3.0, 4.0))
    THIRD, SIXTH, ROOT_6, ROOT_12, ROOT_SIXTH, TWO_ROOT_3 = (
        real(v) for v in (1 / 3, 1 / 6, 6**0.5, 12**0.5, 6**-0.5, 2 * 3**0.5)
    )
    TINY = tiny(real)
    # A row below the rounding noise of the others spans nothing: its reciprocal would overflow.
    NOISE = real(1e-18 if real is wp.float32 else 1e-36)

    @wp.func(inline=True)  # CUDA's compiler, optimizing little, would call it and pass the matrix through memory
    def three_rows(A: mat_3n):
        a = A[0]
        b = A[1]
        c = A[2]
        aa = wp.dot(a, a)
        bb = wp.dot(b, b)
        cc = wp.dot(c, c)
        # H = A Aᵀ in units of a power of four, whose square root is exact, that leave it a trace between 1/2 and 2.
        unit, scale = scales(aa + bb + cc)
        hx = aa * unit
        hy = bb * unit
        hz = cc * unit
        xy = wp.dot(a, b) * unit
        xz = wp.dot(a, c) * unit

        # H = L D Lᵀ with orthogonalised rows: the pivots keep the digits that H itself has lost.
        reciprocal = wp.where(hx > NOISE, ONE / hx, ZERO)
        lb = xy * reciprocal
        lc = xz * reciprocal
        b1 = b - a * lb
        c1 = c - a * lc
        d1 = hx
        d2 = wp.dot(b1, b1) * unit
        bc1 = wp.dot(b1, c1) * unit
        yz = bc1 + lb * xz
        lcb = bc1 * wp.where(d2 > NOISE, ONE / d2, ZERO)
        c2 = c1 - b1 * lcb
        d3 = wp.dot(c2, c2) * unit
        minor = lb * lcb - lc
        det = d1 * d2 * d3
        minors = d1 * (d2 * (ONE + lcb * lcb + minor * minor) + d3 * (ONE + lb * lb)) + d2 * d3

        # The eigenvalues of H are mean + 2 p cos(phi + 2 pi k / 3), where 3 phi is the angle between the deviators of H
        # and of H²: h, and G, that of the adjugate of h too (Cayley–Hamilton); h·G = 3 det h. No cancellation where
        # eigenvalues coincide.
        mean = (hx + hy + hz) * THIRD
        hx = hx - mean
        hy = hy - mean
        hz = -(hx + hy)
        square = TWO * ((hx * hx + hy * hy + hx * hy) + (xy * xy + xz * xz + yz * yz))
        norm, per_square = root_and_reciprocal(wp.where(square > TINY, square, TINY))
        gxy = xz * yz - xy * hz
        gxz = xy * yz - xz * hy
        gyz = xy * xz - yz * hx
        minor_x = hy * hz - yz * yz
        along = (hx * minor_x + xy * gxy) + xz * gxz
        gx = minor_x + square * SIXTH
        gy = (hx * hz - xz * xz) + square * SIXTH
        along = along * THREE * per_square
        gx = gx - along * hx
        gy = gy - along * hy
        gxy = gxy - along * xy
        gxz = gxz - along * xz
        gyz = gyz - along * yz
        across = wp.sqrt((gx * (gx + gy) + gy * gy + gxy * gxy) + (gxz * gxz + gyz * gyz)) * per_square
        cosine, sine = third_of_angle(along * (norm * per_square) * ROOT_6, across * ROOT_12)

        p = norm * ROOT_SIXTH
        l1 = mean + TWO * p * cosine
        l1 = wp.where(l1 > SIXTH, l1, SIXTH)
        sigma_1, i1 = root_and_reciprocal(l1)
        product = det * i1
        total = (minors - product) * i1
        # The gap from the angle errs by eps * l1, that from the discriminant by eps * total² / gap.
        total_square = total * total
        discriminant = total_square - FOUR * product
        from_angle = TWO_ROOT_3 * p * sine
        gap = wp.where(
            discriminant > total_square * total_square,
            wp.sqrt(discriminant),
            wp.where(from_angle < total_square, from_angle, total_square),
        )
        l2 = HALF * (total + wp.where(gap < total, gap, total))
        sigma_2, i2 = root_and_reciprocal(wp.where(l2 > TINY, l2, TINY))
        l3 = product * i2
        l3 = wp.where(l3 < l2, l3, l2)
        return vec_3(sigma_1 * scale, sigma_2 * scale, wp.sqrt(l3) * scale)

    return three_rows


def _third_of_angle(real):
    """Device function (cos a, sin a) -> (cos a/3, sin a/3), 0 <= a <= pi.

    cos(a/3) and sin(a/3) / sin a are smooth functions of cos a where that is not negative: polynomials through
    Chebyshev points; larger angles are reflected. Then, in float64, a step of Newton's method for z³ = e^{i a}.
    """
    HIGHEST, STEPS = DEGREE[real], NEWTON_STEPS[real]
    ZERO, HALF, TWO, THREE, THIRD, HALF_ROOT_3 = (real(v) for v in (0.0, 0.5, 2.0, 3.0, 1.0 / 3.0, 0.75**0.5))
    COS = _polynomial(real, lambda c: np.cos(np.arccos(c) / 3), HIGHEST)
    SIN = _polynomial(real, lambda c: np.sin(np.arccos(c) / 3) / np.sqrt(1 - c * c), HIGHEST)

    @wp.func
    def third_of_angle(cosine: real, sine: real):
        c = wp.abs(cosine)
        u = COS[HIGHEST]
        v = SIN[HIGHEST]
        for i in range(HIGHEST):
            u = u * c + COS[HIGHEST - 1 - i]
            v = v * c + SIN[HIGHEST - 1 - i]
        v = v * sine
        for _step in range(STEPS):
            # z <- (2 z + w / z²) / 3 with 1 / z² = conj(z)² / |z|⁴, and 1 / |z|⁴ = 3 - 2 |z|² near the unit circle.
            scale = THREE - TWO * (u * u + v * v)
            re = (u * u - v * v) * scale
            im = -TWO * u * v * scale
            u, v = (TWO * u + c * re - sine * im) * THIRD, (TWO * v + c * im + sine * re) * THIRD
        reflected = cosine < ZERO
        return (
            wp.where(reflected, HALF * u + HALF_ROOT_3 * v, u),
            wp.where(reflected, HALF_ROOT_3 * u - HALF * v, v),
        )

    return third_of_angle


def _polynomial(real, function, degree: int):
    """Coefficients, lowest first, of a function on [0, 1], through Chebyshev points."""
    fitted = Chebyshev.interpolate(function, degree, [0, 1]).convert(kind=Polynomial)
    return wp.types.vector(degree + 1, real)(*fitted.coef)
