"""Configurations of samples by number."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import TypeAdapter

from wsrender.documents.arm import PYTHON_CLASS, robot_named
from wsrender.documents.quantities import argument, integer
from wsrender.documents.robot import RobotSpec
from wsrender.documents.sampling import Converge, Grid, Sampling
from wsrender.engine import configurations
from wsrender.errors import InputError
from wsrender.keywords import keywords
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.robot import Robot, as_robot, robot_of_spec

if TYPE_CHECKING:
    from wsrender.results.result import Result

_SAMPLING: TypeAdapter[Any] = TypeAdapter(Sampling)


@keywords
def configuration_of(result: "Result", number: int, robot: Any = None) -> np.ndarray:
    """The configuration (n,) float64 [rad or m] of a sample of a ``workspace`` result by its number, as of ``best``.

    Any sample of any method has one, admitted or not. ``robot`` is that of the result, for one that is a Python class.
    Raises InputError for a number that is none of the result's, and for another analysis; ModelError.

    >>> result = ws.analyze("scara", ws.Grid(4), task=["x", "y"], refined_volume=None)
    >>> ws.configuration_of(result, 0).round(3).tolist()  # the first of the grid: all lower limits
    [-0.785, 0.785, 0.2, -3.142]
    """
    job = result.document.get("job") or {}
    if result.document.get("analysis") != "workspace" or "sampling" not in job:
        raise InputError("result", "must be of the analysis workspace, whose samples have numbers")
    if robot is None and PYTHON_CLASS in job["robot"]:
        raise InputError("robot", f"must be given: {job['robot'][PYTHON_CLASS]} is a Python class")
    return configuration_in(result.document, as_robot(robot) if robot is not None else _robot(job), number)


def configuration_in(document: Mapping[str, Any], robot: Robot, number: int) -> np.ndarray:
    """The same of a result document and its robot."""
    job, number = document["job"], argument("number", integer, number)
    sampling = _SAMPLING.validate_python(job["sampling"])
    if isinstance(sampling, Converge):
        sampling = Grid(tuple(document["sampling"]["per_joint"]), locked=sampling.locked)
    plan = plan_sampling(robot.chain, sampling)
    if not 0 <= number < plan.count:
        raise InputError("number", f"must be from 0 to {plan.count - 1}, not {number}")
    pipeline = Pipeline(Evaluation(robot.chain), plan, precision=job["precision"])
    return np.asarray(configurations(pipeline, np.array([number]))[0], np.float64)


def _robot(job: Mapping[str, Any]) -> Robot:
    spec = RobotSpec(**robot_named(job["robot"]))
    return robot_of_spec(spec, job["base"], job["tip"], held=job["sampling"]["locked"])
