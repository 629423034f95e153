"""The numbers of a robot as the kernels read them."""

from functools import cache

import warp as wp


@cache
def model_arrays(real):
    """Struct with a robot's numbers; arrays that a kernel's shape does not use are empty."""

    @wp.struct
    class Model:
        base_axes: wp.types.matrix((3, 3), real)  # rows: axes of the base in the world, for tasks given row by row
        chain: wp.array(dtype=real)  # kinematics.pack_kinematics
        bodies: wp.array(dtype=real)  # inertia.pack_inertia
        lower: wp.array(dtype=real)  # (n,) limits for the penalisation
        upper: wp.array(dtype=real)  # (n,)
        limited: wp.array(dtype=real)  # (n,) 1 where the limits count, else 0
        penalty: real  # K of the penalisation
        torque: wp.array(dtype=real)  # (n,) largest joint efforts
        linear_scale: real  # 1 / characteristic length where a task mixes linear and angular rows, else 1
        position_given: wp.array(dtype=real)  # (3 * stride,) value r of given sample s at [r * stride + s]
        jacobian_given: wp.array(dtype=real)  # (6 n * stride,)
        inertia_given: wp.array(dtype=real)  # (n n * stride,)

    return Model
