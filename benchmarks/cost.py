"""Estimates beside what ran: samples, memory, bytes of files and seconds of jobs of all analyses, small and large.

``python benchmarks/cost.py [NAME …]`` runs each job in a process of its own, with one thread, after a small one of
the same analysis (imports, kernels; among shapes after itself), and prints what it took and the ratio of estimate to
that. Seconds are processor time of that thread, as on an idle core, from the plan to saved files. Memory is the peak
of the process between plan and result above what it had before, every array in pages of its own: what an allocator
keeps of those that are gone, up to as much again, is not counted. Files count as they are before they are compressed.
Constants of ``wsrender/analyses/cost.py`` and the rates beside each analysis were read off such runs.
"""

import ctypes
import gc
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ONE_THREAD = dict.fromkeys(("WSRENDER_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
OWN_PAGES = {"MALLOC_MMAP_THRESHOLD_": "65536"}


def sampled(count: int, method: str = "random") -> dict:
    """A sampling."""
    return {"method": method, "count": count, **({} if method == "sobol" else {"seed": 1})}


def arm(robot: str, count: int, **fields) -> dict:
    """A robot with its samples, one of several."""
    return {"robot": robot, "sampling": sampled(count), **fields}


def pair(robot: str, count: int, **fields) -> dict:
    """The robots of a job: one and the same half a metre aside."""
    aside = {"library": robot, "placement": {"position_m": [0.5, 0, 0]}}
    return {"robots": [arm(robot, count), arm(robot, count) | {"robot": aside, "name": "other"}], **fields}


def points(count: int) -> list:
    """Targets in and around an arm's workspace."""
    return [[0.8 * ((k * s) % 1) - 0.4 for s in (0.6180339887, 0.7548776662, 0.5698402910)] for k in range(count)]


def rows(count: int) -> list:
    """Configurations of six joints."""
    return [[(k * s) % 1 for s in (0.61, 0.75, 0.56, 0.33, 0.47, 0.29)] for k in range(count)]


def down(count: int, listed: bool = False) -> dict:
    """Poses of a tip that looks down, in the fields of a list of targets or of one analysis of poses."""
    names = ("points_m", "quats_wxyz") if listed else ("position_m", "quat_wxyz")
    return dict(zip(names, (points(count), [[0, 1, 0, 0]] * count), strict=True))


def two_arms(robot: str, over: dict) -> dict:
    """Two arms of a kind, and where either may stand."""
    return {side: {"robot": robot, "over": over} for side in ("first", "second")}


PLAIN = {"refined_volume": None}
LIMITED = {"library": "ur5e", "velocity_limits": {f"joint{k}": 3.1 for k in range(1, 7)}}
PLACES = {"x_m": [-0.6, 0.6, 0.05], "y_m": [-0.6, 0.6, 0.05], "yaw_deg": [0, 360, 15]}
TARGET = {"position_m": [0.1, 0, 0.3], "quat_wxyz": [0, 1, 0, 0]}
SIZES = ((0.1, 70, 0.2), (0.4, 40, 0.1), (0.15, -80, 0.05), (0, 90, 0.35), (0.1, -90, 0.1), (0.05, 20, 0.1))
ROWS = [{"a": a, "alpha_deg": alpha, "d": d, "limits_deg": [-180, 180]} for a, alpha, d in SIZES]
GENERAL = {"dh": {"convention": "standard", "rows": ROWS}}  # without a closed form
POST = {"shape": "box", "name": "post", "size_m": [0.1, 0.1, 1.0], "position_m": [0.35, 0.3, 0.5]}
AMONG = {"environment": {"items": [POST]}, "constraints": {"self_collision": True}}
PLANE = {"sampling": {"method": "random", "count": 100_000, "locked": {"joint4": 0.0}}}
DESIGN = {"analysis": "parallel_workspace", "mechanism": {"library": "six_pus"}, "method": "exact"}
BALL = [{"limits_deg": [-90, 90]}, {"alpha_deg": 90, "limits_deg": [60, 150]}]
BALL = {"dh": {"convention": "modified", "rows": [*BALL, {"alpha_deg": 90, "joint": "prismatic", "limits": [2, 4]}]}}
SWEPT = {"analysis": "workspace", **arm("phantom_omni", 100_000), **PLAIN, "voxel_size_m": 0.01}
PLATFORM = {"name": "platform", "pointers": ["/mechanism/platform_m"], "bounds": [1, 3]}
SIZE = {"name": "size", "pointers": ["/voxel_size_m"], "bounds": [0.01, 0.02]}
SERIAL = {"type": "serial", "holds": "pose", "actuated": ["joint1", "joint3", "joint5"]}
SERIAL = [
    SERIAL
    | {"robot": {"library": "puma560", "placement": {"position_m": [x, 0, 0], "rpy_deg": [0, 0, turn]}}}
    | {"attachment": {"position_m": [x / 4, 0, 0]}}
    for x, turn in ((-0.6, 0), (0.6, 180))
]
# By analysis: the job that warms up, then those that are measured.
JOBS = {
    "workspace": {
        "small": arm("phantom_omni", 20_000) | PLAIN,
        "refined": arm("phantom_omni", 20_000),
        "default": {"robot": "ur5e"},
        "fine voxels": arm("ur5e", 4_000_000) | PLAIN | {"voxel_size_m": 0.01},
        "all, float64": arm("franka_panda", 2_000_000, precision="float64", indices="all", voxel_size_m=0.02)
        | PLAIN
        | {"voxel_statistics": ["count", "maximum", "mean", "minimum"]},
        "map": arm("ur5e", 4_000_000, keep_map=True, map_columns=["configuration"]) | PLAIN,
        "labels": arm("puma560", 1_000_000, voxel_labels=True, voxel_size_m=0.05) | PLAIN,
        "among shapes": arm("ur5e", 1_000_000, **AMONG, voxel_size_m=0.03) | PLAIN,
        "refined to .2 %": arm("stanford_arm", 1_000_000, refined_volume=0.002),
    },
    "capability": {
        "small": {"robot": "phantom_omni", "directions": 20, "voxel_size_m": 0.05},
        "default": {"robot": "phantom_omni"},
        "one direction": {"robot": "puma560", "directions": 1, "voxel_size_m": 0.02, "precision": "float32"},
        "among shapes": {"robot": "ur5e", "directions": 10, "voxel_size_m": 0.2, **AMONG},
        "many directions": {"robot": "spherical", "directions": 2000, "voxel_size_m": 0.05},
    },
    "kinetostatic_field": {
        "small": {"robot": "phantom_omni", "sampling": sampled(2048, "sobol")},
        "large": {"robot": "ur5e", "sampling": sampled(300_000, "sobol")},
    },
    "indices_at": {
        "small": {"robot": "phantom_omni", "configurations": rows(1000)},
        "large": {"robot": "ur5e", "configurations": rows(500_000)},
        "among shapes": {"robot": "ur5e", "configurations": rows(100_000), **AMONG},
        "all": {"robot": "puma560", "configurations": rows(300_000), "indices": "all", "precision": "float32"},
        "polytopes": {"robot": LIMITED, "configurations": rows(20), "polytopes": ["velocity", "force"]},
    },
    "postures": {
        "small": {"robot": "puma560", **down(50)},
        "default": {"robot": "ur5e", **down(20_000)},
        "positions": {"robot": "phantom_omni", "position_m": points(300)},
        "families": {"robot": "ur5e", "position_m": points(100)},
        "searched": {"robot": GENERAL, **down(1000)},
        "aspects": {"robot": "ur5e", **down(300), "aspects": True},
        "self-motions": {"robot": "franka_panda", **down(20)},
    },
    "base_placement": {
        "small": {"robot": "puma560", **down(4, listed=True), "over": PLACES | {"x_m": [-0.6, 0.6, 0.3]}},
        "default": {"robot": "ur5e", **down(20, listed=True), "over": PLACES},
        "scored": {"robot": "ur5e", **down(20, listed=True), "over": PLACES, "index": "manipulability"},
        "among shapes": {"robot": "ur5e", **down(20, listed=True), "over": PLACES, **AMONG},
        "positions": {"robot": "phantom_omni", "points_m": points(20), "over": PLACES},
    },
    "inverse_reachability": {
        "small": {"robot": "puma560", "target": TARGET, "over": PLACES | {"x_m": [-0.6, 0.6, 0.3]}},
        "default": {"robot": "ur5e", "target": TARGET, "over": PLACES},
        "among shapes": {"robot": "ur5e", "target": TARGET, "over": PLACES, **AMONG},
        "among shapes, 7 joints": {"robot": "franka_panda", "target": TARGET, "over": PLACES, **AMONG},
        "voxels": {"robot": "ur5e", "target": TARGET, "over": PLACES | {"z_m": [-0.6, 0.6, 0.05]}},
    },
    "two_arm_placement": {
        "small": {**down(4, listed=True), **two_arms("puma560", PLACES | {"x_m": [-0.6, 0.6, 0.3]})},
        "default": {**down(20, listed=True), **two_arms("ur5e", PLACES | {"yaw_deg": 0})},
        "among shapes": {**down(20, listed=True), **two_arms("ur5e", PLACES | {"yaw_deg": 0}), **AMONG},
    },
    "reachability": {
        "small": {"robot": "phantom_omni", "points_m": points(500)},
        "large": {"robot": "ur5e", "points_m": points(300_000)},
        "among shapes": {"robot": "ur5e", "points_m": points(1000), **AMONG},
        "poses among shapes": {"robot": "ur5e", **down(20_000, listed=True), **AMONG},
        "poses": {"robot": "puma560", "points_m": points(100_000), "quats_wxyz": [[1, 0, 0, 0]] * 100_000},
    },
    "shared_workspace": {
        "small": pair("phantom_omni", 20_000) | PLAIN,
        "refined": pair("ur5e", 1_000_000, refined_volume=0.01),
        "fine voxels": pair("ur5e", 2_000_000, voxel_size_m=0.01) | PLAIN,
        "scan": pair("phantom_omni", 200_000, scan={"robot": 1, "axis": "x", "values": [0.1 * k for k in range(12)]})
        | PLAIN,
    },
    "robot_comparison": {
        "small": pair("phantom_omni", 20_000) | PLAIN,
        "refined": pair("ur5e", 1_000_000, refined_volume=0.01),
        "fine voxels": pair("ur5e", 2_000_000, voxel_size_m=0.01) | PLAIN,
    },
    "collaborative_volume": {
        "small": {"left": {"robot": "phantom_omni"}, "right": {"robot": "phantom_omni"}, "samples": 20_000} | PLAIN,
        "default": {"left": {"robot": "gao_6r"}, "right": {"robot": "gao_6r"}},
        "many points": {"left": {"robot": "ur5e"}, "right": {"robot": "ur5e"}, "samples": 4_000_000, "seeds": 1}
        | PLAIN,
        "many cells": {"left": {"robot": "ur5e"}, "right": {"robot": "ur5e"}, "cells": [120] * 3, "seeds": 1} | PLAIN,
    },
    "master_slave_mapping": {
        "small": {"master": arm("phantom_omni", 2000), "slave": arm("phantom_omni", 2000)},
        "default": {"master": {"robot": "phantom_omni"}, "slave": {"robot": "phantom_omni"}, "scale": 0.5},
        "search": {"master": arm("phantom_omni", 5000), "slave": arm("ur5e", 5000), "search": {}},
        "large": {"master": arm("ur5e", 200_000), "slave": arm("phantom_omni", 20_000)},
        "voxels": {"master": arm("ur5e", 50_000), "slave": arm("phantom_omni", 5000)}
        | {"containment": {"kind": "voxels", "voxel_size_m": 0.003}},
    },
    "five_bar": {
        "small": {"base_m": 0.5, "proximal_m": 0.3, "distal_m": 0.4, "voxel_size_m": 0.02, "joint_steps": 60},
        "default": {"base_m": 0.5, "proximal_m": 0.3, "distal_m": 0.4},
        "fine": {"base_m": 0.5, "proximal_m": 0.3, "distal_m": 0.4, "voxel_size_m": 0.0025, "joint_steps": 400},
    },
    "planar_boundary": {
        "small": {"robot": "scara", "sampling": PLANE["sampling"] | {"count": 5000}},
        "default": {"robot": "scara", **PLANE},
        "large": {"robot": "scara", "sampling": PLANE["sampling"] | {"count": 5_000_000}},
    },
    "boundary_patches": {
        "small": {"robot": BALL, "cells": 16},
        "default": {"robot": "phantom_omni"},
        "default, ball": {"robot": BALL},
        "fine": {"robot": BALL, "cells": 128},
        "fitted": {"robot": "ur5e", "cells": 32},
    },
    "parallel_workspace": {
        "small": {"mechanism": "six_pus", "voxel_size_m": 0.2} | PLAIN,
        "default": {"mechanism": "six_pus"},
        "fine": {"mechanism": "stewart_gough", "voxel_size_m": 0.003} | PLAIN,
        "indices": {"mechanism": "six_pus", "voxel_size_m": 0.025, "indices": "kinematic"} | PLAIN,
        "dexterous": {"mechanism": "stewart_gough", "kind": "dexterous", "orientations": {"tilt_deg": 15}},
        "orientation": {"mechanism": "stewart_gough", "kind": "orientation", "position_m": [0, 0, 0.55]}
        | {"orientations": {"tilt_deg": 40}},
        "serial legs": {"mechanism": {"legs": SERIAL}, "voxel_size_m": 0.1} | PLAIN,
        "exact": {"mechanism": "six_pus", "method": "exact"},
        "solids": {"mechanism": "six_pus", "method": "solids"},
    },
    "method_comparison": {
        "small": {"mechanism": "six_pus", "voxel_sizes_m": [0.4], "ball_subdivisions": [1]},
        "default": {"mechanism": "six_pus"},
        "fine": {"mechanism": "stewart_gough", "voxel_sizes_m": [0.005], "ball_subdivisions": [6]},
    },
    "design_optimization": {
        "small": {"design": DESIGN, "parameters": [PLATFORM], "objectives": [{"value": "exact_volume"}]}
        | {"search": {"method": "sweep", "steps": 20}},
        "exact": {"design": DESIGN, "parameters": [PLATFORM], "objectives": [{"value": "exact_volume"}]}
        | {"search": {"method": "sweep", "steps": 2000}},
        "jobs": {"design": SWEPT, "parameters": [SIZE], "objectives": [{"value": "/volume_m3/occupied"}]}
        | {"search": {"method": "sweep", "steps": 5}},
    },
}
GIVEN = ("five_bar", "indices_at", "boundary_patches", "design_optimization")  # without a device


def job_of(analysis: str, size: str) -> dict:
    """The document of a job."""
    device = {} if analysis in GIVEN else {"device": "cpu"}
    return {"analysis": analysis, **device, **JOBS[analysis][size]}


def uncompressed(path: Path) -> int:
    """Bytes of a file, of a compressed one its numbers'."""
    if path.suffix == ".vtkhdf":
        import h5py

        with h5py.File(path) as file:
            return sum(each.size * each.dtype.itemsize for each in file["VTKHDF/CellData"].values())
    if path.suffix == ".parquet":
        import pyarrow.parquet as pq

        found = pq.ParquetFile(path).metadata
        return sum(found.row_group(k).total_byte_size for k in range(found.num_row_groups))
    return path.stat().st_size


def resident() -> dict[str, int]:
    """Bytes of this process: now (VmRSS) and at most (VmHWM)."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return {line.split(":")[0]: 1024 * int(line.split()[1]) for line in lines if line.startswith(("VmRSS", "VmHWM"))}


def settle() -> int:
    """Bytes of this process once what nobody uses is given back; its peak begins anew."""
    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)
    Path("/proc/self/clear_refs").write_text("5")
    return resident()["VmRSS"]


def taken(job: dict) -> dict[str, dict[str, float]]:
    """Estimate and what ran of a job."""
    from wsrender import run

    before = settle()
    planned = run.plan(job)
    estimate = planned.estimate
    settle()  # what the plan keeps counts, not what it took meanwhile
    done = 0

    def report(samples: int) -> None:
        nonlocal done
        done = max(done, samples)

    started = time.process_time()
    result = run.finish(planned, run.run_shard(planned, 0, report, threads=1), threads=1)
    peak = resident()["VmHWM"] - before
    with tempfile.TemporaryDirectory() as folder:
        result.save(Path(folder) / "result")
        seconds = time.process_time() - started
        files = [path for path in (Path(folder) / "result").rglob("*") if path.is_file()]
        size = sum(map(uncompressed, files))
    found = {"samples": done, "memory_bytes": peak, "file_bytes": size, "seconds": seconds}
    return {"estimate": {name: estimate[name] for name in found}, "found": found}


def one(analysis: str, size: str) -> None:
    """Run a job here, once warm, and print what it took as JSON."""
    taken(job_of(analysis, size if "environment" in JOBS[analysis][size] else "small"))
    print(json.dumps(taken(job_of(analysis, size))))


def main(names: list[str]) -> None:
    """Print estimates, what ran, and the ratios."""
    print(f"{'analysis':38} {'samples':>9} {'×':>6} {'MB':>8} {'×':>6} {'file MB':>8} {'×':>6} {'s':>8} {'×':>6}")
    for analysis, jobs in JOBS.items():
        for size in jobs:
            name = f"{analysis} {size}"
            if names and not any(each in name for each in names):
                continue
            command = [sys.executable, __file__, "--one", analysis, size]
            own = os.environ | ONE_THREAD | OWN_PAGES
            ran = subprocess.run(command, env=own, stdout=subprocess.PIPE, text=True, check=False)
            if ran.returncode:
                print(f"{name:38} failed", flush=True)
                continue
            found = json.loads(ran.stdout.splitlines()[-1])
            estimate, took = found["estimate"], found["found"]
            units = {"samples": 1.0, "memory_bytes": 1e6, "file_bytes": 1e6, "seconds": 1.0}
            cells = []
            for field, unit in units.items():
                ratio = estimate[field] / took[field] if took[field] else float("nan")
                cells.append(f"{took[field] / unit:{9 if unit == 1 else 8}.5g} {ratio:6.2f}")
            print(f"{name:38} {' '.join(cells)}", flush=True)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--one"]:
        one(*sys.argv[2:])
    else:
        main(sys.argv[1:])
