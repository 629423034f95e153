"""Singular values of an m×n matrix (m task rows), in descending order, accurate near singularities.

Up to three rows: an orthogonal factorisation of the rows gives det(A Aᵀ) without squaring the condition number; the
largest eigenvalue and the gap of the others come from the angle between the deviators of H = A Aᵀ and of H², the
smallest by deflation. Four to six rows: one-sided Jacobi (Hestenes 1958; Demmel & Veselić 1992) on the triangular
factor, which spares two sweeps (Drmač & Veselić 2008).

The columns of J M^-1 differ by the ratio of the links' inertias, often 1e5. Errors then must stay relative to each
column, or float32 loses the small singular values: ``graded`` matrices are rotated by their largest columns first, or
orthogonalised by columns (Demmel & Veselić: Jacobi is accurate for a well-conditioned matrix times any scaling).
"""

from types import SimpleNamespace

import numpy as np
import warp as wp
from numpy.polynomial import Chebyshev, Polynomial

from wsrender_kernels.elementary import elementary
from wsrender_kernels.factories import factory
from wsrender_kernels.matrices import transpose

SWEEPS = {wp.float32: 4, wp.float64: 5}  # of a triangular factor
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
        return _by_rotations(real, m, n, graded, inline)
    solver = _two_rows(real, n, graded) if m == 2 else {1: _one_row, 3: _three_rows}[m](real, n)
    rotated = _by_largest_columns(real, n) if graded and m == 3 else _as_it_is(real, m, n)
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


def _as_it_is(real, m: int, n: int):
    mat_mn = wp.types.matrix((m, n), real)

    @wp.func
    def as_it_is(A: mat_mn):
        return A

    return as_it_is


def _by_largest_columns(real, n: int):
    """Device function A -> R = E A: rows of E span the largest column, then the largest remainder (pivoted QR)."""
    vec3, vec_n, mat_3n = wp.types.vector(3, real), wp.types.vector(n, real), wp.types.matrix((3, n), real)
    ZERO, TINY = real(0.0), _tiny(real)
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
    HALF, ZERO, ONE, TINY = real(0.5), real(0.0), real(1.0), _tiny(real)
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
    TINY = _tiny(real)
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


def _rotation(real):
    """Device function (b·b - a·a, 2 a·b) -> cosine, sine, tangent of the rotation, within 45°, that makes a ⟂ b.

    By the cosine and sine of twice the angle: c² = (1 + cosine) / 2 and s = sine / (2 c). Inverse roots cost less than
    divisions.
    """
    ZERO, HALF, ONE, TINY = real(0.0), real(0.5), real(1.0), _tiny(real)
    inverse_root = elementary(real).inverse_root

    @wp.func
    def rotation(difference: real, twice: real):
        square = difference * difference + twice * twice
        regular = square > TINY
        per_length = wp.where(regular, inverse_root(square), ZERO)
        cosine = wp.where(regular, wp.abs(difference) * per_length, ONE)
        c_square = HALF * cosine + HALF
        per_c = inverse_root(c_square)
        sine = wp.where(difference < ZERO, -twice, twice) * (HALF * per_length * per_c)
        return c_square * per_c, sine, sine * per_c

    return rotation


@factory
def _rotations(real, m: int, n: int, graded: bool) -> SimpleNamespace:
    """One-sided Jacobi on the rows of R, (the n columns, or the m rows) P = Q R with pivoting, in stages.

    Device functions ``start(A) -> R, scale``, ``rotated(R) -> R`` after all sweeps and ``finish(R, scale) -> (m,)
    values``.

    Columns are graded, and may be so along their coordinates too: with the longest of these first, the reflections err
    relative to each (Powell & Reid 1969; Cox & Higham 1998).
    """
    by_columns = m > n or graded
    COUNT, LENGTH = (n, m) if by_columns else (m, n)
    RANK = min(m, n)
    mat_mn, vec_m, vec_rank = wp.types.matrix((m, n), real), wp.types.vector(m, real), wp.types.vector(RANK, real)
    factor_type = wp.types.matrix((RANK, COUNT), real)
    triangular_factor = _triangular_factor(real, COUNT, LENGTH)
    ordered = _longest_rows_first(real, m, n) if by_columns else _as_it_is(real, m, n)
    oriented = transpose(real, m, n) if by_columns else _as_it_is(real, m, n)
    angles, turned = _angles(real, RANK, COUNT), _turned(real, RANK, COUNT)
    ROUNDS, NUMBER_OF_SWEEPS = _rounds(RANK), SWEEPS[real]
    ZERO, ONE, TINY = real(0.0), real(1.0), _tiny(real)

    @wp.func
    def start(A: mat_mn):
        W = oriented(ordered(A))
        # Unit scale, so that squares of small robots' lengths do not underflow.
        scale = ZERO
        for i in range(COUNT):
            scale = scale + wp.dot(W[i], W[i])
        scale = wp.sqrt(scale)
        per_scale = ONE / wp.max(scale, TINY)
        for i in range(COUNT):  # W * per_scale stays a loop where n is large, and the lane loop then scalar
            W[i] *= per_scale
        return triangular_factor(W), scale

    @wp.func
    def rotated(R: factor_type):
        # No ranges, which Warp would write out: two spectra of a sample do not fit in a GPU's registers then.
        out = R
        sweeps = wp.int32(0)
        while sweeps < NUMBER_OF_SWEEPS:
            squares = vec_rank()  # cancellation in them costs convergence at most: every sweep begins with new ones
            for i in range(RANK):
                squares[i] = wp.dot(out[i], out[i])
            rounds = wp.int32(0)
            while rounds < ROUNDS:
                cosines, sines, squares = angles(out, squares)
                out = turned(out, cosines, sines)
                rounds += 1
            sweeps += 1
        return out

    @wp.func
    def finish(R: factor_type, scale: real):
        norms = vec_rank()
        for i in range(RANK):
            norms[i] = wp.sqrt(wp.dot(R[i], R[i])) * scale
        for last in range(wp.static(RANK - 1), 0, -1):
            for i in range(last):
                larger = wp.max(norms[i], norms[i + 1])
                norms[i + 1] = wp.min(norms[i], norms[i + 1])
                norms[i] = larger
        sigma = vec_m()
        for i in range(RANK):
            sigma[i] = norms[i]
        return sigma

    return SimpleNamespace(start=start, rotated=rotated, finish=finish, factor_shape=(RANK, COUNT))


@factory
def singular_values_of_lanes(real, m: int, n: int, graded: bool, lanes: int):
    """Device function (m n lanes) -> (m lanes): singular values of many matrices of four to six rows side by side.

    Number (r, c) of a lane's matrix is ``matrices[(r * n + c) * lanes + lane]``, value r ``values[r * lanes + lane]``.
    Loops over lanes instead of one function per matrix: less to compile, and SIMD.
    """
    stages = _rotations(real, m, n, graded)
    ROWS, COLUMNS = stages.factor_shape
    start, finish, swept = stages.start, stages.finish, _swept(real, ROWS, COLUMNS, lanes)
    mat_mn, factor_type = wp.types.matrix((m, n), real), wp.types.matrix((ROWS, COLUMNS), real)
    matrices_type, factors_type, scales_type, values_type = (
        wp.types.vector(size * lanes, real) for size in (m * n, ROWS * COLUMNS, 1, m)
    )

    @wp.func(inline=True)
    def values_of_lanes(matrices: matrices_type):
        factors = factors_type()
        scales = scales_type()
        values = values_type()
        for lane in range(lanes):
            A = mat_mn()
            at = lane
            for r in range(m):
                for c in range(n):
                    A[r, c] = matrices[at]
                    at += lanes
            R, scale = start(A)
            scales[lane] = scale
            at = lane
            for i in range(ROWS):
                for c in range(COLUMNS):
                    factors[at] = R[i, c]
                    at += lanes
        orthogonal = swept(factors)
        for lane in range(lanes):
            factor = factor_type()
            place = lane
            for i in range(ROWS):
                for c in range(COLUMNS):
                    factor[i, c] = orthogonal[place]
                    place += lanes
            sigma = finish(factor, scales[lane])
            for r in range(m):
                values[r * lanes + lane] = sigma[r]
        return values

    return values_of_lanes


@factory
def _swept(real, count: int, length: int, lanes: int):
    """Device function vectors -> vectors: all sweeps of the vectors (count, length) of as many samples as lanes.

    Number c of vector i of a sample is ``vectors[(i * length + c) * lanes + lane]``. One round is all the code
    there is, in a lane loop: written out for one sample after the other, the sweeps would be twenty times as much to
    compile. Angles have a loop of their own: they are long chains of operations, of which a core overlaps those of
    several samples where little else is between.
    """
    PART, ROUNDS, NUMBER_OF_SWEEPS, PAIRS = lanes, _rounds(count), SWEEPS[real], _pairs(count)
    mat, vec, vec_pairs = (wp.types.matrix((count, length), real), *(wp.types.vector(k, real) for k in (count, PAIRS)))
    vectors_type, squares_type, pairs_type = (
        wp.types.vector(rows * PART, real) for rows in (count * length, count, PAIRS)
    )
    angles, turned, ZERO = _angles(real, count, length), _turned(real, count, length), real(0.0)

    @wp.func
    def swept(vectors_before: vectors_type):
        out = vectors_before
        lane_squares = squares_type()
        lane_cosines = pairs_type()
        lane_sines = pairs_type()
        sweeps = wp.int32(0)
        while sweeps < NUMBER_OF_SWEEPS:
            for lane in range(PART):
                at = lane
                for i in range(count):
                    square = ZERO
                    for _c in range(length):
                        square += out[at] * out[at]
                        at += PART
                    lane_squares[i * PART + lane] = square
            rounds = wp.int32(0)
            while rounds < ROUNDS:
                for lane in range(PART):
                    vectors = mat()
                    squares = vec()
                    at = lane
                    for i in range(count):
                        squares[i] = lane_squares[i * PART + lane]
                        for c in range(length):
                            vectors[i, c] = out[at]
                            at += PART
                    cosines, sines, squares = angles(vectors, squares)
                    for k in range(PAIRS):
                        lane_cosines[k * PART + lane] = cosines[k]
                        lane_sines[k * PART + lane] = sines[k]
                    for i in range(count):
                        lane_squares[i * PART + lane] = squares[i]
                for lane in range(PART):
                    before = mat()
                    at = lane
                    for i in range(count):
                        for c in range(length):
                            before[i, c] = out[at]
                            at += PART
                    c_of = vec_pairs()
                    s_of = vec_pairs()
                    for k in range(PAIRS):
                        c_of[k] = lane_cosines[k * PART + lane]
                        s_of[k] = lane_sines[k * PART + lane]
                    after = turned(before, c_of, s_of)
                    at = lane
                    for i in range(count):
                        for c in range(length):
                            out[at] = after[i, c]
                            at += PART
                rounds += 1
            sweeps += 1
        return out

    return swept


def _by_rotations(real, m: int, n: int, graded: bool, inline: bool):
    """Device function A (m, n) -> singular values (m,), all stages of `_rotations` for one matrix."""
    stages, mat_mn = _rotations(real, m, n, graded), wp.types.matrix((m, n), real)
    start, rotated, finish = stages.start, stages.rotated, stages.finish

    @wp.func(inline=inline)
    def by_rotations(A: mat_mn):
        R, scale = start(A)
        return finish(rotated(R), scale)

    return by_rotations


def _rounds(count: int) -> int:
    """Rounds in which each of ``count`` vectors meets each other once, nobody twice in a round (of one, nobody)."""
    return count - 1 + count % 2


def _pairs(count: int) -> int:
    """Pairs of a round, or 1: Warp has no empty vectors."""
    return max(count // 2, 1)


def _seats(count: int):
    """Seat of every vector in the next round of a tournament.

    Those that sit opposite each other meet: the first and the last, the second and the last but one; if they are odd in
    number, the first meets nobody, and they begin with the second. Then all but the first (odd: all) move on by one
    seat. So every round is the same code, and after the last one all are back where they began.
    """
    moving = list(range(1 - count % 2, count))
    seats = dict(zip(moving, [*moving[1:], *moving[:1]], strict=True))
    return wp.types.vector(count, wp.int32)(*[seats.get(i, i) for i in range(count)])


@factory
def _angles(real, count: int, length: int):
    """Device function (vectors (count, length), squared lengths) -> cosines, sines, squared lengths after a round."""
    mat, vec, vec_pairs = (
        wp.types.matrix((count, length), real),
        *(wp.types.vector(k, real) for k in (count, _pairs(count))),
    )
    PAIRS, LAST, ODD, NEXT = count // 2, count - 1, count % 2, _seats(count)
    TWO = real(2.0)
    rotation = _rotation(real)

    @wp.func
    def angles(vectors: mat, squares: vec):
        out = vec()
        cosines = vec_pairs()
        sines = vec_pairs()
        out[NEXT[0]] = squares[0]  # meets nobody, or is overwritten
        for k in range(PAIRS):
            i = wp.static(ODD) + k
            j = LAST - k
            along = wp.dot(vectors[i], vectors[j])
            c, s, t = rotation(squares[j] - squares[i], TWO * along)
            cosines[k] = c
            sines[k] = s
            out[NEXT[i]] = squares[i] - t * along
            out[NEXT[j]] = squares[j] + t * along
        return cosines, sines, out

    return angles


@factory
def _turned(real, count: int, length: int):
    """Device function (vectors (count, length), cosines, sines) -> vectors after a round, in their next seats."""
    mat, vec_pairs = wp.types.matrix((count, length), real), wp.types.vector(_pairs(count), real)
    PAIRS, LAST, ODD, NEXT = count // 2, count - 1, count % 2, _seats(count)

    @wp.func
    def turned(vectors: mat, cosines: vec_pairs, sines: vec_pairs):
        out = mat()
        out[NEXT[0]] = vectors[0]  # meets nobody, or is overwritten
        for k in range(PAIRS):
            i = wp.static(ODD) + k
            j = LAST - k
            a = vectors[i]
            b = vectors[j]
            out[NEXT[i]] = a * cosines[k] - b * sines[k]
            out[NEXT[j]] = a * sines[k] + b * cosines[k]
        return out

    return turned


def _longest_rows_first(real, rows: int, columns: int):
    """Device function A (rows, columns) -> A with its rows sorted, the longest first."""
    mat, vec_rows = wp.types.matrix((rows, columns), real), wp.types.vector(rows, real)
    LAST = rows - 1

    @wp.func
    def longest_rows_first(A: mat):
        out = A
        sizes = vec_rows()
        for r in range(rows):
            sizes[r] = wp.dot(out[r], out[r])
        for last in range(LAST, 0, -1):
            for r in range(last):
                a = out[r]
                b = out[r + 1]
                swap = sizes[r] < sizes[r + 1]
                larger = wp.max(sizes[r], sizes[r + 1])
                sizes[r + 1] = wp.min(sizes[r], sizes[r + 1])
                sizes[r] = larger
                out[r] = wp.where(swap, b, a)
                out[r + 1] = wp.where(swap, a, b)
        return out

    return longest_rows_first


@factory
def _triangular_factor(real, count: int, length: int):
    """Device function vectors (count, length) -> R (min(count, length), count), vectors P = Q R with pivoting."""
    rank = min(count, length)
    mat, vec_count = wp.types.matrix((count, length), real), wp.types.vector(count, real)
    factor_type = wp.types.matrix((rank, count), real)
    LAST, LAST_COORDINATE, STEPS = count - 1, length - 1, min(count, length - 1)
    ZERO, ONE, TINY = real(0.0), real(1.0), _tiny(real)
    by_coordinate = transpose(real, count, length)

    @wp.func
    def triangular_factor(vectors: mat):
        out = vectors
        for k in range(STEPS):
            # The longest of the vectors that are left comes next. Lengths are those across the coordinates before k.
            sizes = vec_count()
            for i in range(k, count):
                sizes[i] = out[i, k] * out[i, k]
                for r in range(LAST_COORDINATE, k, -1):
                    sizes[i] += out[i, r] * out[i, r]
            for i in range(LAST, k, -1):
                swap = sizes[i] > sizes[i - 1]
                sizes[i - 1] = wp.max(sizes[i], sizes[i - 1])
                a = out[i - 1]
                b = out[i]
                out[i - 1] = wp.where(swap, b, a)
                out[i] = wp.where(swap, a, b)
            # A reflection turns it onto coordinate k.
            reflected = wp.copysign(wp.sqrt(sizes[k]), out[k, k])
            first = out[k, k] + reflected
            size = reflected * first
            scale = wp.where(size > TINY, ONE / wp.max(size, TINY), ZERO)
            for i in range(LAST, k, -1):
                along = first * out[i, k]
                for r in range(LAST_COORDINATE, k, -1):
                    along += out[k, r] * out[i, r]
                along *= scale
                out[i, k] -= along * first
                for r in range(LAST_COORDINATE, k, -1):
                    out[i, r] -= along * out[k, r]
            out[k, k] = -reflected
            for r in range(LAST_COORDINATE, k, -1):
                out[k, r] = ZERO
        coordinates = by_coordinate(out)
        R = factor_type()
        for k in range(rank):
            R[k] = coordinates[k]
        return R

    return triangular_factor


def _tiny(real):
    """A number whose square root and reciprocal are finite: below it a square counts as 0."""
    return real(1e-36 if real is wp.float32 else 1e-300)
