"""What the structure of a grid spares.

Samples that differ only in joints whose effect is known are not evaluated; detected from the chain and the request:

- Base joint: turning or sliding the whole arm changes neither the singular values of whole triads of Jacobian rows nor
  the inertia matrix. One evaluation serves all levels of the first joint; only the end effector's position is moved.
  Not so with joint-limit penalisation, with single rows in base axes, for an index that does not survive it, or under
  ``wsrender_code``, whose tables keep the rounding noise of singular postures.
- Trailing joints whose axes pass through the end effector: they change neither its position nor the linear rows. One
  evaluation stands for all their levels. Not so for angular rows, or for indices that do not survive them, as dynamic
  ones. What an index survives is said by its entry in the catalogue.

Of the others, what depends on the leading joints alone (their sines, the first frames) is computed once for all samples
of a block, on the CPU: they change least often, and blocks end where they do. Positions keep every bit; of an index
the last may change, since the compiler fuses other products with sums.
"""

from dataclasses import dataclass, replace
from math import prod

import numpy as np
from wsrender_kernels.sampling import LANES, base_levels
from wsrender_kernels.spectrum import LINEAR, in_base_axes

from wsrender.indices.entry import BASE_JOINT, TRAILING_JOINTS
from wsrender.indices.index_catalogue import find, is_dynamic
from wsrender.pipeline.constraints.constraint import STRUCTURES, Structure
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.sampling import SamplingPlan
from wsrender.robots.chain import Chain

MOSTLY_FULL = 0.9  # samples per lane of the blocks of a grid whose leading coordinates are shared
ON_AXIS = 1e-12  # of the reach: rounding of a model file's numbers
MOST_BASE_LEVELS = 2**20  # counts of one block of samples stay far below 32 bits


@dataclass(frozen=True, eq=False)
class GridStructure:
    """The samples ``evaluated`` instead of all; each stands for ``base_levels`` positions and ``weight`` repeats."""

    evaluated: SamplingPlan
    base_levels: int = 1
    weight: int = 1

    @property
    def multiplicity(self) -> int:
        """Samples that an evaluated one stands for."""
        return self.base_levels * self.weight


def structure_of(
    evaluation: Evaluation, sampling: SamplingPlan, kept: frozenset[Structure] = frozenset(STRUCTURES)
) -> GridStructure:
    """The structure that a sampling has under an evaluation, as far as constraints have ``kept`` it.

    Mostly none: every sample is evaluated.
    """
    chain, levels = evaluation.device_chain, sampling.levels.copy()
    if sampling.method != "grid" or chain is None or evaluation.on_host or evaluation.convention == "wsrender_code":
        return GridStructure(sampling)
    if not np.array_equal(chain.joint_source, np.arange(chain.n)):
        return GridStructure(sampling)
    still = TRAILING_JOINTS in kept and set(evaluation.rows) <= set(LINEAR) and _survive(evaluation, TRAILING_JOINTS)
    free = chain.n - _trailing(chain) if still else chain.n
    weight = prod(int(level) for level in levels[free:])
    levels[free:] = 1
    base = 1
    if _invariant(evaluation) and BASE_JOINT in kept and free > 0 and levels[0] <= MOST_BASE_LEVELS:
        base, levels[0] = int(levels[0]), 1
    # A coordinate of one level takes its upper value.
    upper = np.where(levels < sampling.levels, sampling.lower, sampling.upper)
    evaluated = replace(sampling, levels=levels, upper=upper, count=sampling.count // (base * weight))
    return GridStructure(evaluated, base, weight)


def shared_coordinates(sampling: SamplingPlan) -> int:
    """Leading coordinates that all samples of a block may share without leaving many of its lanes empty."""
    if sampling.method != "grid":
        return 0
    full = [shared for shared in range(1, len(sampling.levels)) if _fill(run_length(sampling, shared)) >= MOSTLY_FULL]
    return max(full, default=0)


def run_length(sampling: SamplingPlan, shared: int) -> int:
    """Samples in a row that have the leading coordinates in common."""
    return sampling.count // prod(int(level) for level in sampling.levels[:shared])


def block_count(run: int, first: int, count: int) -> int:
    """Blocks that hold samples first … first + count - 1 when blocks end with every run of so many samples."""
    per_run, last = -(-run // LANES), first + count - 1
    return (last // run - first // run) * per_run + last % run // LANES - first % run // LANES + 1


def _fill(run: int) -> float:
    return run / (-(-run // LANES) * LANES)


def _invariant(evaluation: Evaluation) -> bool:
    axes_matter = evaluation.penalty is not None or in_base_axes(evaluation.rows)
    return not axes_matter and _survive(evaluation, BASE_JOINT)


def _survive(evaluation: Evaluation, structure: str) -> bool:
    """Whether all indices of an evaluation survive a structure."""
    return all(structure in find(name).surviving(is_dynamic(name)) for name in evaluation.indices)


def _trailing(chain: Chain) -> int:
    """Number of last joints whose axes pass through the end effector, in any configuration."""
    tip = (chain.T_tip @ chain.T_tip_tool)[:3, 3]
    for number, i in enumerate(reversed(range(chain.n))):
        if not chain.joint_is_revolute[i] or np.hypot(*tip[:2]) > ON_AXIS * chain.reach:
            return number
        tip = chain.T_joint[i][:3, :3] @ tip + chain.T_joint[i][:3, 3]
    return chain.n


def device_base(structure: GridStructure, sampling: SamplingPlan, real):
    """The BaseLevels struct of a sampling's structure."""
    base = base_levels(real)()
    base.lower, base.upper, base.step = (float(v[0]) for v in (sampling.lower, sampling.upper, sampling.step))
    base.levels = structure.base_levels
    return base
