"""Torques by which gravity pulls at the joints of a chain."""

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.inertia import BODY_STRIDE
from wsrender_kernels.kinematics import JOINT_STRIDE, chain_type, frames_type


@factory
def gravity_pulls(real, n: int, sources: tuple[int, ...], plain: bool, size: int, gravity: int, bodies: int):
    """Device function ``(limits, chain, frames) -> (n,)`` [N m or N]: what the joints hold against is its negative.

    ``limits`` (size,): from ``gravity`` on, gravity in the world (3,) [m/s²], from ``bodies`` on `pack_inertia`.
    """
    L = len(sources)
    SOURCE = wp.types.vector(L, wp.int32)(*sources)
    STRIDE, B, BODY = JOINT_STRIDE, L * JOINT_STRIDE, BODY_STRIDE
    limits_type, vec_n, vec3 = wp.types.vector(size, real), wp.types.vector(n, real), wp.types.vector(3, real)
    axes_type, Chain, Frames = wp.types.matrix((L, 3), real), chain_type(real, L), frames_type(real, L)
    GRAVITY, BODIES, PLAIN = gravity, bodies, plain

    @wp.func
    def weights(limits: limits_type, chain: Chain, frames: Frames):
        """Torques by which gravity pulls at the joints, (n,)."""
        g = vec3()
        for k in range(3):
            for r in range(3):
                g[k] += chain[B + 3 * k + r] * limits[GRAVITY + r]
        pulls = axes_type()  # gravity in the frame of each joint
        for i in range(L):
            a = i * STRIDE
            y = chain[a] * g[1] + chain[a + 1] * g[2]
            z = chain[a] * g[2] - chain[a + 1] * g[1]
            x = g[0]
            g = vec3(frames.cosines[i] * x + frames.sines[i] * y, frames.cosines[i] * y - frames.sines[i] * x, z)
            pulls[i, 0] = g[0]
            pulls[i, 1] = g[1]
            pulls[i, 2] = g[2]
        torques = vec_n()
        h = vec3()  # first moment of all beyond a joint, about its origin
        for back in range(L):
            i = L - 1 - back
            a = i * STRIDE
            b = BODIES + i * BODY
            h = h + vec3(limits[b + 1], limits[b + 2], limits[b + 3])
            pull = h[0] * pulls[i, 1] - h[1] * pulls[i, 0]
            z = h[2]
            if wp.static(not PLAIN):
                pull = pull * chain[a + 8] + limits[b] * pulls[i, 2] * chain[a + 9]
                z = z + limits[b] * frames.slides[i]
            torques[SOURCE[i]] += pull
            x = frames.cosines[i] * h[0] - frames.sines[i] * h[1]
            y = frames.sines[i] * h[0] + frames.cosines[i] * h[1]
            h = vec3(x, chain[a] * y - chain[a + 1] * z, chain[a + 1] * y + chain[a] * z)
        return torques

    return weights
