"""The four steps of a job, and a local run of them."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from wsrender.analyses.contract import Analysis, Progress
from wsrender.analyses.execution import Execution
from wsrender.analyses.jobs import parse_job
from wsrender.analyses.registry import planned
from wsrender.collision.asked import told_to
from wsrender.documents.arm import Arm, ArmPath, dotted
from wsrender.errors import InputError
from wsrender.keywords import keywords
from wsrender.results.result import Result
from wsrender.robot import Robot, as_robot, robot_of_spec
from wsrender.robot.constraints import notices_of
from wsrender.robot.gravity import gravity_notices
from wsrender.run.usable_robots import usable

Plan = Analysis
"""A job with everything resolved: device target, voxel size, sampling path, shards, cost."""


def plan(document: Any, robot: Any = None, *, resolved: dict[str, Any] | None = None) -> Plan:
    """Resolve a job: a document (dict or JSON text) or a parsed job.

    ``robot`` replaces the document's; where a job has several, a list with a robot or None for each.

    ``resolved`` is `Analysis.resolved` of an earlier plan of the same job: nothing in it is settled again, so that
    partial results of different processes merge. A plan has one shard; that of an `Analysis.division` has several, and
    what is merged of them may have `further` ones.

    Raises DocumentError, InputError, ModelError, ResourceError; nothing has run then.
    """
    job = parse_job(document)
    arms = job.arms()
    given = robot if isinstance(robot, list) else [robot] * len(arms)
    robots = [
        usable(_robot(path, arm, one), arm, path, job) for (path, arm), one in zip(arms.items(), given, strict=True)
    ]
    found = planned(job, *robots, resolved=resolved)
    of_robots = (n for path, each in zip(arms, robots, strict=True) for n in notices_of(each, job, dotted(path)))
    found.notices = (*of_robots, *(n for each in robots for n in gravity_notices(job, each)))
    return found


def _robot(path: ArmPath, arm: Arm, given: Any) -> Robot:
    """The robot given, or else that of the document; errors say where in the document it is."""
    if given is not None:
        return as_robot(given)
    try:
        return robot_of_spec(arm.robot, arm.base, arm.tip, arm.held_joints)
    except InputError as error:
        raise error.within(dotted(path)) from None


def run_shard(
    plan: Plan,
    shard: int,
    progress: Callable[[int], None] | None = None,
    *,
    threads: int | None = None,
    chunk_size: int | None = None,
    checkpoint: str | Path | None = None,
) -> Any:
    """The partial result of one shard; a plan that can go on where it was stopped does so from the file ``checkpoint``.

    ``threads`` and ``chunk_size`` (samples) change no bit; see `Execution`. Raises InputError where they are below 1.
    """
    kept = Path(checkpoint) if checkpoint is not None and plan.resumes else None
    return plan.run_shard(shard, progress, Execution(threads, chunk_size, kept, execute))


def merge(plan: Plan, a: Any, b: Any) -> Any:
    """The partial result of both; associative, so the order of shards does not matter."""
    return plan.merged(a, b)


def further(plan: Plan, partial: Any, *, threads: int | None = None) -> Plan | None:
    """The plan with one more round of shards that follow from the merged ones, as of a search; None: they were all."""
    settled = plan.further(partial, Execution(threads, runner=execute))
    return None if settled is None else plan.settled_as(settled)


def finish(
    plan: Plan,
    partial: Any,
    seconds: dict[str, float] | None = None,
    progress: Progress | None = None,
    *,
    threads: int | None = None,
) -> Result:
    """The result of the merged partial results; ``seconds`` goes into ``timing_s``, ``threads`` change no bit.

    ``progress(done, total, message)`` is called while a plan refines, with points and about how many there will be,
    and with all samples once the rest begins.
    """
    seconds, execution = dict(seconds or {}), Execution(threads, runner=execute)
    started, merged = time.perf_counter(), partial
    partial = plan.refined(merged, progress, execution)
    if partial is not merged:
        seconds["refine"] = time.perf_counter() - started
    if progress:
        progress(plan.samples, plan.samples, "finishing")
    return plan.finish(partial, seconds, execution)


@keywords
def execute(
    document: Any,
    progress: Progress | None = None,
    robot: Any = None,
    *,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """Run a job here, from document to result.

    ``progress(done, total, message)`` is called in this thread a few times a second. ``threads`` (default:
    the variable WSRENDER_THREADS, else all cores) and ``chunk_size`` change no bit of the result.

    >>> pose = {"position_m": [0.4, 0.2, 0.3], "quat_wxyz": [0, 1, 0, 0]}
    >>> result = ws.execute({"analysis": "postures", "robot": {"library": "ur5e"}, **pose})
    >>> result.document["postures"]["postures"]
    8
    """
    with _interruptible(progress) as told:
        started = time.perf_counter()
        told(0, 1, "planning")
        with told_to(progress):
            settled = plan(document, robot)
        total = settled.samples
        planned_at = time.perf_counter()

        def report(done: int) -> None:
            told(done, max(total, done), "samples")  # converging jobs exceed it

        partial = run_shard(settled, 0, report, threads=threads, chunk_size=chunk_size)
        swept_at = time.perf_counter()
        seconds = {"plan": planned_at - started, "sweep": swept_at - planned_at}
        return finish(settled, partial, seconds, told if progress else None, threads=threads)


@contextmanager
def _interruptible(progress: Progress | None) -> Iterator[Progress]:
    """What reports progress; to a Ctrl-C it adds how far the run was, and that a run here keeps nothing."""
    last = (0, 1, "planning")

    def told(done: int, total: int, message: str) -> None:
        nonlocal last
        last = done, total, message
        if progress:
            progress(done, total, message)

    try:
        yield told
    except KeyboardInterrupt as error:
        if not getattr(error, "__notes__", ()):  # of a run within this one
            done, total, message = last
            error.add_note(f"{message}, {done:,} of {total:,} done; nothing of this run was kept")
        raise
