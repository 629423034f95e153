"""The analyses of several robots from Python."""

from collections.abc import Sequence
from typing import Any

from wsrender.errors import InputError
from wsrender.results.result import Result
from wsrender.robot import Robot, as_robot
from wsrender.run.from_python import (
    arm_entry,
    as_source,
    execute_here,
    plain,
    sampling_entry,
    source_entry,
)
from wsrender.run.steps import Progress


def shared_workspace(
    robots: Sequence[Any],
    sampling: Any = None,
    *,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
    **fields: Any,
) -> Result:
    """What several robots reach together: union, shared volume, volume by number of robots, shared quality.

    ``robots`` are Robots (placed by ``load_robot(…, placement=…)``), user-defined robots or what `load_robot` takes;
    the arms of one model are loaded with other ``base`` and ``tip``. ``sampling`` is one for all or a list of one for
    each (default Sobol(2**20), of user-defined robots Sobol(2**16)). ``fields`` are the other fields of the job
    document ``shared_workspace``: scan, refined_volume, indices, task, voxel_size_m, max_samples, precision, device …;
    ``names`` says what the result calls the robots; ``threads`` and ``chunk_size`` are those of `analyze`.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    return _several("shared_workspace", robots, sampling, fields, progress, threads, chunk_size)


def robot_comparison(
    robots: Sequence[Any],
    sampling: Any = None,
    *,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
    **fields: Any,
) -> Result:
    """Several robots, or placements of one, on one lattice: a table of differences, pictures of one scale.

    The arguments are those of `shared_workspace`, without ``scan``.
    """
    return _several("robot_comparison", robots, sampling, fields, progress, threads, chunk_size)


def collaborative_volume(
    left: Any,
    right: Any,
    *,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
    **fields: Any,
) -> Result:
    """Collaborative volume of two arms by the body-elemental algorithm, and its true value if asked.

    ``left`` and ``right`` are robots as in `shared_workspace`, or points (N, 3) [m]. ``fields`` are the other fields of
    the job document ``collaborative_volume``: samples, seeds, seed, cells, refinements, neighbours, refined_volume …
    ``threads`` and ``chunk_size`` are those of `analyze`.

    Raises DocumentError, InputError, ModelError, ResourceError.
    """
    return _two("collaborative_volume", {"left": left, "right": right}, {}, fields, progress, threads, chunk_size)


def master_slave_mapping(
    master: Any,
    slave: Any,
    *,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
    **fields: Any,
) -> Result:
    """Whether a slave's workspace, scaled, turned and shifted, lies in its master's, and the largest that does.

    ``master`` and ``slave`` are robots as in `shared_workspace`, points (N, 3) [m], or the document of a mechanism,
    {"mechanism": "master_4dof"}. ``sampling`` is one for both
    robots (default Sobol(20000)); ``fields`` are the other fields of the job document ``master_slave_mapping``: scale,
    rotation, offsets_m, containment, search, device. ``threads`` and ``chunk_size`` are those of `analyze`.

    Raises DocumentError, InputError, ModelError, ResourceError.
    """
    sampling = fields.pop("sampling", None)
    sources = {"master": master, "slave": slave}
    return _two("master_slave_mapping", sources, sampling_entry(sampling), fields, progress, threads, chunk_size)


def _two(
    analysis: str,
    sources: dict[str, Any],
    sampled: dict[str, Any],
    fields: dict[str, Any],
    progress: Progress | bool | None,
    threads: int | None,
    chunk_size: int | None,
) -> Result:
    """Run an analysis of two robots or sets of points, by their fields of the document."""
    subjects = {name: as_source(source) for name, source in sources.items()}
    robots = [subject for subject in subjects.values() if isinstance(subject, Robot)]
    entries = {
        name: source_entry(subject) | (sampled if isinstance(subject, Robot) else {})
        for name, subject in subjects.items()
    }
    return execute_here({"analysis": analysis, **entries, **plain(fields)}, robots, progress, threads, chunk_size)


def _several(
    analysis: str,
    robots: Sequence[Any],
    sampling: Any,
    fields: dict[str, Any],
    progress: Progress | bool | None,
    threads: int | None,
    chunk_size: int | None,
) -> Result:
    subjects = [as_robot(robot) for robot in robots]
    samplings = sampling if isinstance(sampling, list | tuple) else [sampling] * len(subjects)
    names = fields.pop("names", None) or [None] * len(subjects)
    if not len(subjects) == len(samplings) == len(names):
        counts = f"{len(samplings)} samplings and {len(names)} names for {len(subjects)} robots"
        raise InputError("robots", f"there are {counts}; one for each is needed")
    arms = [
        {**arm_entry(subject), **sampling_entry(own, subject), "name": name}
        for subject, own, name in zip(subjects, samplings, names, strict=True)
    ]
    return execute_here(
        {"analysis": analysis, "robots": arms, **plain(fields)}, subjects, progress, threads, chunk_size
    )
