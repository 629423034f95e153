"""From the arguments of a Python function to a job document, and its execution here."""

from collections.abc import Callable, Mapping
from functools import wraps
from inspect import Signature, signature
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, cast

import numpy as np

from wsrender.analyses.jobs import parse_job
from wsrender.analyses.registry import job_classes
from wsrender.documents.robot import DHTable, RobotSpec
from wsrender.documents.sampling import PYTHON_COUNT, BoundaryBiased, Converge, Grid, Random, Sobol
from wsrender.errors import InputError
from wsrender.keywords import unknown
from wsrender.mechanisms.five_bar import FiveBar
from wsrender.progress import RunProgress
from wsrender.results.result import Result
from wsrender.robot import Robot, UserRobot, as_robot, load_robot
from wsrender.robot.poses import position_and_quaternion
from wsrender.robots import of_mujoco
from wsrender.run.steps import Progress, execute

if TYPE_CHECKING:
    from wsrender.robots.loading import Source

    RobotLike = Robot | UserRobot | Source | RobotSpec | Mapping[str, Any]
    SourceLike = RobotLike | np.ndarray

SamplingLike = Grid | Random | Sobol | BoundaryBiased | Converge | Mapping[str, Any]

Function = TypeVar("Function", bound=Callable[..., Result])

EXECUTION = ("progress", "threads", "chunk_size")
POSES = (("points_m", "quats_wxyz"), ("position_m", "quat_wxyz"))  # which transforms may stand for
SOURCES = ("left", "right", "master", "slave")
_LENGTHS = ("base_m", "proximal_m", "distal_m", "limits_rad")


def runs(analysis: str) -> Callable[[Function], Function]:
    """What makes a function run an analysis: its signature says the parameters, its body is empty.

    Only arguments that are given become fields of the job document: defaults may depend on other fields.
    """

    def decorate(function: Function) -> Function:
        parameters = signature(function)

        @wraps(function)
        def run(*args: Any, **named: Any) -> Result:
            given = _given(function.__name__, parameters, args, named)
            if "sampling" in parameters.parameters:
                given.setdefault("sampling", None)
            progress, threads, chunk_size = (given.pop(name, None) for name in EXECUTION)
            document, robots = document_of(analysis, given)
            return execute_here(document, robots, progress, threads, chunk_size)

        return cast(Function, run)

    return decorate


def _given(name: str, parameters: Signature, args: Any, named: dict[str, Any]) -> dict[str, Any]:
    """Arguments by parameter; TypeError for one that is not known, with the parameter that may be meant."""
    allowed = list(parameters.parameters)
    if wrong := next((each for each in named if each not in allowed), None):
        raise unknown(name, wrong, allowed)
    try:
        return parameters.bind(*args, **named).arguments
    except TypeError as error:
        raise TypeError(f"{name}(): {error}") from None


def document_of(analysis: str, given: dict[str, Any]) -> tuple[dict[str, Any], Any]:
    """The job document of arguments by parameter, and the robots among them, as `execute` takes them.

    ``sampling`` is None, and there, where the analysis takes one that is not given. Raises InputError, and ModelError
    for a robot that cannot be loaded.
    """
    fields, robots = _posed(analysis, given), None
    several = fields.get("robots") is not None
    if "robot" in fields and not (several and fields["robot"] is None):
        robots, fields = _of_one(fields)
    elif several:
        robots, fields = _of_several(fields)
    elif not fields.keys().isdisjoint(SOURCES):
        robots, fields = _of_sources(fields)
    elif isinstance(fields.get("mechanism"), FiveBar):
        mechanism = fields.pop("mechanism")
        fields |= {name: getattr(mechanism, name) for name in _LENGTHS}
    elif fields.get("resume") is not None:
        fields = _resumed(fields)
    fields.pop("resume", None)
    return {"analysis": analysis, **plain(fields)}, robots


def _posed(analysis: str, given: dict[str, Any]) -> dict[str, Any]:
    """The fields, with positions and quaternions of the transforms among them."""
    fields = dict(given)
    for names in POSES:
        if names[0] in fields and names[1] in job_classes()[analysis].model_fields:
            position, quat = position_and_quaternion(fields[names[0]], fields.get(names[1]), names)
            fields |= {names[0]: position} | ({} if quat is None else {names[1]: quat})
    return fields


def _of_one(fields: dict[str, Any]) -> tuple[Robot | None, dict[str, Any]]:
    """The fields of a job of one robot; its document stays as it is."""
    robot, base, tip = (fields.pop(name, None) for name in ("robot", "base", "tip"))
    document = isinstance(robot, Mapping | RobotSpec)
    subject = None if document else _loaded(robot, base, tip)
    arm = arm_entry(subject) if subject is not None else {"robot": robot, "base": base, "tip": tip}
    sampled = sampling_entry(fields.pop("sampling"), subject) if "sampling" in fields else {}
    return subject, {**arm, **sampled, **fields}


def _loaded(robot: Any, base: str | None, tip: str | None) -> Robot:
    """The robot with the frames asked for; InputError where it has its own."""
    if base is None and tip is None:
        return as_robot(robot)
    if isinstance(robot, str | Path | DHTable) or of_mujoco(robot):
        return load_robot(robot, base=base, tip=tip)
    field = "tip" if base is None else "base"
    raise InputError(field, f"must not be given beside a robot that has its own: load_robot(…, {field}=…)")


def _of_several(fields: dict[str, Any]) -> tuple[list[Robot | None], dict[str, Any]]:
    """The fields of a job of several robots, each with its own name and sampling."""
    given, sampled = fields.pop("robots"), "sampling" in fields
    sampling, names = fields.pop("sampling", None), fields.pop("names", None) or [None] * len(given)
    samplings = sampling if isinstance(sampling, list | tuple) else [sampling] * len(given)
    if not len(given) == len(samplings) == len(names):
        counts = f"{len(samplings)} samplings and {len(names)} names for {len(given)} robots"
        raise InputError("robots", f"there are {counts}; one for each is needed")
    entries = [_entry(*each, sampled) for each in zip(given, samplings, names, strict=True)]
    return [robot for _, robot in entries], {"robots": [entry for entry, _ in entries], **fields}


def _entry(given: Any, sampling: Any, name: str | None, sampled: bool) -> tuple[Any, Robot | None]:
    """One of several robots in a job document; what its own document says goes before."""
    beside = {} if name is None else {"name": name}
    if isinstance(given, Mapping):
        return {**sampling_entry(sampling), **beside, **given}, None
    robot = as_robot(given)
    return {**arm_entry(robot), **(sampling_entry(sampling, robot) if sampled else {}), **beside}, robot


def _of_sources(fields: dict[str, Any]) -> tuple[list[Robot | None], dict[str, Any]]:
    """The fields of a job of two robots, sets of points or documents of either; ``sampling`` is for both robots."""
    sampled, robots = sampling_entry(fields.pop("sampling", None)), []
    for name in [each for each in SOURCES if each in fields]:
        source = fields[name]
        if isinstance(source, np.ndarray):
            fields[name] = {"points": source}
        elif not isinstance(source, Mapping):
            robots.append(as_robot(source))
            fields[name] = {**arm_entry(robots[-1]), **sampled}
        elif "robot" in source:
            robots.append(None)
            fields[name] = {**sampled, **source}
    return robots, fields


def _resumed(fields: dict[str, Any]) -> dict[str, Any]:
    """The fields of a search, with the designs of an earlier result."""
    if "evaluations" in fields:
        raise InputError("evaluations", "must not be given together with resume: one of the two")
    tables = fields["resume"].tables
    if "evaluations" not in tables:
        raise InputError("resume", "must be a result of design_optimization: it has no table of evaluations")
    rows = np.stack(list(tables["evaluations"].columns.values()), axis=1)
    known = [[value if np.isfinite(value) else None for value in row] for row in rows.tolist()]
    return {**fields, "evaluations": known}


def arm_entry(robot: Robot) -> dict[str, Any]:
    """Robot, base and tip of a job document; a user-defined robot has no form, and its result document says so."""
    spec = robot.spec or RobotSpec(path="user-defined")
    return {"robot": spec.model_dump(mode="json", exclude_none=True), "base": robot.base, "tip": robot.tip}


def sampling_entry(sampling: Any, robot: Robot | None = None) -> dict[str, Any]:
    """The field ``sampling`` of a job document, if one is given; of a robot that is a Python class always."""
    if sampling is None and robot and robot.definition:
        sampling = Sobol(PYTHON_COUNT)
    return {} if sampling is None else {"sampling": sampling}


def plain(fields: dict[str, Any]) -> dict[str, Any]:
    """Fields of a job document, tuples and sets as lists."""
    return {name: list(value) if isinstance(value, tuple | set) else value for name, value in fields.items()}


def execute_here(
    document: Any,
    robots: Any,
    progress: Progress | bool | None,
    threads: int | None,
    chunk_size: int | None,
) -> Result:
    """Run a job here; ``progress`` True shows a bar."""
    job = parse_job(document)
    if progress is True:
        with RunProgress() as bar:
            return execute(job, bar, robots, threads=threads, chunk_size=chunk_size)
    return execute(job, progress or None, robots, threads=threads, chunk_size=chunk_size)
