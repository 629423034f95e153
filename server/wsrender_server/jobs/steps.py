"""The steps of a computation, as they run in a kernel process: plan, shards, finish, all by `wsrender.run`."""

import ctypes
import os
import shutil
import time
from collections import OrderedDict
from functools import reduce
from importlib import import_module
from pathlib import Path
from typing import Any

from wsrender.errors import ResourceError
from wsrender.robots.uploaded import MODELS_VARIABLE
from wsrender_server.jobs.child_process import settle_in
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.task import Step, Task
from wsrender_server.settings import Settings

MOST_SHARDS = 256
KEPT_PLANS = 4
BEHIND = 10  # niceness: a server answers, and live streams run, while jobs take all cores
# Modules that take seconds to load: of plans, of shards, of results and their files.
NEEDED = (
    *("wsrender.analyses.jobs", "wsrender.run.steps", "wsrender.run.partial_files", "wsrender.robots.mjcf_model"),
    *("wsrender.analyses.refined", "wsrender.geometry.surfaces", "wsrender.results.drawing.result_plots"),
    *("h5py", "matplotlib.figure", "pyarrow.parquet", "skimage.measure", "trimesh"),
)
GPU_FACTOR = 256  # samples of a GPU in the time of one of the CPU, roughly

_state: dict[str, Any] = {}
_plans: "OrderedDict[str, Any]" = OrderedDict()


def start(settings: Settings, threads: int, gauges: "ctypes.Array[ctypes.c_int64]") -> None:
    """Set up a kernel process; ``gauges`` (3,), shared with the worker.

    They hold the process id, the samples done of the shard, the points that the last step has decided or the
    collision tables that the first has made, and how many of these there will be.
    """
    settle_in()
    if hasattr(os, "nice"):  # not on Windows
        os.nice(BEHIND)
    files = DataFolder(settings.data_dir)
    os.environ.update({"WSRENDER_THREADS": str(threads), MODELS_VARIABLE: str(files.models)})
    _state.update(files=files, threads=threads, gauges=gauges)
    _state.update(shard_samples=settings.shard_samples)
    gauges[1] = gauges[2] = 0
    gauges[0] = os.getpid()


def describe() -> dict[str, str]:
    """The target of each kind of device here: "cpu", and "cuda" where there is a GPU."""
    from wsrender.engine import devices_of, target_of
    from wsrender.errors import InputError

    targets = {}
    for device in ("cpu", "cuda"):
        try:
            targets[device] = target_of(devices_of(device))
        except InputError:
            continue
    return targets


def warm() -> None:
    """Load what any job needs, and nothing that the next one would have to wait for: see ``NEEDED``."""
    describe()
    for name in NEEDED:
        import_module(name)


def run(task: Task) -> Any:
    """Run a step. PLAN gives what was settled, SHARD None, FINISH the artifacts' records, or more shards settled."""
    _state["gauges"][1] = _state["gauges"][2] = 0
    return {Step.PLAN: _plan, Step.SHARD: _shard, Step.FINISH: _finish}[task.step](task)


def _plan(task: Task) -> dict[str, Any]:
    from wsrender.collision.asked import told_to
    from wsrender.collision.store import put

    started, gauges = time.perf_counter(), _state["gauges"]

    def report(done: int, total: int, message: str) -> None:
        gauges[1], gauges[2] = done, total

    with told_to(report):
        plan = _planned(task)
    put(plan.programs, _programs(task))
    samples = max(plan.cost.samples, plan.samples)
    if task.limits is not None and samples > (allowed := task.limits.samples):
        raise ResourceError("sampling", f"has {samples:.4g} samples; this server allows {allowed:.4g}")
    faster = GPU_FACTOR if plan.target.startswith("cuda:") else 1
    return {
        "resolved": plan.division(faster * _state["shard_samples"], MOST_SHARDS).entry(),
        "target": plan.target,
        "estimate": plan.estimate,
        "seconds": time.perf_counter() - started,
    }


def _shard(task: Task) -> None:
    """Compute and keep one partial result."""
    from wsrender.run import run_shard
    from wsrender.run.partial_files import save_partial

    gauges = _state["gauges"]

    def report(done: int) -> None:
        gauges[1] = done

    path = _files().partials(task.computation) / partial_name(task.shard)
    if path.exists():  # kept by a process that was lost before it could say so
        return
    path.parent.mkdir(exist_ok=True)
    kept = path.with_suffix(".checkpoint")
    partial = run_shard(_planned(task), task.shard, report, threads=_state["threads"], checkpoint=kept)
    save_partial(partial, path)


def _finish(task: Task) -> list[dict[str, Any]] | dict[str, Any]:
    """Merge all partial results, in one pass that holds two of them, and write the artifacts; or settle more shards."""
    from wsrender.run import finish, further, merge

    plan = _planned(task)
    partials = (_load(task, shard, plan) for shard in range(len(plan.shards)))
    partial = reduce(lambda a, b: merge(plan, a, b), partials)
    if (more := further(plan, partial, threads=_state["threads"])) is not None:
        return {"resolved": more.resolved(), "target": more.target}
    gauges = _state["gauges"]

    def report(done: int, total: int, message: str) -> None:
        gauges[1], gauges[2] = done, total

    result = finish(plan, partial, task.seconds, report, threads=_state["threads"])
    scratch = _files().root / "scratch"
    for left in scratch.glob(f"{task.computation}.*"):  # by a process that was lost at this step
        shutil.rmtree(left, ignore_errors=True)
    own = scratch / f"{task.computation}.{os.getpid()}"
    own.mkdir()
    try:
        result.save(own / "result")
        return _publish(result.document, own / "result", task.computation)
    finally:
        shutil.rmtree(own, ignore_errors=True)


def _publish(document: dict[str, Any], staging: Path, computation: str) -> list[dict[str, Any]]:
    """Move the artifacts to where their hashes say, the document first in the list."""
    from wsrender.results.export.artifacts import DOCUMENT, sha256
    from wsrender.results.export.formats import media_type

    path = staging / DOCUMENT
    own = {"name": DOCUMENT, "media_type": media_type(DOCUMENT), "bytes": path.stat().st_size, "sha256": sha256(path)}
    records = [own, *document["artifacts"]]
    for record in records:
        target = _files().artifact(computation, record["sha256"])
        target.parent.mkdir(exist_ok=True)
        source = staging / record["name"]
        with source.open("rb") as file:
            os.fsync(file.fileno())
        if source.exists():
            source.replace(target)
    return records


class DamagedPartialError(Exception):
    """A file of a partial result cannot be read; it has been removed, so that its shard is computed again."""


def _load(task: Task, shard: int, plan: Any) -> Any:
    from wsrender.errors import InputError
    from wsrender.run.partial_files import load_partial

    path = _files().partials(task.computation) / partial_name(shard)
    try:
        return load_partial(path, plan)
    except InputError as error:
        path.unlink(missing_ok=True)
        raise DamagedPartialError(str(error)) from error


def partial_name(shard: int) -> str:
    """File name of a shard's partial result."""
    return f"{shard}.npz"


def _planned(task: Task) -> Any:
    """The plan of a computation, made once per process; programs of collisions are those that the first has made."""
    from wsrender.collision.store import take_from
    from wsrender.run import plan

    take_from(_programs(task))
    key = f"{task.token}:{len(task.resolved['shards']) if task.resolved else 0}"
    if key not in _plans:
        _plans[key] = plan(task.document.read(_files(), task.computation), resolved=task.resolved)
        while len(_plans) > KEPT_PLANS:
            _plans.popitem(last=False)
    return _plans[key]


def _programs(task: Task) -> Path:
    return _files().partials(task.computation) / "programs"


def _files() -> DataFolder:
    return _state["files"]
