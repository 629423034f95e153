"""Largest singular value of the tip's linear rows times a weight of each joint."""

from typing import Any

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.singular_values import singular_values
from wsrender_kernels.task_rows import linear_rows


@factory
def weighted_norm(
    real, n: int, sources: tuple[int, ...], plain: bool, rows: tuple[int, ...], squared: bool, size: int, offset: int
):
    """Device function of an index, the value or its square; its numbers: the weights (n,)."""
    m = len(rows)
    forward, rows_of = linear_rows(real, n, sources, plain, rows, m == 3)
    values, SQUARED = singular_values(real, m, n, True), squared
    vec_n, vec3 = wp.types.vector(n, real), wp.types.vector(3, real)

    @wp.func
    def norm(model: Any, q: vec_n):
        _axes, frames = forward(model, q)
        A = rows_of(model, frames, vec3())
        for i in range(n):
            for r in range(m):
                A[r, i] *= model.limits[offset + i]
        sigma = values(A)
        largest = sigma[0]
        if wp.static(SQUARED):
            largest = largest * largest
        return largest

    return norm
