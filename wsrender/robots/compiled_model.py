"""A robot model after MuJoCo compiled it, before a chain is chosen in it."""

import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import mujoco

from wsrender.errors import ModelError

MUJOCO_ERRORS = (ValueError, RuntimeError, mujoco.FatalError)


@contextmanager
def quiet() -> Iterator[None]:
    """Keeps MuJoCo's warnings to itself: of near-singular inertias, no fault of a kinematic model, and such.

    Some of them come as Python warnings, others end in a log file in the working directory.
    """
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda message: None)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            yield
    finally:
        mujoco.set_mju_user_warning(before)


def refusal(error: Exception, model_field: str) -> ModelError:
    """MuJoCo's complaint as a ModelError, without line numbers: they count in our own rewriting."""
    message = re.sub(r",? line \d+", "", " ".join(str(error).split()))
    return ModelError(model_field, f"MuJoCo refuses the model: {message}")


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
