"""Singular values that the indices of a convention are functions of (DEFINITIONS of the project, section 2).

``standard``: those of A = J or J M^-1. ``table_1`` (Zhang, Cursi, Yang, *WSRender*, 2019, Table I as printed):
those of J, and for the dynamic indices those whose squares are the eigenvalues of H with H^-1 = (M J^+)^T (M J^+).
``wsrender_code`` (the original program): mu = sqrt det of the linear rows of J, or of all rows of J M, followed by
the singular values of all six rows of J, or of J M.

A singular value of J counts as 0 up to max(m, n) eps sigma_1. M being regular, J M^-1 and J M have the rank of J: which
of their values count as 0 is decided on J, whose scale is uniform. The threshold of J M^-1 itself would call values of
up to 1e-2 of their maximum zero in float32.
"""

from types import SimpleNamespace
from typing import Any

import warp as wp

from wsrender_kernels.elementary import elementary
from wsrender_kernels.factories import factory
from wsrender_kernels.inertia import inertia
from wsrender_kernels.singular_values import without_noise

LINEAR, ALL_ROWS = (0, 1, 2), (0, 1, 2, 3, 4, 5)


def in_base_axes(rows: tuple[int, ...]) -> bool:
    """Whether a task has some rows of a triad (linear, angular) but not all: then its axes matter."""
    return any(len({r for r in rows if r // 3 == part}) in (1, 2) for part in (0, 1))


def spectrum_length(n: int, rows: tuple[int, ...], convention: str) -> int:
    """Number of values that an index function of this convention receives."""
    return 1 + min(6, n) if convention == "wsrender_code" else len(rows)


@factory
def spectrum(
    real, n: int, rows: tuple[int, ...], convention: str, dynamic: bool, penalty: bool, torque: bool
) -> SimpleNamespace:
    """Device functions around the singular values: of which matrices they are, and what the indices get of them.

    ``penalized(model, q, J) -> J``; ``kinematic_matrix(model, J) -> A`` and ``dynamic_matrix(model, J, M) -> B``;
    ``volume(J)``, which a convention may take from J itself; with the singular values of A and B,
    ``kinematic(volume, sigma) -> spectrum`` and ``dynamic(kinematic spectrum, sigma) -> spectrum``.
    ``kinematic_shape``, ``dynamic_shape``: those of A and B. Without ``dynamic``, B is a number that nobody looks at.
    """
    make = {"standard": _standard, "table_1": _table_1, "wsrender_code": _wsrender_code}[convention]
    spectra = make(real, n, rows, _torque_scaled(real, n) if torque else None)
    if not dynamic:
        spectra.dynamic_matrix, spectra.dynamic_shape = _no_matrix(real, n), (1, 1)
        spectra.dynamic = _zeros(real, spectrum_length(n, rows, convention))
    spectra.penalized = _penalized(real, n) if penalty else _unchanged(real, n)
    return spectra


def _no_matrix(real, n: int):
    """Device function in place of a ``dynamic_matrix``: a single 0."""
    mat_6n, mat_nn = wp.types.matrix((6, n), real), wp.types.matrix((n, n), real)
    mat_11 = wp.types.matrix((1, 1), real)

    @wp.func
    def no_matrix(model: Any, J: mat_6n, M: mat_nn):
        return mat_11()

    return no_matrix


def _zeros(real, length: int):
    """Device function in place of a ``dynamic`` of zeros."""
    spectrum_type, vec1 = wp.types.vector(length, real), wp.types.vector(1, real)

    @wp.func
    def zeros(kinematic: spectrum_type, sigma: vec1):
        return spectrum_type()

    return zeros


def _unchanged(real, n: int):
    vec_n, mat_6n = wp.types.vector(n, real), wp.types.matrix((6, n), real)

    @wp.func
    def unchanged(model: Any, q: vec_n, J: mat_6n):
        return J

    return unchanged


def _penalized(real, n: int):
    """Columns times (1 - exp(-4 K t)) / (1 - exp(-K)), t = (q_max - q)(q - q_min) / range² (WSRender eq. 3)."""
    vec_n, mat_6n = wp.types.vector(n, real), wp.types.matrix((6, n), real)
    exp2 = elementary(real).exp2
    ZERO, ONE, FOUR, LOG2_E = real(0.0), real(1.0), real(4.0), real(1.4426950408889634)

    @wp.func
    def penalized(model: Any, q: vec_n, J: mat_6n):
        out = J
        K = model.penalty * LOG2_E
        scale = ONE / (ONE - exp2(-K))
        for i in range(n):
            width = model.upper[i] - model.lower[i]
            t = (model.upper[i] - q[i]) * (q[i] - model.lower[i]) / (width * width)
            p = (ONE - exp2(-FOUR * K * wp.max(t, ZERO))) * scale
            p = wp.where(model.limited[i] > ZERO, p, ONE)
            for r in range(6):
                out[r, i] *= p
        return out

    return penalized


def _torque_scaled(real, n: int):
    """Device function factory: columns of an (m, n) matrix times the largest joint efforts."""

    @factory
    def make(m: int):
        mat_mn = wp.types.matrix((m, n), real)

        @wp.func
        def torque_scaled(model: Any, A: mat_mn):
            out = A
            for r in range(m):
                for i in range(n):
                    out[r, i] *= model.torque[i]
            return out

        return torque_scaled

    return make


@factory
def _task_matrix(real, n: int, rows: tuple[int, ...]):
    """The chosen rows of J, linear ones divided by the characteristic length where there are angular ones too.

    Whole triads are taken in world axes, which changes no singular value; single rows mean base axes.
    """
    m = len(rows)
    IN_BASE_AXES, MIXED = in_base_axes(rows), len({r // 3 for r in rows}) == 2
    vec3 = wp.types.vector(3, real)
    ROW = wp.types.vector(m, wp.int32)(*rows)
    mat_6n, mat_mn = wp.types.matrix((6, n), real), wp.types.matrix((m, n), real)

    @wp.func
    def task_matrix(model: Any, J: mat_6n):
        B = J
        if wp.static(IN_BASE_AXES):
            for i in range(n):
                linear = model.base_axes * vec3(J[0, i], J[1, i], J[2, i])
                angular = model.base_axes * vec3(J[3, i], J[4, i], J[5, i])
                for r in range(3):
                    B[r, i] = linear[r]
                    B[3 + r, i] = angular[r]
        A = mat_mn()
        for r in range(m):
            if ROW[r] < wp.static(3 if MIXED else 0):
                A[r] = B[ROW[r]] * model.linear_scale
            else:
                A[r] = B[ROW[r]]
        return A

    return task_matrix


def _no_volume(real, n: int):
    mat_6n = wp.types.matrix((6, n), real)
    ZERO = real(0.0)

    @wp.func
    def no_volume(J: mat_6n):
        return ZERO

    return no_volume


def _without_noise_of_task(real, m: int, n: int):
    """Device function (volume, sigma) -> singular values of the task matrix, noise as exact zeros."""
    vec_m, regular = wp.types.vector(m, real), without_noise(real, m, n, m)

    @wp.func
    def without_noise_of_task(volume: real, sigma: vec_m):
        return regular(sigma)

    return without_noise_of_task


def _where_positive(real, m: int):
    """Device function (a, b) -> b where a > 0, else 0."""
    vec_m = wp.types.vector(m, real)
    ZERO = real(0.0)

    @wp.func
    def where_positive(a: vec_m, b: vec_m):
        out = vec_m()
        for i in range(m):
            out[i] = wp.where(a[i] > ZERO, b[i], ZERO)
        return out

    return where_positive


def _standard(real, n: int, rows: tuple[int, ...], torque) -> SimpleNamespace:
    m = len(rows)
    mat_6n, mat_nn, mat_mn = (wp.types.matrix(size, real) for size in ((6, n), (n, n), (m, n)))
    task_matrix = _task_matrix(real, n, rows)
    solve = inertia(real, n, tuple(range(n)), True).solve(m)

    @wp.func
    def unscaled(model: Any, A: mat_mn):
        return A

    scaled = torque(m) if torque else unscaled

    @wp.func
    def dynamic_matrix(model: Any, J: mat_6n, M: mat_nn):
        return scaled(model, solve(M, task_matrix(model, J)))

    return SimpleNamespace(
        kinematic_matrix=task_matrix,
        kinematic_shape=(m, n),
        dynamic_matrix=dynamic_matrix,
        dynamic_shape=(m, n),
        volume=_no_volume(real, n),
        kinematic=_without_noise_of_task(real, m, n),
        dynamic=_where_positive(real, m),
    )


def _table_1(real, n: int, rows: tuple[int, ...], torque) -> SimpleNamespace:
    """H = X X^T with X = L U^-T, where J = L Q and Q M = U V (L, U lower triangular; Q, V with orthonormal rows)."""
    m = len(rows)
    mat_6n, mat_nn, mat_mm = (wp.types.matrix(size, real) for size in ((6, n), (n, n), (m, m)))
    task_matrix = _task_matrix(real, n, rows)
    lower_factor, times_inertia = _lower_factor(real, m, n), _times_inertia(real, m, n)
    deficient = n < m  # no joint motions for most task motions: every index is 0
    ZERO, ONE = real(0.0), real(1.0)

    @wp.func
    def dynamic_matrix(model: Any, J: mat_6n, M: mat_nn):
        L, Q = lower_factor(task_matrix(model, J))
        U, _V = lower_factor(times_inertia(Q, M))
        # Rows of X with X Uᵀ = L, that is the matrix whose singular values are the inverses of those of M J⁺.
        X = mat_mm()
        for r in range(m):
            for c in range(m):
                value = L[r, c]
                for k in range(c):
                    value -= X[r, k] * U[c, k]
                X[r, c] = wp.where(U[c, c] > ZERO, value / wp.where(U[c, c] > ZERO, U[c, c], ONE), ZERO)
        return X

    return SimpleNamespace(
        kinematic_matrix=task_matrix,
        kinematic_shape=(m, n),
        dynamic_matrix=_no_matrix(real, n) if deficient else dynamic_matrix,
        dynamic_shape=(1, 1) if deficient else (m, m),
        volume=_no_volume(real, n),
        kinematic=_without_noise_of_task(real, m, n),
        dynamic=_zeros(real, m) if deficient else _where_positive(real, m),
    )


def _times_inertia(real, m: int, n: int):
    """Device function (A (m, n), M) -> A M, number by number, M being symmetric.

    Warp's product stays a loop where n is large, and the lane loop around it is then not vectorised.
    """
    mat_mn, mat_nn = wp.types.matrix((m, n), real), wp.types.matrix((n, n), real)

    @wp.func
    def times_inertia(A: mat_mn, M: mat_nn):
        product = mat_mn()
        for r in range(m):
            for i in range(n):
                product[r, i] = wp.dot(M[i], A[r])
        return product

    return times_inertia


def _lower_factor(real, m: int, n: int):
    """Device function A (m, n) -> (L lower triangular, Q orthonormal rows) with A = L Q, by Gram–Schmidt done twice."""
    mat_mn, mat_mm = wp.types.matrix((m, n), real), wp.types.matrix((m, m), real)
    ZERO, ONE = real(0.0), real(1.0)
    NEGLIGIBLE = real(1e-30 if real is wp.float32 else 1e-290)

    @wp.func
    def lower_factor(A: mat_mn):
        L = mat_mm()
        Q = A
        for r in range(m):
            for _again in range(2):
                for k in range(r):
                    along = wp.dot(Q[r], Q[k])
                    L[r, k] += along
                    Q[r] = Q[r] - Q[k] * along
            size = wp.sqrt(wp.dot(Q[r], Q[r]))
            L[r, r] = size
            Q[r] = Q[r] * wp.where(size > NEGLIGIBLE, ONE / wp.max(size, NEGLIGIBLE), ZERO)
        return L, Q

    return lower_factor


def _wsrender_code(real, n: int, rows: tuple[int, ...], torque) -> SimpleNamespace:
    mat_6n, mat_nn, vec6 = wp.types.matrix((6, n), real), wp.types.matrix((n, n), real), wp.types.vector(6, real)
    COUNT = min(6, n)
    FULL_RANK = n >= 6
    out_type = wp.types.vector(1 + COUNT, real)
    regular, times_inertia = without_noise(real, 6, n, 6), _times_inertia(real, 6, n)
    ONE, ZERO = real(1.0), real(0.0)

    @wp.func
    def kinematic_matrix(model: Any, J: mat_6n):
        return J

    @wp.func
    def dynamic_matrix(model: Any, J: mat_6n, M: mat_nn):
        return times_inertia(J, M)

    @wp.func
    def volume(J: mat_6n):
        a = J[0]
        b = J[1]
        c = J[2]
        aa = wp.dot(a, a)
        ab = wp.dot(a, b)
        ac = wp.dot(a, c)
        bb = wp.dot(b, b)
        bc = wp.dot(b, c)
        cc = wp.dot(c, c)
        # The program's determinant, rounding noise at singular postures included: its sixth root is in the tables.
        determinant = aa * (bb * cc - bc * bc) - ab * (ab * cc - bc * ac) + ac * (ab * bc - bb * ac)
        return wp.sqrt(wp.abs(determinant))

    @wp.func
    def kinematic(volume: real, sigma: vec6):
        six = regular(sigma)
        out = out_type()
        out[0] = volume
        for i in range(COUNT):
            out[1 + i] = six[i]
        return out

    @wp.func
    def dynamic(kinematic: out_type, sigma: vec6):
        out = out_type()
        determinant = ONE
        for i in range(COUNT):
            out[1 + i] = wp.where(kinematic[1 + i] > ZERO, sigma[i], ZERO)
            determinant *= out[1 + i]
        out[0] = wp.where(FULL_RANK, determinant, ZERO)
        return out

    return SimpleNamespace(
        kinematic_matrix=kinematic_matrix,
        kinematic_shape=(6, n),
        dynamic_matrix=dynamic_matrix,
        dynamic_shape=(6, n),
        volume=volume,
        kinematic=kinematic,
        dynamic=dynamic,
    )
