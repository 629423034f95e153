"""The tip's axis stays near a direction, or its rotation near another."""

import warp as wp

from wsrender_kernels.factories import factory


@factory
def orientation(real, n: int, size: int, offset: int):
    """Device function of the constraint; see the package.

    Its numbers: up to three unit vectors in the tip's frame, and as many in the world, columns of (3, 3) each; the
    largest sum of the squares of their distances.
    """
    limits_type, vec_n = wp.types.vector(size, real), wp.types.vector(n, real)
    vec3, mat33 = wp.types.vector(3, real), wp.types.matrix((3, 3), real)
    TOWARD, LARGEST = offset + 9, offset + 18

    @wp.func
    def turned(limits: limits_type, q: vec_n, tip: vec3, axes: mat33):
        apart = real(0.0)
        for r in range(3):
            for c in range(3):
                away = -limits[TOWARD + 3 * r + c]
                for k in range(3):
                    away += axes[r, k] * limits[offset + 3 * k + c]
                apart += away * away
        return wp.where(apart <= limits[LARGEST], 0, 1)

    return turned
