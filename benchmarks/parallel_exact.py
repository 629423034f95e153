"""Methods C and D on the 6-PUS of Shah, Narayanan and Krovi (2010): CPU time of one core, and errors.

python benchmarks/parallel_exact.py [--repeat 20]
"""

import argparse
import os
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from pydantic import TypeAdapter

from wsrender.design.inscribed import largest_ball, largest_cube
from wsrender.documents.mechanism import MechanismSpec
from wsrender.mechanisms.ball_region import ball_region
from wsrender.mechanisms.exact import ExactWorkspace, exact_volumes
from wsrender.mechanisms.mechanism import mechanism_of
from wsrender.mechanisms.solids import solid_workspace
from wsrender.run import plan, run_shard

KNOWN_M3 = 0.717344315
SPEC = TypeAdapter(MechanismSpec)
SWEEP = {
    "analysis": "design_optimization",
    "design": {"analysis": "parallel_workspace", "mechanism": "six_pus", "device": "cpu"},
    "parameters": [
        {"name": "platform", "pointers": ["/mechanism/platform_m"], "bounds": [1.0, 3.0]},
        {"name": "link", "pointers": [f"/mechanism/link_m/{k}" for k in range(3)], "bounds": [2.3, 4.3]},
    ],
    "objectives": [{"value": "exact_volume"}],
    "search": {"method": "sweep", "steps": 21},
}


def six_pus(**parameters):
    return ball_region(mechanism_of(SPEC.validate_python({"library": "six_pus", **parameters})), np.eye(3))


def cpu_seconds(work, repeat):
    work()
    started = time.process_time()
    for _ in range(repeat):
        found = work()
    return (time.process_time() - started) / repeat, found


def report(name, seconds, volume, exact=KNOWN_M3):
    print(f"{name:44s} {1e3 * seconds:9.2f} ms   volume {volume:.9f} m³, error {volume / exact - 1:+.1e}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeat", type=int, default=20)
    repeat = parser.parse_args().repeat
    region = six_pus()

    def vertices():
        workspace = ExactWorkspace.of(region)
        return workspace.volume_m3, workspace.vertices

    seconds, (volume, points) = cpu_seconds(vertices, repeat)
    report(f"C, volume and {len(points)} vertices", seconds, volume)
    seconds, mesh = cpu_seconds(lambda: ExactWorkspace.of(region).mesh, repeat)
    report(f"C, faces and mesh of {len(mesh.faces)} triangles", seconds, mesh.volume)
    for subdivisions in (4, 5):
        seconds, mesh = cpu_seconds(lambda n=subdivisions: solid_workspace(region, n), 2)
        report(f"D, balls of {20 * 4**subdivisions} triangles", seconds, mesh.volume)
    steps = np.linspace(0, 2, 21)
    designs = [six_pus(platform_m=1 + side, link_m=2.3 + link) for side in steps for link in steps]
    seconds, found = cpu_seconds(lambda: exact_volumes(designs).volume, 3)
    print(
        f"C, 441 volumes at once {1e3 * seconds:31.2f} ms   {found.min():.3f} … {found.max():.3f} m³ (0.43 s to beat)"
    )
    planned = plan(SWEEP)
    seconds, partial = cpu_seconds(lambda: run_shard(planned, 0), 3)
    found = partial["values"]
    print(
        f"the same as a design_optimization {1e3 * seconds:20.2f} ms   {found.min():.3f} … {found.max():.3f} m³ "
        "(0.43 s on two cores to beat)"
    )
    for name, largest in (("ball", largest_ball), ("cube", largest_cube)):
        seconds, found = cpu_seconds(lambda largest=largest: largest(region, np.eye(4)), repeat)
        bound = found.at_most / found.size - 1
        print(f"largest inscribed {name:26s} {1e3 * seconds:9.2f} ms   {found.size:.9f} m, at most {bound:.1%} more")


if __name__ == "__main__":
    main()
