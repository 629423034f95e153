"""Products and principal axes of small matrices, the same to the last bit on every machine.

BLAS and LAPACK, which ``@`` and ``numpy.linalg`` call, round by the kernels of the processor that they find: the hash
of a chain, by which results are found again, must not.
"""

import math
from functools import reduce

import numpy as np
from numpy.typing import ArrayLike


def product(*factors: ArrayLike) -> np.ndarray:
    """Product of two or more stacks of matrices (…, I, J), from the left."""
    return reduce(lambda A, B: np.einsum("...ij,...jk->...ik", A, B), map(np.asarray, factors))


def applied(A: ArrayLike, x: ArrayLike) -> np.ndarray:
    """Matrices (…, I, J) times vectors (…, J)."""
    return np.einsum("...ij,...j->...i", np.asarray(A), np.asarray(x))


def principal_axes(A: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues (3,), ascending, and eigenvectors, columns (3, 3), of a symmetric matrix (3, 3).

    By cyclic Jacobi rotations (Golub and Van Loan, Matrix Computations, section 8.5). Raises LinAlgError for numbers
    that are not finite.
    """
    A, V = np.array(A, float), np.eye(3)
    if not np.isfinite(A).all():
        raise np.linalg.LinAlgError("a matrix has numbers that are not finite")
    rounding, least = np.finfo(float).eps / 2, 2.0**-70 * np.abs(A).max()
    turned = True
    while turned:  # what is left beside the diagonal is squared by each round
        turned = False
        for p, q in ((0, 1), (0, 2), (1, 2)):
            if abs(A[p, q]) > max(rounding * math.sqrt(abs(A[p, p])) * math.sqrt(abs(A[q, q])), least):
                turn = _turn(A[p, p], A[q, q], A[p, q], p, q)
                A, V, turned = product(turn.T, A, turn), product(V, turn), True
            A[p, q] = A[q, p] = 0.0
    order = np.argsort(np.diag(A), kind="stable")
    return np.diag(A)[order], V[:, order]


def _turn(pp: float, qq: float, pq: float, p: int, q: int) -> np.ndarray:
    """The turn (3, 3) in the plane of axes ``p`` and ``q`` that makes their element ``pq`` 0."""
    with np.errstate(over="ignore"):
        cot = (qq - pp) / (2.0 * pq)
        tan = math.copysign(1.0, cot) / (abs(cot) + np.sqrt(cot * cot + 1.0))
    turn, c = np.eye(3), 1.0 / math.sqrt(tan * tan + 1.0)
    turn[p, p] = turn[q, q] = c
    turn[p, q], turn[q, p] = tan * c, -tan * c
    return turn
