"""Estimates beside what ran: seconds of one core's time and bytes of files, of ten jobs of different analyses.

``python benchmarks/cost.py`` prints a line for each. The constants of ``wsrender/analyses/cost.py`` and the rates
beside each analysis were read off such runs; times are of this process on one thread, so that a busy machine changes
them little. Parquet and VTKHDF count as they are before they are compressed.
"""

import os
import tempfile
import time
from pathlib import Path

os.environ["WSRENDER_THREADS"] = "1"  # before anything starts threads

from wsrender import run

SAMPLING = {"method": "random", "count": 20_000, "seed": 1}
ARM = {"robot": "phantom_omni", "sampling": SAMPLING}
POINTS = [[0.1, 0.001 * k, 0.1] for k in range(500)]
JOBS = {
    "workspace": ARM,
    "capability": {"robot": "phantom_omni", "directions": 20, "voxel_size_m": 0.05},
    "kinetostatic_field": ARM | {"sampling": {"method": "sobol", "count": 2048}},
    "indices_at": {"robot": "phantom_omni", "configurations": [[0.1 * k for k in range(6)]] * 1000},
    "reachability": {"robot": "phantom_omni", "points_m": POINTS},
    "shared_workspace": {"robots": [ARM, ARM | {"name": "other"}]},
    "robot_comparison": {"robots": [ARM, ARM | {"name": "other"}]},
    "collaborative_volume": {"left": {"robot": "phantom_omni"}, "right": {"robot": "phantom_omni"}, "samples": 20_000},
    "master_slave_mapping": {"master": ARM, "slave": ARM},
    "five_bar": {"base_m": 0.5, "proximal_m": 0.3, "distal_m": 0.4},
}


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


def taken(job: dict) -> tuple[dict[str, float], float, int]:
    """Estimate, seconds and bytes of files of a job."""
    planned = run.plan(job)
    started = time.process_time()
    result = run.finish(planned, run.run_shard(planned, 0, threads=1))
    with tempfile.TemporaryDirectory() as folder:
        result.save(Path(folder) / "result")
        seconds = time.process_time() - started
        files = [path for path in (Path(folder) / "result").rglob("*") if path.is_file()]
        return planned.estimate, seconds, sum(map(uncompressed, files))


def main() -> None:
    """Print estimate, what ran, and their ratio."""
    print(f"{'analysis':22} {'s est.':>8} {'s ran':>8} {'ratio':>6} {'kB est.':>9} {'kB':>9} {'ratio':>6}")
    for analysis, fields in JOBS.items():
        job = {"analysis": analysis} | fields
        if analysis != "five_bar":
            job["device"] = "cpu"
        taken(job)  # kernels are compiled and modules imported
        estimate, seconds, files = taken(job)
        s, b = estimate["seconds"], estimate["file_bytes"]
        print(
            f"{analysis:22} {s:8.2f} {seconds:8.2f} {s / seconds:6.2f} "
            f"{b / 1e3:9.0f} {files / 1e3:9.0f} {b / files:6.2f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
