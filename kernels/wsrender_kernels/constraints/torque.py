"""Joints hold the arm and what it carries, at rest or while the tip accelerates in any direction."""

from typing import Any

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.kinematics import kinematics
from wsrender_kernels.loads import loads


@factory
def torque(real, n: int, sources: tuple[int, ...], plain: bool, rows: tuple[int, ...], size: int, offset: int):
    """Device function of the constraint; see the package.

    Its numbers: gravity in the world (3,) [m/s²], the acceleration [m/s²] in the ``rows`` of the task, the joints'
    limits back and forth (n,) each [N m or N], and `pack_inertia` of the chain with what it carries.
    """
    BACK, FORTH, BODIES = offset + 4, offset + 4 + n, offset + 4 + 2 * n
    vec_n, vec3, mat33 = wp.types.vector(n, real), wp.types.vector(3, real), wp.types.matrix((3, 3), real)
    forward = kinematics(real, n, sources, plain, True).forward
    loads_of = loads(real, n, sources, plain, rows, size, offset, BODIES)

    @wp.func
    def overloaded(model: Any, q: vec_n, tip: vec3, axes: mat33):
        _tip, _x, _y, _z, frames = forward(model.chain, q)
        pulls, more = loads_of(model, frames)
        admitted = wp.int32(1)
        for i in range(n):
            # Not a number, of a singular posture, is not within a limit.
            admitted = wp.where(more[i] + pulls[i] <= model.limits[BACK + i], admitted, 0)
            admitted = wp.where(more[i] - pulls[i] <= model.limits[FORTH + i], admitted, 0)
        return 1 - admitted

    return overloaded
