"""How much of their torque limits the joints have left, at rest or while the tip accelerates in any direction."""

from typing import Any

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.kinematics import kinematics
from wsrender_kernels.loads import loads


@factory
def torque_margin(real, n: int, sources: tuple[int, ...], plain: bool, rows: tuple[int, ...], size: int, offset: int):
    """Device function of the index; its numbers are those of the constraint `torque`."""
    BACK, FORTH, BODIES = offset + 4, offset + 4 + n, offset + 4 + 2 * n
    vec_n, ONE = wp.types.vector(n, real), real(1.0)
    forward = kinematics(real, n, sources, plain, True).forward
    loads_of = loads(real, n, sources, plain, rows, size, offset, BODIES)

    @wp.func
    def margin(model: Any, q: vec_n):
        _tip, _x, _y, _z, frames = forward(model.chain, q)
        pulls, more = loads_of(model, frames)
        least = ONE
        for i in range(n):
            back = ONE - (more[i] + pulls[i]) / model.limits[BACK + i]
            forth = ONE - (more[i] - pulls[i]) / model.limits[FORTH + i]
            # Not a number, of a singular posture, is cut too.
            least = wp.min(least, wp.where(back > -ONE, back, -ONE))
            least = wp.min(least, wp.where(forth > -ONE, forth, -ONE))
        return least

    return margin
