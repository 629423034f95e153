"""Rows of A M^-1 against NumPy's solutions in float64."""

import numpy as np
import pytest
import warp as wp
from wsrender_kernels.inertia import inertia
from wsrender_kernels.options import MODULE_OPTIONS

from wsrender.tolerances import epsilon

REAL = {"float32": wp.float32, "float64": wp.float64}


@pytest.mark.parametrize(("m", "n"), [(1, 1), (3, 2), (6, 2), (3, 6), (6, 7), (3, 12), (6, 12)])
def test_solutions_err_by_the_condition_of_the_inertia_matrix(m, n, precision, device):
    """By some n epsilon times it (Higham 2002, 10.1): found 1.0 times that for n = 1, 0.44 for 2, 0.03 for 12."""
    generator = np.random.default_rng(10 * m + n)
    Q = np.linalg.qr(generator.normal(size=(500, n, n)))[0]
    M = np.einsum("cij,cj,ckj->cik", Q, 10.0 ** generator.uniform(-2, 0, (500, n)), Q)
    M = ((M + M.swapaxes(1, 2)) / 2).astype(precision)
    A = generator.normal(size=(500, m, n)).astype(precision)
    real = REAL[precision]
    square, rows = wp.types.matrix((n, n), real), wp.types.matrix((m, n), real)
    solve = inertia(real, n, tuple(range(n)), True).solve(m)

    @wp.kernel(module="unique", module_options=MODULE_OPTIONS, enable_backward=False)
    def solutions(M: wp.array(dtype=square), A: wp.array(dtype=rows), X: wp.array(dtype=rows)):
        X[wp.tid()] = solve(M[wp.tid()], A[wp.tid()])

    X = wp.empty(500, dtype=rows, device=device)
    given = [wp.array(M, dtype=square, device=device), wp.array(A, dtype=rows, device=device)]
    wp.launch(solutions, 500, given, [X], device=device)
    exact = np.linalg.solve(M.astype(np.float64), A.swapaxes(1, 2).astype(np.float64)).swapaxes(1, 2)
    error = np.linalg.norm(X.numpy() - exact, axis=2) / np.linalg.norm(exact, axis=2)
    worst = (error / (n * epsilon(precision) * np.linalg.cond(M.astype(np.float64))[:, None])).max()
    assert worst < 2, worst
