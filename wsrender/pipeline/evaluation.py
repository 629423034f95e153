"""What is computed of every sample: indices of an arm, and how they are defined."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from wsrender.indices.index_catalogue import is_dynamic
from wsrender.notices import Notice
from wsrender.pipeline.chain_index import ChainIndex
from wsrender.pipeline.constraints.expression import ExpressionIndex
from wsrender.robots.chain import Chain
from wsrender.robots.kinematics import Kinematics


@dataclass(frozen=True)
class Evaluation:
    """The indices to evaluate and how (the fields of the job document, resolved); without any, the tip's position.

    ``rows`` are 0…5 for x y z rx ry rz; ``penalty`` is K or None. ``host_inertia(q: (N, n)) -> (N, n, n)`` replaces the
    chain's inertia matrix, ``given(q: (N, n)) -> (N,)`` by index what the host gives; ``of_chain``: those that kernels
    compute of the whole chain. ``options``: all values of the
    indices that have any, by index and option.
    """

    chain: Kinematics
    indices: tuple[str, ...] = ()
    rows: tuple[int, ...] = ()
    convention: str = "standard"
    penalty: float | None = None
    characteristic_length_m: float = 1.0
    torque_scaling: bool = False
    host_inertia: Callable[[np.ndarray], np.ndarray] | None = None
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict, hash=False)
    of_chain: Mapping[str, ChainIndex | ExpressionIndex] = field(default_factory=dict, hash=False)
    given: Mapping[str, Callable[[np.ndarray], np.ndarray]] = field(default_factory=dict, hash=False)
    notices: tuple[Notice, ...] = ()  # what to know of the values

    @property
    def dynamic(self) -> bool:
        """Whether any index is dynamic."""
        return any(is_dynamic(name) for name in self.indices)

    @property
    def cuts(self) -> dict[str, float]:
        """Of indices whose larger values are told as another, that."""
        return {name: each.cut for name, each in self.of_chain.items() if each.cut is not None}

    @property
    def device_chain(self) -> Chain | None:
        """The chain that the kernels evaluate; None where the host computes all kinematics."""
        chain = self.chain.geometry
        whole = self.of_chain or (self.dynamic and self.host_inertia is None)
        return chain.dynamic if chain and whole else chain

    @property
    def given_kinematics(self) -> bool:
        """Whether the host computes positions and Jacobians: there is no geometry that a kernel could evaluate."""
        return self.chain.geometry is None

    @property
    def on_host(self) -> bool:
        """Whether the host computes a part of every sample."""
        return bool(self.given) or self.given_kinematics or (self.dynamic and self.host_inertia is not None)

    @property
    def mixed_rows(self) -> bool:
        """Whether the task has linear and angular rows."""
        return bool(self.rows) and min(self.rows) < 3 <= max(self.rows)
