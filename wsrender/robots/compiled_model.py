"""A robot model after MuJoCo compiled it, before a chain is chosen in it."""

import re
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Literal

import mujoco

from wsrender.errors import ModelError, WsrenderError
from wsrender.notices import Notice

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


@contextmanager
def building(model_field: str) -> Iterator[None]:
    """Whatever goes wrong while a model is built becomes a ModelError: the model is at fault, not the program."""
    try:
        yield
    except (WsrenderError, MemoryError):
        raise
    except MUJOCO_ERRORS as error:
        raise refusal(error, model_field) from error
    except Exception as error:
        raise ModelError(model_field, f"it cannot be built: {type(error).__name__}: {error}") from error


@dataclass(frozen=True)
class JointFault:
    """What is wrong with a joint by which ``body`` moves: an error on a chain through it, a note off it.

    Where ``by_limits``, limits that the user gives mend it.
    """

    body: int
    joint: str
    message: str
    by_limits: bool = False


Purpose = Literal["collision", "visual"]


@dataclass(frozen=True)
class CompiledModel:
    """A compiled model and what its source said that MuJoCo's model cannot hold.

    ``path_faults`` and ``inertia_faults`` map a body's number to what forbids a chain through its joints, or
    over its inertia; they are errors only for a chain that meets them. ``unset_limits`` names the joints whose limits
    were 0 … 0, taken as none. ``velocity_limits`` [rad/s or m/s] are those of all joints by number, 0 for none, or
    empty; ``gravity`` (3,) [m/s²] is what the model states, if it does. ``with_geometry`` compiles the same bodies and
    joints with all shapes of a purpose, and says what was odd about them; it reads meshes, and raises ModelError where
    one that may collide cannot be had.
    """

    model: mujoco.MjModel
    name: str
    with_geometry: Callable[[Purpose], tuple[mujoco.MjModel, tuple[Notice, ...]]]
    path_faults: dict[int, str] = field(default_factory=dict)
    inertia_faults: dict[int, str] = field(default_factory=dict)
    joint_faults: tuple[JointFault, ...] = ()
    unset_limits: tuple[str, ...] = ()
    velocity_limits: tuple[float, ...] = ()
    gravity: tuple[float, ...] | None = None
    notices: tuple[Notice, ...] = ()
