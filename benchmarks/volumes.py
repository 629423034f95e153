"""Refined volumes beside exact ones: whether the interval holds them, and what it took.

    python benchmarks/volumes.py [--device cpu] [--threads 2] [--tolerances 0.005 0.001]

Seconds are those of the processor on the CPU. Last, without an exact one, a UR5e over a floor that keeps apart from
itself, to 1 %, from the chain and its constraints on: what is free, with seconds of the clock too, twice, for the first
prepares the collisions where the cache lacks them. Nothing is asserted.
"""

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import wsrender as ws
from tests.reference.exact_volumes import CASES, articulated, spherical_pair
from wsrender.documents.constraints import Constraints
from wsrender.reach import Inside, VolumeEstimate, refined_volume, refined_volumes
from wsrender.reach.measure_refinement import free_measures
from wsrender.robot.constraints import constraints_for

EVENTS = {"any": Inside(1, 2), "both": Inside(2, 2)}


def pairs() -> dict[str, tuple[list[ws.Robot], dict[str, float], float]]:
    """Placed robots, the volumes that any and both reach [m³], and their relative error."""
    at = {x: ws.Transform(position_m=(x, 0, 0.4)) for x in (0.1, -0.1)}
    beside = {x: ws.Transform(position_m=(x, 0.4, 0), rpy_deg=(0, 0, 90)) for x in (0.1, -0.1)}
    back = {angle: ws.Transform(rpy_deg=(0, 0, angle)) for angle in (0, 180)}
    placements = {"articulated": at, "spherical": beside, "gao_6r": back}
    any_spherical, both_spherical = spherical_pair()
    exact = {
        "articulated": ({"any": 2 * articulated() - 0.012757, "both": 0.012757}, 3e-4),
        "spherical": ({"any": any_spherical, "both": both_spherical}, 1e-4),
        "gao_6r": ({"any": 2 * 0.403721 - 6.2190e-3, "both": 6.2190e-3}, 5e-4),
    }
    return {
        name: ([ws.load_robot(name, placement=placement) for placement in placements[name].values()], *exact[name])
        for name in placements
    }


def print_line(name: str, tolerance: float, found: VolumeEstimate, exact: float, error: float) -> None:
    """Interval, exact volume and whether they agree."""
    held = "held" if found.low <= exact * (1 + error) and found.high >= exact * (1 - error) else "MISSED"
    half = (found.high - found.low) / 2 / found.value if found.value else 0.0
    interval = f"{found.low:12.6g} … {found.high:12.6g}  ±{half:.2%}"
    print(
        f"{name:28} {tolerance:6.1%}  {interval}  exact {exact:12.6g}  {held:6} {'' if found.met else 'not met '}",
        end="",
    )


def print_free(device: str, threads: int) -> None:
    """The free volume of a UR5e over a floor, what blocks the rest, and what it took."""
    robot, floor = ws.load_robot("ur5e"), ws.Environment([ws.HalfSpace(name="floor")])
    for _ in range(2):
        clock, processor = time.perf_counter(), time.process_time()
        constraints = constraints_for(robot, Constraints(self_collision=True), floor)
        found = free_measures([robot.chain], [constraints], {"": 1}, 0.01, device=device, threads=threads)[""]
        took = f"{time.perf_counter() - clock:.1f} s, of the processor {time.process_time() - processor:.1f} s"
        for name in ("free", "blocked"):
            of = found[name]
            print(f"ur5e over a floor, {name:8} {of.value:.4f} m³ ({of.ci95[0]:.4f} … {of.ci95[1]:.4f})", end="  ")
        print(f"{found['free'].points:,} points {took}", flush=True)


def main() -> None:
    """Parse the options and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--tolerances", type=float, nargs="+", default=[0.005, 0.001])
    options = parser.parse_args()
    clock = time.process_time if options.device == "cpu" else time.perf_counter
    execution = {"device": options.device, "threads": options.threads}
    for tolerance in options.tolerances:
        for name, case in CASES.items():
            chain, start = case.robot().chain, clock()
            estimate, found = refined_volume(chain, tolerance, **execution)
            print_line(name, tolerance, estimate, case.volume, case.error)
            print(f"{found.points:9,} points {clock() - start:6.1f} s", flush=True)
        for name, (robots, exact, error) in pairs().items():
            start = clock()
            found = refined_volumes([robot.chain for robot in robots], EVENTS, tolerance, **execution)
            for event, volume in exact.items():
                print_line(f"two {name}, {event}", tolerance, found.volumes[event], volume, error)
                print(f"{found.points:9,} points {clock() - start:6.1f} s", flush=True)
    print_free(options.device, options.threads)


if __name__ == "__main__":
    main()
