"""What a function of the configuration and the tip's pose admits: where it is 0 or more."""

from typing import Any

import warp as wp

from wsrender_kernels.factories import factory


@factory
def expression(margin: Any, real, own, n: int, options: int, size: int, offset: int):
    """Device function of the constraint; see the package.

    ``margin(inputs, inputs) -> (1,)``, in the precision ``own``, of ``inputs``: q (n,), the tip's position in the world
    (3,), its axes, three numbers each (9,), and options. The numbers from ``offset`` on: where positions are counted
    from (3,), and the options; then what ``real`` may have left of each.
    """
    limits_type, vec_n = wp.types.vector(size, real), wp.types.vector(n, real)
    vec3, mat33 = wp.types.vector(3, real), wp.types.matrix((3, 3), real)
    inputs_type = wp.types.vector(n + 12 + options, own)
    ZERO, POSITION, AXES, OPTIONS, LEFT = own(0.0), n, n + 3, n + 12, 3 + options

    @wp.func
    def number(limits: limits_type, k: wp.int32):
        return own(limits[offset + k]) + own(limits[offset + LEFT + k])

    @wp.func
    def violated(limits: limits_type, q: vec_n, tip: vec3, axes: mat33):
        inputs = inputs_type()
        for i in range(n):
            inputs[i] = own(q[i])
        for r in range(3):
            inputs[POSITION + r] = own(tip[r]) + number(limits, r)
            for k in range(3):
                inputs[AXES + 3 * k + r] = own(axes[r, k])
        for k in range(options):
            inputs[OPTIONS + k] = number(limits, 3 + k)
        found = margin(inputs, inputs)
        return wp.where(found[0] >= ZERO, 0, 1)

    return violated
