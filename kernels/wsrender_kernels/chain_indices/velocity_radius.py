"""Speed of the tip that the joints' speeds allow in every direction, or along one."""

from typing import Any

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.polytopes import largest_ball, longest_ray
from wsrender_kernels.task_rows import linear_rows


@factory
def velocity_radius(
    real, n: int, sources: tuple[int, ...], plain: bool, rows: tuple[int, ...], along: bool, size: int, offset: int
):
    """Device function of the index (Yoshikawa 1985; Chiacchio et al. 1997).

    Its numbers: the joints' largest speeds (n,) [rad/s or m/s], and where ``along``, a unit vector of the task's rows.
    """
    m = len(rows)
    whole = m == 3 and not along
    forward, rows_of = linear_rows(real, n, sources, plain, rows, whole)
    ball, ray = largest_ball(real, m, n), longest_ray(real, m, n)
    vec_n, vec_m, vec3, ALONG, DIRECTION = (
        wp.types.vector(n, real), wp.types.vector(m, real), wp.types.vector(3, real), along, offset + n,
    )  # fmt: skip

    @wp.func
    def radius(model: Any, q: vec_n):
        _axes, frames = forward(model, q)
        A = rows_of(model, frames, vec3())
        most = vec_n()
        for i in range(n):
            most[i] = model.limits[offset + i]
        if wp.static(ALONG):
            direction = vec_m()
            for r in range(m):
                direction[r] = model.limits[DIRECTION + r]
            return ray(A, most, vec_m(), direction)
        else:
            return ball(A, most, vec_m())

    return radius
