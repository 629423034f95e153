"""Local indices of a robot: from the words of a job document to an evaluation of the engine."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from wsrender.documents.constraints import Constraints
from wsrender.documents.environment import Environment
from wsrender.documents.options import (
    DEFAULT_PENALTY,
    LARGEST_PENALTY,
    NAMED_TASKS,
    SMALLEST_PENALTY,
    TASK_ROWS,
    IndexChoices,
)
from wsrender.documents.quantities import argument, positive, real, sequence
from wsrender.errors import InputError, MissingInertiaError
from wsrender.indices.index_catalogue import CONVENTIONS, find, is_dynamic, option_values, resolve
from wsrender.keywords import keywords
from wsrender.notices import Notice, warn
from wsrender.pipeline.constraints.region import Point
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.robot.chain_indices import chain_indices_of
from wsrender.robot.gravity import GRAVITY, gravity_of
from wsrender.robot.model_robot import Robot, configuration_rows
from wsrender.robot.user_robot import as_robot
from wsrender.robots.model_warning import ModelWarning
from wsrender.robots.plausibility import need_ranges

# In float32: up to 7e7 the indices of arms of 3 to 7 joints err by at most 2e-5 of their largest values, from 1.3e8 on
# their smallest singular values of three and six rows count as 0 here and there; a tenth of that.
LARGEST_INERTIA_RATIO = 1e7
SUSPECT_INERTIA_RATIO = 1e10  # no real arm's: a link without mass gets 1e-14 kg and kg m²


@keywords
def evaluate_indices(
    robot: Any,
    q: Any,
    indices: str | Sequence[str] = "all",
    task: str | Sequence[str] = "linear",
    *,
    convention: str = "standard",
    joint_limit_penalty: float | bool | None = None,
    characteristic_length_m: float = 1.0,
    torque_scaling: bool = False,
    index_options: Mapping[str, Mapping[str, Any]] | None = None,
    inertia: str = "kernel",
    gravity_m_s2: Point = GRAVITY,
    precision: str = "float64",
    device: str = "auto",
    threads: int | None = None,
) -> dict[str, np.ndarray]:
    """Local indices at configurations ``q`` (n,) or (N, n) [rad or m]: a dict of arrays (N,).

    ``robot`` is a Robot, a user-defined robot or what `load_robot` takes. The other arguments are those of the job
    document ``indices_at``; ``threads`` change no bit. Raises InputError, ModelError, MissingInertiaError.

    >>> rows = [{"a": 0.3, "limits_deg": [-180, 180]}, {"a": 0.2, "limits_deg": [-180, 180]}]
    >>> arm = ws.DHTable(convention="standard", rows=rows)
    >>> found = ws.evaluate_indices(arm, [[0, np.pi / 2], [0, 0]], ["manipulability"], task=["x", "y"])
    >>> found["manipulability"].round(9).tolist()  # 0.3 m · 0.2 m · sin q2
    [0.06, 0.0]
    """
    from wsrender.engine import evaluate_samples

    robot = as_robot(robot)
    evaluation = evaluation_of(
        robot,
        indices=indices,
        task=task,
        convention=convention,
        joint_limit_penalty=joint_limit_penalty,
        characteristic_length_m=characteristic_length_m,
        torque_scaling=torque_scaling,
        index_options=index_options or {},
        inertia=inertia,
        precision=precision,
    )
    evaluation = _with_clearance(_of_chain(evaluation, robot, gravity_m_s2), robot, None, None)
    rows = configuration_rows(q, robot.chain.n)
    pipeline = Pipeline(evaluation, plan_sampling(robot.chain, rows), kept_rows=frozenset(), precision=precision)
    values = evaluate_samples(pipeline, device, threads=threads).values
    return dict(zip(evaluation.indices, values, strict=True))


def evaluation_of_job(job: IndexChoices, robot: Robot) -> Evaluation:
    """The engine's evaluation of a job's choices for a robot, each checked."""
    choices = {name: getattr(job, name) for name in IndexChoices.model_fields if name != "device"}
    evaluation = _of_chain(evaluation_of(robot, **choices), robot, gravity_of(job), getattr(job, "held_joints", ()))
    return _with_clearance(evaluation, robot, getattr(job, "constraints", None), getattr(job, "environment", None))


def _of_chain(evaluation: Evaluation, robot: Robot, gravity: Point, held: Collection[str] = ()) -> Evaluation:
    """With its indices of the whole chain; raises InputError where the robot has not what they take."""
    options, names, rows = evaluation.options, evaluation.indices, evaluation.rows
    return replace(evaluation, of_chain=chain_indices_of(robot, options, names, rows, gravity, held))


def _with_clearance(
    evaluation: Evaluation, robot: Robot, choice: Constraints | None, environment: Environment | None
) -> Evaluation:
    """With what the shapes give of its indices; raises InputError where the robot has none."""
    names = [name for name in evaluation.indices if find(name).given]
    if not names:
        return evaluation
    from wsrender.robot.collisions import clearance_of

    clearance, options = clearance_of(robot, choice, environment), evaluation.options
    of = {"clearance": clearance.least, "clearance_lower_bound": clearance.lower_bound}
    return replace(evaluation, given={name: partial(of[name], **options[name]) for name in names})


def evaluation_of(
    robot: Robot,
    *,
    indices: str | Sequence[str],
    task: str | Sequence[str],
    convention: str,
    joint_limit_penalty: float | bool | None,
    characteristic_length_m: float,
    torque_scaling: bool,
    index_options: Mapping[str, Mapping[str, Any]],
    inertia: str,
    precision: str,
) -> Evaluation:
    """The engine's evaluation of these choices for a robot, each checked."""
    if convention not in CONVENTIONS:
        raise InputError("convention", f"{convention!r} is not allowed; {', '.join(CONVENTIONS)} are")
    if convention == "wsrender_code" and precision != "float64":
        raise InputError("precision", f'{precision!r} is not allowed with the convention wsrender_code; "float64" is')
    if precision not in ("float32", "float64"):
        raise InputError("precision", f'{precision!r} is not allowed; "float32" or "float64" is')
    if inertia not in ("kernel", "mujoco"):
        raise InputError("inertia", f'{inertia!r} is not allowed; "kernel" or "mujoco" is')
    chain = robot.chain
    names = resolve(indices if isinstance(indices, str) else argument("indices", sequence, indices), robot.has_inertia)
    dynamic = any(is_dynamic(name) for name in names)
    if torque_scaling and not dynamic:
        raise InputError("torque_scaling", "must be false with kinematic indices: it scales dynamic ones")
    if torque_scaling and chain.effort_limits is None:
        raise MissingInertiaError("torque_scaling", f"the model of {robot.name} lacks effort limits for some joint")
    characteristic_length_m = argument("characteristic_length_m", positive, characteristic_length_m)
    host_inertia = robot.given_inertia(inertia)
    notices = check_inertias(robot, precision) if dynamic and not robot.definition else ()
    if (penalty := _penalty(joint_limit_penalty)) is not None:
        need_ranges(chain, "robot.limits")
    return Evaluation(
        chain=chain,
        indices=names,
        rows=task_rows(task),
        convention=convention,
        penalty=penalty,
        characteristic_length_m=characteristic_length_m,
        torque_scaling=torque_scaling,
        host_inertia=host_inertia if dynamic else None,
        options=option_values(index_options, names),
        notices=notices,
    )


def check_inertias(robot: Robot, precision: str) -> tuple[Notice, ...]:
    """Whether float32 holds the robot's dynamic indices: J M^-1 with columns too different loses its small values.

    Float64 does, but a link without mass, whose acceleration has no bound, is worth a warning.
    """
    chain = robot.chain
    about_joints = np.diagonal(robot.mujoco_inertia(chain.within(0.5)[None])[0])
    ratio = about_joints.max() / about_joints.min()
    if ratio > SUSPECT_INERTIA_RATIO and precision == "float64":
        message = f"the inertias about the joints of {robot.name} differ by a factor of {ratio:.1g}"
        remedy = "a link without mass?): dynamic indices tell of the lightest link"
        notice = Notice("inertia_ratio", f"{message} ({remedy}")
        warn([notice], ModelWarning)
        return (notice,)
    if ratio > LARGEST_INERTIA_RATIO and precision == "float32":
        raise InputError(
            "precision",
            f'"float32" is not allowed for dynamic indices of {robot.name}: the inertias about its joints differ by '
            f'a factor of {ratio:.1g}, more than {LARGEST_INERTIA_RATIO:g} (a link without mass?); "float64" is',
        )
    return ()


def _penalty(value: float | bool | None) -> float | None:
    """K of the joint-limit penalisation; None where it is off."""
    if value is None or value is False:
        return None
    if value is True:
        return DEFAULT_PENALTY
    if not SMALLEST_PENALTY <= argument("joint_limit_penalty", real, value) <= LARGEST_PENALTY:
        allowed = f"{SMALLEST_PENALTY:g} … {LARGEST_PENALTY:g}, true or null"
        raise InputError("joint_limit_penalty", f"{value!r} is not allowed; {allowed} is")
    return float(value)


def task_rows(task: str | Sequence[str]) -> tuple[int, ...]:
    """Row numbers 0…5 of a task: "linear", "angular", "full" or names from x y z rx ry rz."""
    names = NAMED_TASKS.get(task, (task,)) if isinstance(task, str) else argument("task", sequence, task)
    rows = tuple(TASK_ROWS.index(name) for name in names if name in TASK_ROWS)
    if not rows or len(rows) != len(names) or len(set(rows)) != len(rows):
        raise InputError(
            "task", f"{task!r} is not allowed; linear, angular, full or distinct rows of x y z rx ry rz are"
        )
    return tuple(sorted(rows))
