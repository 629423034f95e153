"""What is evaluated at every sample, and its form on a device."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import warp as wp
from wsrender_kernels.inertia import pack_inertia
from wsrender_kernels.kinematics import pack_kinematics
from wsrender_kernels.model import model_type
from wsrender_kernels.spectrum import spectrum_length
from wsrender_kernels.sweep import Shape

from wsrender.engine.index_code import function_of_source, index_source
from wsrender.indices.index_catalogue import is_dynamic
from wsrender.notices import Notice
from wsrender.robots.chain import Chain
from wsrender.robots.kinematics import Kinematics

REAL = {"float32": wp.float32, "float64": wp.float64}


@dataclass(frozen=True, eq=False)
class Evaluation:
    """The indices to evaluate and how (the fields of the job document, resolved).

    ``rows`` are 0…5 for x y z rx ry rz; ``penalty`` is K or None. ``host_inertia(q: (N, n)) -> (N, n, n)`` replaces the
    chain's inertia matrix. ``options``: all values of the indices that have any, by index and option.
    """

    chain: Kinematics
    indices: tuple[str, ...]
    rows: tuple[int, ...] = (0, 1, 2)
    convention: str = "standard"
    penalty: float | None = None
    characteristic_length_m: float = 1.0
    torque_scaling: bool = False
    host_inertia: Callable[[np.ndarray], np.ndarray] | None = None
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    notices: tuple[Notice, ...] = ()  # what to know of the values

    @property
    def dynamic(self) -> bool:
        """Whether any index is dynamic."""
        return any(is_dynamic(name) for name in self.indices)

    @property
    def device_chain(self) -> Chain | None:
        """The chain that the kernels evaluate; None where the host computes all kinematics."""
        chain = self.chain.geometry
        return chain.dynamic if chain and self.dynamic and self.host_inertia is None else chain

    @property
    def given_kinematics(self) -> bool:
        """Whether the host computes positions and Jacobians: there is no geometry that a kernel could evaluate."""
        return self.chain.geometry is None

    @property
    def on_host(self) -> bool:
        """Whether the host computes a part of every sample."""
        return self.given_kinematics or (self.dynamic and self.host_inertia is not None)

    @property
    def mixed_rows(self) -> bool:
        """Whether the task has linear and angular rows."""
        return bool(self.rows) and min(self.rows) < 3 <= max(self.rows)


def shape_of(evaluation: Evaluation, precision: str, method: str, **outputs: Any) -> Shape:
    """Compile-time part of the sweep kernel of an evaluation."""
    real, n = REAL[precision], evaluation.chain.n
    indices = None
    if evaluation.indices:
        body = index_source(evaluation.indices, evaluation.rows, n, evaluation.convention, evaluation.options)
        length = spectrum_length(n, evaluation.rows, evaluation.convention)
        indices = function_of_source(body, len(evaluation.indices), length, real)
    chain = evaluation.device_chain
    sources, plain = drive(chain) if chain else (tuple(range(n)), True)
    return Shape(
        real=real,
        n=n,
        sources=sources,
        plain=plain,
        method="given" if evaluation.on_host else method,
        rows=evaluation.rows,
        convention=evaluation.convention,
        indices=indices,
        n_indices=len(evaluation.indices),
        dynamic=evaluation.dynamic,
        given_jacobian=evaluation.given_kinematics,
        given_inertia=evaluation.dynamic and evaluation.host_inertia is not None,
        penalty=evaluation.penalty is not None,
        torque_scaling=evaluation.torque_scaling and evaluation.dynamic,
        **outputs,
    )


def drive(chain: Chain) -> tuple[tuple[int, ...], bool]:
    """How coordinates drive joints: ``sources`` and ``plain`` of the kernels' `kinematics`."""
    own = np.array_equal(chain.joint_source, np.arange(chain.n)) and np.all(chain.joint_scale == 1)
    return tuple(int(s) for s in chain.joint_source), bool(own and np.all(chain.joint_is_revolute))


def evaluation_model(evaluation: Evaluation, precision: str, origin: np.ndarray, limits: np.ndarray):
    """The Model struct of an evaluation, without what the host computes; positions are relative to ``origin`` (3,).

    ``limits``: numbers of all constraints, of `packed_constraints`.
    """
    chain, real = evaluation.chain, REAL[precision]
    if device_chain := evaluation.device_chain:
        model = chain_model(device_chain.relative_to(origin), precision, len(limits))
    else:
        model = _placed_model(chain, chain.n, precision, len(limits))
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


def chain_model(chain: Chain, precision: str, limits: int = 0):
    """The Model struct with a chain's kinematics and inertias alone, and room for so many numbers of constraints."""
    real, model = REAL[precision], _placed_model(chain, len(chain.joint_source), precision, limits)
    kinematics = pack_kinematics(
        chain.T_world_base,
        chain.T_joint,
        chain.T_tip @ chain.T_tip_tool,
        chain.joint_is_revolute,
        chain.joint_scale,
        chain.joint_offset,
    )
    bodies = pack_inertia(chain.T_joint, chain.mass, chain.center_of_mass, chain.inertia, chain.armature)
    model.chain, model.bodies = vector_of(kinematics, real), vector_of(bodies, real)
    return model


def _placed_model(chain: Kinematics, joints: int, precision: str, limits: int):
    """A Model struct for so many joints that says how the base stands, and nothing of what it carries."""
    real = REAL[precision]
    model = model_type(real, chain.n, joints, limits)()
    model.base_axes = wp.types.matrix((3, 3), real)(*chain.T_world_base[:3, :3].T.ravel().tolist())
    model.linear_scale = 1.0
    return model


def vector_of(values: np.ndarray, dtype):
    """NumPy values as a Warp vector."""
    return wp.types.vector(len(values), dtype)(*values.tolist())


def device_array(values: np.ndarray, dtype, device: wp.Device) -> wp.array:
    """A contiguous copy of NumPy values on a device."""
    return wp.array(np.ascontiguousarray(values, wp.dtype_to_numpy(dtype)), dtype=dtype, device=device)
