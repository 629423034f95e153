"""What a coarse first pass over 2^16 Sobol samples settles: voxel size, lattice block, scales of the sums."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from wsrender.documents.sampling import Sobol
from wsrender.engine.drawn_configurations import configurations
from wsrender.engine.kinematics import evaluate_kinematics
from wsrender.engine.rows import Evaluated, evaluate_samples
from wsrender.engine.sums import own_bound
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import SamplingPlan, plan_sampling
from wsrender.robots.reachable_box import reachable_box
from wsrender.tolerances import FLAT
from wsrender.volume.lattice import MOST_DIVISIONS, LatticeBlock, block_around, measured, voxel_size_of

SAMPLES = 2**16
STEP_SAMPLES = 2**10
# An index without a bound of its own may take this many times its coarse maximum. The pseudo-inverse of
# the original program jumps up in exactly singular postures, which grids hit and the first pass does not.
HEADROOM, HEADROOM_CODE = 2.0, 1024.0


@dataclass(eq=False)
class FirstPass:
    """Coarse knowledge of a robot under an evaluation; the samples are drawn when first needed."""

    evaluation: Evaluation
    locked: dict[str, float]

    @cached_property
    def evaluated(self) -> Evaluated:
        """Positions and values of the coarse samples, in float64 on the CPU: the same on every target."""
        return evaluate_samples(self._coarse.at(configurations(self._coarse)))

    @cached_property
    def _coarse(self) -> Pipeline:
        sampling = Sobol(count=SAMPLES, seed=0, locked=self.locked)
        # What the host gives takes long, and has a bound of its own.
        nothing = dict.fromkeys(self.evaluation.given, lambda q: np.zeros(len(q)))
        return Pipeline(replace(self.evaluation, given=nothing), plan_sampling(self.evaluation.chain, sampling))

    @cached_property
    def hull(self) -> tuple[int, float, float]:
        """Dimension, measure and extent of the positions."""
        return measured(self.evaluated.position)

    def voxel_size(self, sampling: SamplingPlan | None, divisions: float = MOST_DIVISIONS) -> float:
        """Default voxel edge [m] for the samples of a plan, at most so many in the size; None: for as many as it takes.

        Of a grid count its distinct positions, and voxels are no smaller than the longest step that one level of one
        joint makes, in the median over configurations.
        """
        if sampling is None:
            return voxel_size_of(self.hull, divisions=divisions)
        if sampling.method != "grid":
            return voxel_size_of(self.hull, sampling.count, divisions=divisions)
        steps = self._steps(sampling)
        moving = steps.max(axis=0) > FLAT * np.ptp(self.evaluated.position, axis=0).max()
        distinct = np.prod(sampling.levels[moving], dtype=float)
        return voxel_size_of(self.hull, distinct, least=float(np.median(steps.max(axis=1))), divisions=divisions)

    def least_voxel_size(self, sampling: SamplingPlan | None) -> float:
        """The voxel edge [m] below which the samples of a plan leave holes; 0 for as many as it takes."""
        return self.voxel_size(sampling, np.inf)

    def _steps(self, grid: SamplingPlan) -> np.ndarray:
        """How far one level of each joint moves the end effector, (N, n) [m], at some of the coarse samples."""
        chain = self.evaluation.chain
        q = configurations(self._coarse, np.arange(STEP_SAMPLES))
        slopes = np.linalg.norm(evaluate_kinematics(chain, q, device="cpu").jacobian[:, :3], axis=1)
        turned = 2 * np.sin(np.minimum(grid.step, np.pi) / 2)  # the chord, of radius 1
        return slopes * np.where(chain.revolute, turned, grid.step)

    def block(self, voxel_size_m: float) -> LatticeBlock:
        """A block that holds every position the robot can reach."""
        whole = self.evaluation.chain
        held = whole.held(self.locked)
        low, high = reachable_box(held, held.lower_limits, held.upper_limits)
        reach = whole.reach
        low, high = np.maximum(low, whole.center - reach), np.minimum(high, whole.center + reach)
        return block_around(low, high, voxel_size_m, whole.foot)

    @cached_property
    def bounds(self) -> tuple[float, ...]:
        """Bounds (K,) of the fixed-point sums: the indices' own, else from the coarse maximum."""
        bounds = np.array([own_bound(self.evaluation, name) for name in self.evaluation.indices])
        unknown = np.isnan(bounds)
        if unknown.any():
            headroom = HEADROOM_CODE if self.evaluation.convention == "wsrender_code" else HEADROOM
            largest = headroom * np.abs(self.evaluated.values[unknown]).max(axis=1)
            bounds[unknown] = np.where(largest > 0, largest, 1.0)
        return tuple(bounds.tolist())
