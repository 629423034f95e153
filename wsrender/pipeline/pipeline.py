"""The sampling pipeline: samples → kinematics → constraints → values → what is kept of them."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from wsrender.pipeline.constraints.constraint import Constraint, asks_for_chain
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.sampling import SamplingPlan, plan_sampling
from wsrender.robots.chain import Chain
from wsrender.robots.kinematics import Kinematics
from wsrender.volume.lattice import LatticeBlock


@dataclass(frozen=True, repr=False)
class Pipeline:
    """What the engine compiles: whether it sweeps samples, evaluates given ones, or draws starts of inverse kinematics.

    A value: equal to another where every number, name and function is. Of all samples it keeps, in the ``block``, the
    count and the ``statistics`` of voxels ("maximum", "minimum", "mean"), and as ``kept_rows`` position, indices and
    more columns, "configuration" and "orientation"; each None: not kept. ``bounds`` (K,): the largest absolute value of
    each index, for its fixed-point sums; None: not summed. ``collapse``: whether the structure of a grid is used.
    ``best``: the index of which every voxel keeps the sample with the largest value, among its maxima; None: of none.
    """

    evaluation: Evaluation
    sampling: SamplingPlan
    constraints: tuple[Constraint, ...] = ()
    block: LatticeBlock | None = None
    statistics: frozenset[str] = frozenset()
    kept_rows: frozenset[str] | None = None
    bounds: tuple[float, ...] | None = None
    precision: str = "float64"
    collapse: bool = True
    best: str | None = None

    def at(self, q: np.ndarray) -> "Pipeline":
        """The same at given configurations ``q`` (N, n) [rad or m], of which rows are kept."""
        given = plan_sampling(self.evaluation.chain, q)
        return replace(
            self, sampling=given, block=None, statistics=frozenset(), kept_rows=frozenset(), bounds=None, best=None
        )

    @property
    def of_tip(self) -> "Pipeline":
        """The same samples, of which the tip's position alone is kept, admitted or not."""
        tip = Evaluation(self.evaluation.chain)
        return Pipeline(tip, self.sampling, kept_rows=frozenset(), precision=self.precision)

    @property
    def origin(self) -> np.ndarray:
        """Where the engine counts positions from, in the world (3,) [m]."""
        return self.evaluation.chain.origin if self.block is None else self.block.origin

    @property
    def device_chain(self) -> Chain | None:
        """The chain that the kernels evaluate, with all bodies where a constraint asks for them; None: the host's."""
        chain = self.evaluation.device_chain
        whole = any(map(asks_for_chain, self.constraints))
        return chain.dynamic if chain and whole else chain

    def __str__(self) -> str:
        """Its stages, such as ``sobol 1e6 → ur5e → region → manipulability → voxels 5 mm (count, maximum)``."""
        constraints = " ∧ ".join(each.name for each in self.constraints)
        values = ", ".join(self.evaluation.indices) or "position"
        kept = " and ".join(self._kept())
        stages = (str(self.sampling), self.evaluation.chain.name, constraints, values, kept)
        return " → ".join(filter(None, stages))

    __repr__ = __str__

    def _kept(self) -> Iterator[str]:
        if self.block is not None:
            statistics = ", ".join(("count", *sorted(self.statistics - {"count"})))
            yield f"voxels {1000 * self.block.voxel_size_m:g} mm ({statistics})"
        if self.kept_rows is not None:
            yield f"rows ({', '.join(sorted(self.kept_rows))})" if self.kept_rows else "rows"


def tip_pipeline(chain: Kinematics, sampling: Any, max_samples: int | None = None) -> Pipeline:
    """Positions of a chain's tip at a sampling of the job document, or at configurations (N, n) [rad or m].

    Raises InputError, ResourceError as `plan_sampling` does.
    """
    return Pipeline(Evaluation(chain), plan_sampling(chain, sampling, max_samples))
