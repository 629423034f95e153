"""Rates of the fused kernel by itself and of ws.analyze, in one run, beside the machine's peak.

    python benchmarks/limits.py [--robots ur5e franka_panda] [--device cpu] [--repeats 5]

A kernel's rate is that of its launches, the slope between two numbers of samples: what a launch costs at any size is
left out. Voxels are 100 per axis of the robot's reach. "rows" are written to device memory and stay there.
"""

import argparse
import statistics
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace

import numpy as np
import warp as wp
from arithmetic import operations
from throughput import machine, peaks, plan_of

import wsrender as ws
from wsrender.engine import SweepPlan, devices_of
from wsrender.engine.sweep_plan import Accumulator
from wsrender.pipeline.pipeline import Pipeline

PRECISIONS = ("float32", "float64")
CHUNK_CPU, CHUNK_CUDA = 1 << 20, 1 << 26  # samples of a launch; on a GPU, whose rows it holds


@dataclass
class Case:
    """One row: ``seconds(count)`` of work, rate by the slope between two counts."""

    name: str
    precision: str
    seconds: Callable[[int], float]
    counts: tuple[int, int]
    share: float | None = None  # of the peak, per sample and second
    rates: list[float] = field(default_factory=list)

    def measure(self) -> None:
        """Adds one repeat."""
        few, many = self.counts
        slope = (self.seconds(many) - self.seconds(few)) / (many - few)
        self.rates.append(1 / slope if slope > 0 else float("nan"))


def cases_of(robot: ws.Robot, device: str, threads: int, peak: dict) -> list[Case]:
    """The kernel's cases on one device."""
    on_gpu = devices_of(device)[0].is_cuda
    size = 1 << 32 if on_gpu else 1 << 24
    cases = []
    for precision in PRECISIONS:

        def add(
            name: str, pipeline: Pipeline, slower: int, flop: int | None = None, precision: str = precision
        ) -> None:
            counts = (size // slower, 5 * size // slower)
            share_of_peak = flop / peak[precision, threads] if flop else None
            cases.append(
                Case(name, precision, lambda count: _launched(pipeline, count, device, threads), counts, share_of_peak)
            )

        n = robot.chain.n
        six, twelve = (operations(n, precision, dynamic, voxels=False) for dynamic in (False, True))
        fields = {"voxel_statistics": ["maximum"], "voxel_size_m": 2 * robot.chain.reach / 100}
        kinematic = plan_of(robot, precision, device, **fields)
        every = plan_of(robot, precision, device, **fields, indices="all")
        full = plan_of(robot, precision, device, **fields, task="full")
        sums = plan_of(robot, precision, device, **fields | {"voxel_statistics": ["maximum", "mean"]})
        without = {"block": None, "statistics": frozenset[str]()}
        rows = {**without, "kept_rows": frozenset[str]()}
        add("6 kinematic", replace(kinematic, **without), 1, six)
        add("12", replace(every, **without), 4, twelve)
        if on_gpu:
            add("6 kinematic, rows", replace(kinematic, **rows), 1)
            add("12, rows", replace(every, **rows), 4)
        add("6 kinematic, voxels: count, 6 maxima", kinematic, 2)
        add("6 kinematic, voxels: count, 6 maxima, 6 sums", sums, 4)
        add("6 kinematic, task full", replace(full, **without), 16)
    return cases


def _launched(pipeline: Pipeline, count: int, device: str, threads: int) -> float:
    """Seconds of launches alone, each thread with an accumulator of its own."""
    target = devices_of(device)[0]
    workers, chunk = (1, CHUNK_CUDA) if target.is_cuda else (threads, CHUNK_CPU)
    plan = SweepPlan(pipeline)
    accumulators = [Accumulator(plan, plan.shape, pipeline.block, target, chunk) for _ in range(workers)]

    def work(worker: int) -> None:
        for first in range(worker * chunk, count, workers * chunk):
            accumulators[worker].launch(first, min(chunk, count - first))

    started = time.perf_counter()
    with ThreadPoolExecutor(workers) as pool:
        list(pool.map(work, range(workers)))
    wp.synchronize_device(target)
    return time.perf_counter() - started


def table(cases: list[Case], title: str) -> str:
    """Markdown: median rates, spread, share of the peak."""
    lines = [f"### {title}", "", "| work | precision | M samples/s | min … max | % of peak |", "|---|---|--:|--:|--:|"]
    for case in cases:
        middle, low, high = statistics.median(case.rates), min(case.rates), max(case.rates)
        share = f"{100 * middle * case.share:.0f}" if case.share else ""
        low_high = f"{low / 1e6:.3g} … {high / 1e6:.3g}"
        lines.append(f"| {case.name} | {case.precision} | {middle / 1e6:.4g} | {low_high} | {share} |")
    return "\n".join(lines)


def end_to_end(robot: ws.Robot, device: str, repeats: int) -> str:
    """Seconds of ws.analyze, warm: grids, and many samples with what they cost beside the sweep."""
    on_gpu = devices_of(device)[0].is_cuda
    block = {"voxel_size_m": 2 * robot.chain.reach / 100, "voxel_statistics": ["maximum"], "device": device}
    samplings = [ws.Grid(16), ws.Random(10**8, seed=1)]
    if on_gpu:
        samplings = [ws.Grid(40), ws.Random(10**9, seed=1)]
    lines = ["| ws.analyze, float32 | s | of these in the sweep |", "|---|--:|--:|"]
    for sampling in samplings:
        levels = getattr(sampling, "per_joint", None)
        what = f"grid {levels}^{robot.chain.n}" if levels else f"{sampling.count:.0e} random"
        if levels and levels**robot.chain.n > 2e10:
            continue
        totals, sweeps = [], []
        for repeat in range(repeats + 1):
            started = time.perf_counter()
            result = ws.analyze(robot, sampling, max_samples=10**11, refined_volume=None, **block)
            if repeat:  # the first is not warm
                totals.append(time.perf_counter() - started)
                sweeps.append(result.document["timing_s"]["sweep"])
        lines.append(f"| {what} | {np.median(totals):.3f} | {np.median(sweeps):.3f} |")
    return "\n".join(lines)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("--robots", nargs="+", default=["ur5e", "franka_panda"])
    parser.add_argument("--device", default="auto")
    parser.add_argument("--repeats", type=int, default=5)
    arguments = parser.parse_args()
    device = arguments.device
    if device == "auto":
        device = devices_of("auto")[0].alias
    peak = peaks(device)
    print(machine(device, peak), flush=True)
    for name in arguments.robots:
        robot = ws.load_robot(name)
        for threads in sorted({threads for _precision, threads in peak}):
            cases = cases_of(robot, device, threads, peak)
            for case in cases:
                case.seconds(256)  # compiles
            for _repeat in range(arguments.repeats):
                for case in cases:
                    case.measure()
            print(f"\n{table(cases, f'{name}, {threads} thread(s)' if device == 'cpu' else name)}", flush=True)
        print(f"\n{end_to_end(robot, device, arguments.repeats)}", flush=True)


if __name__ == "__main__":
    main()
