"""The numbers of a robot as the kernels read them."""

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.inertia import BODY_STRIDE
from wsrender_kernels.kinematics import chain_type


@factory
def model_type(real, n: int, joints: int, limits: int = 0, labelled: bool = False, given_values: bool = False):
    """Struct with the numbers of a robot of n coordinates; what a kernel's shape does not use is empty or 0.

    Of a sweep with constraints also ``limits``, their numbers, and where ``labelled``, ``labels`` of the samples from
    ``first_label`` on, which other kernels have decided; and ``values_given`` of indices that the host gives.

    Vectors in the struct, not arrays: on the CPU the compiler then sees that nothing written in the lane loop changes
    them, on CUDA they are read from constant memory.
    """
    vec_n = wp.types.vector(n, real)
    bodies_type = wp.types.vector(joints * BODY_STRIDE, real)

    class Model:
        base_axes: wp.types.matrix((3, 3), real)  # rows: axes of the base in the world, for tasks given row by row
        chain: chain_type(real, joints)  # kinematics.pack_kinematics
        bodies: bodies_type  # inertia.pack_inertia
        lower: vec_n  # limits for the penalisation
        upper: vec_n
        limited: vec_n  # 1 where the limits count, else 0
        penalty: real  # K of the penalisation
        torque: vec_n  # largest joint efforts
        linear_scale: real  # 1 / characteristic length, for tasks that mix linear and angular rows
        position_given: wp.array(dtype=real)  # (3 * stride,) value r of given sample s at [r * stride + s]
        jacobian_given: wp.array(dtype=real)  # (6 n * stride,)
        inertia_given: wp.array(dtype=real)  # (n n * stride,)

    if limits:
        Model.__annotations__["limits"] = wp.types.vector(limits, real)
    if labelled:
        Model.__annotations__ |= {"labels": wp.array(dtype=wp.uint8), "first_label": wp.int64}
    if given_values:
        Model.__annotations__["values_given"] = wp.array(dtype=real)  # (G * stride,)
    return wp.struct(Model)
