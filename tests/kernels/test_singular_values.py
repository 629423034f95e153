"""Singular values of small matrices against NumPy's float64 ones."""

from functools import cache

import numpy as np
import pytest
import warp as wp
from hypothesis import given, settings
from hypothesis import strategies as st
from wsrender_kernels.options import LONG_OPTIONS, MODULE_OPTIONS
from wsrender_kernels.rotations import singular_values_of_lanes
from wsrender_kernels.singular_values import singular_values, without_noise

from wsrender.tolerances import TOLERANCES, epsilon

REAL = {"float32": wp.float32, "float64": wp.float64}
SHAPES = [(1, 4), (2, 2), (2, 6), (3, 2), (3, 3), (3, 6), (4, 6), (6, 4), (6, 6), (6, 7)]


@cache
def kernel_of(precision, m, n, graded):
    real = REAL[precision]
    values = singular_values(real, m, n, graded)
    mat, vec = wp.types.matrix((m, n), real), wp.types.vector(m, real)
    regular = without_noise(real, m, n, m)

    @wp.kernel(module="unique", module_options=MODULE_OPTIONS, enable_backward=False)
    def values_as_computed(A: wp.array(dtype=mat), out: wp.array(dtype=vec)):
        out[wp.tid()] = values(A[wp.tid()])

    @wp.kernel(module="unique", module_options=MODULE_OPTIONS, enable_backward=False)
    def values_without_noise(A: wp.array(dtype=mat), out: wp.array(dtype=vec)):
        out[wp.tid()] = regular(values(A[wp.tid()]))

    return values_as_computed if graded else values_without_noise


def evaluated(A, precision, graded=False, device="cpu"):
    _, m, n = A.shape
    real = REAL[precision]
    given_ = wp.array(A.astype(precision), dtype=wp.types.matrix((m, n), real), device=device)
    out = wp.empty(len(A), dtype=wp.types.vector(m, real), device=device)
    wp.launch(kernel_of(precision, m, n, graded), len(A), [given_], [out], device=device)
    return out.numpy()


def reference(A, precision):
    """Descending singular values (N, m) of the rounded matrices, zeros past the rank's bound min(m, n)."""
    sigma = np.linalg.svd(A.astype(precision).astype(np.float64), compute_uv=False)
    return np.pad(sigma, ((0, 0), (0, A.shape[1] - sigma.shape[1])))


def matrices(generator, m, n, count):
    """Random orthogonal factors around spectra that are apart, equal, nearly equal, nearly of rank 1, or partly 0."""
    rank = min(m, n)
    U = np.linalg.qr(generator.normal(size=(count, m, m)))[0][:, :, :rank]
    V = np.linalg.qr(generator.normal(size=(count, n, n)))[0][:, :, :rank]
    spectrum = generator.uniform(0.05, 1, (count, rank))
    kind = np.arange(count) % 6
    spectrum[kind == 1] = 1.0
    spectrum[kind == 2] = 1 + generator.normal(size=(count, rank))[kind == 2] * 1e-4
    spectrum[kind == 3, 1:] *= 10.0 ** generator.uniform(-8, -2, (int((kind == 3).sum()), 1))
    spectrum[kind == 4, -1] *= 10.0 ** generator.uniform(-8, -1, int((kind == 4).sum()))
    spectrum[kind == 5, -1] = 0.0
    scale = 10.0 ** generator.uniform(-3, 3, (count, 1, 1))
    return np.einsum("cij,cj,ckj->cik", U, spectrum, V) * scale


def assert_close(A, precision, device, graded=False):
    found, exact = evaluated(A, precision, graded, device), reference(A, precision)
    assert np.isfinite(found).all() and (found >= 0).all()
    # Rounding may swap equal values by an ulp.
    assert (np.diff(found, axis=1) <= 4 * epsilon(precision) * found[:, :1]).all()
    error = np.abs(found - exact) / np.maximum(exact[:, :1], np.finfo(np.float64).tiny)
    assert error.max() <= TOLERANCES[precision].singular_value
    return found


@pytest.mark.parametrize(("m", "n"), SHAPES)
def test_random_matrices(m, n, precision, device):
    A = matrices(np.random.default_rng(10 * m + n), m, n, 1200)
    found = assert_close(A, precision, device)
    assert (found[:, min(m, n) :] == 0).all()


@pytest.mark.parametrize(("m", "n"), [(3, 6), (6, 6)])
def test_products_are_accurate_near_singularities(m, n, precision, device):
    """The product, √det(A Aᵀ), without the square root of epsilon that det of A Aᵀ would leave."""
    A = matrices(np.random.default_rng(m), m, n, 600)
    found, exact = evaluated(A, precision, device=device), reference(A, precision)
    largest = np.maximum(exact[:, 0] ** m, np.finfo(np.float64).tiny)
    error = np.abs(np.prod(found.astype(np.float64), axis=1) - np.prod(exact, axis=1)) / largest
    assert error.max() <= 10 * TOLERANCES[precision].singular_value


def test_three_rows_err_by_some_roundings(precision, device):
    """Whatever the spectrum; worst where two small ones nearly agree: in float64 one in some 50,000 by 20 epsilon."""
    A = matrices(np.random.default_rng(0), 3, 6, 60_000)
    error = np.abs(evaluated(A, precision, device=device) - (exact := reference(A, precision)))
    most = {"float32": 16, "float64": 24}[precision]
    assert (error <= most * epsilon(precision) * exact[:, :1]).all()


def test_two_small_singular_values_that_agree(precision, device):
    """Nearly rank one, where H = A Aᵀ and its characteristic polynomial both lose the gap of the small eigenvalues.

    It then errs by epsilon or total² of it, whichever is less: the values by some epsilon^(3/4) at most, here 0.8.
    """
    generator = np.random.default_rng(1)
    small = 10 ** generator.uniform(-8, 0, 20_000)
    spectrum = np.stack([np.ones_like(small), small, small * (1 - 10 ** generator.uniform(-9, -1, 20_000))], axis=1)
    U = np.linalg.qr(generator.normal(size=(20_000, 3, 3)))[0]
    V = np.linalg.qr(generator.normal(size=(20_000, 6, 3)))[0]
    A = (U * spectrum[:, None]) @ V.transpose(0, 2, 1)
    error = np.abs(evaluated(A, precision, device=device) - (exact := reference(A, precision)))
    assert (error <= 1.5 * epsilon(precision) ** 0.75 * exact[:, :1]).all()


@pytest.mark.parametrize(("m", "n"), SHAPES)
def test_singular_matrices_have_exact_zeros(m, n, precision, device):
    generator = np.random.default_rng(m + 10 * n)
    A = generator.integers(-8, 9, (200, m, n)).astype(np.float64)
    A[:50] = 0
    A[50:100, m - 1] = 0
    A[100:150, :, 1:] = 0
    A[150:, m - 1] = 2 * A[150:, 0] if m > 1 else 0
    found = assert_close(A, precision, device)
    assert (found[:50] == 0).all()
    rank = np.linalg.matrix_rank(A)
    assert (np.count_nonzero(found, axis=1) == rank).all()


def hard_matrices(m, n):
    """24,000 matrices (m, n): see `test_rotations_err_by_some_roundings`."""
    generator = np.random.default_rng(100 * m + n)
    shape = (4000, m, n)
    sparse = generator.normal(size=shape) * (generator.uniform(size=shape) < 0.35)
    whole = generator.integers(-1, 2, shape).astype(float)
    uneven_rows = generator.normal(size=shape) * 10.0 ** generator.uniform(-4, 0, (4000, m, 1))
    uneven_columns = generator.normal(size=shape) * 10.0 ** generator.uniform(-4, 0, (4000, 1, n))
    nearly_alike = generator.normal(size=(4000, 1, n)) + 10.0 ** generator.uniform(-6, 0, (4000, 1, 1)) * sparse
    return np.concatenate([matrices(generator, m, n, 4000), sparse, whole, uneven_rows, uneven_columns, nearly_alike])


def assert_some_roundings(found, A, precision):
    exact = reference(A, precision)
    roundings = 16 if precision == "float32" else 64
    assert (np.abs(found - exact) <= roundings * epsilon(precision) * exact[:, :1]).all()


@pytest.mark.parametrize("graded", [False, True])
@pytest.mark.parametrize(("m", "n"), [(4, 7), (6, 4), (6, 6), (6, 7), (6, 12)])
def test_rotations_err_by_some_roundings(m, n, graded, precision, device):
    """Dependent rows and columns, zeros, lengths of many orders of magnitude.

    In float64 the bound is NumPy's: against 160 bits it errs by up to 51 epsilon where values nearly agree, ours by 8.
    """
    A = hard_matrices(m, n)
    assert_some_roundings(evaluated(A, precision, graded, device), A, precision)


LANES = 32


@cache
def lanes_kernel(precision, m, n, graded):
    """Kernel: singular values of LANES matrices a task, by lane loops as in a sweep on the CPU."""
    real = REAL[precision]
    values_of_lanes = singular_values_of_lanes(real, m, n, graded, LANES)
    vector = wp.types.vector(m * n * LANES, real)

    @wp.kernel(module="unique", module_options=LONG_OPTIONS, enable_backward=False)
    def of_lanes(A: wp.array2d(dtype=real), out: wp.array2d(dtype=real)):
        lanes = vector()
        for k in range(len(lanes)):
            lanes[k] = A[wp.tid(), k]
        values = values_of_lanes(lanes)
        for k in range(len(values)):
            out[wp.tid(), k] = values[k]

    return of_lanes


@pytest.mark.parametrize("graded", [False, True])
@pytest.mark.parametrize(("m", "n"), [(4, 7), (5, 7), (6, 1), (6, 3), (6, 6), (6, 12)])
def test_lane_loops_as_on_a_cpu(m, n, graded, precision):
    A = hard_matrices(m, n)
    tasks = len(A) // LANES
    assert len(A) == tasks * LANES
    side_by_side = A.reshape(tasks, LANES, m * n).swapaxes(1, 2).reshape(tasks, -1)
    given_ = wp.array(side_by_side.astype(precision), dtype=REAL[precision], device="cpu")
    out = wp.empty((tasks, m * LANES), dtype=REAL[precision], device="cpu")
    wp.launch(lanes_kernel(precision, m, n, graded), tasks, [given_], [out], device="cpu")
    found = out.numpy().reshape(tasks, m, LANES).swapaxes(1, 2).reshape(-1, m)
    assert_some_roundings(found, A, precision)


@pytest.mark.parametrize("m", [3, 6])
def test_graded_columns_keep_their_small_singular_values(m, precision, device):
    """Columns of J M^-1 differ by 1e5: the smallest singular value is still that of the well-conditioned part."""
    generator = np.random.default_rng(m)
    order = generator.permuted(np.tile(np.arange(6), (500, 1)), axis=1)
    A = generator.normal(size=(500, m, 6)) * 10.0 ** np.linspace(0, 4, 6)[order][:, None, :]
    found, exact = evaluated(A, precision, True, device), reference(A, precision)
    moderate = np.linalg.cond(A / np.linalg.norm(A, axis=1, keepdims=True)) < 100
    assert moderate.sum() > 50
    error = np.abs(found / exact - 1)[moderate].max(axis=0)
    assert error.max() <= {"float32": 1e-3, "float64": 1e-10}[precision]


CASES = settings(derandomize=True, max_examples=60, deadline=None, database=None)
entry = st.one_of(
    st.sampled_from([0.0, 1.0, -1.0, 0.5, 1e-3, 1e3]),
    st.floats(-1e3, 1e3).filter(lambda v: v == 0 or abs(v) > 1e-3),
)


@CASES
@given(st.lists(entry, min_size=18, max_size=18))
def test_three_rows_of_any_numbers(entries):
    A = np.array(entries).reshape(1, 3, 6)
    for precision in REAL:
        assert_close(A, precision, "cpu")


@CASES
@given(st.lists(entry, min_size=36, max_size=36))
def test_six_rows_of_any_numbers(entries):
    A = np.array(entries).reshape(1, 6, 6)
    for precision in REAL:
        assert_close(A, precision, "cpu")
