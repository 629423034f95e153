"""Parallel mechanisms: poses per second of methods A and B, and what the indices at the voxels take.

    python benchmarks/parallel.py [--device cpu] [--threads 2] [--poses 8e6]

A rate on the CPU is per processor second times the threads, so that a busy machine does not count; on a GPU per second
of the wall, with the copy of what is reached to the host. Nothing is asserted.
"""

import argparse
import sys
import time
from pathlib import Path

import numpy as np
from pydantic import TypeAdapter

sys.path.insert(0, str(Path(__file__).parents[1]))

from wsrender.documents.mechanism import MechanismSpec
from wsrender.engine import count_orientations
from wsrender.mechanisms.jacobians import pose_indices
from wsrender.mechanisms.mechanism import mechanism_of
from wsrender.mechanisms.membership import leg_test, reachable_box
from wsrender.volume.lattice import block_around

NAMES = ("stewart_gough", "six_pus", "delta")
LEVEL = np.eye(3)[None]
REPEATS = 5
# Additions, multiplications, divisions and square roots of a leg at a pose: place of the joint 3; UPS: difference 3,
# its square 5; PUS: difference 3, along 5, off the rail 6, squares 6, root 1, sliders 2; crank: difference 3, two
# dot products 10, square 5, constant 4, sum 3, root 3, quotient 1, sines and cosines 16, angles 6.
LEG_FLOP = {"UPS": 3 + 3 + 5, "PUS": 3 + 3 + 5 + 6 + 6 + 1 + 2, "delta": 3 + 3 + 10 + 5 + 4 + 3 + 3 + 1 + 16 + 6}
PLACE_FLOP, BYTES = 9 + 15, 8  # of a pose: the voxel's centre and its place in the base frame; two counts written


def print_rates(device: str, threads: int, poses: int) -> None:
    """Poses per second by mechanism, precision and method, with operations and bytes per pose."""
    print("mechanism      precision method        poses/s   legs/pose  flop/pose  bytes/pose  GFLOP/s")
    for name in NAMES:
        mechanism = mechanism_of(TypeAdapter(MechanismSpec).validate_python(name))
        box = reachable_box(mechanism, LEVEL)
        block = block_around(box.lower, box.upper, float(np.cbrt(box.volume / poses)))
        for precision in ("float32", "float64"):
            for method, by_subsystem in (("A", False), ("B", True)):
                rate, legs = _rate(leg_test(mechanism, precision), block, by_subsystem, device, threads)
                flop = PLACE_FLOP + legs * LEG_FLOP[mechanism.kinds[0]]
                print(
                    f"{name:14} {precision:9} {method:6} {rate:14,.0f} {legs:11.2f} {flop:10.1f} {BYTES:11}"
                    f" {rate * flop / 1e9:8.1f}"
                )


def _rate(test, block, by_subsystem: bool, device: str, threads: int) -> tuple[float, float]:
    """The best rate of several runs, and legs evaluated per pose."""
    options = {"by_subsystem": by_subsystem, "device": device, "threads": threads}
    count_orientations(test, block, LEVEL, 0, 256, **options)
    spent = []
    for _ in range(REPEATS):
        wall, processor = time.perf_counter(), time.process_time()
        found = count_orientations(test, block, LEVEL, 0, block.size, **options)
        taken = (time.process_time() - processor) / threads if device == "cpu" else time.perf_counter() - wall
        spent.append(taken)
    return block.size / min(spent), found.asked / block.size


def print_indices() -> None:
    """Poses per processor second of the six indices and both Jacobians (NumPy)."""
    print("six indices, condition numbers and determinants at poses: poses per processor second")
    for name, position in (("stewart_gough", (0, 0, 0.55)), ("six_pus", (0, 0, 1.9)), ("delta", (0, 0, -0.7))):
        mechanism = mechanism_of(TypeAdapter(MechanismSpec).validate_python(name))
        poses = np.broadcast_to(np.eye(4), (20_000, 4, 4)).copy()
        poses[:, :3, 3] = np.array(position) + np.random.default_rng(0).uniform(-0.01, 0.01, (20_000, 3))
        names = ("manipulability", "inverse_condition_number", "isotropy")
        start = time.process_time()
        pose_indices(mechanism, poses, names, range(mechanism.degrees_of_freedom))
        print(f"  {name:14} {len(poses) / (time.process_time() - start):10,.0f}")


def main() -> None:
    """Parse the options and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--poses", type=float, default=8e6)
    options = parser.parse_args()
    print_rates(options.device, options.threads, int(options.poses))
    print_indices()


if __name__ == "__main__":
    main()
