"""The workspace analysis from Python."""

from collections.abc import Sequence
from typing import Any

from wsrender.progress import RunProgress
from wsrender.result import Result
from wsrender.robot import Robot, as_robot
from wsrender.run.steps import Progress, execute
from wsrender.spec import WorkspaceJob
from wsrender.spec.document import Document
from wsrender.spec.parsing import parse_job
from wsrender.spec.robot import RobotSpec
from wsrender.spec.sampling import Grid


def analyze(
    robot: Any,
    sampling: Any = None,
    indices: str | Sequence[str] = "kinematic",
    task: str | Sequence[str] = "linear",
    *,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
    **fields: Any,
) -> Result:
    """Sample a robot's joint space: distribution map, volume data and global indices.

    ``robot`` is a Robot, a user-defined robot or what `load_robot` takes; ``sampling`` one of Grid, Random, Sobol,
    BoundaryBiased, Converge (default Grid(15)) or its part of a job document; ``fields`` are the other fields of the
    job document ``workspace``: convention, joint_limit_penalty, characteristic_length_m, torque_scaling, inertia,
    voxel_size_m, voxel_statistics, keep_map, map_columns, max_samples, precision, device. ``progress``: True shows a
    bar on work of more than a second; or a function (done, total, message). ``threads`` and ``chunk_size`` change no
    bit of the result. Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    subject = _robot(robot)
    job = parse_job(
        {
            "analysis": "workspace",
            "robot": _spec(subject),
            "base": subject.base,
            "tip": subject.tip,
            "sampling": _sampling(sampling),
            "indices": indices if isinstance(indices, str) else list(indices),
            "task": task if isinstance(task, str) else list(task),
            **{name: list(v) if isinstance(v, tuple | set) else v for name, v in fields.items()},
        }
    )
    assert isinstance(job, WorkspaceJob)
    options: dict[str, Any] = {"robot": subject, "threads": threads, "chunk_size": chunk_size}
    if progress is True:
        with RunProgress() as bar:
            return execute(job, bar, **options)
    return execute(job, progress or None, **options)


def _robot(robot: Any) -> Robot:
    from pathlib import Path

    from wsrender.robot import load_robot
    from wsrender.spec.robot import DHTable

    return load_robot(robot) if isinstance(robot, str | Path | DHTable) else as_robot(robot)


def _sampling(sampling: Any) -> Any:
    if sampling is None:
        return Grid().model_dump(mode="json")
    return sampling.model_dump(mode="json") if isinstance(sampling, Document) else sampling


def _spec(robot: Robot) -> dict[str, Any]:
    """The document form of a robot; a user-defined one has none, and its result document says so."""
    spec = robot.spec or RobotSpec(path="user-defined")
    return spec.model_dump(mode="json", exclude_none=True)
