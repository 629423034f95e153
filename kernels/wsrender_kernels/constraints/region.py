"""The tip stays in a box, a ball and a half-space."""

import warp as wp

from wsrender_kernels.factories import factory


@factory
def region(real, n: int, size: int, offset: int):
    """Device function of the constraint; see the package.

    Its numbers: lower and upper corner of the box; centre and squared radius of the ball; normal and offset. Of a shape
    that is not asked for they are infinite.
    """
    limits_type, vec_n = wp.types.vector(size, real), wp.types.vector(n, real)
    vec3, mat33 = wp.types.vector(3, real), wp.types.matrix((3, 3), real)
    UPPER, CENTER, RADIUS, NORMAL, PLANE = offset + 3, offset + 6, offset + 9, offset + 10, offset + 13
    LOWER = offset

    @wp.func
    def inside(limits: limits_type, q: vec_n, tip: vec3, axes: mat33):
        apart = real(0.0)
        along = real(0.0)
        violated = wp.int32(0)
        for k in range(3):
            violated = wp.where(tip[k] < limits[LOWER + k], 1, violated)
            violated = wp.where(tip[k] > limits[UPPER + k], 1, violated)
            away = tip[k] - limits[CENTER + k]
            apart += away * away
            along += limits[NORMAL + k] * tip[k]
        violated = wp.where(apart > limits[RADIUS], 1, violated)
        return wp.where(along < limits[PLANE], 1, violated)

    return inside
