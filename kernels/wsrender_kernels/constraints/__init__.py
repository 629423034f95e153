"""Constraints on configurations, as device functions: one module each, with a factory of the module's name.

``<name>(real, n, size, offset)`` makes the device function ``(limits, q, tip, axes) -> 0 admitted | 1 violated | 2
open``, where it cannot decide. ``limits`` (size,) holds the numbers of all constraints of a sweep, those of this one
from ``offset`` on; ``q`` (n,) is the configuration [rad or m], ``tip`` the tip's position [m] from where positions are
counted, ``axes`` (3, 3) its axes in the world, as columns. Of a mechanism of n legs it is ``(limits, p, p_end, q,
q_end)``, of the ends of two legs' links [m].

Those of the whole chain are made by ``<name>(real, n, sources, plain, *choices, size, offset)``, the chain as of
`kinematics`, and marked as `OfChain`: device functions ``(model, q, tip, axes)``, the numbers in ``model.limits``.
"""

from collections.abc import Callable
from typing import NamedTuple


class OfChain(NamedTuple):
    """Marks the device function of a constraint that asks for more of the chain than where its tip is."""

    function: Callable
