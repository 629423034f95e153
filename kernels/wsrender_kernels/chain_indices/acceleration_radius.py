"""Acceleration of the tip that the joints' torques give in every direction, or along one, from rest."""

from typing import Any

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.gravity import gravity_pulls
from wsrender_kernels.inertia import inertia
from wsrender_kernels.loads import bodies_among
from wsrender_kernels.polytopes import largest_ball, longest_ray
from wsrender_kernels.task_rows import linear_rows


@factory
def acceleration_radius(
    real, n: int, sources: tuple[int, ...], plain: bool, rows: tuple[int, ...], along: bool, size: int, offset: int
):
    """Device function of the index (Yoshikawa 1985; Bowling and Khatib 2005).

    Its numbers: gravity in the world (3,) [m/s²], the joints' limits back and forth (n,) each [N m or N], where
    ``along`` a unit vector of the task's rows (m,), and `pack_inertia` of the chain.
    """
    m = len(rows)
    BACK, FORTH, DIRECTION = offset + 3, offset + 3 + n, offset + 3 + 2 * n
    BODIES = DIRECTION + m * along
    weights = gravity_pulls(real, n, sources, plain, size, offset, BODIES)
    dyn, bodies_of = inertia(real, n, sources, plain), bodies_among(real, len(sources), size, BODIES)
    inertia_matrix, solve = dyn.inertia_matrix, dyn.solve(m)
    forward, rows_of = linear_rows(real, n, sources, plain, rows, m == 3 and not along)
    ball, ray = largest_ball(real, m, n), longest_ray(real, m, n)
    vec_n, vec_m, vec3 = wp.types.vector(n, real), wp.types.vector(m, real), wp.types.vector(3, real)
    ALONG, HALF = along, real(0.5)

    @wp.func
    def radius(model: Any, q: vec_n):
        _axes, frames = forward(model, q)
        A = solve(inertia_matrix(model.chain, bodies_of(model.limits), frames), rows_of(model, frames, vec3()))
        pulls = weights(model.limits, model.chain, frames)
        most = vec_n()
        shift = vec_m()
        for i in range(n):
            back = model.limits[BACK + i]
            forth = model.limits[FORTH + i]
            most[i] = HALF * (forth + back)
            for r in range(m):
                shift[r] += A[r, i] * (HALF * (forth - back) + pulls[i])
        if wp.static(ALONG):
            direction = vec_m()
            for r in range(m):
                direction[r] = model.limits[DIRECTION + r]
            return ray(A, most, shift, direction)
        else:
            return ball(A, most, shift)

    return radius
