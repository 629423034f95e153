"""Boundaries of planar arms from Python."""

from collections.abc import Mapping
from typing import Any

from wsrender.geometry.planar.exact_boundary import ExactBoundary
from wsrender.results.result import Result
from wsrender.robot import as_robot, model_chain
from wsrender.run.from_python import arm_entry, execute_here, plain, sampling_entry
from wsrender.run.steps import Progress
from wsrender.sampling import held_chain


def planar_boundary(
    robot: Any,
    sampling: Any = None,
    *,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
    **fields: Any,
) -> Result:
    """The boundary of the positions that a planar arm reaches: exact, and by Monte Carlo (Alciatore & Ng 1994).

    ``robot`` is a Robot or what `load_robot` takes; ``sampling`` (default Random(100000)) may lock joints that would
    leave the plane. ``fields`` are the other fields of the job document ``planar_boundary``: cells, points_m …
    ``threads`` and ``chunk_size`` are those of `analyze`.

    Raises ModelError, naming the joint, for an arm that is not planar; DocumentError, InputError.
    """
    subject = as_robot(robot)
    document = {"analysis": "planar_boundary", **arm_entry(subject), **sampling_entry(sampling), **plain(fields)}
    return execute_here(document, subject, progress, threads, chunk_size)


def exact_boundary(robot: Any, *, locked: Mapping[str, float] | None = None) -> ExactBoundary:
    """The exact boundary alone, with ``area``, ``segments``, ``contains(points)`` and ``nearest(points)``.

    ``locked`` holds joints, by name, at a value [rad or m]. Raises ModelError, naming the joint, for an arm that is not
    planar; InputError for an unknown joint or a value beyond its limits.
    """
    return ExactBoundary.of(held_chain(model_chain(robot), locked or {}))
