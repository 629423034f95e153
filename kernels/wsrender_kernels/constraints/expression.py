"""What a function of the configuration and the tip's pose admits: where it is 0 or more."""

from typing import Any

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.gravity import gravity_pulls
from wsrender_kernels.inertia import inertia
from wsrender_kernels.kinematics import JOINT_STRIDE, frames_type, kinematics
from wsrender_kernels.loads import bodies_among


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


@factory
def expression_of_chain(
    margin: Any,
    real,
    own,
    n: int,
    sources: tuple[int, ...],
    plain: bool,
    asks: tuple[str, ...],
    options: int,
    size: int,
    offset: int,
):
    """The same of the whole chain, ``(model, q, tip, axes)``; of the inputs of `inputs_of_chain`."""
    inputs_of = inputs_of_chain(real, own, n, sources, plain, asks, options, size, offset)
    forward = kinematics(real, n, sources, plain, True).forward
    vec_n, vec3, mat33 = wp.types.vector(n, real), wp.types.vector(3, real), wp.types.matrix((3, 3), real)
    ZERO = own(0.0)

    @wp.func
    def violated(model: Any, q: vec_n, tip: vec3, axes: mat33):
        _tip, _x, _y, _z, frames = forward(model.chain, q)
        inputs = inputs_of(model, q, tip, axes, frames)
        found = margin(inputs, inputs)
        return wp.where(found[0] >= ZERO, 0, 1)

    return violated


@factory
def inputs_of_chain(
    real,
    own,
    n: int,
    sources: tuple[int, ...],
    plain: bool,
    asks: tuple[str, ...],
    options: int,
    size: int,
    offset: int,
):
    """Device function ``(model, q, tip, axes, frames) -> inputs``: those of `expression`, and then what is asked for.

    ``frames``: of every joint its position (3,) and axes, as those of the tip; ``J`` (6 n,), row by row; ``g`` (n,);
    ``limits`` (3 n,): lower, upper, of effort; ``M`` (n n,), row by row. The numbers go on with those limits, gravity
    in the world (3,), of every joint cosine and sine of the angle by which its frame is turned back from that of
    `forward`, and `pack_inertia`.
    """
    L, LEFT = len(sources), 3 + options
    LIMITS = offset + 2 * LEFT
    GRAVITY = LIMITS + 3 * n
    TURNS = GRAVITY + 3
    BODIES = TURNS + 2 * L
    sizes = {"frames": 12 * L, "J": 6 * n, "g": n, "limits": 3 * n, "M": n * n}
    starts, at = dict.fromkeys(sizes, 0), n + 12 + options
    for name in asks:
        starts[name], at = at, at + sizes[name]
    AT_FRAMES, AT_J, AT_G, AT_LIMITS, AT_M = starts.values()
    ASKS_FRAMES, ASKS_J, ASKS_G, ASKS_LIMITS, ASKS_M = (name in asks for name in sizes)
    jacobian = kinematics(real, n, sources, plain, True).jacobian
    inertia_matrix, bodies_of = inertia(real, n, sources, plain).inertia_matrix, bodies_among(real, L, size, BODIES)
    weights = gravity_pulls(real, n, sources, plain, size, GRAVITY, BODIES)
    vec_n, vec3, mat33 = wp.types.vector(n, real), wp.types.vector(3, real), wp.types.matrix((3, 3), real)
    inputs_type, own3, Frames = wp.types.vector(at, own), wp.types.vector(3, own), frames_type(real, L)
    POSITION, AXES, OPTIONS, STRIDE, B = n, n + 3, n + 12, JOINT_STRIDE, L * JOINT_STRIDE

    @wp.func
    def inputs_of(model: Any, q: vec_n, tip: vec3, axes: mat33, frames: Frames):
        inputs = inputs_type()
        for i in range(n):
            inputs[i] = own(q[i])
        origin = own3()
        for r in range(3):
            origin[r] = own(model.limits[offset + r]) + own(model.limits[offset + LEFT + r])
            inputs[POSITION + r] = own(tip[r]) + origin[r]
            for k in range(3):
                inputs[AXES + 3 * k + r] = own(axes[r, k])
        for k in range(options):
            inputs[OPTIONS + k] = own(model.limits[offset + 3 + k]) + own(model.limits[offset + LEFT + 3 + k])
        if wp.static(ASKS_FRAMES):
            place = vec3(model.chain[B + 9], model.chain[B + 10], model.chain[B + 11])
            x = vec3(model.chain[B], model.chain[B + 1], model.chain[B + 2])
            y = vec3(model.chain[B + 3], model.chain[B + 4], model.chain[B + 5])
            z = vec3(model.chain[B + 6], model.chain[B + 7], model.chain[B + 8])
            for i in range(L):
                a = i * STRIDE
                place = place + x * model.chain[a + 2] + y * model.chain[a + 3] + z * model.chain[a + 4]
                sine = frames.sines[i]
                cosine = frames.cosines[i]
                before_x = vec3(frames.x_before[i, 0], frames.x_before[i, 1], frames.x_before[i, 2])
                before_y = vec3(frames.y_before[i, 0], frames.y_before[i, 1], frames.y_before[i, 2])
                x = before_x * cosine + before_y * sine
                y = before_y * cosine - before_x * sine
                z = vec3(frames.Z[i, 0], frames.Z[i, 1], frames.Z[i, 2])
                place = place + z * frames.slides[i]
                c = model.limits[TURNS + 2 * i]
                s = model.limits[TURNS + 2 * i + 1]
                for r in range(3):
                    inputs[AT_FRAMES + 12 * i + r] = own(place[r]) + origin[r]
                    inputs[AT_FRAMES + 12 * i + 3 + r] = own(x[r] * c - y[r] * s)
                    inputs[AT_FRAMES + 12 * i + 6 + r] = own(x[r] * s + y[r] * c)
                    inputs[AT_FRAMES + 12 * i + 9 + r] = own(z[r])
        if wp.static(ASKS_J):
            J = jacobian(model.chain, frames)
            for r in range(6):
                for i in range(n):
                    inputs[AT_J + n * r + i] = own(J[r, i])
        if wp.static(ASKS_G):
            pulls = weights(model.limits, model.chain, frames)
            for i in range(n):
                inputs[AT_G + i] = -own(pulls[i])
        if wp.static(ASKS_LIMITS):
            for k in range(wp.static(3 * n)):
                inputs[AT_LIMITS + k] = own(model.limits[LIMITS + k])
        if wp.static(ASKS_M):
            M = inertia_matrix(model.chain, bodies_of(model.limits), frames)
            for i in range(n):
                for j in range(n):
                    inputs[AT_M + n * i + j] = own(M[i, j])
        return inputs

    return inputs_of
