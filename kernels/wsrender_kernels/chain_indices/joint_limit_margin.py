"""How far the joints are from their limits, as a share of their ranges."""

from typing import Any

import warp as wp

from wsrender_kernels.factories import factory


@factory
def joint_limit_margin(real, n: int, sources: tuple[int, ...], plain: bool, size: int, offset: int):
    """Device function of the index; its numbers: lower and upper limits, and 1 / range or 0 where none counts."""
    vec_n = wp.types.vector(n, real)
    UPPER, PER_RANGE = offset + n, offset + 2 * n
    ZERO, HALF = real(0.0), real(0.5)

    @wp.func
    def margin(model: Any, q: vec_n):
        least = HALF
        for i in range(n):
            nearer = wp.min(q[i] - model.limits[offset + i], model.limits[UPPER + i] - q[i])
            share = nearer * model.limits[PER_RANGE + i]
            least = wp.min(least, wp.where(model.limits[PER_RANGE + i] > ZERO, share, HALF))
        return wp.max(least, ZERO)

    return margin
