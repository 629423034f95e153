"""Kernels that return configurations and kinematics sample by sample, one thread each, instead of accumulating."""

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.inertia import inertia
from wsrender_kernels.kinematics import kinematics
from wsrender_kernels.model import model_type
from wsrender_kernels.options import MODULE_OPTIONS
from wsrender_kernels.sampling import LANES, sample_space, sampling


@factory
def configuration_kernel(real, n: int, method: str) -> wp.Kernel:
    """Kernel: configurations ``q_out`` (N, n) of the samples with these 64-bit indices (N,)."""
    sampler = sampling(real, n, method)
    prepare, draw = sampler.prepare, sampler.draw
    Space = sample_space(real, n)
    LANE_MASK = wp.int64(LANES - 1)

    @wp.kernel(module="unique", module_options=MODULE_OPTIONS, enable_backward=False)
    def configurations(
        # in
        space: Space,
        indices: wp.array(dtype=wp.int64),
        # out
        q_out: wp.array2d(dtype=real),
    ):
        sample = wp.tid()
        index = indices[sample]
        first = index - (index & LANE_MASK)
        q = draw(space, prepare(space, first), first, wp.int32(index & LANE_MASK))
        for i in range(n):
            q_out[sample, i] = q[i]

    return configurations


@factory
def kinematics_kernel(real, n: int, sources: tuple[int, ...], plain: bool, with_inertia: bool) -> wp.Kernel:
    """Kernel: tip pose (N, 12: axes x, y, z, origin), Jacobian (N, 6, n) and, if asked, M (N, n, n) at ``q`` (N, n)."""
    kin, dyn = kinematics(real, n, sources, plain, True), inertia(real, n, sources, plain)
    forward, jacobian, inertia_matrix = kin.forward, kin.jacobian, dyn.inertia_matrix
    vec_n = kin.vec_n
    Model = model_type(real, n, len(sources))
    WITH_INERTIA = with_inertia

    @wp.kernel(module="unique", module_options=MODULE_OPTIONS, enable_backward=False)
    def poses_and_jacobians(
        # in
        model: Model,
        q_in: wp.array2d(dtype=real),
        # out
        pose_out: wp.array2d(dtype=real),
        jacobian_out: wp.array3d(dtype=real),
        inertia_out: wp.array3d(dtype=real),
    ):
        sample = wp.tid()
        q = vec_n()
        for i in range(n):
            q[i] = q_in[sample, i]
        tip, x, y, z, frames = forward(model.chain, q)
        for r in range(3):
            pose_out[sample, r] = x[r]
            pose_out[sample, 3 + r] = y[r]
            pose_out[sample, 6 + r] = z[r]
            pose_out[sample, 9 + r] = tip[r]
        J = jacobian(model.chain, frames)
        for r in range(6):
            for c in range(n):
                jacobian_out[sample, r, c] = J[r, c]
        if wp.static(WITH_INERTIA):
            M = inertia_matrix(model.chain, model.bodies, frames)
            for r in range(n):
                for c in range(n):
                    inertia_out[sample, r, c] = M[r, c]

    return poses_and_jacobians
