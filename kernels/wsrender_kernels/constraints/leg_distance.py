"""The links of two legs of a mechanism keep a distance."""

import warp as wp

from wsrender_kernels.factories import factory


@factory
def leg_distance(real, n: int, size: int, offset: int):
    """Device function of the constraint; see the package. Its number: the square of the least distance [m²]."""
    limits_type, vec3 = wp.types.vector(size, real), wp.types.vector(3, real)
    ONE, ZERO = real(1.0), real(0.0)
    TINY = real(1e-30 if real is wp.float32 else 1e-200)

    @wp.func
    def between(w: vec3, u: vec3, v: vec3, s: real, a: real, b: real, c: real, d: real, e: real):
        t = wp.min(wp.max((b * s + e) / wp.max(c, TINY), ZERO), ONE)
        near = wp.min(wp.max((b * t - d) / wp.max(a, TINY), ZERO), ONE)
        gap = w + near * u - t * v
        return wp.dot(gap, gap)

    @wp.func
    def closer(limits: limits_type, p: vec3, p_end: vec3, q: vec3, q_end: vec3):
        """By the square of the least distance of two segments (Ericson 2005, 5.1.9)."""
        u = p_end - p
        v = q_end - q
        w = p - q
        a = wp.dot(u, u)
        b = wp.dot(u, v)
        c = wp.dot(v, v)
        d = wp.dot(u, w)
        e = wp.dot(v, w)
        determinant = a * c - b * b
        s = wp.min(wp.max((b * e - c * d) / wp.max(determinant, TINY), ZERO), ONE)
        least = wp.min(between(w, u, v, ZERO, a, b, c, d, e), between(w, u, v, ONE, a, b, c, d, e))
        least = wp.min(least, between(w, u, v, s, a, b, c, d, e))
        return wp.where(least >= limits[offset], 0, 1)

    return closer
