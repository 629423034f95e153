"""Seconds to compile the fused kernel and to load it from the kernel cache, and its rate, by number of joints.

    python benchmarks/compile.py [--device cpu] [--joints 6 7 12]

From an empty cache; loaded by a second process. Both begin with a small kernel, which on a CPU brings Warp's C++
header: precompiled by the first process of a machine that compiles, then kept beside the kernels. A CPU's lane loop
that clang did not vectorise shows in the rate: about a sixth of that of the next smaller arm.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import replace

import numpy as np
import warp as wp
from throughput import plan_of
from wsrender_kernels.pointwise import configuration_kernel

import wsrender as ws
from wsrender.engine import SweepPlan, devices_of
from wsrender.engine.kernel_cache import loaded
from wsrender.engine.sweep_plan import Accumulator

WORKS: dict[str, dict] = {
    "6 kinematic": {},
    "12": {"indices": "all"},
    "6 kinematic, task full": {"task": "full"},
    "12, task full": {"indices": "all", "task": "full"},
    "12, table_1": {"indices": "all", "convention": "table_1"},
}
SMALL = "a small kernel first"


def arm(n: int) -> ws.DHTable:
    """Arm of n revolute joints, each with a link of 1 kg."""
    generator = np.random.default_rng(n)
    link = {"mass": 1.0, "center_of_mass": (0.0, 0.0, 0.1), "inertia": (0.02, 0.02, 0.01), "limits": (-3.0, 3.0)}
    rows = []
    for _joint in range(n):
        a, d = generator.uniform(0.1, 0.3, 2)
        rows.append({"joint": "revolute", "a": a, "alpha": generator.uniform(-3, 3), "d": d, **link})
    return ws.DHTable(convention="modified", rows=rows, name=f"arm{n}")


def rate(accumulator: Accumulator, target: wp.Device) -> float:
    """Samples per second, the best of four runs."""
    count = 2**16 if target.is_cpu else 2**24
    seconds = []
    for _run in range(4):
        started = time.perf_counter()
        accumulator.launch(0, count)
        wp.synchronize_device(target)
        seconds.append(time.perf_counter() - started)
    return count / min(seconds)


def measured(joints: list[int], device: str) -> dict[str, tuple[float, float | None]]:
    """Of each kernel in this process, by its name, seconds until it is loaded, and samples per second."""
    target = devices_of(device)[0]
    started = time.perf_counter()
    loaded(configuration_kernel(wp.float32, 2, "random"), target)
    results: dict[str, tuple[float, float | None]] = {SMALL: (time.perf_counter() - started, None)}
    for n in joints:
        table = arm(n)
        robot, document = ws.load_robot(table), {"dh": table.model_dump(mode="json")}
        for precision in ("float32", "float64"):
            for work, fields in WORKS.items():
                plan = plan_of(robot, precision, device, robot=document, **fields)
                plan = SweepPlan(replace(plan, block=None, statistics=frozenset()))
                started = time.perf_counter()
                accumulator = Accumulator(plan, plan.shape, None, target, 256)
                seconds = time.perf_counter() - started
                results[f"{n} joints, {work}, {precision}"] = seconds, rate(accumulator, target)
    return results


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--joints", type=int, nargs="+", default=[6, 7, 12])
    parser.add_argument("--here", action="store_true", help="measure in this process and print JSON")
    arguments = parser.parse_args()
    if arguments.here:
        print(json.dumps(measured(arguments.joints, arguments.device)))
        return
    with tempfile.TemporaryDirectory() as cache:
        command = [sys.executable, *sys.argv, "--here"]
        environment = {**os.environ, "WARP_CACHE_PATH": cache}
        runs = [subprocess.run(command, env=environment, check=True, stdout=subprocess.PIPE) for _run in range(2)]
    compiled, cached = (json.loads(run.stdout.splitlines()[-1]) for run in runs)
    print("| kernel | compiled [s] | from the cache [ms] | M samples/s |\n|---|--:|--:|--:|")
    for name, (seconds, _rate) in compiled.items():
        load, samples = cached[name]
        print(f"| {name} | {seconds:.2f} | {1e3 * load:.0f} | {'' if samples is None else f'{samples / 1e6:.3g}'} |")


if __name__ == "__main__":
    main()
