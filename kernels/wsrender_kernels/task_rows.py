"""The linear rows of a task, in base axes, of the Jacobian of a chain."""

from typing import Any

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.kinematics import frames_type, kinematics


@factory
def linear_rows(real, n: int, sources: tuple[int, ...], plain: bool, rows: tuple[int, ...], whole: bool):
    """Device functions ``forward(model, q) -> axes of the tip in the world, frames`` and ``rows_of``.

    ``rows_of(model, frames, lever) -> (m, n)``: of the point ``lever`` (3,) [m] from the tip, in the world. ``whole``:
    all three, in any axes, of the tip itself, for what no rotation of them changes.
    """
    kin = kinematics(real, n, sources, plain, not whole)
    forward_of, jacobian, m = kin.forward, kin.jacobian, len(rows)
    vec3, vec_n = kin.vec3, kin.vec_n
    rows_type, Frames = wp.types.matrix((m, n), real), frames_type(real, len(sources))
    ROWS = wp.types.vector(m, wp.int32)(*rows)

    @wp.func
    def forward(model: Any, q: vec_n):
        _tip, x, y, z, frames = forward_of(model.chain, q)
        return wp.matrix_from_cols(x, y, z), frames

    @wp.func
    def in_any_axes(model: Any, frames: Frames, lever: vec3):
        J = jacobian(model.chain, frames)
        A = rows_type()
        for r in range(m):
            for c in range(n):
                A[r, c] = J[r, c]
        return A

    @wp.func
    def in_base_axes(model: Any, frames: Frames, lever: vec3):
        J = jacobian(model.chain, frames)
        A = rows_type()
        for c in range(n):
            v = vec3(J[0, c], J[1, c], J[2, c]) + wp.cross(vec3(J[3, c], J[4, c], J[5, c]), lever)
            for r in range(m):
                for k in range(3):
                    A[r, c] += model.base_axes[ROWS[r], k] * v[k]
        return A

    return forward, in_any_axes if whole else in_base_axes
