"""Which configurations of a chain its constraints admit, and samples of them."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from wsrender.documents.sampling import Sobol
from wsrender.engine import evaluate_samples
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.robots.kinematics import Kinematics

WORTH_THREADS = 1 << 14  # configurations that take longer than setting up what labels them


@dataclass(frozen=True, eq=False)
class Admission:
    """What ``constraints`` say of configurations of a ``chain`` that stands where they are meant."""

    chain: Kinematics
    constraints: Sequence[Constraint]
    device: str = "cpu"
    threads: int | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """The constraints' names: reason k, from 1, is that of the k-th."""
        return tuple(each.name for each in self.constraints)

    def among(self, batch: slice) -> Self:
        """The same for a batch of targets."""
        return self

    def rejected(self, q: np.ndarray, targets: np.ndarray | None = None) -> np.ndarray:
        """The number, from 1, of the first constraint that rejects configurations (N, n), or 0, (N,) int8.

        ``targets`` (N,): which each reaches, for what is asked of one in another way than of the next.
        """
        threads = 1 if len(q) < WORTH_THREADS else self.threads
        if not self.constraints:
            return np.zeros(len(q), np.int8)
        found = evaluate_samples(self._pipeline(q), self.device, threads=threads).rejected
        assert found is not None
        return found

    def samples(self, count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
        """Those of ``count`` Sobol samples that are admitted, (N, n) [rad or m], and their positions (N, 3) [m]."""
        pipeline = self._pipeline(Sobol(count, seed=seed), frozenset({"configuration"}), "float32")
        found = evaluate_samples(pipeline, self.device, threads=self.threads)
        assert found.q is not None
        admitted = slice(None) if found.rejected is None else found.rejected == 0
        return found.q[admitted].astype(np.float64), found.position[admitted].astype(np.float64)

    def _pipeline(self, sampling: object, kept: frozenset[str] = frozenset(), precision: str = "float64") -> Pipeline:
        plan = plan_sampling(self.chain, sampling)
        return Pipeline(Evaluation(self.chain), plan, tuple(self.constraints), kept_rows=kept, precision=precision)
