"""Inverse kinematics: targets per second, labels against closed forms, volumes against exact ones.

    python benchmarks/inverse.py [--device cpu] [--threads 1] [--targets 20000] [--coverage 100]

Rates are processor seconds on the CPU, seconds on a GPU. Nothing is asserted.
"""

import argparse
import sys
import time
from pathlib import Path

import numpy as np
from arithmetic import inverse_step
from scipy.spatial.transform import Rotation

sys.path.insert(0, str(Path(__file__).parents[1]))

import wsrender as ws
from tests.reference import closed_form_inverse as closed_form
from wsrender.engine import Accuracy, solve_inverse
from wsrender.reach import InverseSolver, refined_volume
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.robots.reachable_box import reachable_box

ROBOTS = ("ur5e", "franka_panda", "puma560", "spherical")
ARMS = {"puma560": closed_form.puma560_arm, "spherical": closed_form.spherical_arm}
EXACT = {"articulated": 0.03348, "spherical": np.pi / 2 * np.sqrt(2) * (0.4**3 - 0.2**3) / 3, "gao_6r": 0.403721}
TOLERANCES = (0.005, 0.001)
NEAR, KERNEL_TRIES, STEPS = 0.02, 1 << 18, 8  # rad or m, from the solution; tries of the kernel alone; steps timed


def seconds(device: str) -> float:
    """Processor time on the CPU, so that a busy machine does not count."""
    return time.process_time() if device == "cpu" else time.perf_counter()


def targets_of(robot: ws.Robot, count: int, kind: str) -> tuple[np.ndarray, np.ndarray | None, np.ndarray]:
    """Positions, orientations of the kind and configurations of random samples."""
    q = np.random.default_rng(1).uniform(robot.lower_limits, robot.upper_limits, (count, robot.chain.n))
    T = robot.forward_kinematics(q, device="cpu")
    return T[:, :3, 3], {"position": None, "axis": T[:, :3, 2], "pose": T[:, :3, :3]}[kind], q


def print_rates(device: str, threads: int, count: int) -> None:
    """Targets per second by robot and kind, and what share of those made by forward kinematics is recovered."""
    print("targets made by forward kinematics: share within 1e-4 m; targets/s; then anywhere in the box: targets/s")
    for name in ROBOTS:
        robot = ws.load_robot(name)
        for kind in ("position", "axis", "pose"):
            solver = InverseSolver(robot.chain, kind=kind, device=device, threads=threads)
            position, orientation, _ = targets_of(robot, count, kind)
            solver.solve(position[:256], None if orientation is None else orientation[:256])
            start = seconds(device)
            found = solver.solve(position, orientation)
            reached = seconds(device) - start
            low, high = reachable_box(robot.chain, robot.lower_limits, robot.upper_limits)
            anywhere = np.random.default_rng(2).uniform(low, high, (count, 3))
            start = seconds(device)
            solver.solve(anywhere, orientation)
            mixed = seconds(device) - start
            share = (found.distance_m < 1e-4).mean()
            print(f"  {name:13} {kind:9} {share:8.3%} {count / reached:11,.0f} {count / mixed:11,.0f}")


def print_kernel(device: str, threads: int) -> None:
    """Tries per second of the kernel alone, from starts near the solution."""
    print("kernel alone, starts near the solution: tries/s")
    for name in ("puma560", "ur5e"):
        robot = ws.load_robot(name)
        for kind in ("position", "pose"):
            solver = InverseSolver(robot.chain, kind=kind)
            position, axes, q = targets_of(robot, KERNEL_TRIES, kind)
            rows = position if axes is None else np.hstack([position, axes.transpose(0, 2, 1).reshape(-1, 9)])
            starts = q[:, : solver.chain.n] + np.random.default_rng(3).uniform(-NEAR, NEAR, (len(q), solver.chain.n))
            for precision in ("float32", "float64"):
                accuracy = Accuracy(1e-5, 1e-5, solver.accuracy.length)
                options = {"precision": precision, "device": device, "threads": threads}
                solve_inverse(solver.chain, rows[:64], starts[:64], accuracy, **options)
                start = seconds(device)
                tries = solve_inverse(solver.chain, rows, starts, accuracy, **options)
                rate = len(rows) / (seconds(device) - start)
                steps = _steps_per_second(solver, rows, options, device)
                work = steps * inverse_step(solver.chain.n, precision, kind == "pose") / 1e9
                print(
                    f"  {name:13} {kind:9} {precision} {rate:13,.0f} {steps:13,.0f} steps/s {work:6.1f} GFLOP/s", end=""
                )
                print(f"   reached {tries.reached.mean():.2%}")


def _steps_per_second(solver: InverseSolver, rows: np.ndarray, options: dict, device: str) -> float:
    """From random starts to a target that none of so few steps reaches exactly."""
    chain = solver.chain
    starts = np.random.default_rng(6).uniform(chain.lower_limits, chain.upper_limits, (len(rows), chain.n))
    start = seconds(device)
    solve_inverse(chain, rows, starts, Accuracy(0.0, 0.0, solver.accuracy.length), steps=STEPS, **options)
    return STEPS * len(rows) / (seconds(device) - start)


def print_confusion(device: str, count: int) -> None:
    """Labels against closed forms, targets anywhere in the box of the reach."""
    print("labels against the closed form:  truth reachable: yes / undecided / no;  truth unreachable: likewise")
    for name in ("puma560", "spherical", "ur5e"):
        robot = ws.load_robot(name)
        low, high = reachable_box(robot.chain, robot.lower_limits, robot.upper_limits)
        position = np.random.default_rng(4).uniform(low, high, (count, 3))
        axes = Rotation.random(count, random_state=5).as_matrix()
        for kind in ("position", "pose") if name in ARMS else ("pose",):
            solver = InverseSolver(robot.chain, kind=kind, position_m=1e-9, angle_rad=1e-9, device=device)
            label = solver.solve(position, axes if kind == "pose" else None).label
            truth = _truth(robot, position, axes, kind)
            order = (REACHABLE, UNDECIDED, UNREACHABLE)
            table = [[int((label[truth == t] == value).sum()) for value in order] for t in (True, False)]
            print(f"  {name:13} {kind:9} {table[0]}  {table[1]}")


def _truth(robot: ws.Robot, position: np.ndarray, axes: np.ndarray, kind: str) -> np.ndarray:
    with np.errstate(invalid="ignore", divide="ignore"):
        if robot.name == "ur5e":
            solutions = closed_form.ur5e(position, axes)
        else:
            solutions = ARMS[robot.name](position)
            if kind == "pose":
                solutions = closed_form.with_spherical_wrist(robot.name, solutions, axes)
    n, chain = solutions.shape[2], robot.chain
    limits = chain.lower_limits[:n], chain.upper_limits[:n], chain.revolute[:n]
    return closed_form.within_limits(solutions, *limits).any(axis=1)


def print_volumes(device: str, threads: int) -> None:
    """Refined volumes to two tolerances: interval, points, seconds."""
    print("refined volume: tolerance, value, 95 % interval, exact; points; seconds")
    for name, exact in EXACT.items():
        chain = ws.load_robot(name).chain
        for tolerance in TOLERANCES:
            start = seconds(device)
            estimate, found = refined_volume(chain, tolerance, device=device, threads=threads)
            spent = seconds(device) - start
            interval = f"{estimate.low:.6f} … {estimate.high:.6f}"
            print(
                f"  {name:13} {tolerance:6.1%} {estimate.value:.6f}  {interval}  {exact:.6f}"
                f"  {found.points:8,} points  {spent:5.1f} s"
            )


def print_coverage(device: str, threads: int, runs: int) -> None:
    """How often the interval holds the exact volume, over so many seeds."""
    print(f"coverage of the 95 % interval at 1 %, {runs} seeds")
    for name in ("spherical", "gao_6r"):
        chain, held = ws.load_robot(name).chain, 0
        for seed in range(runs):
            estimate, _ = refined_volume(chain, 0.01, seed=seed, device=device, threads=threads)
            held += estimate.low <= EXACT[name] <= estimate.high
        print(f"  {name:13} {held} of {runs}")


def main() -> None:
    """Parse the options and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--targets", type=int, default=20_000)
    parser.add_argument("--coverage", type=int, default=100, help="seeds of the coverage; 0: none")
    options = parser.parse_args()
    print_kernel(options.device, options.threads)
    print_rates(options.device, options.threads, options.targets)
    print_confusion(options.device, options.targets)
    print_volumes(options.device, options.threads)
    if options.coverage:
        print_coverage(options.device, options.threads, options.coverage)


if __name__ == "__main__":
    main()
