"""What a result says of its origin: robot, versions, hashes, target."""

import os
import platform
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from typing import Any

import numpy as np

from wsrender import __version__
from wsrender.documents.arm import PYTHON_CLASS, at_path
from wsrender.documents.options import TASK_ROWS
from wsrender.origin import asked_by, citation
from wsrender.pipeline.evaluation import Evaluation
from wsrender.robot import Robot

SAY_HOST = "WSRENDER_SAY_HOST"


def robot_entry(robot: Robot) -> dict[str, Any]:
    """Name, hashes, frames, joints and limits of a robot, for the result document."""
    chain = robot.chain
    return {
        "name": robot.name,
        "user_defined": robot.definition is not None,
        "model_hash": robot.model_hash,
        "chain_hash": chain.content_hash,
        "base_frame": chain.base_frame,
        "tip_frame": chain.tip_frame,
        "T_world_base": chain.T_world_base.tolist(),
        "T_tip_tool": chain.T_tip_tool.tolist(),
        "joint_names": list(chain.joint_names),
        "lower_limits": _finite(chain.lower_limits),
        "upper_limits": _finite(chain.upper_limits),
        "has_inertia": chain.has_inertia,
    }


def _finite(limits: np.ndarray) -> list[float | None]:
    """Limits as JSON writes them: null where a joint has none."""
    return [end if np.isfinite(end) else None for end in limits.tolist()]


def job_entry(job: Any, *robots: Robot) -> dict[str, Any]:
    """The job document that gave a result; a robot that is a Python class has no form that could be run again."""
    entry = job.model_dump(mode="json")
    for path, robot in zip(job.arms(), robots, strict=True):
        if robot.definition:
            at_path(entry, path)["robot"] = {PYTHON_CLASS: robot.definition}
    return entry


def index_choices(job: Any, evaluation: Evaluation) -> dict[str, Any]:
    """The choices that make an index's values unambiguous."""
    return {
        "task": [TASK_ROWS[r] for r in evaluation.rows],
        "convention": job.convention,
        "characteristic_length_m": job.characteristic_length_m,
        "joint_limit_penalty": job.joint_limit_penalty,
        "torque_scaling": job.torque_scaling,
        "inertia": job.inertia,
        "index_options": {name: dict(options) for name, options in evaluation.options.items()},
    }


def provenance(job: Any, target: str, **more: Any) -> dict[str, Any]:
    """Versions, host, and what planning settled: precision, target, seed, and what else the plan has to say.

    A job without a choice of ``precision`` is computed in float64. The ``seed`` is the job's, else that of its sampling
    or of its search; without any there is none. ``run`` says when it ended, and by which command; no file but the
    document holds it, so equal results have equal files. The host's name is told where WSRENDER_SAY_HOST is 1.
    """
    packages = ("warp-lang", "mujoco", "numpy")
    return {
        "wsrender": __version__,
        **{name: _version(name) for name in packages},
        "precision": getattr(job, "precision", "float64"),
        "target": target,
        **_seed(job),
        **more,
        "citation": citation(),
        "run": {"date": datetime.now(UTC).isoformat(timespec="seconds"), **_command()},
        "host": {"python": platform.python_version(), "system": platform.platform(), **_host_name()},
    }


def _command() -> dict[str, str]:
    command = asked_by.get()
    return {} if command is None else {"command": command}


def _host_name() -> dict[str, str]:
    return {"name": platform.node()} if os.environ.get(SAY_HOST) == "1" else {}


def _seed(job: Any) -> dict[str, int]:
    """The seed of a job under its name; nothing of one that draws nothing, or of several robots, each with its own."""
    for drawing in (job, getattr(job, "sampling", None), getattr(job, "search", None)):
        if (seed := getattr(drawing, "seed", None)) is not None:
            return {"seed": seed}
    return {}


@cache
def _version(package: str) -> str:
    """Looked up once: it reads a file of each package, 3 ms."""
    try:
        return version(package)
    except PackageNotFoundError:
        return "unknown"
