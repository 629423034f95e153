"""Singular values of four to six rows: one-sided Jacobi (Hestenes 1958; Demmel & Veselić 1992) on a triangular factor.

That of A P = Q R, or Aᵀ P = Q R, with pivoting: its rows take two sweeps less (Drmač & Veselić 2008). Written for one
matrix, in registers (`by_rotations`), and for many, in memory (`singular_values_of_lanes`), for sweeps on the CPU.
"""

from typing import Any

import warp as wp

from wsrender_kernels.elementary import elementary
from wsrender_kernels.factories import factory
from wsrender_kernels.matrices import as_it_is, followed_by, transpose, written_out

SWEEPS = {wp.float32: 4, wp.float64: 5}  # of a triangular factor


@factory
def by_rotations(real, m: int, n: int, graded: bool, inline: bool):
    """Device function A (m, n) -> (m,) singular values, ``inline`` or a function that is called."""
    by_columns, COUNT, LENGTH, RANK = _vectors(m, n, graded)
    mat_mn, vec_m, vec_rank = wp.types.matrix((m, n), real), wp.types.vector(m, real), wp.types.vector(RANK, real)
    factor_type = wp.types.matrix((RANK, COUNT), real)
    triangular_factor = _triangular_factor(real, COUNT, LENGTH)
    ordered = _longest_rows_first(real, m, n) if by_columns else as_it_is(real, m, n)
    oriented = transpose(real, m, n) if by_columns else as_it_is(real, m, n)
    angles, turned = _angles(real, RANK, COUNT), _turned(real, RANK, COUNT)
    ROUNDS, NUMBER_OF_SWEEPS = _rounds(RANK), SWEEPS[real]
    ZERO, ONE, TINY = real(0.0), real(1.0), tiny(real)

    @wp.func(inline=True)  # or CUDA's compiler, optimizing little, passes matrices through memory
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

    @wp.func(inline=inline)
    def by_rotations(A: mat_mn):
        R, scale = start(A)
        return finish(rotated(R), scale)

    return by_rotations


@factory
def singular_values_of_lanes(real, m: int, n: int, graded: bool, lanes: int):
    """Device function (m n lanes) -> (m lanes): singular values of many matrices side by side, as `by_rotations`.

    Number (r, c) of a lane's matrix is ``matrices[(r * n + c) * lanes + lane]``, value r ``values[r * lanes + lane]``.
    Every stage is a loop over lanes of what a step of it takes, all in memory: far less code than a function per matrix
    written out, which would take longer to compile than all else of a sweep.
    """
    by_columns, COUNT, LENGTH, RANK = _vectors(m, n, graded)
    BY_COLUMNS, ROW = by_columns, COUNT * lanes
    NEXT_COORDINATE, NEXT_VECTOR = (n * lanes, lanes) if by_columns else (lanes, n * lanes)
    matrices_type, values_type, sizes_type, lanes_type = (
        wp.types.vector(rows * lanes, real) for rows in (m * n, m, LENGTH, 1)
    )
    factors_of, swept = _triangular_factors(real, COUNT, LENGTH, lanes), _swept(real, RANK, COUNT, lanes)
    ZERO, ONE, TINY = real(0.0), real(1.0), tiny(real)

    @wp.func(inline=True)
    def values_of_lanes(matrices: matrices_type):
        sizes = sizes_type()
        scales = lanes_type()
        per_scales = lanes_type()
        r = wp.int32(0)
        while r < LENGTH:
            for lane in range(lanes):
                size = ZERO
                at = r * NEXT_COORDINATE + lane
                for _i in range(COUNT):
                    size += matrices[at] * matrices[at]
                    at += NEXT_VECTOR
                sizes[r * lanes + lane] = size
                scales[lane] += size
            r += 1
        # Unit scale, so that squares of small robots' lengths do not underflow.
        for lane in range(lanes):
            scale = wp.sqrt(scales[lane])
            scales[lane] = scale
            per_scales[lane] = ONE / wp.max(scale, TINY)
        vectors = matrices_type()
        r = wp.int32(0)
        while r < LENGTH:
            for lane in range(lanes):
                at = r * NEXT_COORDINATE + lane
                to = r * ROW + lane
                for _i in range(COUNT):
                    vectors[to] = matrices[at] * per_scales[lane]
                    at += NEXT_VECTOR
                    to += lanes
            r += 1
        if wp.static(BY_COLUMNS):  # the longest coordinates first
            last = wp.int32(LENGTH - 1)
            while last > 0:
                r = wp.int32(0)
                while r < last:
                    for lane in range(lanes):
                        this = r * lanes + lane
                        other = this + lanes
                        swap = sizes[this] < sizes[other]
                        larger = wp.max(sizes[this], sizes[other])
                        sizes[other] = wp.min(sizes[this], sizes[other])
                        sizes[this] = larger
                        here = r * ROW + lane
                        there = here + ROW
                        for _i in range(COUNT):
                            a = vectors[here]
                            b = vectors[there]
                            vectors[here] = wp.where(swap, b, a)
                            vectors[there] = wp.where(swap, a, b)
                            here += lanes
                            there += lanes
                    r += 1
                last -= 1
        orthogonal = swept(factors_of(vectors))
        values = values_type()
        i = wp.int32(0)
        while i < RANK:
            for lane in range(lanes):
                square = ZERO
                at = i * ROW + lane
                for _c in range(COUNT):
                    square += orthogonal[at] * orthogonal[at]
                    at += lanes
                values[i * lanes + lane] = wp.sqrt(square) * scales[lane]
            i += 1
        last = wp.int32(RANK - 1)
        while last > 0:
            i = wp.int32(0)
            while i < last:
                for lane in range(lanes):
                    here = i * lanes + lane
                    there = here + lanes
                    larger = wp.max(values[here], values[there])
                    values[there] = wp.min(values[here], values[there])
                    values[here] = larger
                i += 1
            last -= 1
        return values

    return values_of_lanes


def _vectors(m: int, n: int, graded: bool) -> tuple[bool, int, int, int]:
    """Whether the vectors of Q R are the columns of A (m, n), not its rows; number of them; their length; the rank.

    Columns are graded, and may be so along their coordinates too: with the longest of these first, the reflections err
    relative to each (Powell & Reid 1969; Cox & Higham 1998).
    """
    by_columns = m > n or graded
    count, length = (n, m) if by_columns else (m, n)
    return by_columns, count, length, min(m, n)


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
    mat, factor_type = wp.types.matrix((count, length), real), wp.types.matrix((min(count, length), count), real)

    @wp.func_native(_triangular_factor_in_cpp(real, count, length))
    def triangular_factor(vectors: mat) -> factor_type: ...

    return triangular_factor


def _triangular_factor_in_cpp(real, count: int, length: int) -> str:
    """`_triangular_factor` written out (see `matrices`). ``v0_1``: coordinate 1 of vector 0; ``size0``: its square."""
    rank = min(count, length)
    lines = [f"R v{i}_{r} = vectors.data[{i}][{r}];" for i in range(count) for r in range(length)]
    lines += [f"R size{i};" for i in range(count)]
    for k in range(min(count, length - 1)):
        later, others = range(length - 1, k, -1), range(count - 1, k, -1)
        # The longest of the vectors that are left comes next. Lengths are those across the coordinates before k.
        for i in range(k, count):
            more = followed_by("+", (f"v{i}_{r} * v{i}_{r}" for r in later))
            lines.append(f"size{i} = v{i}_{k} * v{i}_{k}{more};")
        for i in others:
            lines.append(f"swap = size{i} > size{i - 1};")
            lines.append(f"size{i - 1} = wp::max(size{i}, size{i - 1});")
            for r in range(length):
                a, b = f"v{i - 1}_{r}", f"v{i}_{r}"
                lines.append(f"before = {a}; {a} = swap ? {b} : before; {b} = swap ? before : {b};")
        # A reflection turns it onto coordinate k.
        lines.append(f"reflected = wp::copysign(wp::sqrt(size{k}), v{k}_{k});")
        lines.append(f"v{k}_{k} += reflected;")
        lines.append(f"size = reflected * v{k}_{k};")
        lines.append("scale = size > TINY ? R(1) / wp::max(size, TINY) : R(0);")
        for i in others:
            more = followed_by("+", (f"v{k}_{r} * v{i}_{r}" for r in later))
            lines.append(f"along = (v{k}_{k} * v{i}_{k}{more}) * scale;")
            lines += [f"v{i}_{r} -= along * v{k}_{r};" for r in (k, *later)]
        lines.append(f"v{k}_{k} = -reflected;")
        lines += [f"v{k}_{r} = R(0);" for r in later]
    lines += [f"factor.data[{k}][{i}] = v{i}_{k};" for k in range(rank) for i in range(count)]
    return written_out(
        real,
        f"const R TINY = R({float(tiny(real))});",
        "R before, reflected, size, scale, along;",
        "bool swap;",
        f"wp::mat_t<{rank}, {count}, R> factor;",
        *lines,
        "return factor;",
    )


@factory
def _triangular_factors(real, count: int, length: int, lanes: int):
    """Device function vectors -> vectors: `_triangular_factor` of as many samples as lanes, in loops over them.

    Coordinate r of vector i of a sample is ``vectors[(r * count + i) * lanes + lane]``, so is number (r, i) of its R.
    One step is all the code there is: quicker to compile than `_triangular_factor`, if slower to run.
    """
    LAST, STEPS, ROW = count - 1, min(count, length - 1), count * lanes
    vectors_type, sizes_type, lanes_type, normals_type, vec_length = (
        wp.types.vector(size, real) for size in (ROW * length, ROW, lanes, lanes * length, length)
    )
    ZERO, ONE, TINY = real(0.0), real(1.0), tiny(real)

    @wp.func
    def triangular_factors(vectors_before: vectors_type):
        out = vectors_before
        sizes = sizes_type()
        normals = normals_type()
        heads = lanes_type()
        diagonals = lanes_type()
        scales = lanes_type()
        left = vec_length(ONE)  # 1 for the coordinates that are left, 0 for those before
        i = wp.int32(0)
        while i < count:
            for lane in range(lanes):
                size = ZERO
                at = i * lanes + lane
                for _r in range(length):
                    size += out[at] * out[at]
                    at += ROW
                sizes[i * lanes + lane] = size
            i += 1
        step = wp.int32(0)
        while step < STEPS:
            i = wp.int32(LAST)
            while i > step:
                for lane in range(lanes):
                    here = i * lanes + lane
                    before = here - lanes
                    swap = sizes[here] > sizes[before]
                    larger = wp.max(sizes[here], sizes[before])
                    sizes[here] = wp.min(sizes[here], sizes[before])
                    sizes[before] = larger
                    for _r in range(length):
                        a = out[before]
                        b = out[here]
                        out[before] = wp.where(swap, b, a)
                        out[here] = wp.where(swap, a, b)
                        before += ROW
                        here += ROW
                i -= 1
            # In loops of their own, or clang does not know that lanes do not depend on each other.
            for lane in range(lanes):
                head = out[step * (ROW + lanes) + lane]
                reflected = wp.copysign(wp.sqrt(sizes[step * lanes + lane]), head)
                size = reflected * (head + reflected)
                scales[lane] = wp.where(size > TINY, ONE / wp.max(size, TINY), ZERO)
                heads[lane] = head + reflected
                diagonals[lane] = -reflected
            for lane in range(lanes):
                at = step * lanes + lane
                for r in range(length):
                    normals[r * lanes + lane] = left[r] * out[at]
                    out[at] -= left[r] * out[at]
                    at += ROW
            for lane in range(lanes):
                normals[step * lanes + lane] = heads[lane]
                out[step * (ROW + lanes) + lane] = diagonals[lane]
            left[step] = ZERO
            i = step + 1
            while i < count:
                for lane in range(lanes):
                    along = ZERO
                    at = i * lanes + lane
                    for r in range(length):
                        along += normals[r * lanes + lane] * out[at]
                        at += ROW
                    along *= scales[lane]
                    size = ZERO
                    at = i * lanes + lane
                    for r in range(length):
                        turned = out[at] - along * normals[r * lanes + lane]
                        out[at] = turned
                        size += left[r] * turned * turned
                        at += ROW
                    sizes[i * lanes + lane] = size
                i += 1
            step += 1
        return out

    return triangular_factors


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
    squares_type, pairs_type = (wp.types.vector(rows * PART, real) for rows in (count, PAIRS))
    angles, turned, ZERO = _angles(real, count, length), _turned(real, count, length), real(0.0)

    @wp.func
    def swept(vectors_before: Any):
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


def _rotation(real):
    """Device function (b·b - a·a, 2 a·b) -> cosine, sine, tangent of the rotation, within 45°, that makes a ⟂ b.

    By the cosine and sine of twice the angle: c² = (1 + cosine) / 2 and s = sine / (2 c). Inverse roots cost less than
    divisions.
    """
    ZERO, HALF, ONE, TINY = real(0.0), real(0.5), real(1.0), tiny(real)
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


def tiny(real):
    """A number whose square root and reciprocal are finite: below it a square counts as 0."""
    return real(1e-36 if real is wp.float32 else 1e-300)
