"""Force of the tip that the joints hold in every direction, or along one, without a moment and at rest."""

from typing import Any

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.gravity import gravity_pulls
from wsrender_kernels.task_rows import linear_rows


@factory
def force_radius(
    real, n: int, sources: tuple[int, ...], plain: bool, rows: tuple[int, ...], along: bool, size: int, offset: int
):
    """Device function of the index.

    Its numbers: gravity in the world (3,) [m/s²], the value at which it is cut [N], the joints' limits back and forth
    (n,) each [N m or N], where ``along`` a unit vector of the task's rows (m,), and `pack_inertia` of the chain.
    """
    m = len(rows)
    CUT, BACK, FORTH, DIRECTION = offset + 3, offset + 4, offset + 4 + n, offset + 4 + 2 * n
    weights = gravity_pulls(real, n, sources, plain, size, offset, DIRECTION + m * along)
    forward, rows_of = linear_rows(real, n, sources, plain, rows, m == 3 and not along)
    vec_n, vec3, ALONG, ZERO = wp.types.vector(n, real), wp.types.vector(3, real), along, real(0.0)

    @wp.func
    def radius(model: Any, q: vec_n):
        _axes, frames = forward(model, q)
        A = rows_of(model, frames, vec3())
        pulls = weights(model.limits, model.chain, frames)
        least = model.limits[CUT]
        for i in range(n):
            back = model.limits[BACK + i] - pulls[i]
            forth = model.limits[FORTH + i] + pulls[i]
            slack = wp.min(back, forth)
            force = ZERO
            part = ZERO
            if wp.static(ALONG):
                for r in range(m):
                    part += A[r, i] * model.limits[DIRECTION + r]
                force = wp.where(part > ZERO, forth, back) / wp.abs(part)
                part = wp.abs(part)
            else:
                for r in range(m):
                    part += A[r, i] * A[r, i]
                force = slack / wp.sqrt(part)
            least = wp.where(part > ZERO and force < least, force, least)
            least = wp.where(slack > ZERO, least, ZERO)
        return least

    return radius
