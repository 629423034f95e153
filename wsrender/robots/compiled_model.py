"""A robot model after MuJoCo compiled it, before a chain is chosen in it."""

from dataclasses import dataclass, field

import mujoco


@dataclass(frozen=True)
class CompiledModel:
    """A compiled model and what its source said that MuJoCo's model cannot hold.

    ``path_faults`` and ``inertia_faults`` map a body's number to what forbids a chain through its joints, or
    over its inertia; they are errors only for a chain that meets them.
    """

    model: mujoco.MjModel
    name: str
    path_faults: dict[int, str] = field(default_factory=dict)
    inertia_faults: dict[int, str] = field(default_factory=dict)
