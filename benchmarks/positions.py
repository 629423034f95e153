"""Positions alone beside six indices, side by side in one run: rates of launches, and of rows returned as NumPy arrays.

    python benchmarks/positions.py [--robots ur5e franka_panda] [--device cpu] [--threads 1] [--repeats 5]

Every repeat takes all cases in turn; ratios are of the least times. Aims: launches of positions at 1.3 times the rate
of six indices or more, NumPy rows (N, 3) at half that rate or more.
"""

import argparse
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from throughput import plan_of

import wsrender as ws
from wsrender.engine import devices_of, sampled_positions, sweep
from wsrender.pipeline.pipeline import Pipeline

SAMPLES = {"cpu": 1 << 23, "cuda": 1 << 28}
ROWS = 1 << 22  # returned to the host


def cases_of(robot: ws.Robot, precision: str, device: str, threads: int) -> dict[str, tuple[int, Callable[[], object]]]:
    """Samples and work of each case, by name."""
    devices = devices_of(device)
    count = SAMPLES["cuda" if devices[0].is_cuda else "cpu"]
    six = plan_of(robot, precision, device, sampling=ws.Sobol(count))
    alone = replace(six.of_tip, kept_rows=None)
    rows = Pipeline(six.evaluation, six.sampling, bounds=six.bounds, precision=precision)
    return {
        "six indices": (count, lambda: sweep(rows, 0, count, devices, threads=threads)),
        "positions": (count, lambda: sweep(alone, 0, count, devices, threads=threads)),
        "positions, NumPy rows": (
            ROWS,
            lambda: sampled_positions(six, device, count=ROWS, threads=threads),
        ),
    }


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("--robots", nargs="+", default=["ur5e", "franka_panda"])
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--repeats", type=int, default=5)
    arguments = parser.parse_args()
    print("| robot | precision | work | M samples/s | of six indices |\n|---|---|---|--:|--:|")
    for name in arguments.robots:
        for precision in ("float32", "float64"):
            cases = cases_of(ws.load_robot(name), precision, arguments.device, arguments.threads)
            least = dict.fromkeys(cases, np.inf)
            for repeat in range(arguments.repeats + 1):
                for case, (_count, work) in cases.items():
                    started = time.perf_counter()
                    work()
                    if repeat:  # the first is not warm
                        least[case] = min(least[case], time.perf_counter() - started)
            rates = {case: count / least[case] for case, (count, _work) in cases.items()}
            for case, rate in rates.items():
                print(f"| {name} | {precision} | {case} | {rate / 1e6:.1f} | {rate / rates['six indices']:.2f} |")


if __name__ == "__main__":
    main()
