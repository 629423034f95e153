"""A pipeline on a device: compile-time shape and numbers of its evaluation."""

from typing import Any

import numpy as np
import warp as wp
from wsrender_kernels.inertia import pack_inertia
from wsrender_kernels.kinematics import pack_kinematics
from wsrender_kernels.model import model_type
from wsrender_kernels.spectrum import spectrum_length
from wsrender_kernels.sweep import Shape

from wsrender.engine.index_code import function_of_source, index_source
from wsrender.pipeline.pipeline import Pipeline
from wsrender.robots.chain import Chain
from wsrender.robots.kinematics import Kinematics

REAL = {"float32": wp.float32, "float64": wp.float64}


def shape_of(pipeline: Pipeline, **outputs: Any) -> Shape:
    """Compile-time part of the sweep kernel of a pipeline, but for what it keeps and its constraints."""
    evaluation, chain, real = pipeline.evaluation, pipeline.device_chain, REAL[pipeline.precision]
    n = evaluation.chain.n
    indices = None
    if evaluation.indices:
        body = index_source(evaluation.indices, evaluation.rows, n, evaluation.convention, evaluation.options)
        length = spectrum_length(n, evaluation.rows, evaluation.convention)
        indices = function_of_source(body, len(evaluation.indices), length, real)
    sources, plain = drive(chain) if chain else (tuple(range(n)), True)
    return Shape(
        real=real,
        n=n,
        sources=sources,
        plain=plain,
        method="given" if evaluation.on_host else pipeline.sampling.method,
        rows=evaluation.rows,
        convention=evaluation.convention,
        indices=indices,
        n_indices=len(evaluation.indices),
        dynamic=evaluation.dynamic,
        given_jacobian=evaluation.given_kinematics,
        given_inertia=evaluation.dynamic and evaluation.host_inertia is not None,
        given_values=tuple(k for k, name in enumerate(evaluation.indices) if name in evaluation.given),
        penalty=evaluation.penalty is not None,
        torque_scaling=evaluation.torque_scaling and evaluation.dynamic,
        **outputs,
    )


def drive(chain: Chain) -> tuple[tuple[int, ...], bool]:
    """How coordinates drive joints: ``sources`` and ``plain`` of the kernels' `kinematics`."""
    own = np.array_equal(chain.joint_source, np.arange(chain.n)) and np.all(chain.joint_scale == 1)
    return tuple(int(s) for s in chain.joint_source), bool(own and np.all(chain.joint_is_revolute))


def pipeline_model(pipeline: Pipeline, limits: np.ndarray, shape: Shape):
    """The Model struct of a pipeline, without what the host computes.

    ``limits``: of `packed_constraints`; ``shape``: the kernel's.
    """
    more = {"labelled": shape.labelled, "given_values": bool(shape.given_values)}
    evaluation, precision, origin = pipeline.evaluation, pipeline.precision, pipeline.origin
    chain, real = evaluation.chain, REAL[precision]
    if device_chain := pipeline.device_chain:
        model = chain_model(device_chain.relative_to(origin), precision, len(limits), **more)
    else:
        model = _placed_model(chain, chain.n, precision, len(limits), **more)
    if len(limits):
        model.limits = vector_of(limits, real)
    model.lower, model.upper = vector_of(chain.lower_limits, real), vector_of(chain.upper_limits, real)
    limited = ~chain.periodic & (chain.upper_limits > chain.lower_limits)
    model.limited = vector_of(limited, real)
    model.penalty = evaluation.penalty or 0.0
    if evaluation.torque_scaling and chain.effort_limits is not None:
        model.torque = vector_of(chain.effort_limits, real)
    mixed = evaluation.mixed_rows
    model.linear_scale = 1.0 / evaluation.characteristic_length_m if mixed else 1.0
    return model


def chain_model(chain: Chain, precision: str, limits: int = 0, **more: bool):
    """The Model struct with a chain's kinematics and inertias alone, and room for so many numbers of constraints."""
    real, model = REAL[precision], _placed_model(chain, len(chain.joint_source), precision, limits, **more)
    kinematics = pack_kinematics(
        chain.T_world_base,
        chain.T_joint,
        chain.T_tip @ chain.T_tip_tool,
        chain.joint_is_revolute,
        chain.joint_scale,
        chain.joint_offset,
    )
    model.chain, model.bodies = vector_of(kinematics, real), vector_of(packed_bodies(chain), real)
    return model


def packed_bodies(chain: Chain) -> np.ndarray:
    """The numbers of a chain's bodies, (L * BODY_STRIDE,) float64."""
    return pack_inertia(chain.T_joint, chain.mass, chain.center_of_mass, chain.inertia, chain.armature)


def _placed_model(chain: Kinematics, joints: int, precision: str, limits: int, **more: bool):
    """A Model struct for so many joints that says how the base stands, and nothing of what it carries."""
    real = REAL[precision]
    model = model_type(real, chain.n, joints, limits, **more)()
    model.base_axes = wp.types.matrix((3, 3), real)(*chain.T_world_base[:3, :3].T.ravel().tolist())
    model.linear_scale = 1.0
    return model


def vector_of(values: np.ndarray, dtype):
    """NumPy values as a Warp vector."""
    return wp.types.vector(len(values), dtype)(*values.tolist())


def device_array(values: np.ndarray, dtype, device: wp.Device) -> wp.array:
    """A contiguous copy of NumPy values on a device."""
    return wp.array(np.ascontiguousarray(values, wp.dtype_to_numpy(dtype)), dtype=dtype, device=device)


def given_array(values: np.ndarray, dtype, device: wp.Device) -> wp.array:
    """NumPy values that kernels read, flat: on the CPU where they are if they are contiguous there, else a copy."""
    flat = np.ascontiguousarray(values, wp.dtype_to_numpy(dtype)).ravel()
    return wp.array(flat, dtype=dtype, device=device, copy=False)
