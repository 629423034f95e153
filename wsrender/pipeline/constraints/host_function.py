"""Constraints of users that a Python function decides, in the process that registered it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.errors import InputError
from wsrender.pipeline.constraints.constraint import LABELLED, Structure
from wsrender.robots.kinematics import Kinematics


@dataclass(frozen=True)
class HostConstraint:
    """Admits configurations where ``function(q, poses, **options)`` is true, (N,) bool.

    ``q`` (N, n) [rad or m] and ``poses`` (N, 4, 4) of the tip in the world are float64; it is asked in any order, by
    several threads, and must say the same of a configuration always.
    """

    name: str
    function: Callable[..., Any]
    options: tuple[tuple[str, float], ...] = ()
    keeps: frozenset[Structure] = frozenset()
    device: str = LABELLED

    def pack(self, chain: Kinematics, origin: np.ndarray, precision: str) -> np.ndarray:
        """No numbers: samples are labelled before the sweep."""
        return np.zeros(0)

    def host(self, q: np.ndarray, frames: np.ndarray, moved: np.ndarray | None = None) -> np.ndarray:
        """See `Constraint.host`; tip poses say all of where an arm stands.

        Raises InputError where the function raises, or answers anything but (N,) bool.
        """
        try:
            admitted = np.asarray(self.function(q, frames, **dict(self.options)))
        except Exception as error:
            message = f"its function raised {type(error).__name__}: {error}"
            raise InputError(f"constraints.{self.name}", message) from error
        if admitted.shape != (len(q),) or admitted.dtype != bool:
            found = f"{admitted.dtype} of shape {admitted.shape}"
            message = f"its function must give whether each of {len(q)} configurations is admitted, bool, not {found}"
            raise InputError(f"constraints.{self.name}", message)
        return (~admitted).astype(np.int8)


def on_host(constraints: Sequence[object]) -> tuple[HostConstraint, ...]:
    """The constraints that functions of the host decide, in order; their labels follow those of `labelling`."""
    return tuple(each for each in constraints if isinstance(each, HostConstraint))
