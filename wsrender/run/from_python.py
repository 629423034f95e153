"""From Python objects to job documents, and their execution here."""

from typing import Any

import numpy as np

from wsrender.analyses.jobs import parse_job
from wsrender.documents.document import Document
from wsrender.documents.robot import RobotSpec
from wsrender.documents.sampling import PYTHON_COUNT, Sobol
from wsrender.progress import RunProgress
from wsrender.results.result import Result
from wsrender.robot import Robot, as_robot
from wsrender.run.steps import Progress, execute


def as_source(source: Any) -> Robot | np.ndarray | dict[str, Any]:
    """Points and documents as they are, anything else as a robot."""
    return source if isinstance(source, np.ndarray | dict) else as_robot(source)


def source_entry(source: Robot | np.ndarray | dict[str, Any]) -> dict[str, Any]:
    """A robot, points or a document of either in a job document."""
    if isinstance(source, dict):
        return source
    return arm_entry(source) if isinstance(source, Robot) else {"points": source}


def arm_entry(robot: Robot) -> dict[str, Any]:
    """Robot, base and tip of a job document; a user-defined robot has no form, and its result document says so."""
    spec = robot.spec or RobotSpec(path="user-defined")
    return {"robot": spec.model_dump(mode="json", exclude_none=True), "base": robot.base, "tip": robot.tip}


def sampling_entry(sampling: Any, robot: Robot | None = None) -> dict[str, Any]:
    """The field ``sampling`` of a job document, if one is given; of a robot that is a Python class always."""
    if sampling is None and robot and robot.definition:
        sampling = Sobol(PYTHON_COUNT)
    if sampling is None:
        return {}
    return {"sampling": sampling.model_dump(mode="json") if isinstance(sampling, Document) else sampling}


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
