"""Samples per second of wsrender beside NumPy, MuJoCo and Pinocchio, all in one run, repeats interleaved.

    python benchmarks/throughput.py [--robots ur5e franka_panda] [--repeats 5] [--devices cpu] [--without-analyze]

A sample is a random configuration with its 3 x n Jacobian, singular values and six kinematic indices, or twelve with
the inertia matrix and the six dynamic ones. Nothing is asserted but that all contenders compute the same numbers.
"""

import argparse
import os
import platform
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np
from arithmetic import bytes_moved, operations
from contenders import CONTENDERS, Loop
from peak import cpu_peak, gpu_peak

import wsrender as ws
from wsrender.engine import devices_of, sweep, thread_count
from wsrender.pipeline.pipeline import Pipeline

AGREEMENT = 1e-6  # relative to the largest value, between contenders at the same configurations
FEW, FIRST_GUESS, WANTED_SECONDS = 256, 1 << 18, 1.0
LOOP_SAMPLES, BATCH_SAMPLES = 1_000, 1 << 14
WORKS = {False: "6 kinematic", True: "12"}


@dataclass
class Case:
    """One row of the table; ``run(count)`` evaluates so many random samples."""

    contender: str
    work: str
    run: Callable[[int], object]
    samples: int
    operations: int = 0
    bytes: int = 0
    peak: float = 0.0
    rates: list[float] = field(default_factory=list)

    def measure(self) -> None:
        """Adds one repeat."""
        self.rates.append(self.samples / _seconds(self, self.samples))

    @property
    def rate(self) -> float:
        """Median samples per second."""
        return statistics.median(self.rates)


def engine_cases(robot: ws.Robot, device: str, peaks: dict, with_analyze: bool = True) -> list[Case]:
    """Cases of the fused kernel: precisions, threads, with and without voxels; and of the whole of ws.analyze."""
    cases = []
    on_gpu = devices_of(device)[0].is_cuda
    for precision in ("float32", "float64"):
        for threads in [1] if on_gpu else sorted({1, thread_count()}):
            for dynamic, work in WORKS.items():
                plan = plan_of(robot, precision, device, indices="all" if dynamic else "kinematic")
                bare = replace(plan, block=None, statistics=frozenset())
                where = device if on_gpu else f"{threads} thread{'s' * (threads > 1)}"
                for voxels, what in ((False, bare), (True, plan)):
                    case = Case(
                        f"wsrender kernel {precision}, {where}",
                        work + (", voxels" if voxels else ""),
                        lambda count, what=what, threads=threads: _sweep(what, count, device, threads),
                        FIRST_GUESS,
                        operations(robot.chain.n, precision, dynamic, voxels),
                        bytes_moved(precision, dynamic, voxels),
                        peaks[precision, threads],
                    )
                    cases.append(_sized(case))
                if not with_analyze:
                    continue
                case = Case(
                    f"ws.analyze {precision}, {where}",
                    f"{work}, voxels",
                    lambda count, p=precision, d=dynamic, t=threads: _analyze(robot, count, p, d, device, t),
                    FIRST_GUESS,
                )
                cases.append(_sized(case))
    return cases


def plan_of(robot: ws.Robot, precision: str, device: str, /, **fields) -> Pipeline:
    """The pipeline of a job with 2^40 random samples; by default as ws.analyze: count and maximum per voxel."""
    job = {
        "analysis": "workspace",
        "robot": {"library": robot.name},
        "sampling": {"method": "random", "count": 1 << 40, "seed": 1},
        "max_samples": 1 << 41,
        "precision": precision,
        "device": device,
    }
    return ws.run.plan({**job, **fields}, robot).pipeline  # type: ignore[attr-defined]


def _sweep(pipeline: Pipeline, count: int, device: str, threads: int) -> None:
    sweep(pipeline, 0, count, devices_of(device), threads=threads)


def _analyze(robot: ws.Robot, count: int, precision: str, dynamic: bool, device: str, threads: int) -> None:
    indices = "all" if dynamic else "kinematic"
    ws.analyze(
        robot,
        ws.Random(count, seed=1),
        indices,
        precision=precision,
        refined_volume=None,
        device=device,
        threads=threads,
    )


def _sized(case: Case) -> Case:
    """The case with enough samples that what a run costs at any size (voxel records) is a fifth of it at most.

    Compiles its kernel on the way.
    """
    case.run(FEW)
    fixed = max(_seconds(case, FEW) for _ in range(3))
    while _seconds(case, case.samples) < 5 * fixed + WANTED_SECONDS:
        case.samples *= 4
    return case


def _seconds(case: Case, count: int) -> float:
    started = time.perf_counter()
    case.run(count)
    return time.perf_counter() - started


def python_cases(robot: ws.Robot) -> list[Case]:
    """Cases of the other contenders, each first compared with wsrender."""
    q = np.random.default_rng(0).uniform(robot.lower_limits, robot.upper_limits, (BATCH_SAMPLES, robot.chain.n))
    cases = []
    for make in CONTENDERS:
        try:
            contender = make(robot)
        except ImportError as error:
            print(f"{make.name}: left out, {error}")
            continue
        _check(robot, contender, q[:200])
        loop = issubclass(make, Loop)
        for dynamic, work in WORKS.items():
            for batched in (False, True) if loop else (True,):
                name = contender.name + (", SVD batched" if loop and batched else "")
                cases.append(
                    Case(
                        f"{name}, float64",
                        work,
                        lambda count, c=contender, d=dynamic, b=batched: c(q[:count], d, b),
                        LOOP_SAMPLES if loop else BATCH_SAMPLES,
                    )
                )
    return cases


def _check(robot: ws.Robot, contender, q: np.ndarray) -> None:
    J, M, values = contender(q, True)
    own = (robot.jacobian(q)[:, :3], robot.inertia_matrix(q), np.array([*ws.evaluate_indices(robot, q).values()]))
    for theirs, ours in zip((J, M, values), own, strict=True):
        scale = np.abs(ours).max(axis=-1, keepdims=True) if theirs is values else np.abs(ours).max()
        worst = float((np.abs(theirs - ours) / scale).max())
        if worst > AGREEMENT:
            raise SystemExit(f"{contender.name} differs from wsrender by {worst:.2g} on {robot.name}")


def table(cases: list[Case], robot: ws.Robot) -> str:
    """Markdown: rates, ratio to NumPy's rate for the same indices, share of the peak, bytes."""
    base = {case.work: case.rate for case in cases if case.contender.startswith("NumPy")}
    lines = [f"### {robot.name}, {robot.chain.n} joints", ""]
    lines += [
        "| contender | work | samples/s | min … max | × NumPy | flop | % of peak | bytes |",
        "|---|---|--:|--:|--:|--:|--:|--:|",
    ]
    for case in cases:
        share = f"{100 * case.rate * case.operations / case.peak:.0f}" if case.peak else ""
        ratio = case.rate / base[case.work.removesuffix(", voxels")]
        lines.append(
            f"| {case.contender} | {case.work} | {_short(case.rate)} | {_short(min(case.rates))} … "
            f"{_short(max(case.rates))} | {ratio:.3g} | {case.operations or ''} | {share} | {case.bytes or ''} |"
        )
    return "\n".join(lines)


def _short(rate: float) -> str:
    for size, unit in ((1e9, " G"), (1e6, " M"), (1e3, " k")):
        if rate >= size:
            return f"{rate / size:.3g}{unit}"
    return f"{rate:.3g}"


def machine(device: str, peaks: dict) -> str:
    """What it was measured on: processor, load, versions, peaks."""
    names = ("wsrender", "warp-lang", "numpy", "mujoco", "pin")
    load = f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"
    lines = [
        f"- {_processor()}, {thread_count()} cores, load {load} at the start; device {devices_of(device)[0].name}",
        "- Python " + platform.python_version() + ", " + ", ".join(f"{name} {_version(name)}" for name in names),
    ]
    lines += [
        f"- peak {precision}, {threads} thread(s): {peak / 1e9:.4g} GFLOP/s"
        for (precision, threads), peak in peaks.items()
    ]
    return "\n".join(lines)


def _processor() -> str:
    try:
        with Path("/proc/cpuinfo").open() as file:
            return next(line.split(":")[1].strip() for line in file if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "absent"


def peaks(device: str) -> dict[tuple[str, int], float]:
    """Operations per second by precision and threads (1 on a GPU)."""
    target = devices_of(device)[0]
    if target.is_cuda:
        return {(precision, 1): gpu_peak(precision, target) for precision in ("float32", "float64")}
    threads = sorted({1, thread_count()})
    return {(precision, t): cpu_peak(precision, t) for precision in ("float32", "float64") for t in threads}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("--robots", nargs="+", default=["ur5e", "franka_panda"])
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--without-analyze", action="store_true", help="leave out ws.analyze, which takes longest")
    parser.add_argument("--devices", nargs="+", help="default: cpu, and cuda:0 where there is a GPU")
    arguments = parser.parse_args()
    full = not arguments.without_analyze
    devices = arguments.devices or ["cpu"] + ["cuda:0"] * devices_of("auto")[0].is_cuda
    peak = {device: peaks(device) for device in devices}
    for device in devices:
        print(machine(device, peak[device]))
    for name in arguments.robots:
        robot = ws.load_robot(name)
        cases = python_cases(robot) + [case for d in devices for case in engine_cases(robot, d, peak[d], full)]
        for _repeat in range(arguments.repeats):
            for case in cases:
                case.measure()
        print(f"\n{table(cases, robot)}", flush=True)


if __name__ == "__main__":
    main()
