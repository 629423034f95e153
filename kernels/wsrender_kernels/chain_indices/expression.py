"""An index of users: a function of the configuration, the tip's pose and the chain."""

from typing import Any

import warp as wp

from wsrender_kernels.constraints.expression import inputs_of_chain
from wsrender_kernels.factories import factory
from wsrender_kernels.kinematics import kinematics


@factory
def expression(
    real,
    n: int,
    sources: tuple[int, ...],
    plain: bool,
    function: Any,
    own,
    asks: tuple[str, ...],
    options: int,
    size: int,
    offset: int,
):
    """Device function of the index ``function(inputs, inputs) -> (1,)``, in the precision ``own``.

    Inputs and numbers are those of `inputs_of_chain`.
    """
    inputs_of = inputs_of_chain(real, own, n, sources, plain, asks, options, size, offset)
    forward = kinematics(real, n, sources, plain, True).forward
    vec_n, mat33 = wp.types.vector(n, real), wp.types.matrix((3, 3), real)

    @wp.func
    def value(model: Any, q: vec_n):
        tip, x, y, z, frames = forward(model.chain, q)
        axes = mat33(x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2])
        inputs = inputs_of(model, q, tip, axes, frames)
        found = function(inputs, inputs)
        return real(found[0])

    return value
