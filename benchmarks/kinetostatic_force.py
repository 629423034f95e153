"""CPU time of single evaluations ``field.force(q)``, by robot, device and form.

    python benchmarks/kinetostatic_force.py [--rounds 40]

Goal: at most 50 µs on a CPU core. Prints [µs] of the calling thread, mean over 200 random configurations in the fastest
of many rounds: of a default field, whose forces act near limits and at ill-conditioned postures, and of one whose
joint-limit and conditioning forces act everywhere, the dearest.
"""

import argparse
import itertools
import time

import numpy as np

import wsrender as ws

ROBOTS = ("scara", "phantom_omni", "slave_5r", "puma560", "ur5e", "franka_panda")
GOAL_US = 50.0
CALLS = 200


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--rounds", type=int, default=40)
    rounds = options.parse_args().rounds
    print(f"{'robot':<16}{'joints':>7}  {'device':<8}{'form':<12}{'default':>8}{'all':>8}  [µs], goal {GOAL_US:g}")
    for name, kind, form in itertools.product(ROBOTS, ("force", "wrench"), ("potential", "normalised")):
        times = [microseconds(*case, rounds) for case in cases(name, kind, form)]
        joints = ws.load_robot(name).chain.n
        verdict = "" if max(times) <= GOAL_US else "  above the goal"
        print(f"{name:<16}{joints:>7}  {kind:<8}{form:<12}{times[0]:>8.1f}{times[1]:>8.1f}{verdict}")


def cases(name: str, kind: str, form: str):
    """(field, configurations): of a default field, and of one whose forces all act everywhere."""
    robot = ws.load_robot(name)
    choices = {"form": form, "haptic_device": {"kind": kind}, "task": "full" if kind == "wrench" else "linear"}
    random = np.random.default_rng(0)
    q = random.uniform(robot.lower_limits, robot.upper_limits, (CALLS, len(robot.lower_limits)))
    yield ws.force_field(robot, **choices), q
    wide = {"margin_rad": 3.0, "margin_m": 3.0}
    always = {"joint_limits": wide, "conditioning": {"inverse_condition_on": 1.0, "condition_threshold": 1e9}}
    yield ws.force_field(robot, **choices, **always), q


def microseconds(field: ws.ForceField, q: np.ndarray, rounds: int) -> float:
    """CPU time per call of the fastest round [µs]."""
    best = np.inf
    for _ in range(rounds):
        started = time.thread_time()
        for row in q:
            field.force(row)
        best = min(best, time.thread_time() - started)
    return 1e6 * best / len(q)


if __name__ == "__main__":
    main()
